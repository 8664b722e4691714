#pragma once

#include <cmath>

#include <pyroclast/laws/law.hpp>

/// A law for plane bodies, with a function that no compiler inlines: the linker must not share it among
/// instruction sets.
namespace small {

[[gnu::noinline]] inline double doubled(double x) {
  return x + x;
}

struct Law {
  static constexpr const char* name = "small";
  static constexpr const char* meaning = "a spring in each direction";

  template <class Real>
  struct Properties {
    using Law = small::Law;

    Real stiffness{};  ///< Pa/m

    template <class F, class... P>
    static constexpr void each(F&& f, P&... p) {
      f(pyroclast::PropertyInfo{"K", "half the stiffness in each direction",
                                pyroclast::unit::stiffness_per_area, pyroclast::Range::positive()},
        p.stiffness...);
    }
    template <class F, class... P>
    static constexpr void each_choice(F&&, P&...) {}
  };

  template <class Real>
  struct Constants {
    Real stiffness;

    template <class F, class... C>
    static constexpr void each(F&& f, C&... c) {
      f(pyroclast::Nothing{}, c.stiffness...);
    }
    template <class F, class... C>
    static constexpr void each_choice(F&&, C&...) {}
  };

  template <int Dim, class Real>
  struct Internals : pyroclast::Nothing {};
  template <class Sum>
  struct Losses : pyroclast::Nothing {};

  static Constants<double> derive(const Properties<double>& p) { return {doubled(p.stiffness)}; }
  static pyroclast::Objection check(const Properties<double>&) { return {}; }

  template <class Real>
  static pyroclast::ContactStiffness<Real> stiffness(const Constants<Real>& c) {
    return {c.stiffness, c.stiffness};
  }

  template <int Dim, class Real, class Number, class Sum>
  static pyroclast::ContactResponse<Dim, Real> update(const Constants<Number>& c, const Real& opening,
                                                      const pyroclast::Tangential<Dim, Real>& tangential,
                                                      Internals<Dim, Real>&, Losses<Sum>&) {
    static_assert(Dim == 2);
    const Real half = doubled(0.25);
    pyroclast::ContactResponse<Dim, Real> r;
    r.normal_traction = c.stiffness * opening;
    r.shear_traction = tangential * Real(c.stiffness);
    r.stored = half * c.stiffness * (opening * opening + dot(tangential, tangential));
    return r;
  }
};

}  // namespace small
