#pragma once

#include "pyroclast/laws/cohesive.hpp"
#include "pyroclast/laws/mixed_mode.hpp"

namespace pyroclast {

/// Law of a contact that loses strength to cracks below the mesh, less where it is pressed while they form,
/// around another law (docs/understand/theory.md, "Strength that remembers its load").
///
/// Paste and sand part inside a block as they expand apart. A(T) is the share of strength that this takes
/// from a contact without load. A point keeps the share 1 - a of the strengths of the law around which this
/// one is,
///
///     da = w dA,   w = max(0, 1 - p / p_close),
///
/// where A exceeds its greatest value so far, and again where it falls farther below that than ever, for the
/// mismatch that creep has taken opens the cracks anew on cooling. p is the pressure after the last update.
/// So a changes only in the first update after a change of properties, and does not depend on steps.
///
/// \tparam Base  law with `weakened(constants, left)`
/// \tparam Self  law that derives from this one and names it
template <class Base, class Self>
struct WithMemory : Base {
  /// Bit of ContactResponse::changed: the share lost may have changed.
  static constexpr unsigned kLost = 4;
  /// Bound of A. A point loses at most 2 A, on heating and on cooling.
  static constexpr double kMostCracks = 0.5;

  /// Parameters at one temperature. Strengths are those that no crack below the mesh has weakened.
  template <class Real>
  struct Properties : Base::template Properties<Real> {
    using Law = Self;

    Real cracks{};            ///< A, share of strength
    Real closing_pressure{};  ///< p_close, Pa

    template <class F, class... P>
    static constexpr void each(F&& f, P&... p) {
      Base::template Properties<Real>::each(f, p...);
      f(PropertyInfo{"cracks", "share of strengths lost to cracks below the mesh without load",
                     unit::dimensionless, Range{.lower = 0.0, .upper = kMostCracks, .upper_inclusive = false},
                     Role::hidden_cracks},
        p.cracks...);
      f(PropertyInfo{"p_close", "pressure that keeps such cracks shut", unit::stress,
                     Range::positive().usually(1e4, 50e6), Role::cold_strength},
        p.closing_pressure...);
    }
  };

  /// Constants that follow from the parameters.
  template <class Real>
  struct Constants : Base::template Constants<Real> {
    Real cracks;                 ///< A
    Real over_closing_pressure;  ///< 1 / p_close, 1/Pa

    template <class F, class... C>
    static constexpr void each(F&& f, C&... c) {
      Base::template Constants<Real>::each(f, c...);
      f(Nothing{}, c.cracks...);
      f(Nothing{}, c.over_closing_pressure...);
    }
  };

  static Constants<double> derive(const Properties<double>& p) {
    Constants<double> c;
    static_cast<typename Base::template Constants<double>&>(c) = Base::derive(p);
    c.cracks = p.cracks;
    c.over_closing_pressure = 1.0 / p.closing_pressure;
    return c;
  }

  /// Internal variables of a contact point.
  template <int Dim, class Real>
  struct Internals : Base::template Internals<Dim, Real> {
    Real lost{};      ///< a
    Real most{};      ///< greatest A so far
    Real reopened{};  ///< how far A fell below that at most
    Real pressure{};  ///< p, Pa

    template <class F, class... H>
    static constexpr void each(F&& f, H&... h) {
      Base::template Internals<Dim, Real>::each(f, h...);
      f(InternalInfo{"lost_strength", "share of strengths lost to cracks below the mesh; never decreases",
                     unit::dimensionless, pyroclast::Remembers::lost_strength, kLost},
        h.lost...);
      f(InternalInfo{"most_cracks", "greatest value of cracks so far", unit::dimensionless,
                     pyroclast::Remembers::parameter, kLost, false},
        h.most...);
      f(InternalInfo{"reopened", "how far cracks fell below their greatest value at most",
                     unit::dimensionless, pyroclast::Remembers::parameter, kLost, false},
        h.reopened...);
      f(InternalInfo{"pressure", "after the last update", unit::stress, pyroclast::Remembers::other, 0,
                     false},
        h.pressure...);
    }
  };

  template <int Dim, class Real, class Number, class Losses>
  static ContactResponse<Dim, Real> update(const Constants<Number>& c, const Real& opening,
                                           const Tangential<Dim, Real>& tangential, Internals<Dim, Real>& h,
                                           Losses& losses) {
    const Real cracks = Real(c.cracks);
    const bool loses = any((cracks > h.most) | (h.most - cracks > h.reopened));
    if (loses) lose<Dim>(cracks, Real(c.over_closing_pressure), h);
    const Real left = 1.0 - h.lost;
    auto response =
        Base::template update<Dim>(Base::template weakened<Real>(c, left), opening, tangential,
                                   static_cast<typename Base::template Internals<Dim, Real>&>(h), losses);
    h.pressure = larger(0.0 - response.normal_traction, Real(0.0));
    if (loses) response.changed |= kLost;
    return response;
  }

 private:
  template <int Dim, class Real>
  static void lose(const Real& cracks, const Real& over_closing_pressure, Internals<Dim, Real>& h) {
    const Real most = larger(cracks, h.most), reopened = larger(most - cracks, h.reopened);
    const Real open = larger(1.0 - h.pressure * over_closing_pressure, Real(0.0));
    h.lost += ((most - h.most) + (reopened - h.reopened)) * open;
    h.most = most;
    h.reopened = reopened;
  }
};

struct CohesiveWithMemory : WithMemory<Cohesive, CohesiveWithMemory> {
  static constexpr const char* name = "remembers";
  static constexpr const char* meaning =
      "cohesive, and loses strength when heated and cooled, less where it is pressed";
  static const CompiledForSets compiled;
};

struct MixedModeWithMemory : WithMemory<MixedMode, MixedModeWithMemory> {
  static constexpr const char* name = "remembers_mixed_mode";
  static constexpr const char* meaning =
      "mixed_mode, and loses strength when heated and cooled, less where it is pressed";
  static const CompiledForSets compiled;
};

}  // namespace pyroclast
