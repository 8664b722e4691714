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
template <int Dim>
using Tangential = Vec<Dim - 1>;

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
struct ContactProperties {
  double normal_stiffness = 0.0;   ///< K_n, Pa/m
  double shear_stiffness = 0.0;    ///< K_s, Pa/m
  double tensile_strength = 0.0;   ///< f_t, Pa
  double mode_1_energy = 0.0;      ///< G_f1, J/m²
  double compressive_limit = 0.0;  ///< f_cm, end of the first slope in compression, Pa; may be infinite
  double hardening = 0.0;          ///< beta, second slope over first
  double cohesion = 0.0;           ///< c_o, Pa
  double residual_cohesion = 0.0;  ///< c_res, Pa
  double friction = 0.0;           ///< tan(phi)
  double residual_friction = 0.0;  ///< tan(phi_res)
  double mode_2_energy = 0.0;      ///< G_f2, J/m²
  ContactBehaviour behaviour = ContactBehaviour::cohesive;
  CompressionReading compression = CompressionReading::irreversible;
  bool coupled = false;  ///< cohesion also scaled by 1 - D_t

  /// u_e = f_t / K_n, opening at which softening begins, m.
  double elastic_opening() const { return tensile_strength / normal_stiffness; }
  /// u_f = 2 G_f1 / f_t, opening at which nothing is left, m.
  double ultimate_opening() const { return 2.0 * mode_1_energy / tensile_strength; }
};

/// What a contact point remembers. A contact that never held tension or cohesion (a platen's) starts with
/// both damages at 1.
template <int Dim>
struct ContactHistory {
  double tension_damage = 0.0;    ///< D_t = 1 - delta_t of the paper, 0 intact, 1 broken; never decreases
  double shear_damage = 0.0;      ///< D_s = 1 - delta_s, likewise
  double closure = 0.0;           ///< u_p, irreversible closure in compression, m; never decreases
  double accumulated_slip = 0.0;  ///< s, length of the slip path, m
  Tangential<Dim> slip{};         ///< irreversible part of the tangential jump, m
  double held_slip = 0.0;         ///< length of the elastic part of the tangential jump, m
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

template <int Dim>
struct ContactResponse {
  double normal_traction = 0.0;      ///< sigma, Pa, tension positive
  Tangential<Dim> shear_traction{};  ///< tau, Pa
  double stored = 0.0;               ///< elastic energy now held, J/m²
  ContactDissipation dissipated;     ///< in this update
};

/// Throws Error, naming the quantity, when the parameters cannot make a law: non-positive stiffness, negative
/// strength, or a softening branch steeper than the elastic one (snap-back).
void validate(const ContactProperties& properties, const std::string& name);

namespace contact_law {

/// Normal part: bilinear compression and linear tension softening over the elastic opening u_n + u_p.
template <int Dim>
void update_normal(const ContactProperties& p, double opening, ContactHistory<Dim>& h,
                   ContactResponse<Dim>& r) {
  const double k = p.normal_stiffness;
  if (p.behaviour == ContactBehaviour::elastic) {
    r.normal_traction = k * opening;
    r.stored = 0.5 * k * opening * opening;
    return;
  }
  double elastic = opening + h.closure;  // opening beyond the closure left behind: zero traction at zero
  if (elastic <= 0.0) {
    const double limit = p.compressive_limit / k;
    if (p.compression == CompressionReading::reversible) {
      const double beyond = std::max(0.0, -opening - limit);
      r.normal_traction = k * (opening + (1.0 - p.hardening) * beyond);
      const double within = -opening - beyond;
      r.stored = 0.5 * k * within * within;
      if (beyond > 0.0) r.stored += beyond * (p.compressive_limit + 0.5 * p.hardening * k * beyond);
      return;
    }
    const double closure = (1.0 - p.hardening) * (-opening - limit);
    if (closure > h.closure) {
      // Yield stress f_cm + H u_p with H = beta K_n / (1 - beta): on monotone loading exactly Eq. (15).
      const double slope = p.hardening * k / (1.0 - p.hardening);
      r.dissipated.compression =
          (closure - h.closure) * (p.compressive_limit + 0.5 * slope * (closure + h.closure));
      h.closure = closure;
      elastic = opening + closure;
    }
    r.normal_traction = k * elastic;
    r.stored = 0.5 * k * elastic * elastic;
    return;
  }
  if (h.tension_damage >= 1.0) return;
  const double u_e = p.elastic_opening();
  const double u_f = p.ultimate_opening();
  const double damage = std::min(1.0, (elastic - u_e) / (u_f - u_e));
  if (damage > h.tension_damage) {
    // The area between the envelope and the secant grows by G_f1 dD, whatever the step.
    r.dissipated.tension = p.mode_1_energy * (damage - h.tension_damage);
    h.tension_damage = damage;
    if (damage >= 1.0) return;
  }
  const double kappa = u_e + h.tension_damage * (u_f - u_e);
  r.normal_traction = (1.0 - h.tension_damage) * p.tensile_strength * elastic / kappa;
  r.stored = 0.5 * r.normal_traction * elastic;
}

/// Shear part: elastic predictor and exact return to the softening Mohr-Coulomb envelope.
template <int Dim>
void update_shear(const ContactProperties& p, const Tangential<Dim>& jump, double opening,
                  ContactHistory<Dim>& h, ContactResponse<Dim>& r) {
  const double k = p.shear_stiffness;
  Tangential<Dim> elastic = jump - h.slip;
  if (p.behaviour == ContactBehaviour::elastic) {
    r.shear_traction = k * elastic;
    r.stored += 0.5 * k * dot(elastic, elastic);
    return;
  }
  const bool open_and_broken = h.tension_damage >= 1.0 && opening + h.closure > 0.0;
  const double held = norm(elastic);
  if (open_and_broken) {
    // The bond lets go of the shear it still carried. That energy was held by cohesion, so it is booked
    // there.
    r.dissipated.shear += 0.5 * k * h.held_slip * h.held_slip;
    h.held_slip = 0.0;
    h.slip = jump;
    return;
  }
  const double cohesion = p.coupled ? p.cohesion * (1.0 - h.tension_damage) : p.cohesion;
  const double residual_cohesion = std::min(p.residual_cohesion, cohesion);
  const double peak = std::max(0.0, cohesion - r.normal_traction * p.friction);
  const double residual =
      std::min(peak, std::max(0.0, residual_cohesion - r.normal_traction * p.residual_friction));
  const double drop = peak - residual;
  const double strength = peak - h.shear_damage * drop;
  const double excess = k * held - strength;
  if (excess > 0.0) {
    double slip = 0.0;
    if (h.shear_damage < 1.0 && drop > 0.0) {
      const double to_residual = 2.0 * p.mode_2_energy / drop;  // s_u
      const double remaining = 1.0 - h.shear_damage;
      slip = excess / (k - drop / to_residual);
      const double damage = h.shear_damage + slip / to_residual;
      if (damage < 1.0) {
        const double left = 1.0 - damage;
        r.dissipated.shear += p.mode_2_energy * (remaining - left) * (remaining + left);
        h.shear_damage = damage;
      } else {
        slip = (k * held - residual) / k;
        r.dissipated.shear += p.mode_2_energy * remaining * remaining;
        h.shear_damage = 1.0;
      }
    } else {
      slip = excess / k;
    }
    r.dissipated.friction += residual * slip;
    h.accumulated_slip += slip;
    const Tangential<Dim> step = elastic * (slip / held);
    h.slip += step;
    elastic -= step;
  }
  h.held_slip = norm(elastic);
  r.shear_traction = k * elastic;
  r.stored += 0.5 * k * h.held_slip * h.held_slip;
}

}  // namespace contact_law

/// Takes one contact point to a new jump at fixed properties (one temperature).
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
template <int Dim>
ContactResponse<Dim> update_contact(const ContactProperties& properties, double opening,
                                    const Tangential<Dim>& tangential, ContactHistory<Dim>& history) {
  ContactResponse<Dim> response;
  contact_law::update_normal<Dim>(properties, opening, history, response);
  contact_law::update_shear<Dim>(properties, tangential, opening, history, response);
  return response;
}

}  // namespace pyroclast
