#pragma once

#include "pyroclast/laws/common.hpp"

namespace pyroclast {

/// A contact that never fails and remembers nothing, as between two blocks of aggregate (paper §3.1).
struct Elastic {
  static constexpr const char* name = "elastic";
  static constexpr const char* meaning = "never fails";
  static const CompiledForSets compiled;

  template <class Real>
  struct Properties {
    using Law = Elastic;

    Real normal_stiffness{};  ///< K_n, Pa/m
    Real shear_stiffness{};   ///< K_s, Pa/m

    template <class F, class... P>
    static constexpr void each(F&& f, P&... p) {
      f(info::normal_stiffness, p.normal_stiffness...);
      f(info::shear_stiffness, p.shear_stiffness...);
    }
    template <class F, class... P>
    static constexpr void each_choice(F&&, P&...) {}
  };

  template <class Real>
  using Constants = Properties<Real>;

  template <int Dim, class Real>
  struct Internals : Nothing {};
  template <class Sum>
  struct Losses : Nothing {};

  static Constants<double> derive(const Properties<double>& p) { return p; }
  static Objection check(const Properties<double>&) { return {}; }

  template <class Real>
  static ContactStiffness<Real> stiffness(const Constants<Real>& c) {
    return {c.normal_stiffness, c.shear_stiffness};
  }

  template <int Dim, class Real, class Number, class Sum>
  static ContactResponse<Dim, Real> update(const Constants<Number>& c, const Real& opening,
                                           const Tangential<Dim, Real>& tangential, Internals<Dim, Real>&,
                                           Losses<Sum>&) {
    ContactResponse<Dim, Real> r;
    const auto k_n = c.normal_stiffness;
    const auto k_s = c.shear_stiffness;
    r.normal_traction = k_n * opening;
    r.shear_traction = tangential * Real(k_s);
    r.stored = 0.5 * k_n * opening * opening + 0.5 * k_s * dot(tangential, tangential);
    return r;
  }
};

}  // namespace pyroclast
