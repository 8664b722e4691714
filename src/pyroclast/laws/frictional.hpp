#pragma once

#include "pyroclast/laws/common.hpp"

namespace pyroclast {

/// A contact that holds no tension and no cohesion: pressure along K_n, Coulomb friction along K_s, as
/// between a platen and the specimen. What it still carried in shear when it opens goes into friction.
struct Frictional {
  static constexpr const char* name = "frictional";
  static constexpr const char* meaning = "presses and rubs, never held";
  static const CompiledForSets compiled;

  template <class Real>
  struct Properties {
    using Law = Frictional;

    Real normal_stiffness{};  ///< K_n, Pa/m
    Real shear_stiffness{};   ///< K_s, Pa/m
    Real friction{};          ///< coefficient of friction

    template <class F, class... P>
    static constexpr void each(F&& f, P&... p) {
      f(info::normal_stiffness, p.normal_stiffness...);
      f(info::shear_stiffness, p.shear_stiffness...);
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

  template <int Dim, class Real>
  struct Internals {
    Tangential<Dim, Real> slip{};  ///< m
    Real held_jump{};              ///< m

    template <class F, class... H>
    static constexpr void each(F&& f, H&... h) {
      for (int i = 0; i + 1 < Dim; ++i) f(info::slip, h.slip[i]...);
      f(info::held_jump, h.held_jump...);
    }
  };

  template <class Sum>
  struct Losses {
    Sum slip_path, friction;

    template <class F, class... L>
    static constexpr void each(F&& f, L&... l) {
      f(info::slip_path, l.slip_path...);
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
                                           const Tangential<Dim, Real>& tangential, Internals<Dim, Real>& h,
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
      slide<Dim>(slips, length, h.slip, elastic, held);
      r.changed = info::kSlid;
    }
    if (any(open)) {
      let_go<Dim>(open, k, tangential, h.held_jump, h.slip, elastic, held, losses.friction);
      r.changed = info::kSlid;
    }
    h.held_jump = held;
    r.shear_traction = elastic * Real(k);
    r.stored = 0.5 * r.normal_traction * pressed + 0.5 * k * held * held;
    return r;
  }
};

}  // namespace pyroclast
