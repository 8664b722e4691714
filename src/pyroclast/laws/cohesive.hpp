#pragma once

#include "pyroclast/laws/common.hpp"

namespace pyroclast {

/// Contact law of the paper, Eqs. (10)-(15): linear softening in tension, softening Mohr-Coulomb friction in
/// shear, bilinear compression.
///
/// Along one axis (opening alone, or sliding at a steady opening) the result does not depend on how the path
/// to the jump is cut into steps. On combined paths friction follows the pressure at the end of each step, so
/// the result converges with the number of steps. Energies are closed forms of the internal variables, not
/// quadratures. When the law is taken again to the jump of its last update, it gives the same tractions and
/// loses nothing.
struct Cohesive {
  static constexpr const char* name = "cohesive";
  static constexpr const char* meaning = "softens in tension and shear, yields in compression (the paper's)";
  static const CompiledForSets compiled;

  using Compression = pyroclast::Compression;

  /// Parameters at one temperature (paper, Tables 1 and 2).
  template <class Real>
  struct Properties {
    using Law = Cohesive;

    Real normal_stiffness{};         ///< K_n, Pa/m
    Real shear_stiffness{};          ///< K_s, Pa/m
    Real tensile_strength{};         ///< f_t, Pa
    Real mode_1_energy{};            ///< G_f1, J/m²
    Real compressive_limit{};        ///< f_cm, end of the first slope in compression, Pa; may be infinite
    Real hardening{};                ///< beta, second slope over first
    Real cohesion{};                 ///< c_o, Pa
    Real residual_cohesion{};        ///< c_res, Pa
    Real friction_angle{};           ///< phi, rad
    Real residual_friction_angle{};  ///< phi_res, rad
    Real mode_2_energy{};            ///< G_f2, J/m²
    Compression compression = Compression::irreversible;
    bool coupled = false;  ///< true: the factor 1 - D_t also scales the cohesion

    template <class F, class... P>
    static constexpr void each(F&& f, P&... p) {
      f(info::normal_stiffness, p.normal_stiffness...);
      f(info::shear_stiffness, p.shear_stiffness...);
      f(info::tensile_strength, p.tensile_strength...);
      f(info::mode_1_energy, p.mode_1_energy...);
      f(info::compressive_limit, p.compressive_limit...);
      f(info::hardening, p.hardening...);
      f(info::cohesion, p.cohesion...);
      f(PropertyInfo{"c_res", "residual cohesion", unit::stress, Range::non_negative(), Role::strength},
        p.residual_cohesion...);
      f(info::friction_angle, p.friction_angle...);
      f(PropertyInfo{"phi_res", "residual friction angle", unit::angle, info::kAngles},
        p.residual_friction_angle...);
      f(info::mode_2_energy, p.mode_2_energy...);
    }
    template <class F, class... P>
    static constexpr void each_choice(F&& f, P&... p) {
      f(info::compression, p.compression...);
      f(ChoiceInfo{"coupled",
                   "whether damage in tension also lowers the cohesion, by the factor 1 − D_t",
                   {{"false", "no"}, {"true", "by the factor 1 - D_t"}}},
        p.coupled...);
    }

    /// Returns u_e = f_t / K_n, the opening at which softening begins, m.
    Real elastic_opening() const { return tensile_strength / normal_stiffness; }
    /// Returns u_f = 2 G_f1 / f_t, the opening at which no strength is left, m.
    Real ultimate_opening() const { return 2.0 * mode_1_energy / tensile_strength; }
  };

  /// Constants that follow from the parameters.
  template <class Real>
  struct Constants {
    Real normal_stiffness, shear_stiffness;        ///< Pa/m
    Real shear_compliance;                         ///< 1 / K_s, m/Pa
    Real tensile_strength, mode_1_energy;          ///< Pa, J/m²
    Real elastic_opening;                          ///< u_e, m
    Real softening_range, over_softening_range;    ///< u_f - u_e, m; 1/m
    Real compressive_limit;                        ///< Pa
    Real closure_at_limit;                         ///< f_cm / K_n, m
    Real share_left;                               ///< share of closure past the limit kept as u_p: 1 - beta
    Real hardening_slope;                          ///< slope of the yield stress over u_p, Pa/m
    Real cohesion, residual_cohesion;              ///< Pa
    Real friction, residual_friction;              ///< tan(phi), tan(phi_res)
    Real mode_2_energy, over_twice_mode_2_energy;  ///< J/m², m²/J
    Compression compression = Compression::irreversible;
    bool coupled = false;

    template <class F, class... C>
    static constexpr void each(F&& f, C&... c) {
      f(Nothing{}, c.normal_stiffness...);
      f(Nothing{}, c.shear_stiffness...);
      f(Nothing{}, c.shear_compliance...);
      f(Nothing{}, c.tensile_strength...);
      f(Nothing{}, c.mode_1_energy...);
      f(Nothing{}, c.elastic_opening...);
      f(Nothing{}, c.softening_range...);
      f(Nothing{}, c.over_softening_range...);
      f(Nothing{}, c.compressive_limit...);
      f(Nothing{}, c.closure_at_limit...);
      f(Nothing{}, c.share_left...);
      f(Nothing{}, c.hardening_slope...);
      f(Nothing{}, c.cohesion...);
      f(Nothing{}, c.residual_cohesion...);
      f(Nothing{}, c.friction...);
      f(Nothing{}, c.residual_friction...);
      f(Nothing{}, c.mode_2_energy...);
      f(Nothing{}, c.over_twice_mode_2_energy...);
    }
    template <class F, class... C>
    static constexpr void each_choice(F&& f, C&... c) {
      f(Nothing{}, c.compression...);
      f(Nothing{}, c.coupled...);
    }
  };

  static Constants<double> derive(const Properties<double>& p) {
    Constants<double> c;
    c.normal_stiffness = p.normal_stiffness;
    c.shear_stiffness = p.shear_stiffness;
    c.shear_compliance = 1.0 / p.shear_stiffness;
    c.tensile_strength = p.tensile_strength;
    c.mode_1_energy = p.mode_1_energy;
    c.elastic_opening = p.elastic_opening();
    c.softening_range = p.ultimate_opening() - p.elastic_opening();
    c.over_softening_range = 1.0 / c.softening_range;
    c.compressive_limit = p.compressive_limit;
    c.closure_at_limit = p.compressive_limit / p.normal_stiffness;
    c.share_left = 1.0 - p.hardening;
    // gives exactly Eq. (15) on monotone loading
    c.hardening_slope = p.hardening * p.normal_stiffness / (1.0 - p.hardening);
    c.cohesion = p.cohesion;
    c.residual_cohesion = p.residual_cohesion;
    c.friction = std::tan(p.friction_angle);
    c.residual_friction = std::tan(p.residual_friction_angle);
    c.mode_2_energy = p.mode_2_energy;
    c.over_twice_mode_2_energy = 0.5 / p.mode_2_energy;
    c.compression = p.compression;
    c.coupled = p.coupled;
    return c;
  }

  /// Objects to residual values above the initial ones, and to a softening branch that is steeper than the
  /// elastic one: it would snap back.
  static Objection check(const Properties<double>& p) {
    if (p.residual_cohesion > p.cohesion) return {"c_res", "between 0 and c_o = %g", p.cohesion};
    if (p.residual_friction_angle > p.friction_angle)
      return {"phi_res", "between 0 and phi = %g", p.friction_angle};
    const double snap_1 = p.tensile_strength * p.tensile_strength / (2.0 * p.normal_stiffness);
    if (!(p.mode_1_energy > snap_1))
      return {"G_f1", "greater than f_t^2 / (2 K_n) = %g, else softening snaps back", snap_1};
    // Where friction does not drop, tau_max - tau_res is at most c_o - c_res. A drop in friction adds the
    // pressure times the drop, and f_cm bounds the pressure of the elastic range. Beyond f_cm the law falls
    // to the residual line.
    double drop = p.cohesion - p.residual_cohesion;
    const double friction_drop = std::tan(p.friction_angle) - std::tan(p.residual_friction_angle);
    if (friction_drop > 0.0 && std::isfinite(p.compressive_limit))
      drop += p.compressive_limit * friction_drop;
    const double snap_2 = drop * drop / (2.0 * p.shear_stiffness);
    if (drop != 0.0 && !(p.mode_2_energy > snap_2))
      return {"G_f2", "greater than (tau_max - tau_res)^2 / (2 K_s) = %g, else softening snaps back", snap_2};
    return {};
  }

  template <class Real>
  static ContactStiffness<Real> stiffness(const Constants<Real>& c) {
    return {c.normal_stiffness, c.shear_stiffness};
  }

  /// Returns the constants of a point that has a share of its strengths left; energies and stiffnesses stay.
  template <class Real, class Number>
  static Constants<Real> weakened(const Constants<Number>& c, const Real& left) {
    auto w = same_constants<Constants<Real>, Real>(c);
    w.tensile_strength *= left;
    w.elastic_opening *= left;
    w.softening_range = (c.softening_range + c.elastic_opening) / left - w.elastic_opening;
    w.over_softening_range = 1.0 / w.softening_range;
    w.compressive_limit *= left;
    w.closure_at_limit *= left;
    w.cohesion *= left;
    w.residual_cohesion *= left;
    return w;
  }

  /// Internal variables of a contact point.
  template <int Dim, class Real>
  struct Internals {
    Real tension_damage{};         ///< D_t = 1 - delta_t of the paper
    Real shear_damage{};           ///< D_s = 1 - delta_s
    Real closure{};                ///< u_p, m
    Tangential<Dim, Real> slip{};  ///< m
    Real held_jump{};              ///< m

    template <class F, class... H>
    static constexpr void each(F&& f, H&... h) {
      f(InternalInfo{"tension_damage", "0 intact, 1 broken; never decreases", unit::dimensionless,
                     Remembers::tension_damage, info::kDamaged},
        h.tension_damage...);
      f(InternalInfo{"shear_damage", "0 intact, 1 broken; never decreases", unit::dimensionless,
                     Remembers::shear_damage, info::kDamaged},
        h.shear_damage...);
      f(info::closure, h.closure...);
      for (int i = 0; i + 1 < Dim; ++i) f(info::slip, h.slip[i]...);
      f(info::held_jump, h.held_jump...);
    }
  };

  /// Losses of a contact point, which are final. An update that loses nothing adds nothing.
  template <class Sum>
  struct Losses {
    Sum slip_path, tension, shear, friction, compression;

    template <class F, class... L>
    static constexpr void each(F&& f, L&... l) {
      f(info::slip_path, l.slip_path...);
      f(LossInfo{"tension", "G_f1 when torn apart", unit::fracture_energy, "tension softening"},
        l.tension...);
      f(LossInfo{"shear", "above the residual line; G_f2 when fully softened", unit::fracture_energy,
                 "shear softening"},
        l.shear...);
      f(LossInfo{"friction", "along the residual line", unit::fracture_energy}, l.friction...);
      f(info::lost_in_compression, l.compression...);
    }
  };

  template <int Dim, class Real, class Number, class Sum>
  static ContactResponse<Dim, Real> update(const Constants<Number>& constants, const Real& opening,
                                           const Tangential<Dim, Real>& tangential,
                                           Internals<Dim, Real>& internals, Losses<Sum>& losses) {
    ContactResponse<Dim, Real> response;
    update_normal<Dim>(constants, opening, internals, response, losses);
    update_shear<Dim>(constants, tangential, opening, internals, response, losses);
    return response;
  }

 private:
  /// Computes linear tension softening with unloading to the origin.
  /// \param elastic  opening beyond the closure left behind, m
  template <int Dim, class Real, class Constants, class Losses>
  static void update_tension(const Constants& c, const Real& elastic, Internals<Dim, Real>& h,
                             ContactResponse<Dim, Real>& r, Losses& losses) {
    const auto open = elastic > 0.0;
    // This order of the arguments breaks a contact without any strength, for which the damage is 0 / 0.
    const Real damage = smaller(Real(1.0), (elastic - c.elastic_opening) * c.over_softening_range);
    const auto grows = open & (damage > h.tension_damage);
    if (any(grows)) {
      // The area between the envelope and the secant grows by G_f1 dD, whatever the step.
      losses.tension += select(grows, c.mode_1_energy * (damage - h.tension_damage), Real(0.0));
      h.tension_damage = select(grows, damage, h.tension_damage);
      r.changed |= info::kDamaged;
    }
    const auto holds = open & (h.tension_damage < 1.0);
    const Real kappa = c.elastic_opening + h.tension_damage * c.softening_range;
    const Real traction =
        select(holds, (1.0 - h.tension_damage) * c.tensile_strength * elastic / kappa, Real(0.0));
    r.normal_traction += traction;
    r.stored += 0.5 * traction * elastic;
  }

  /// Computes the normal part: bilinear compression and linear tension softening over the elastic opening
  /// u_n + u_p.
  template <int Dim, class Real, class Constants, class Losses>
  static void update_normal(const Constants& c, const Real& opening, Internals<Dim, Real>& h,
                            ContactResponse<Dim, Real>& r, Losses& losses) {
    const Real elastic = compress<Dim, Real>(c, opening, h.closure, r, losses.compression);
    if (any((elastic > 0.0) & (h.tension_damage < 1.0))) update_tension<Dim>(c, elastic, h, r, losses);
  }

  /// Returns the elastic predictor exactly to the softening envelope.
  ///
  /// No softening branch can be followed where the envelope falls more steeply than K_s, as under pressures
  /// beyond f_cm where friction drops. The point then falls to the residual line at once, and the energy
  /// released beyond G_f2 is booked as shear loss too.
  /// \param elastic  in and out: elastic part of the tangential jump, m
  /// \param held     in and out: length of the elastic part, m
  template <int Dim, class Real, class Constants, class Truth, class Losses>
  static void return_to_envelope(const Constants& c, const Truth& slips, const Real& excess,
                                 const Real& residual, const Real& drop, Tangential<Dim, Real>& elastic,
                                 Real& held, Internals<Dim, Real>& h, ContactResponse<Dim, Real>& r,
                                 Losses& losses) {
    const auto softens = slips & (h.shear_damage < 1.0) & (drop > 0.0);
    const Real remaining = 1.0 - h.shear_damage;
    const Real per_slip = drop * c.over_twice_mode_2_energy;  // 1 / s_u
    const auto follows = drop * per_slip < c.shear_stiffness;
    const Real softening_slip = excess / (c.shear_stiffness - drop * per_slip);
    const Real damage = h.shear_damage + softening_slip * per_slip;
    const auto partly = softens & follows & (damage < 1.0);
    // The way leads to the residual line where the point softens to the end.
    Real length = select(softens, held - residual * c.shear_compliance, excess * c.shear_compliance);
    length = select(partly, softening_slip, length);
    length = select(slips, length, Real(0.0));
    if (any(softens)) {
      const Real new_damage = select(partly, damage, Real(1.0));
      const Real left = 1.0 - new_damage;
      const Real energy = select(follows, Real(c.mode_2_energy), 0.5 * drop * drop * c.shear_compliance);
      losses.shear += select(softens, energy * (remaining - left) * (remaining + left), Real(0.0));
      h.shear_damage = select(softens, new_damage, h.shear_damage);
      r.changed |= info::kDamaged;
    }
    losses.friction += residual * length;
    losses.slip_path += length;
    slide<Dim>(slips, length, h.slip, elastic, held);
    r.changed |= info::kSlid;
  }

  /// Computes the shear part: elastic predictor and exact return to the softening Mohr-Coulomb envelope.
  template <int Dim, class Real, class Constants, class Losses>
  static void update_shear(const Constants& c, const Tangential<Dim, Real>& jump, const Real& opening,
                           Internals<Dim, Real>& h, ContactResponse<Dim, Real>& r, Losses& losses) {
    const auto k = c.shear_stiffness;
    Tangential<Dim, Real> elastic = jump - h.slip;
    Real held = norm(elastic);
    const auto open_and_broken = (h.tension_damage >= 1.0) & (opening + h.closure > 0.0);
    Real cohesion = c.cohesion;
    if (c.coupled) cohesion *= 1.0 - h.tension_damage;
    const Real residual_cohesion = smaller(cohesion, Real(c.residual_cohesion));
    const Real peak = larger(cohesion - r.normal_traction * c.friction, Real(0.0));
    const Real residual =
        smaller(peak, larger(residual_cohesion - r.normal_traction * c.residual_friction, Real(0.0)));
    const Real drop = peak - residual;
    const Real excess = k * held - (peak - h.shear_damage * drop);
    const auto slips = (excess > 0.0) & !open_and_broken;
    if (any(slips)) return_to_envelope<Dim>(c, slips, excess, residual, drop, elastic, held, h, r, losses);
    if (any(open_and_broken)) {
      // The bond lets go of the shear that it still carried. Cohesion held this energy, so it is booked as a
      // loss in shear.
      let_go<Dim>(open_and_broken, k, jump, h.held_jump, h.slip, elastic, held, losses.shear);
      r.changed |= info::kSlid;
    }
    h.held_jump = held;
    r.shear_traction = elastic * Real(k);
    r.stored += 0.5 * k * held * held;
  }
};

}  // namespace pyroclast
