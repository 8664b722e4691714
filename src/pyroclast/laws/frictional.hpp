#pragma once

#include "pyroclast/laws/law.hpp"

namespace pyroclast {

/// A contact that holds no tension and no cohesion: pressure along K_n, Coulomb friction along K_s, as
/// between a platen and the specimen. What it still carried in shear when it opens goes into friction.
struct Frictional {
  static constexpr const char* name = "frictional";
  static constexpr const char* meaning = "presses and rubs, never held";
  static const LawRows rows;

  template <class Real>
  struct Properties {
    using Law = Frictional;

    Real normal_stiffness{};  ///< K_n, Pa/m
    Real shear_stiffness{};   ///< K_s, Pa/m
    Real friction{};          ///< coefficient of friction

    template <class F, class... P>
    static constexpr void each(F&& f, P&... p) {
      f(PropertyInfo{"K_n", "normal stiffness", unit::stiffness_per_area, Range::positive(),
                     Role::normal_stiffness},
        p.normal_stiffness...);
      f(PropertyInfo{"K_s", "shear stiffness", unit::stiffness_per_area, Range::positive(),
                     Role::shear_stiffness},
        p.shear_stiffness...);
      f(PropertyInfo{"friction", "coefficient of friction", unit::dimensionless, Range::non_negative()},
        p.friction...);
    }
    template <class F, class... P>
    static constexpr void each_choice(F&&, P&...) {}
  };

  template <class Real>
  struct Constants {
    Real normal_stiffness, shear_stiffness;  ///< Pa/m
    Real shear_compliance;                   ///< 1 / K_s, m/Pa
    Real friction;

    template <class F, class... C>
    static constexpr void each(F&& f, C&... c) {
      f(Nothing{}, c.normal_stiffness...);
      f(Nothing{}, c.shear_stiffness...);
      f(Nothing{}, c.shear_compliance...);
      f(Nothing{}, c.friction...);
    }
    template <class F, class... C>
    static constexpr void each_choice(F&&, C&...) {}
  };

  /// Of History.
  static constexpr unsigned kSlid = 1;

  template <int Dim, class Real>
  struct History {
    Tangential<Dim, Real> slip{};  ///< m
    Real held_jump{};              ///< m

    template <class F, class... H>
    static constexpr void each(F&& f, H&... h) {
      for (int i = 0; i + 1 < Dim; ++i)
        f(HistoryInfo{"slip", "irreversible part of the tangential jump", unit::length, Remembers::other,
                      kSlid, false},
          h.slip[i]...);
      f(HistoryInfo{"held_jump", "length of the elastic part of the tangential jump", unit::length,
                    Remembers::other, 0, false},
        h.held_jump...);
    }
  };

  template <class Sum>
  struct Losses {
    Sum slip_path, friction;

    template <class F, class... L>
    static constexpr void each(F&& f, L&... l) {
      f(LossInfo{"slip_path", "length of the slip's path", unit::length}, l.slip_path...);
      f(LossInfo{"friction", "rubbed off", unit::fracture_energy}, l.friction...);
    }
  };

  static Constants<double> derive(const Properties<double>& p) {
    return {p.normal_stiffness, p.shear_stiffness, 1.0 / p.shear_stiffness, p.friction};
  }
  static Objection check(const Properties<double>&) { return {}; }

  template <class Real>
  static ContactStiffness<Real> stiffness(const Constants<Real>& c) {
    return {c.normal_stiffness, c.shear_stiffness};
  }

  template <int Dim, class Real, class Number, class Sum>
  static ContactResponse<Dim, Real> update(const Constants<Number>& c, const Real& opening,
                                           const Tangential<Dim, Real>& tangential, History<Dim, Real>& h,
                                           Losses<Sum>& losses) {
    ContactResponse<Dim, Real> r;
    const auto k = c.shear_stiffness;
    const Real pressed = smaller(opening, Real(0.0));
    r.normal_traction = c.normal_stiffness * pressed;
    Tangential<Dim, Real> elastic = tangential - h.slip;
    Real held = norm(elastic);
    const Real carried = larger(-r.normal_traction * c.friction, Real(0.0));  // shear that friction holds
    const Real excess = k * held - carried;
    const auto open = opening > 0.0;
    const auto slips = (excess > 0.0) & !open;
    if (any(slips)) {
      const Real length = select(slips, excess * c.shear_compliance, Real(0.0));
      losses.friction += carried * length;
      losses.slip_path += length;
      Tangential<Dim, Real> step;
      if constexpr (Dim == 2)
        step[0] = signed_like(length, elastic[0]);
      else
        step = elastic * select(slips, length / held, Real(0.0));
      h.slip += step;
      elastic -= step;
      held = norm(elastic);
      r.changed = kSlid;
    }
    if (any(open)) {
      const Real released = select(open, 0.5 * k * h.held_jump * h.held_jump, Real(0.0));
      if (any(released > 0.0)) losses.friction += released;
      held = select(open, Real(0.0), held);
      for (int i = 0; i + 1 < Dim; ++i) {
        h.slip[i] = select(open, tangential[i], h.slip[i]);
        elastic[i] = select(open, Real(0.0), elastic[i]);
      }
      r.changed = kSlid;
    }
    h.held_jump = held;
    r.shear_traction = elastic * Real(k);
    r.stored = 0.5 * r.normal_traction * pressed + 0.5 * k * held * held;
    return r;
  }
};

}  // namespace pyroclast
