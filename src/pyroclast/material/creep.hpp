#pragma once

#include "pyroclast/material/zone_law.hpp"

/// Load-induced thermal strain of a zone (transient creep): what concrete under stress is shorter by when it
/// is heated for the first time, beyond what it strains elastically. Thelandersson 1987, with the choices of
/// Pearce, Nielsen and Bicanic 2004 (tension) and of Torelli et al. 2018 (confinement):
///
///     d(eps_L) = (dB / f_c) eta Q(s),    Q(s) = (1 + nu_L) s - nu_L tr(s) I,    s = sigma⁻ + chi_t sigma⁺
///
/// with sigma⁻ and sigma⁺ the compressive and the tensile part of the stress, by its principal stresses.
namespace pyroclast {

/// What a zone creeps by in one exchange of temperature, for each unit of its stress.
struct CreepIncrement {
  double compliance = 0.0;   ///< rise of B over f_c, 1/Pa; 0 where the zone is not heated for the first time
  double poisson = 0.0;      ///< nu_L, in (-1, 1/2]
  double tension = 1.0;      ///< chi_t: share of creep in tension, from 0 to 1
  double confinement = 0.0;  ///< gamma of eta = 1 + (C - 1) gamma, C = -tr(s⁻) / |s⁻|; 1 under one stress
};

/// Q of a stress, Pa.
template <int Dim>
SymmetricTensor<Dim> creep_direction(const SymmetricTensor<Dim>& stress, double poisson);

/// How an exchange splits what a zone creeps: half with the stress at its beginning, which is known; half
/// with that at its end, which acts as a compliance until then. Split by sign and eta are those of the
/// beginning.
template <int Dim>
struct CreepSplit {
  SymmetricTensor<Dim> known{};  ///< strain at the end = known + compliance Q(stress at the end)
  double compliance = 0.0;       ///< 1/Pa
};

/// \param stress  at the beginning of the exchange, in the zone's own frame, Pa
template <int Dim>
CreepSplit<Dim> creep_split(const CreepIncrement& increment, const SymmetricTensor<Dim>& stress);

/// A zone whose stress adds a strain compliance Q(stress): isotropic again.
/// \param compliance  1/Pa
template <int Dim>
ZoneProperties with_compliance(const ZoneProperties& zone, double compliance, double poisson);

/// Creep strain across the plane of a zone in plane stress, which acts on nothing: that of its own plane says
/// it. With nu_L as throughout.
inline double creep_across(const SymmetricTensor<2>& strain, double poisson) {
  return -poisson / (1.0 - poisson) * (strain[0] + strain[1]);
}

extern template SymmetricTensor<2> creep_direction<2>(const SymmetricTensor<2>&, double);
extern template SymmetricTensor<3> creep_direction<3>(const SymmetricTensor<3>&, double);
extern template CreepSplit<2> creep_split<2>(const CreepIncrement&, const SymmetricTensor<2>&);
extern template CreepSplit<3> creep_split<3>(const CreepIncrement&, const SymmetricTensor<3>&);
extern template ZoneProperties with_compliance<2>(const ZoneProperties&, double, double);
extern template ZoneProperties with_compliance<3>(const ZoneProperties&, double, double);

}  // namespace pyroclast
