#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <string>

#include "pyroclast/base/error.hpp"
#include "pyroclast/base/vec.hpp"

/// The contact law, paper Eqs. (10)-(15): a pure function of one contact point.
///
/// A law is three things: `ContactProperties` (parameters at one temperature), `ContactHistory` (what the
/// point remembers; plain data) and `update_contact`, which takes properties, history and jump to traction,
/// new history and energies. The simulation, the point driver and the tests call this one function.
///
/// Sign: tension and opening are positive. All energies are per unit of contact area, J/m².
namespace pyroclast {

/// Components of a contact's tangential jump and traction: 1 in 2D, 2 in 3D.
template <int Dim, class Real = double>
using Tangential = Vec<Dim - 1, Real>;

/// How a contact responds once its elastic range is left.
enum class ContactBehaviour : std::uint8_t {
  elastic,   ///< no failure in any direction (aggregate-aggregate)
  cohesive,  ///< tension softening, Mohr-Coulomb softening, bilinear compression
};

/// The reading of the compression law, Eq. (15).
enum class CompressionReading : std::uint8_t {
  irreversible,  ///< unloading has slope K_n and leaves a closure
  reversible     ///< unloading retraces the bilinear curve
};

/// Parameters of one contact at its current temperature (paper, Tables 1 and 2).
template <class Real>
struct ContactPropertiesOf {
  Real normal_stiffness{};   ///< K_n, Pa/m
  Real shear_stiffness{};    ///< K_s, Pa/m
  Real tensile_strength{};   ///< f_t, Pa
  Real mode_1_energy{};      ///< G_f1, J/m²
  Real compressive_limit{};  ///< f_cm, end of the first slope in compression, Pa; may be infinite
  Real hardening{};          ///< beta, second slope over first
  Real cohesion{};           ///< c_o, Pa
  Real residual_cohesion{};  ///< c_res, Pa
  Real friction{};           ///< tan(phi)
  Real residual_friction{};  ///< tan(phi_res)
  Real mode_2_energy{};      ///< G_f2, J/m²
  ContactBehaviour behaviour = ContactBehaviour::cohesive;
  CompressionReading compression = CompressionReading::irreversible;
  bool coupled = false;  ///< cohesion also scaled by 1 - D_t

  /// u_e = f_t / K_n, opening at which softening begins, m.
  Real elastic_opening() const { return tensile_strength / normal_stiffness; }
  /// u_f = 2 G_f1 / f_t, opening at which nothing is left, m.
  Real ultimate_opening() const { return 2.0 * mode_1_energy / tensile_strength; }
};
using ContactProperties = ContactPropertiesOf<double>;

/// Parameters as the law needs them: worked out once for the many times that it is asked.
template <class Real>
struct ContactConstantsOf {
  Real normal_stiffness, shear_stiffness;      ///< Pa/m
  Real shear_compliance;                       ///< 1 / K_s, m/Pa
  Real tensile_strength, mode_1_energy;        ///< Pa, J/m²
  Real elastic_opening;                        ///< u_e, m
  Real softening_range, over_softening_range;  ///< u_f - u_e, m; 1/m
  Real compressive_limit;                      ///< Pa
  Real closure_at_limit;                       ///< f_cm / K_n, m
  Real share_left;                             ///< of a closure beyond the limit, as u_p: 1 - beta
  Real hardening_slope;                        ///< of the yield stress over u_p, Pa/m
  Real cohesion, residual_cohesion, friction, residual_friction;
  Real mode_2_energy, over_twice_mode_2_energy;  ///< J/m², m²/J
  ContactBehaviour behaviour = ContactBehaviour::cohesive;
  CompressionReading compression = CompressionReading::irreversible;
  bool coupled = false;

  ContactConstantsOf() = default;
  explicit ContactConstantsOf(const ContactPropertiesOf<Real>& p)
      : normal_stiffness(p.normal_stiffness),
        shear_stiffness(p.shear_stiffness),
        shear_compliance(1.0 / p.shear_stiffness),
        tensile_strength(p.tensile_strength),
        mode_1_energy(p.mode_1_energy),
        elastic_opening(p.elastic_opening()),
        softening_range(p.ultimate_opening() - p.elastic_opening()),
        over_softening_range(1.0 / softening_range),
        compressive_limit(p.compressive_limit),
        closure_at_limit(p.compressive_limit / p.normal_stiffness),
        share_left(1.0 - p.hardening),
        // on monotone loading exactly Eq. (15)
        hardening_slope(p.hardening * p.normal_stiffness / (1.0 - p.hardening)),
        cohesion(p.cohesion),
        residual_cohesion(p.residual_cohesion),
        friction(p.friction),
        residual_friction(p.residual_friction),
        mode_2_energy(p.mode_2_energy),
        over_twice_mode_2_energy(0.5 / p.mode_2_energy),
        behaviour(p.behaviour),
        compression(p.compression),
        coupled(p.coupled) {}
};
using ContactConstants = ContactConstantsOf<double>;

/// Calls `f` with each number of the constants, in one order.
template <class Constants, class F>
constexpr void for_each_number(Constants& c, F f) {
  f(c.normal_stiffness);
  f(c.shear_stiffness);
  f(c.shear_compliance);
  f(c.tensile_strength);
  f(c.mode_1_energy);
  f(c.elastic_opening);
  f(c.softening_range);
  f(c.over_softening_range);
  f(c.compressive_limit);
  f(c.closure_at_limit);
  f(c.share_left);
  f(c.hardening_slope);
  f(c.cohesion);
  f(c.residual_cohesion);
  f(c.friction);
  f(c.residual_friction);
  f(c.mode_2_energy);
  f(c.over_twice_mode_2_energy);
}

inline constexpr int kContactConstants = [] {
  ContactConstants constants{};
  int count = 0;
  for_each_number(constants, [&](double&) { ++count; });
  return count;
}();

/// What a contact point remembers. A contact that never held tension or cohesion (a platen's) starts with
/// both damages at 1.
template <int Dim, class Real = double>
struct ContactHistory {
  Real tension_damage{};         ///< D_t = 1 - delta_t of the paper, 0 intact, 1 broken; never decreases
  Real shear_damage{};           ///< D_s = 1 - delta_s, likewise
  Real closure{};                ///< u_p, irreversible closure in compression, m; never decreases
  Tangential<Dim, Real> slip{};  ///< irreversible part of the tangential jump, m
  Real held_jump{};              ///< length of the elastic part of the tangential jump, m
};

/// Energy dissipated at a contact point, by mechanism, J/m².
struct ContactDissipation {
  double tension = 0.0;      ///< G_f1 when torn apart
  double shear = 0.0;        ///< above the residual line; G_f2 when fully softened
  double friction = 0.0;     ///< along the residual line
  double compression = 0.0;  ///< irreversible closure

  double total() const { return tension + shear + friction + compression; }

  ContactDissipation& operator+=(const ContactDissipation& o) {
    tension += o.tension;
    shear += o.shear;
    friction += o.friction;
    compression += o.compression;
    return *this;
  }
};

/// What a contact point loses for good, where the law adds to it.
/// \tparam Sum  takes `+=`: a number, or what adds to rows of an array. Nothing is added while nothing is
/// lost.
template <class Sum>
struct ContactLossesOf {
  Sum slip_path;                              ///< length of the slip's path, m
  Sum tension, shear, friction, compression;  ///< as of ContactDissipation, J/m²
};

template <int Dim, class Real = double>
struct ContactResponse {
  Real normal_traction = 0.0;              ///< sigma, Pa, tension positive
  Tangential<Dim, Real> shear_traction{};  ///< tau, Pa
  Real stored = 0.0;                       ///< elastic energy now held, J/m²
  bool slid = false;                       ///< in any lane `slip` changed
  bool damaged = false;                    ///< in any lane a damage or the closure changed
};

/// With what was lost in the update.
template <int Dim>
struct ContactResponseAndLosses : ContactResponse<Dim> {
  double slip_path = 0.0;  ///< length of the slip's path, m
  ContactDissipation dissipated;
};

/// Throws Error, naming the quantity, when the parameters cannot make a law: non-positive stiffness, negative
/// strength, or a softening branch steeper than the elastic one (snap-back).
void validate(const ContactProperties& properties, const std::string& name);

namespace contact_law {

/// A contact that never fails and remembers nothing.
template <int Dim, class Real, class Number>
ContactResponse<Dim, Real> respond_elastically(const ContactConstantsOf<Number>& c, const Real& opening,
                                               const Tangential<Dim, Real>& tangential) {
  ContactResponse<Dim, Real> r;
  const auto k_n = c.normal_stiffness;
  const auto k_s = c.shear_stiffness;
  r.normal_traction = k_n * opening;
  r.shear_traction = tangential * Real(k_s);
  r.stored = 0.5 * k_n * opening * opening + 0.5 * k_s * dot(tangential, tangential);
  return r;
}

/// Linear tension softening with unloading to the origin.
/// \param elastic  opening beyond the closure left behind, m
template <int Dim, class Real, class Constants, class Losses>
void update_tension(const Constants& c, const Real& elastic, ContactHistory<Dim, Real>& h,
                    ContactResponse<Dim, Real>& r, Losses& losses) {
  const auto open = elastic > 0.0;
  // In this order a contact without any strength, 0 / 0, breaks.
  const Real damage = smaller(Real(1.0), (elastic - c.elastic_opening) * c.over_softening_range);
  const auto grows = open & (damage > h.tension_damage);
  if (any(grows)) {
    // The area between the envelope and the secant grows by G_f1 dD, whatever the step.
    losses.tension += select(grows, c.mode_1_energy * (damage - h.tension_damage), Real(0.0));
    h.tension_damage = select(grows, damage, h.tension_damage);
    r.damaged = true;
  }
  const auto holds = open & (h.tension_damage < 1.0);
  const Real kappa = c.elastic_opening + h.tension_damage * c.softening_range;
  const Real traction =
      select(holds, (1.0 - h.tension_damage) * c.tensile_strength * elastic / kappa, Real(0.0));
  r.normal_traction += traction;
  r.stored += 0.5 * traction * elastic;
}

/// Compression with unloading along K_n, which leaves a closure: yield stress f_cm + H u_p.
/// \param elastic  in and out: opening beyond the closure left behind, m
template <int Dim, class Real, class Constants, class Losses>
void update_compression(const Constants& c, const Real& opening, Real& elastic, ContactHistory<Dim, Real>& h,
                        ContactResponse<Dim, Real>& r, Losses& losses) {
  const Real closure = c.share_left * (-opening - c.closure_at_limit);
  const auto yields = closure > h.closure;
  if (any(yields)) {
    losses.compression += select(
        yields,
        (closure - h.closure) * (c.compressive_limit + 0.5 * c.hardening_slope * (closure + h.closure)),
        Real(0.0));
    h.closure = select(yields, closure, h.closure);
    elastic = opening + h.closure;
    r.damaged = true;
  }
  const Real pressed = smaller(elastic, Real(0.0));
  r.normal_traction = c.normal_stiffness * pressed;
  r.stored = 0.5 * r.normal_traction * pressed;
}

/// Compression that retraces the bilinear curve (15).
template <int Dim, class Real, class Constants>
void follow_compression(const Constants& c, const Real& opening, ContactResponse<Dim, Real>& r) {
  const auto k = c.normal_stiffness;
  const Real pressed = smaller(opening, Real(0.0));
  const Real beyond = larger(-pressed - c.closure_at_limit, Real(0.0));
  const Real within = -pressed - beyond;
  r.normal_traction = k * (pressed + c.share_left * beyond);
  const Real yielded = beyond * (c.compressive_limit + 0.5 * (1.0 - c.share_left) * k * beyond);
  r.stored = 0.5 * k * within * within + select(beyond > 0.0, yielded, Real(0.0));  // f_cm may be infinite
}

/// Normal part: bilinear compression and linear tension softening over the elastic opening u_n + u_p.
template <int Dim, class Real, class Constants, class Losses>
void update_normal(const Constants& c, const Real& opening, ContactHistory<Dim, Real>& h,
                   ContactResponse<Dim, Real>& r, Losses& losses) {
  Real elastic = opening + h.closure;  // zero traction at zero
  if (c.compression == CompressionReading::irreversible)
    update_compression<Dim>(c, opening, elastic, h, r, losses);
  else
    follow_compression<Dim>(c, opening, r);
  if (any((elastic > 0.0) & (h.tension_damage < 1.0))) update_tension<Dim>(c, elastic, h, r, losses);
}

/// Exact return of the elastic predictor to the softening envelope.
///
/// Where the envelope falls more steeply than K_s, as under pressures beyond f_cm where friction drops, no
/// softening branch can be followed: the point falls to the residual line at once, and what that releases
/// beyond G_f2 is booked as shear loss too.
/// \param elastic  in and out: elastic part of the tangential jump, m
/// \param held     in and out: its length
template <int Dim, class Real, class Constants, class Truth, class Losses>
void return_to_envelope(const Constants& c, const Truth& slips, const Real& excess, const Real& residual, const Real& drop,
          Tangential<Dim, Real>& elastic, Real& held, ContactHistory<Dim, Real>& h,
          ContactResponse<Dim, Real>& r, Losses& losses) {
  const auto softens = slips & (h.shear_damage < 1.0) & (drop > 0.0);
  const Real remaining = 1.0 - h.shear_damage;
  const Real per_slip = drop * c.over_twice_mode_2_energy;  // 1 / s_u
  const auto follows = drop * per_slip < c.shear_stiffness;
  const Real softening_slip = excess / (c.shear_stiffness - drop * per_slip);
  const Real damage = h.shear_damage + softening_slip * per_slip;
  const auto partly = softens & follows & (damage < 1.0);
  // all the way down to the residual line where it softens to the end
  Real length = select(softens, held - residual * c.shear_compliance, excess * c.shear_compliance);
  length = select(partly, softening_slip, length);
  length = select(slips, length, Real(0.0));
  if (any(softens)) {
    const Real new_damage = select(partly, damage, Real(1.0));
    const Real left = 1.0 - new_damage;
    const Real energy = select(follows, Real(c.mode_2_energy), 0.5 * drop * drop * c.shear_compliance);
    losses.shear += select(softens, energy * (remaining - left) * (remaining + left), Real(0.0));
    h.shear_damage = select(softens, new_damage, h.shear_damage);
    r.damaged = true;
  }
  losses.friction += residual * length;
  losses.slip_path += length;
  Tangential<Dim, Real> step;
  if constexpr (Dim == 2)
    step[0] = signed_like(length, elastic[0]);
  else
    step = elastic * select(slips, length / held, Real(0.0));
  h.slip += step;
  elastic -= step;
  held = norm(elastic);
  r.slid = true;
}

/// Shear part: elastic predictor and exact return to the softening Mohr-Coulomb envelope.
template <int Dim, class Real, class Constants, class Losses>
void update_shear(const Constants& c, const Tangential<Dim, Real>& jump, const Real& opening,
                  ContactHistory<Dim, Real>& h, ContactResponse<Dim, Real>& r, Losses& losses) {
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
    // The bond lets go of the shear it still carried. That energy was held by cohesion, so it is booked
    // there.
    const Real released = select(open_and_broken, 0.5 * k * h.held_jump * h.held_jump, Real(0.0));
    if (any(released > 0.0)) losses.shear += released;
    held = select(open_and_broken, Real(0.0), held);
    for (int i = 0; i + 1 < Dim; ++i) {
      h.slip[i] = select(open_and_broken, jump[i], h.slip[i]);
      elastic[i] = select(open_and_broken, Real(0.0), elastic[i]);
    }
    r.slid = true;
  }
  h.held_jump = held;
  r.shear_traction = elastic * Real(k);
  r.stored += 0.5 * k * held * held;
}

}  // namespace contact_law

/// Takes one contact point to a new jump at fixed properties (one temperature), or eight of them.
///
/// \param constants   of the contact's properties at its temperature, which are valid
/// \param opening     u_n, m, opening positive
/// \param tangential  u_s, m
/// \param history     in: of the last step; out: of this one
/// \param losses      the energy dissipated by this update is added to them
/// \return traction and stored energy
///
/// Along one axis (opening alone, or sliding at a steady opening) the result does not depend on how the way
/// to the jump is cut into steps. On combined ways friction is that of the pressure at the end of each step,
/// so it converges with the number of steps. Energies are closed forms of the history, not quadratures.
template <int Dim, class Real, class Number, class Sum>
ContactResponse<Dim, Real> update_contact(const ContactConstantsOf<Number>& constants, const Real& opening,
                                          const Tangential<Dim, Real>& tangential,
                                          ContactHistory<Dim, Real>& history, ContactLossesOf<Sum>& losses) {
  if (constants.behaviour == ContactBehaviour::elastic)
    return contact_law::respond_elastically<Dim>(constants, opening, tangential);
  ContactResponse<Dim, Real> response;
  contact_law::update_normal<Dim>(constants, opening, history, response, losses);
  contact_law::update_shear<Dim>(constants, tangential, opening, history, response, losses);
  return response;
}

/// One contact point, with its losses in this update.
template <int Dim>
ContactResponseAndLosses<Dim> update_contact(const ContactProperties& properties, double opening,
                                             const Tangential<Dim>& tangential,
                                             ContactHistory<Dim>& history) {
  ContactLossesOf<double> lost{};
  const auto response =
      update_contact<Dim, double>(ContactConstants(properties), opening, tangential, history, lost);
  return {response, lost.slip_path, {lost.tension, lost.shear, lost.friction, lost.compression}};
}

}  // namespace pyroclast
