#pragma once

#include "pyroclast/material/zone_law.hpp"

/// Load-induced thermal strain of a zone (transient creep): strain by which concrete under stress is shorter
/// when it is heated for the first time, beyond its elastic strain. Thelandersson 1987, with the choices of
/// Pearce, Nielsen and Bicanic 2004 (tension) and of Torelli et al. 2018 (confinement):
///
///     d(eps_L) = (dB / f_c) eta Q(s),    Q(s) = (1 + nu_L) s - nu_L tr(s) I,    s = sigma⁻ + chi_t sigma⁺
///
/// with sigma⁻ and sigma⁺ the compressive and the tensile part of the stress, by its principal stresses.
namespace pyroclast {

/// Creep of a zone in one exchange of temperature, for each unit of its stress.
struct CreepIncrement {
  double compliance = 0.0;   ///< rise of B over f_c, 1/Pa; 0 where the zone is not heated for the first time
  double poisson = 0.0;      ///< nu_L, in (-1, 1/2]
  double tension = 1.0;      ///< chi_t: share of creep in tension, from 0 to 1
  double confinement = 0.0;  ///< gamma of eta = 1 + (C - 1) gamma, C = -tr(s⁻) / |s⁻|; 1 under one stress
};

/// Returns Q of a stress, Pa.
template <int Dim>
SymmetricTensor<Dim> creep_direction(const SymmetricTensor<Dim>& stress, double poisson);

/// Split of a zone's creep in an exchange: half with the stress at its beginning, which is known, and half
/// with the stress at its end, for which the split acts as a compliance. The signs of the principal stresses
/// and eta are those of the beginning.
template <int Dim>
struct CreepSplit {
  SymmetricTensor<Dim> known{};  ///< strain at the end = known + compliance Q(stress at the end)
  double compliance = 0.0;       ///< 1/Pa
};

/// Splits the creep of an exchange.
/// \param stress  stress at the beginning of the exchange, in the zone's own frame, Pa
template <int Dim>
CreepSplit<Dim> creep_split(const CreepIncrement& increment, const SymmetricTensor<Dim>& stress);

/// Returns the properties of a zone whose stress adds a strain compliance Q(stress), which are isotropic
/// again.
/// \param compliance  1/Pa
template <int Dim>
ZoneProperties with_compliance(const ZoneProperties& zone, double compliance, double poisson);

/// Returns the creep strain across the plane of a zone in plane stress. It follows from the strain in the
/// plane and has no effect on the motion. nu_L is taken as constant.
inline double creep_across(double xx, double yy, double poisson) {
  return -poisson / (1.0 - poisson) * (xx + yy);
}

extern template SymmetricTensor<2> creep_direction<2>(const SymmetricTensor<2>&, double);
extern template SymmetricTensor<3> creep_direction<3>(const SymmetricTensor<3>&, double);
extern template CreepSplit<2> creep_split<2>(const CreepIncrement&, const SymmetricTensor<2>&);
extern template CreepSplit<3> creep_split<3>(const CreepIncrement&, const SymmetricTensor<3>&);
extern template ZoneProperties with_compliance<2>(const ZoneProperties&, double, double);
extern template ZoneProperties with_compliance<3>(const ZoneProperties&, double, double);

}  // namespace pyroclast
