#pragma once

#include <cmath>

#include <pyroclast/laws/law.hpp>

/// The potential-based cohesive law of Park, Paulino and Roesler, J. Mech. Phys. Solids 57 (2009) 891-908,
/// with unloading to the origin, a penalty in compression, and Coulomb friction where shear is damaged and
/// the contact closed (Spring and Paulino, Int. J. Numer. Meth. Engng 2015).
///
/// With f(x) = (1 - x)^alpha (1 + alpha x / m)^m of x = u_n / delta_n, and g(y) likewise of y = |u_s| /
/// delta_t, the potential is phi - A B / phi, where phi = min(G_n, G_t), A = G_n f - <G_n - G_t>, B = G_t g -
/// <G_t - G_n>.
namespace ppr {

using namespace pyroclast;

/// x^y of 0 < x <= 1, from operations that all lanes have: 64 log(x^(1/64)) by its series, exp(.)^1024 by
/// Taylor's.
template <class Real, class Exponent>
Real power(const Real& x, const Exponent& y) {
  using std::sqrt;
  Real root = x;
  for (int i = 0; i < 6; ++i) root = sqrt(root);
  const Real z = (root - 1.0) / (root + 1.0), zz = z * z;
  Real log = 1.0 / 15.0;
  for (double k = 13.0; k > 0.0; k -= 2.0) log = log * zz + 1.0 / k;
  const Real part = log * z * 128.0 * y * (1.0 / 1024.0);
  Real exp = 1.0;
  for (double k = 11.0; k > 0.0; k -= 1.0) exp = exp * part * (1.0 / k) + 1.0;
  for (int i = 0; i < 10; ++i) exp = exp * exp;
  return exp;
}

struct Law {
  static constexpr const char* name = "ppr";
  static constexpr const char* meaning =
      "potential-based, any shape of softening (Park, Paulino and Roesler 2009)";

  template <class Real>
  struct Properties {
    using Law = ppr::Law;
    Real normal_energy{}, shear_energy{};      ///< G_n, G_t, J/m²
    Real normal_strength{}, shear_strength{};  ///< Pa
    Real normal_shape{}, shear_shape{};  ///< alpha, beta: 2 softens about linearly, more has a longer tail
    Real normal_slope{}, shear_slope{};  ///< lambda: the jump at the peak over the last one
    Real friction{};

    template <class F, class... P>
    static constexpr void each(F&& f, P&... p) {
      using enum Role;
      constexpr Range kPositive = Range::positive(), kShape = Range::above(1.0),
                      kSlope = Range::inside(0.0, 1.0);
      f(PropertyInfo{"G_n", "work of separation in tension", unit::fracture_energy, kPositive, energy},
        p.normal_energy...);
      f(PropertyInfo{"G_t", "work of separation in shear", unit::fracture_energy, kPositive, energy},
        p.shear_energy...);
      f(PropertyInfo{"sigma_max", "strength in tension", unit::stress, kPositive, strength},
        p.normal_strength...);
      f(PropertyInfo{"tau_max", "strength in shear", unit::stress, kPositive, strength}, p.shear_strength...);
      f(PropertyInfo{"alpha", "shape in tension", unit::dimensionless, kShape}, p.normal_shape...);
      f(PropertyInfo{"beta", "shape in shear", unit::dimensionless, kShape}, p.shear_shape...);
      f(PropertyInfo{"lambda_n", "opening at the peak over the last one", unit::dimensionless, kSlope},
        p.normal_slope...);
      f(PropertyInfo{"lambda_t", "tangential jump at the peak over the last one", unit::dimensionless,
                     kSlope},
        p.shear_slope...);
      f(PropertyInfo{"friction", "coefficient of friction", unit::dimensionless, Range::non_negative()},
        p.friction...);
    }
    template <class F, class... P>
    static constexpr void each_choice(F&&, P&...) {}
  };

  /// One direction: tension or shear.
  template <class Real>
  struct Direction {
    Real energy, surplus;         ///< G, <G - other G>, J/m²
    Real shape, exponent, start;  ///< alpha, m, m / alpha
    Real last;                    ///< delta, m
    Real stiffness;               ///< of the intact contact, Pa/m

    template <class F, class... D>
    static constexpr void each(F& f, D&... d) {
      f(Nothing{}, d.energy...), f(Nothing{}, d.surplus...), f(Nothing{}, d.shape...),
          f(Nothing{}, d.exponent...);
      f(Nothing{}, d.start...), f(Nothing{}, d.last...), f(Nothing{}, d.stiffness...);
    }
  };

  template <class Real>
  struct Constants {
    Direction<Real> normal, shear;
    Real least_energy;  ///< phi, J/m²
    Real friction;

    template <class F, class... C>
    static constexpr void each(F&& f, C&... c) {
      Direction<Real>::each(f, c.normal...), Direction<Real>::each(f, c.shear...);
      f(Nothing{}, c.least_energy...), f(Nothing{}, c.friction...);
    }
    template <class F, class... C>
    static constexpr void each_choice(F&&, C&...) {}
  };

  static Constants<double> derive(const Properties<double>& p) {
    const auto direction = [](double energy, double other, double strength, double shape, double slope) {
      Direction<double> d;
      const double m = shape * (shape - 1.0) * slope * slope / (1.0 - shape * slope * slope);
      d.energy = energy;
      d.surplus = energy > other ? energy - other : 0.0;
      d.shape = shape, d.exponent = m, d.start = m / shape;
      d.last = energy / strength * shape * slope * std::pow(1.0 - slope, shape - 1.0) * (shape / m + 1.0) *
               std::pow(shape / m * slope + 1.0, m - 1.0);
      d.stiffness = energy * (m + shape) * shape / (m * d.last * d.last);
      return d;
    };
    return {direction(p.normal_energy, p.shear_energy, p.normal_strength, p.normal_shape, p.normal_slope),
            direction(p.shear_energy, p.normal_energy, p.shear_strength, p.shear_shape, p.shear_slope),
            p.normal_energy < p.shear_energy ? p.normal_energy : p.shear_energy, p.friction};
  }

  static Objection check(const Properties<double>& p) {
    if (!(p.normal_slope * p.normal_slope * p.normal_shape < 1.0))
      return {"lambda_n", "less than 1 / sqrt(alpha) = %g", 1.0 / std::sqrt(p.normal_shape)};
    if (!(p.shear_slope * p.shear_slope * p.shear_shape < 1.0))
      return {"lambda_t", "less than 1 / sqrt(beta) = %g", 1.0 / std::sqrt(p.shear_shape)};
    return {};
  }

  /// Friction has a spring of its own beside the cohesive one.
  template <class Real>
  static ContactStiffness<Real> stiffness(const Constants<Real>& c) {
    return {c.normal.stiffness, 2.0 * c.shear.stiffness};
  }

  static constexpr unsigned kDamaged = 1, kSlid = 2;

  template <int Dim, class Real>
  struct Internals {
    Real opened{}, sheared{};               ///< the largest jumps, m
    Real tension_damage{}, shear_damage{};  ///< 1 - secant over first stiffness
    Tangential<Dim, Real> slip{};           ///< of friction, m
    Real held{};                            ///< stretch of friction's spring, m

    template <class F, class... H>
    static constexpr void each(F&& f, H&... h) {
      using enum Remembers;
      f(InternalInfo{"opened", "largest opening", unit::length, other, kDamaged}, h.opened...);
      f(InternalInfo{"sheared", "largest tangential jump", unit::length, other, kDamaged}, h.sheared...);
      f(InternalInfo{"tension_damage", "0 intact, 1 broken", unit::dimensionless, Remembers::tension_damage,
                     kDamaged},
        h.tension_damage...);
      f(InternalInfo{"shear_damage", "0 intact, 1 broken", unit::dimensionless, Remembers::shear_damage,
                     kDamaged},
        h.shear_damage...);
      for (int i = 0; i + 1 < Dim; ++i)
        f(InternalInfo{"slip", "of friction", unit::length, other, kSlid, false}, h.slip[i]...);
      f(InternalInfo{"held", "stretch of friction's spring", unit::length, other, 0, false}, h.held...);
    }
  };

  template <class Sum>
  struct Losses {
    Sum separation, friction;

    template <class F, class... L>
    static constexpr void each(F&& f, L&... l) {
      f(LossInfo{"separation", "G_n or G_t when separated in one mode", unit::fracture_energy},
        l.separation...);
      f(LossInfo{"friction", "rubbed off", unit::fracture_energy}, l.friction...);
    }
  };

  /// The factor of a direction in the potential, and its secant stiffness over the first one, as far as it
  /// hangs on that direction.
  template <class Real>
  struct Factor {
    Real value, secant;
  };
  template <class Real, class Number>
  static Factor<Real> factor(const Direction<Number>& d, const Real& jump) {
    const Real x = smaller(jump / d.last, Real(1.0)), left = 1.0 - x;
    const Real tail = select(left > 1e-9, power<Real>(larger(left, Real(1e-9)), d.shape - 1.0), Real(0.0));
    // (1 + x / start)^(m - 1), as the reciprocal of numbers up to 1
    const Real base = d.start / (d.start + x);
    const Real rise = power<Real>(base, 1.0 - d.exponent);
    return {d.energy * tail * left * rise / base - d.surplus, tail * rise};
  }

  template <int Dim, class Real, class Number, class Sum>
  static ContactResponse<Dim, Real> update(const Constants<Number>& c, const Real& opening,
                                           const Tangential<Dim, Real>& jump, Internals<Dim, Real>& h,
                                           Losses<Sum>& losses) {
    ContactResponse<Dim, Real> r;
    const Real none = 0.0, open = larger(opening, none), pressed = smaller(opening, none),
               sheared = norm(jump);
    if (any((open > h.opened) | (sheared > h.sheared))) separate(c, open, sheared, h, losses, r.changed);
    const Real k_n = (1.0 - h.tension_damage) * c.normal.stiffness,
               k_s = (1.0 - h.shear_damage) * c.shear.stiffness;
    r.normal_traction = k_n * open + c.normal.stiffness * pressed;
    r.shear_traction = jump * k_s;
    r.stored = 0.5 * (r.normal_traction * opening + k_s * sheared * sheared);

    // friction on the damaged share, by a return of its own spring
    const Real spring = c.shear.stiffness;
    const Real carried = h.shear_damage * c.friction * -c.normal.stiffness * pressed;
    Tangential<Dim, Real> stretch = jump - h.slip;
    Real length = norm(stretch);
    const auto slides = spring * length > carried;
    if (any(slides)) {
      const Real held = carried / spring, way = select(slides, length - held, none);
      // what a smaller pressure no longer holds is lost too
      const Real dropped = larger(h.held - held, none);
      losses.friction += select(
          slides, carried * larger(way - dropped, none) + 0.5 * spring * dropped * (held + h.held), none);
      const Tangential<Dim, Real> step = stretch * select(slides, way / length, none);
      h.slip += step;
      stretch -= step;
      length = select(slides, held, length);
      r.changed |= kSlid;
    }
    h.held = length;
    r.shear_traction += stretch * spring;
    r.stored += 0.5 * spring * length * length;
    return r;
  }

 private:
  /// Takes the largest jumps on. Along one axis the loss is exact: work by the potential less what is stored.
  template <int Dim, class Real, class Number, class Losses>
  static void separate(const Constants<Number>& c, const Real& open, const Real& sheared,
                       Internals<Dim, Real>& h, Losses& losses, unsigned& changed) {
    const Real none = 0.0, opened = larger(h.opened, open), slid = larger(h.sheared, sheared);
    const auto n0 = factor<Real>(c.normal, h.opened), n1 = factor<Real>(c.normal, opened);
    const auto t0 = factor<Real>(c.shear, h.sheared), t1 = factor<Real>(c.shear, slid);
    const Real per = 1.0 / c.least_energy;
    const Real work = per * ((n0.value - n1.value) * larger(t0.value, none) +
                             (t0.value - t1.value) * larger(n1.value, none));
    const Real damage_n = larger(1.0 - n1.secant * larger(t1.value, none) * per, h.tension_damage);
    const Real damage_t = larger(1.0 - t1.secant * larger(n1.value, none) * per, h.shear_damage);
    const auto held = [](const Real& damage, const Real& k, const Real& u) {
      return 0.5 * (1.0 - damage) * k * u * u;
    };
    const Real k_n = c.normal.stiffness, k_s = c.shear.stiffness;
    const Real stored = held(damage_n, k_n, opened) - held(h.tension_damage, k_n, h.opened) +
                        held(damage_t, k_s, slid) - held(h.shear_damage, k_s, h.sheared);
    // a direction that is not at its largest jump loses less
    const Real kept = 0.5 * k_n * (damage_n - h.tension_damage) * (opened * opened - open * open) +
                      0.5 * k_s * (damage_t - h.shear_damage) * (slid * slid - sheared * sheared);
    losses.separation += work - stored - kept;
    h.opened = opened, h.sheared = slid;
    h.tension_damage = damage_n, h.shear_damage = damage_t;
    changed |= kDamaged;
  }
};

}  // namespace ppr
