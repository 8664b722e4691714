#pragma once

#include <pyroclast/laws/cohesive.hpp>

/// The law of the paper under another name, with one more property, internal variables and loss.
namespace renamed {

struct Law {
  static constexpr const char* name = "renamed";
  static constexpr const char* meaning = "the paper's, and it remembers how far it was open when it was torn";

  using Paper = pyroclast::Cohesive;

  template <class Real>
  struct Properties : Paper::Properties<Real> {
    using Law = renamed::Law;

    Real mark{};  ///< m

    template <class F, class... P>
    static constexpr void each(F&& f, P&... p) {
      Paper::Properties<Real>::each(f, p...);
      f(pyroclast::PropertyInfo{"u_mark", "openings beyond it are counted", pyroclast::unit::length,
                                pyroclast::Range::non_negative()},
        p.mark...);
    }
  };

  template <class Real>
  struct Constants : Paper::Constants<Real> {
    Real mark{};

    template <class F, class... C>
    static constexpr void each(F&& f, C&... c) {
      Paper::Constants<Real>::each(f, c...);
      f(pyroclast::Nothing{}, c.mark...);
    }
  };

  template <int Dim, class Real>
  struct Internals : Paper::Internals<Dim, Real> {
    Real torn_at{};  ///< m

    template <class F, class... H>
    static constexpr void each(F&& f, H&... h) {
      Paper::Internals<Dim, Real>::each(f, h...);
      f(pyroclast::InternalInfo{"torn_at", "opening at which damage last grew", pyroclast::unit::length,
                                pyroclast::Remembers::other, pyroclast::info::kDamaged},
        h.torn_at...);
    }
  };

  template <class Sum>
  struct Losses : Paper::Losses<Sum> {
    Sum marked;

    template <class F, class... L>
    static constexpr void each(F&& f, L&... l) {
      Paper::Losses<Sum>::each(f, l...);
      f(pyroclast::LossInfo{"marked", "damage in tension beyond the mark", pyroclast::unit::dimensionless},
        l.marked...);
    }
  };

  static Constants<double> derive(const Properties<double>& p) { return {Paper::derive(p), p.mark}; }
  static pyroclast::Objection check(const Properties<double>& p) { return Paper::check(p); }

  template <class Real>
  static pyroclast::ContactStiffness<Real> stiffness(const Constants<Real>& c) {
    return Paper::stiffness<Real>(c);
  }

  template <int Dim, class Real, class Number, class Sum>
  static pyroclast::ContactResponse<Dim, Real> update(const Constants<Number>& c, const Real& opening,
                                                      const pyroclast::Tangential<Dim, Real>& tangential,
                                                      Internals<Dim, Real>& h, Losses<Sum>& losses) {
    using pyroclast::select;  // for one number; of lanes it is found by itself
    const Real before = h.tension_damage;
    const auto response = Paper::update<Dim, Real, Number, Sum>(c, opening, tangential, h, losses);
    if ((response.changed & pyroclast::info::kDamaged) != 0) {
      const auto grew = h.tension_damage > before;
      h.torn_at = select(grew, opening, h.torn_at);
      losses.marked += select(grew & (opening > c.mark), h.tension_damage - before, Real(0.0));
    }
    return response;
  }
};

}  // namespace renamed
