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

/// What a contact point remembers. A contact that never held tension or cohesion (a platen's) starts with
/// both damages at 1.
template <int Dim, class Real = double>
struct ContactHistory {
  Real tension_damage{};         ///< D_t = 1 - delta_t of the paper, 0 intact, 1 broken; never decreases
  Real shear_damage{};           ///< D_s = 1 - delta_s, likewise
  Real closure{};                ///< u_p, irreversible closure in compression, m; never decreases
  Tangential<Dim, Real> slip{};  ///< irreversible part of the tangential jump, m
  Real held_slip{};              ///< length of the elastic part of the tangential jump, m
};

/// Energy dissipated at a contact point, by mechanism, J/m².
template <class Real>
struct ContactDissipationOf {
  Real tension{};      ///< G_f1 when torn apart
  Real shear{};        ///< above the residual line; G_f2 when fully softened
  Real friction{};     ///< along the residual line
  Real compression{};  ///< irreversible closure

  Real total() const { return tension + shear + friction + compression; }

  ContactDissipationOf& operator+=(const ContactDissipationOf& o) {
    tension += o.tension;
    shear += o.shear;
    friction += o.friction;
    compression += o.compression;
    return *this;
  }
};
using ContactDissipation = ContactDissipationOf<double>;

template <int Dim, class Real = double>
struct ContactResponse {
  Real normal_traction{};                  ///< sigma, Pa, tension positive
  Tangential<Dim, Real> shear_traction{};  ///< tau, Pa
  Real stored{};                           ///< elastic energy now held, J/m²
  Real slipped{};                          ///< length of the slip in this update, m
  ContactDissipationOf<Real> dissipated;   ///< in this update
  bool irreversible = false;               ///< the history changed beyond `held_slip`, in any lane
};

/// Throws Error, naming the quantity, when the parameters cannot make a law: non-positive stiffness, negative
/// strength, or a softening branch steeper than the elastic one (snap-back).
void validate(const ContactProperties& properties, const std::string& name);

namespace contact_law {

/// Linear tension softening with unloading to the origin.
/// \param elastic  opening beyond the closure left behind, m
template <int Dim, class Real, class Properties>
void update_tension(const Properties& p, const Real& elastic, ContactHistory<Dim, Real>& h,
                    ContactResponse<Dim, Real>& r) {
  const auto u_e = p.elastic_opening();
  const auto range = p.ultimate_opening() - u_e;
  const auto open = elastic > 0.0;
  // In this order a contact without any strength, 0 / 0, breaks.
  const Real damage = smaller(Real(1.0), (elastic - u_e) / range);
  const auto grows = open & (damage > h.tension_damage);
  if (any(grows)) {
    // The area between the envelope and the secant grows by G_f1 dD, whatever the step.
    r.dissipated.tension = select(grows, p.mode_1_energy * (damage - h.tension_damage), 0.0);
    h.tension_damage = select(grows, damage, h.tension_damage);
    r.irreversible = true;
  }
  const auto holds = open & (h.tension_damage < 1.0);
  const Real kappa = u_e + h.tension_damage * range;
  const Real traction = select(holds, (1.0 - h.tension_damage) * p.tensile_strength * elastic / kappa, 0.0);
  r.normal_traction += traction;
  r.stored += 0.5 * traction * elastic;
}

/// Compression with unloading along K_n, which leaves a closure: yield stress f_cm + H u_p with
/// H = beta K_n / (1 - beta), on monotone loading exactly Eq. (15).
/// \param elastic  in and out: opening beyond the closure left behind, m
template <int Dim, class Real, class Properties>
void update_compression(const Properties& p, const Real& opening, Real& elastic, ContactHistory<Dim, Real>& h,
                        ContactResponse<Dim, Real>& r) {
  const auto k = p.normal_stiffness;
  const Real closure = (1.0 - p.hardening) * (-opening - p.compressive_limit / k);
  const auto yields = closure > h.closure;  // far below elastic = 0
  if (any(yields)) {
    const auto slope = p.hardening * k / (1.0 - p.hardening);
    r.dissipated.compression = select(
        yields, (closure - h.closure) * (p.compressive_limit + 0.5 * slope * (closure + h.closure)), 0.0);
    h.closure = select(yields, closure, h.closure);
    elastic = opening + h.closure;
    r.irreversible = true;
  }
  const Real pressed = smaller(elastic, 0.0);
  r.normal_traction = k * pressed;
  r.stored = 0.5 * k * pressed * pressed;
}

/// Compression that retraces the bilinear curve (15).
template <int Dim, class Real, class Properties>
void follow_compression(const Properties& p, const Real& opening, ContactResponse<Dim, Real>& r) {
  const auto k = p.normal_stiffness;
  const Real pressed = smaller(opening, 0.0);
  const Real beyond = larger(-pressed - p.compressive_limit / k, 0.0);
  const Real within = -pressed - beyond;
  r.normal_traction = k * (pressed + (1.0 - p.hardening) * beyond);
  const auto yields = beyond > 0.0;  // where the limit may be infinite
  r.stored = 0.5 * k * within * within +
             select(yields, beyond * (p.compressive_limit + 0.5 * p.hardening * k * beyond), 0.0);
}

/// Normal part: bilinear compression and linear tension softening over the elastic opening u_n + u_p.
template <int Dim, class Real, class Properties>
void update_normal(const Properties& p, const Real& opening, ContactHistory<Dim, Real>& h,
                   ContactResponse<Dim, Real>& r) {
  Real elastic = opening + h.closure;  // zero traction at zero
  if (p.compression == CompressionReading::irreversible)
    update_compression<Dim>(p, opening, elastic, h, r);
  else
    follow_compression<Dim>(p, opening, r);
  if (any((elastic > 0.0) & (h.tension_damage < 1.0))) update_tension<Dim>(p, elastic, h, r);
}

/// Shear part: elastic predictor and exact return to the softening Mohr-Coulomb envelope.
template <int Dim, class Real, class Properties>
void update_shear(const Properties& p, const Tangential<Dim, Real>& jump, const Real& opening,
                  ContactHistory<Dim, Real>& h, ContactResponse<Dim, Real>& r) {
  const auto k = p.shear_stiffness;
  Tangential<Dim, Real> elastic = jump - h.slip;
  Real held = norm(elastic);
  const auto open_and_broken = (h.tension_damage >= 1.0) & (opening + h.closure > 0.0);
  Real cohesion = p.cohesion;
  if (p.coupled) cohesion *= 1.0 - h.tension_damage;
  const Real residual_cohesion = smaller(cohesion, p.residual_cohesion);
  const Real peak = larger(cohesion - r.normal_traction * p.friction, 0.0);
  const Real residual =
      smaller(peak, larger(residual_cohesion - r.normal_traction * p.residual_friction, 0.0));
  const Real drop = peak - residual;
  const Real strength = peak - h.shear_damage * drop;
  const Real excess = k * held - strength;
  const auto slips = (excess > 0.0) & !open_and_broken;
  if (any(slips)) {
    const auto softens = slips & (h.shear_damage < 1.0) & (drop > 0.0);
    const Real remaining = 1.0 - h.shear_damage;
    const Real per_slip = drop / (2.0 * p.mode_2_energy);  // 1 / s_u
    const Real softening_slip = excess / (k - drop * per_slip);
    const Real damage = h.shear_damage + softening_slip * per_slip;
    const auto partly = softens & (damage < 1.0);
    Real slip = select(softens, (k * held - residual) / k, excess / k);
    slip = select(partly, softening_slip, slip);
    slip = select(slips, slip, 0.0);
    const Real new_damage = select(partly, damage, Real(1.0));
    const Real left = 1.0 - new_damage;
    r.dissipated.shear = select(softens, p.mode_2_energy * (remaining - left) * (remaining + left), 0.0);
    h.shear_damage = select(softens, new_damage, h.shear_damage);
    r.dissipated.friction = residual * slip;
    r.slipped = slip;
    const Real share = select(slips, slip / held, 0.0);
    const Tangential<Dim, Real> step = elastic * share;
    h.slip += step;
    elastic -= step;
    held = norm(elastic);
    r.irreversible = true;
  }
  if (any(open_and_broken)) {
    // The bond lets go of the shear it still carried. That energy was held by cohesion, so it is booked
    // there.
    r.dissipated.shear += select(open_and_broken, 0.5 * k * h.held_slip * h.held_slip, 0.0);
    held = select(open_and_broken, 0.0, held);
    for (int i = 0; i + 1 < Dim; ++i) {
      h.slip[i] = select(open_and_broken, jump[i], h.slip[i]);
      elastic[i] = select(open_and_broken, 0.0, elastic[i]);
    }
    r.irreversible = true;
  }
  h.held_slip = held;
  r.shear_traction = elastic * k;
  r.stored += 0.5 * k * held * held;
}

}  // namespace contact_law

/// Takes one contact point to a new jump at fixed properties (one temperature), or eight of them.
///
/// \param properties  parameters at the contact's temperature, validated
/// \param opening     u_n, m, opening positive
/// \param tangential  u_s, m
/// \param history     in: of the last step; out: of this one
/// \return traction, stored energy and the energy dissipated by this update
///
/// The result does not depend on how the way to the jump is cut into steps as long as it is monotone.
/// Energies are closed forms of the history, not quadratures: with the temperature fixed, stored(new) -
/// stored(old) + dissipated is the work along that way.
template <int Dim, class Real, class Properties>
ContactResponse<Dim, Real> update_contact(const Properties& properties, const Real& opening,
                                          const Tangential<Dim, Real>& tangential,
                                          ContactHistory<Dim, Real>& history) {
  ContactResponse<Dim, Real> response;
  if (properties.behaviour == ContactBehaviour::elastic) {
    const auto k_n = properties.normal_stiffness;
    const auto k_s = properties.shear_stiffness;
    response.normal_traction = k_n * opening;
    response.shear_traction = tangential * k_s;
    response.stored = 0.5 * k_n * opening * opening + 0.5 * k_s * dot(tangential, tangential);
    return response;
  }
  contact_law::update_normal<Dim>(properties, opening, history, response);
  contact_law::update_shear<Dim>(properties, tangential, opening, history, response);
  return response;
}

}  // namespace pyroclast
