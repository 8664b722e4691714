#pragma once

#include "pyroclast/base/exp.hpp"
#include "pyroclast/laws/common.hpp"

namespace pyroclast {

/// Contact law with one damage for tension and shear, friction that stays and dilatancy
/// (docs/understand/theory.md, "Mixed mode").
///
/// A share of the contact is broken. The rest holds along secants to the origin, K_n S / (1 + q_n D) for
/// tension and K_s S / (1 + q_s D) for shear. S(D) is the strength left, D the damage and q = u_f / u_0 - 1,
/// with the end u_f and the beginning u_0 of softening in the pure mode. The broken share rubs (Alfano &
/// Sacco 2006, doi:10.1002/nme.1728). Damage grows with the elastic opening u_n and with u_s, the part of the
/// tangential jump that friction could not hold, |jump| - p tan(phi) / K_s. Damage begins where
/// (u_n / u_0n)^2 + (u_s / u_0s)^2 = 1, that is (sigma / f_t)^2 + (tau / (c_o + p tan(phi)))^2 = 1, and
/// reaches D = 1 where (u_n / u_fn)^2 + (u_s / u_fs)^2 = 1.
///
/// Both secants fall with D, so damage never wins energy back, on any path. G_f1 and G_f2 are exact in the
/// pure modes in any number of steps. On combined paths energies converge with the number of steps.
struct MixedMode {
  static const CompiledForSets compiled;
  static constexpr const char* name = "mixed_mode";
  static constexpr bool exact_in_shear = false;  // dilatancy turns sliding into a combined path
  static constexpr const char* meaning =
      "one damage for tension and shear; broken faces rub and dilate; yields in compression";

  /// Form of the strength's fall from the beginning of softening to its end.
  enum class Softening : std::uint8_t {
    bilinear,     ///< Petersson (1981): a third of the strength is left at 2/9 of the way
    exponential,  ///< e^(-7 D) less its last value, so that the strength ends at 0
    linear,
    /// Linear, but that tension has a tail below a third of f_t, so that a share of G_f1 sets its first
    /// slope.
    tailed
  };
  using Compression = pyroclast::Compression;

  /// Returns the area under S(D), D from 0 to 1.
  static constexpr double area_of(Softening softening) {
    switch (softening) {
      case Softening::bilinear:
        return 5.0 / 18.0;
      case Softening::exponential:
        return 1.0 / kDecay - kTail / (1.0 - kTail);
      case Softening::linear:
      case Softening::tailed:  // but for the tail
        break;
    }
    return 0.5;
  }

  /// Parameters at one temperature.
  template <class Real>
  struct Properties {
    using Law = MixedMode;

    Real normal_stiffness{};   ///< K_n, Pa/m
    Real shear_stiffness{};    ///< K_s, Pa/m
    Real tensile_strength{};   ///< f_t, Pa
    Real mode_1_energy{};      ///< G_f1, J/m²
    Real compressive_limit{};  ///< f_cm, end of the first slope in compression, Pa; may be infinite
    Real hardening{};          ///< beta, second slope over first
    Real cohesion{};           ///< c_o, Pa
    Real friction_angle{};     ///< phi, rad
    Real mode_2_energy{};      ///< G_f2, J/m²
    Real dilatancy_angle{};    ///< psi, dilatancy angle of the first slip, rad
    Real fading_slip{};        ///< u_r, slip over which tan(psi) falls by the factor e, m
    /// Share of G_f1 below the first line of softening in tension, drawn on to its end; above 1 it counts
    /// as 1.
    Real initial_share{1.0};
    Softening softening = Softening::bilinear;
    Compression compression = Compression::irreversible;

    template <class F, class... P>
    static constexpr void each(F&& f, P&... p) {
      f(info::normal_stiffness, p.normal_stiffness...);
      f(info::shear_stiffness, p.shear_stiffness...);
      f(info::tensile_strength, p.tensile_strength...);
      f(info::mode_1_energy, p.mode_1_energy...);
      f(info::compressive_limit, p.compressive_limit...);
      f(info::hardening, p.hardening...);
      f(info::cohesion, p.cohesion...);
      f(info::friction_angle, p.friction_angle...);
      f(info::mode_2_energy, p.mode_2_energy...);
      f(PropertyInfo{"psi", "dilatancy angle of the first slip", unit::angle, info::kAngles},
        p.dilatancy_angle...);
      f(PropertyInfo{"u_r", "slip over which tan(psi) falls by the factor e", unit::length,
                     Range::positive()},
        p.fading_slip...);
      f(PropertyInfo{"initial_share",
                     "initial over whole mode I fracture energy: below the first line of softening, drawn on "
                     "to its end; from 1 on there is no tail",
                     unit::dimensionless, Range::positive().usually(0.1, 1.0), Role::first_softening,
                     kWithTail},
        p.initial_share...);
    }
    template <class F, class... P>
    static constexpr void each_choice(F&& f, P&... p) {
      f(ChoiceInfo{"softening",
                   "how the strength falls with the damage",
                   {{"bilinear", "Petersson's two lines"},
                    {"exponential", "e^(-7 D), less its last value"},
                    {"linear", "one line"},
                    {kWithTail, "one line; in tension a flatter one below a third of f_t"}}},
        p.softening...);
      f(info::compression, p.compression...);
    }

    /// Returns u_0n = f_t / K_n, the opening at which softening begins in tension, m.
    Real first_opening() const { return tensile_strength / normal_stiffness; }
    /// Returns u_0s = c_o / K_s, the tangential jump at which softening begins in shear without pressure, m.
    Real first_slip() const { return cohesion / shear_stiffness; }
    /// Returns u_fn, the opening at which no strength is left in tension, m.
    Real last_opening() const {
      const Real first = first_opening(), way = way_to_end(first, tensile_strength, mode_1_energy);
      return softening == Softening::tailed ? first + way * (3.0 - 2.0 * initial()) : first + way;
    }
    /// Returns u_fs, the tangential jump at which no strength is left in shear without pressure, m.
    Real last_slip() const { return first_slip() + way_to_end(first_slip(), cohesion, mode_2_energy); }
    /// Returns the share of G_f1 that counts.
    Real initial() const { return initial_share < 1.0 ? initial_share : Real(1.0); }

   private:
    /// Returns the jump from the beginning to the end of softening, without a tail: the area under the whole
    /// curve, the elastic branch included, is the fracture energy.
    Real way_to_end(Real first, Real strength, Real energy) const {
      return (energy / strength - 0.5 * first) / area_of(softening);
    }
  };

  /// Constants that follow from the parameters.
  template <class Real>
  struct Constants {
    Real normal_stiffness, shear_stiffness;    ///< Pa/m
    Real compressive_limit;                    ///< Pa
    Real closure_at_limit;                     ///< f_cm / K_n, m
    Real share_left;                           ///< share of closure past the limit kept as u_p: 1 - beta
    Real hardening_slope;                      ///< slope of the yield stress over u_p, Pa/m
    Real over_first_opening, over_first_slip;  ///< 1 / u_0n, 1 / u_0s, 1/m
    Real tension_range, shear_range;           ///< q = u_f / u_0 - 1 of the pure modes; of the first line
    /// Slope of u_n / u_0n over D in the tail, less that before it; 0 without one.
    Real tail_range;
    Real first_over_last_opening;               ///< u_0n / u_fn
    Real first_over_last_slip;                  ///< u_0s / u_fs
    Real first_tension_energy, tension_energy;  ///< f_t u_0n, f_t (u_fn - u_0n), J/m²
    Real first_shear_energy, shear_energy;      ///< c_o u_0s, c_o (u_fs - u_0s), J/m²
    Real friction;                              ///< tan(phi)
    /// tan(phi) / K_s, jump that friction holds for each pascal of pressure, m/Pa.
    Real reach_of_pressure;
    Real last_dilation;     ///< u_r tan(psi), m
    Real over_fading_slip;  ///< 1 / u_r, 1/m
    Softening softening = Softening::bilinear;
    Compression compression = Compression::irreversible;

    template <class F, class... C>
    static constexpr void each(F&& f, C&... c) {
      f(Nothing{}, c.normal_stiffness...);
      f(Nothing{}, c.shear_stiffness...);
      f(Nothing{}, c.compressive_limit...);
      f(Nothing{}, c.closure_at_limit...);
      f(Nothing{}, c.share_left...);
      f(Nothing{}, c.hardening_slope...);
      f(Nothing{}, c.over_first_opening...);
      f(Nothing{}, c.over_first_slip...);
      f(Nothing{}, c.tension_range...);
      f(Nothing{}, c.shear_range...);
      f(Nothing{}, c.tail_range...);
      f(Nothing{}, c.first_over_last_opening...);
      f(Nothing{}, c.first_over_last_slip...);
      f(Nothing{}, c.first_tension_energy...);
      f(Nothing{}, c.tension_energy...);
      f(Nothing{}, c.first_shear_energy...);
      f(Nothing{}, c.shear_energy...);
      f(Nothing{}, c.friction...);
      f(Nothing{}, c.reach_of_pressure...);
      f(Nothing{}, c.last_dilation...);
      f(Nothing{}, c.over_fading_slip...);
    }
    template <class F, class... C>
    static constexpr void each_choice(F&& f, C&... c) {
      f(Nothing{}, c.softening...);
      f(Nothing{}, c.compression...);
    }
  };

  static Constants<double> derive(const Properties<double>& p) {
    Constants<double> c;
    c.normal_stiffness = p.normal_stiffness;
    c.shear_stiffness = p.shear_stiffness;
    c.compressive_limit = p.compressive_limit;
    c.closure_at_limit = p.compressive_limit / p.normal_stiffness;
    c.share_left = 1.0 - p.hardening;
    c.hardening_slope = p.hardening * p.normal_stiffness / (1.0 - p.hardening);
    const double opening = p.first_opening();
    double opening_range = p.last_opening() - opening;
    const double slip = p.first_slip(), slip_range = p.last_slip() - slip;
    c.tail_range = 0.0;
    if (p.softening == Softening::tailed) {
      const double share = p.initial(), without_tail = opening_range / (3.0 - 2.0 * share);
      c.tail_range = kOfTail * (1.0 - share) * without_tail / opening;
      opening_range = share * without_tail;
    }
    c.over_first_opening = 1.0 / opening;
    c.over_first_slip = 1.0 / slip;
    c.tension_range = opening_range / opening;
    c.shear_range = slip_range / slip;
    c.first_over_last_opening = opening / p.last_opening();
    c.first_over_last_slip = slip / p.last_slip();
    c.first_tension_energy = p.tensile_strength * opening;
    c.tension_energy = p.tensile_strength * opening_range;
    c.first_shear_energy = p.cohesion * slip;
    c.shear_energy = p.cohesion * slip_range;
    c.friction = std::tan(p.friction_angle);
    c.reach_of_pressure = c.friction / p.shear_stiffness;
    c.last_dilation = p.fading_slip * std::tan(p.dilatancy_angle);
    c.over_fading_slip = 1.0 / p.fading_slip;
    c.softening = p.softening;
    c.compression = p.compression;
    return c;
  }

  static Objection check(const Properties<double>& p) {
    if (p.dilatancy_angle > p.friction_angle)
      return {"psi", "between 0 and phi = %g, else sliding would win energy", p.friction_angle};
    const double stored_1 = 0.5 * p.tensile_strength * p.first_opening();
    if (!(p.mode_1_energy > stored_1))
      return {"G_f1", "greater than f_t^2 / (2 K_n) = %g, which the contact stores before it softens",
              stored_1};
    const double stored_2 = 0.5 * p.cohesion * p.first_slip();
    if (!(p.mode_2_energy > stored_2))
      return {"G_f2", "greater than c_o^2 / (2 K_s) = %g, which the contact stores before it softens",
              stored_2};
    return {};
  }

  /// Returns the bounds K_n and K_s. Slip that dilates lets pressure and shear raise each other, but makes no
  /// mode of both stiffer (docs/understand/theory.md, "Mixed mode").
  template <class Real>
  static ContactStiffness<Real> stiffness(const Constants<Real>& c) {
    return {c.normal_stiffness, c.shear_stiffness};
  }

  /// Returns the constants of a point that has a share of its strengths left; energies and stiffnesses stay.
  template <class Real, class Number>
  static Constants<Real> weakened(const Constants<Number>& c, const Real& left) {
    auto w = same_constants<Constants<Real>, Real>(c);
    w.compressive_limit *= left;
    w.closure_at_limit *= left;
    const Real over_left = 1.0 / left, over_square = over_left * over_left;
    const auto soften = [&](Real& over_first, Real& range, Real& first_over_last, Real& first_energy,
                            Real& energy) {
      over_first *= over_left;
      range = range * over_square + (over_square - 1.0) * (0.5 / area_of(c.softening));
      first_over_last = 1.0 / (1.0 + range);
      first_energy *= left * left;
      energy = first_energy * range;
    };
    const Real tension_range = w.tension_range, without_tail = tension_range + w.tail_range * (1.0 / kOfTail);
    w.tension_range = without_tail;
    soften(w.over_first_opening, w.tension_range, w.first_over_last_opening, w.first_tension_energy,
           w.tension_energy);
    if (c.softening == Softening::tailed) {
      const Real longer = w.tension_range / without_tail;
      w.tension_range = tension_range * longer;
      w.tail_range *= longer;
      w.first_over_last_opening = 1.0 / (1.0 + w.tension_range + w.tail_range * (1.0 - kTailBegins));
      w.tension_energy = w.first_tension_energy * w.tension_range;
    }
    soften(w.over_first_slip, w.shear_range, w.first_over_last_slip, w.first_shear_energy, w.shear_energy);
    return w;
  }

  /// Internal variables of a contact point.
  template <int Dim, class Real>
  struct Internals {
    Real damage{};                 ///< D
    Real closure{};                ///< u_p, m
    Real dilation{};               ///< m
    Tangential<Dim, Real> slip{};  ///< slip of the broken share, m
    Real held_jump{};              ///< m

    template <class F, class... H>
    static constexpr void each(F&& f, H&... h) {
      f(InternalInfo{"mixed_damage", "of tension and shear: 0 intact, 1 broken; never decreases",
                     unit::dimensionless, Remembers::mixed_damage, info::kDamaged},
        h.damage...);
      f(info::closure, h.closure...);
      f(InternalInfo{"dilation", "opening that slip has forced; never decreases", unit::length,
                     Remembers::other, info::kSlid},
        h.dilation...);
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
      f(LossInfo{"slip_path", "length of the slip's path, times the share that is broken", unit::length},
        l.slip_path...);
      f(LossInfo{"tension", "of the bond by opening; G_f1 when torn apart", unit::fracture_energy,
                 "tension softening"},
        l.tension...);
      f(LossInfo{"shear", "of the bond by shear above friction; G_f2 when sheared off", unit::fracture_energy,
                 "shear softening"},
        l.shear...);
      f(LossInfo{"friction", "rubbed off, less the work that dilation gives back", unit::fracture_energy},
        l.friction...);
      f(info::lost_in_compression, l.compression...);
    }
  };

  template <int Dim, class Real, class Number, class Sum>
  static ContactResponse<Dim, Real> update(const Constants<Number>& c, const Real& opening,
                                           const Tangential<Dim, Real>& tangential, Internals<Dim, Real>& h,
                                           Losses<Sum>& losses) {
    ContactResponse<Dim, Real> r;
    Real elastic = compress<Dim, Real>(c, opening - h.dilation, h.closure, r, losses.compression);
    const Real jump = norm(tangential);
    Bond<Real> bond;
    Real held = 0.0;  // length of the jump that friction holds
    if (any(h.damage > 0.0)) {
      bond = bond_at(c, h.damage);
      rub<Dim>(c, opening, tangential, jump, bond, elastic, held, h, r, losses);
    }
    const Real reach = (0.0 - r.normal_traction) * c.reach_of_pressure;
    const Real above = larger(jump - reach, Real(0.0));  // part of the jump that friction could not hold
    const Real opened = larger(elastic, Real(0.0));
    const Real in_tension = opened * c.over_first_opening, in_shear = above * c.over_first_slip;
    const Real from_first = in_tension * in_tension + in_shear * in_shear;
    if (any((from_first > 1.0) & (h.damage < 1.0))) {
      const Growth<Real> growth{in_tension, in_shear, from_first, jump, above, reach};
      break_bond<Dim>(c, growth, tangential, bond, held, h, r, losses);
    }
    const auto k = c.shear_stiffness;
    const Real tension = c.normal_stiffness * bond.tension * opened;
    r.normal_traction += tension;
    r.shear_traction = (tangential - h.slip * (1.0 - bond.shear)) * Real(k);
    r.stored +=
        0.5 * tension * opened + 0.5 * k * (bond.shear * jump * jump + (1.0 - bond.shear) * held * held);
    h.held_jump = held;
    return r;
  }

 private:
  static constexpr const char* kWithTail = "linear with tail";
  /// Damage at which a third of the strength is left, and the tail begins.
  static constexpr double kTailBegins = 2.0 / 3.0;
  /// Slope of u_n over D in a tail that has all of the energy, over that of a line that has it: the tail is a
  /// triangle a third as high, over a third of D.
  static constexpr double kOfTail = 9.0;
  static constexpr double kDecay = 7.0;
  static constexpr double kTail = 9.118819655545162e-4;  // e^-7
  /// Share of the jumps below which an excess over friction is round-off.
  static constexpr double kRoundOff = 1e-12;

  /// Rest of a bond that is partly broken.
  template <class Real>
  struct Bond {
    Real tension = 1.0, shear = 1.0;         ///< secants over K_n and K_s
    Real per_opening = 1.0, per_slip = 1.0;  ///< 1 / (1 + q D)
    Real in_tail = 0.0;                      ///< damage beyond the beginning of the tail
    Real lost_first = 0.0, lost = 0.0;       ///< loss as a share of `first_..._energy` and of `..._energy`
  };

  /// Returns the rest of a bond at a damage. The energy lost between the beginning of softening and D is the
  /// area below the curve less the area below the secant, f ((u_f - u_0) (int S dD - S D / 2) + u_0 (1 - S) /
  /// 2).
  template <class Real, class Constants>
  static Bond<Real> bond_at(const Constants& c, const Real& damage) {
    Bond<Real> b;
    const Real whole = 1.0 - damage;
    Real strength = whole;
    switch (c.softening) {
      case Softening::bilinear:
        strength = larger(1.0 - 3.0 * damage, (3.0 / 7.0) * whole);
        b.lost = smaller(0.5 * damage, 5.0 / 18.0 - (3.0 / 14.0) * whole);
        break;
      case Softening::exponential: {
        constexpr double kOver = 1.0 / (1.0 - kTail);
        const Real fallen = 1.0 - exp(damage * -kDecay);
        strength = select(damage < 1.0, 1.0 - fallen * kOver, Real(0.0));
        b.lost = (fallen * (1.0 / kDecay) - damage * kTail) * kOver - 0.5 * damage * strength;
        break;
      }
      case Softening::linear:
      case Softening::tailed:  // but for the tail
        b.lost = 0.5 * damage;
        break;
    }
    b.lost_first = 0.5 * (1.0 - strength);
    Real opens = 1.0 + c.tension_range * damage;
    const Real slips = 1.0 + c.shear_range * damage;
    if (c.softening == Softening::tailed) {
      b.in_tail = larger(damage - kTailBegins, Real(0.0));
      opens += c.tail_range * b.in_tail;
    }
    const Real over = 1.0 / (opens * slips);
    b.per_opening = slips * over;
    b.per_slip = opens * over;
    b.tension = strength * b.per_opening;
    b.shear = strength * b.per_slip;
    return b;
  }

  /// Computes friction and dilatancy of the broken share, which carries nothing where it is open.
  /// \param jump     length of `tangential`, m
  /// \param elastic  in and out: opening beyond the dilation and the closure left behind, m
  /// \param held     out: length of the jump that friction holds, m
  template <int Dim, class Real, class Constants, class Losses>
  static void rub(const Constants& c, const Real& opening, const Tangential<Dim, Real>& tangential,
                  const Real& jump, const Bond<Real>& bond, Real& elastic, Real& held,
                  Internals<Dim, Real>& h, ContactResponse<Dim, Real>& r, Losses& losses) {
    const auto is_broken = h.damage > 0.0;
    const auto open = is_broken & (elastic > 0.0);
    const Real broken = 1.0 - bond.shear;
    Tangential<Dim, Real> elastic_jump = tangential - h.slip;
    held = norm(elastic_jump);
    const Real pressure = 0.0 - r.normal_traction;
    const Real reach = pressure * c.reach_of_pressure;
    const Real round_off = kRoundOff * (reach + jump);
    const auto slides = is_broken & !(elastic > 0.0) & (held - reach > round_off);
    if (any(slides)) {
      Real length = select(slides, held - reach, Real(0.0));
      Real pressures = 2.0 * pressure;  // pressure before the slip plus pressure after it
      Real lifted = 0.0;
      if (any(slides & (h.dilation < c.last_dilation))) {
        const Real dilation =
            dilate(c, opening, slides, held, reach, round_off, broken, h.dilation, h.closure, length);
        lifted = dilation - h.dilation;
        h.dilation = dilation;
        elastic = compress<Dim, Real>(c, opening - dilation, h.closure, r, losses.compression);
        pressures = pressure - r.normal_traction;
      }
      const Real path = broken * length;
      losses.friction +=
          select(slides, 0.5 * pressures * larger(c.friction * path - lifted, Real(0.0)), Real(0.0));
      losses.slip_path += path;
      const Real stays = (held - length) / held;  // share of the elastic jump that stays
      for (int i = 0; i + 1 < Dim; ++i)
        h.slip[i] = select(slides, tangential[i] - elastic_jump[i] * stays, h.slip[i]);
      // computes the elastic jump as the next update at this jump does, to the bit
      elastic_jump = tangential - h.slip;
      held = norm(elastic_jump);
      r.changed |= info::kSlid;
    }
    if (any(open)) {
      let_go<Dim>(open, c.shear_stiffness * broken, tangential, h.held_jump, h.slip, elastic_jump, held,
                  losses.friction);
      r.changed |= info::kSlid;
    }
    held = select(is_broken, held, Real(0.0));
  }

  /// Finds the slip and its dilation. Slip dilates, which raises the pressure and with it the friction. The
  /// excess over friction is a falling convex function of the slip, so Newton's method comes to its root from
  /// below. A lane that has arrived stays where it is.
  /// \param length  out: length of the slip, m
  /// \return the dilation after the slip, m
  template <class Real, class Constants, class Truth>
  static Real dilate(const Constants& c, const Real& opening, const Truth& slides, const Real& held,
                     const Real& reach, const Real& round_off, const Real& broken, const Real& dilation,
                     const Real& closure, Real& length) {
    const Real left = larger(c.last_dilation - dilation, Real(0.0));
    const Real fading = broken * c.over_fading_slip;
    const auto k = c.normal_stiffness * c.reach_of_pressure;
    // Slope of the excess; too steep beyond f_cm, so the root is still approached from below.
    Real slope = 1.0 + k * left * fading;
    length = select(slides, (held - reach) / slope, Real(0.0));
    Real after = dilation;
    constexpr int kMostRounds = 60;
    for (int round = 0; round < kMostRounds; ++round) {
      const Real faded = exp(0.0 - fading * length);
      after = dilation + left * (1.0 - faded);
      const Real pressed = after - opening;
      const Real yielded = c.share_left * (pressed - c.closure_at_limit);
      const auto yields = yielded > closure;
      const Real excess = (held - length) - k * (pressed - larger(closure, yielded));
      const auto goes_on = slides & (excess > 0.5 * round_off);
      if (!any(goes_on)) break;
      slope = 1.0 + k * select(yields, 1.0 - c.share_left, Real(1.0)) * left * fading * faded;
      length = select(goes_on, length + excess / slope, length);
    }
    return after;
  }

  /// Quantities that make the damage grow.
  template <class Real>
  struct Growth {
    const Real& in_tension;  ///< elastic opening over u_0n
    const Real& in_shear;    ///< u_s over u_0s
    const Real& from_first;  ///< sum of the squares of in_tension and in_shear
    const Real& jump;        ///< length of the tangential jump, m
    const Real& above;       ///< u_s, m
    const Real& reach;       ///< jump that friction can hold, m
  };

  /// Returns the damage where tension has a tail: the share that the jump has gone of the way to the
  /// beginning of the tail, or from there to the end.
  ///
  /// \param first  jump over the jump at which softening begins, at its ratio of u_n to u_s
  /// \param last   jump over the jump at which it ends
  template <class Real, class Constants>
  static Real way_with_tail(const Constants& c, const Growth<Real>& g, const Real& first, const Real& last) {
    using std::sqrt;
    const Real to_opening = g.in_tension / (1.0 + c.tension_range * kTailBegins);
    const Real to_slip = g.in_shear / (1.0 + c.shear_range * kTailBegins);
    const Real tail = sqrt(to_opening * to_opening + to_slip * to_slip);
    const Real before = tail * (first - 1.0) / (first - tail), behind = last * (tail - 1.0) / (tail - last);
    return select(tail < 1.0, kTailBegins * before,
                  smaller(Real(1.0), 1.0 - (1.0 - kTailBegins) * (1.0 - behind)));
  }

  /// Raises the damage to the share that the jump has gone of the way from the beginning to the end of
  /// softening, at its ratio of u_n to u_s, and adds the energy that is lost.
  template <int Dim, class Real, class Constants, class Losses>
  static void break_bond(const Constants& c, const Growth<Real>& g, const Tangential<Dim, Real>& tangential,
                         Bond<Real>& bond, Real& held, Internals<Dim, Real>& h, ContactResponse<Dim, Real>& r,
                         Losses& losses) {
    using std::sqrt;
    const Real to_last_opening = g.in_tension * c.first_over_last_opening;
    const Real to_last_slip = g.in_shear * c.first_over_last_slip;
    const Real to_last = to_last_opening * to_last_opening + to_last_slip * to_last_slip;
    const Real first = sqrt(g.from_first), last = sqrt(to_last);
    const Real way = c.softening == Softening::tailed
                         ? way_with_tail(c, g, first, last)
                         : smaller(Real(1.0), last * (first - 1.0) / (first - last));
    const auto grows = (g.from_first > 1.0) & (way > h.damage);
    if (!any(grows)) return;
    const Bond<Real> left = bond_at(c, way);
    // The energy of each mode per unit of D is the energy of the pure mode, times the square of the jump over
    // the jump of the pure mode. Beyond the end of softening only the ratio of the modes counts.
    const Real scale = 1.0 / larger(to_last, Real(1.0));
    const Real opened = g.in_tension * left.per_opening, sheared = g.in_shear * left.per_slip;
    const Real lost = larger(left.lost - bond.lost, Real(0.0));
    const Real lost_first = larger(left.lost_first - bond.lost_first, Real(0.0));
    const auto spent = [&](const Real& share, const auto& energy, const auto& first_energy) {
      return select(grows, share * share * scale * (energy * lost + first_energy * lost_first), Real(0.0));
    };
    losses.tension += spent(opened, c.tension_energy, c.first_tension_energy);
    losses.shear += spent(sheared, c.shear_energy, c.first_shear_energy);
    if (c.softening == Softening::tailed) {
      // what G_f1 has more than a line as steep as the first one, by the damage in the tail
      const Real of_tail = c.first_tension_energy * c.tail_range * (0.5 * (1.0 - kTailBegins));
      losses.tension +=
          select(grows, opened * opened * scale * of_tail * (left.in_tail - bond.in_tail), Real(0.0));
    }
    // The share that breaks under pressure rubs from then on: at first with all the friction that there is.
    const auto begins = grows & !(h.damage > 0.0);
    held = select(begins, g.reach, held);
    const Real rubbed = larger(g.reach * (g.above + g.jump) - held * held, Real(0.0)) *
                        larger(bond.shear - left.shear, Real(0.0));
    losses.friction += select(grows, 0.5 * c.shear_stiffness * rubbed, Real(0.0));
    if (any(begins)) {
      const Real slid = select(g.above > 0.0, g.above / g.jump, Real(0.0));
      for (int i = 0; i + 1 < Dim; ++i) h.slip[i] = select(begins, tangential[i] * slid, h.slip[i]);
      held = select(begins, norm(tangential - h.slip), held);
      r.changed |= info::kSlid;
    }
    h.damage = select(grows, way, h.damage);
    bond.tension = select(grows, left.tension, bond.tension);
    bond.shear = select(grows, left.shear, bond.shear);
    r.changed |= info::kDamaged;
  }
};

}  // namespace pyroclast
