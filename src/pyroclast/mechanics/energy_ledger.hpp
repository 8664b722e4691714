#pragma once

#include <array>
#include <cmath>
#include <string_view>
#include <vector>

#include "pyroclast/base/ledger.hpp"

namespace pyroclast {

/// Name of the energy that zones lose by creep.
inline constexpr std::string_view kCreep = "creep";

/// Name of the energy that found contacts lose where their area changes under shear.
inline constexpr std::string_view kContactArea = "contact_area";

/// Name of the energy that the damping of found contacts takes.
inline constexpr std::string_view kContactDamping = "contact_damping";

/// Energies lost for good, J: at contacts, named by their laws, and by creep of zones.
struct Dissipation {
  std::vector<std::string_view> names;
  std::vector<double> energies;  ///< energies in the order of `names`

  /// Returns the energy of a name; 0 where no law has that name.
  double of(std::string_view name) const;
  double total() const;
};

/// Energies of a body since the start, J. The work put in equals all other entries; the remainder is the
/// ledger's error.
struct EnergyLedger {
  // put in
  double loading = 0.0, gravity = 0.0, property_change = 0.0, pore_pressure = 0.0, mass_scaling = 0.0;
  // held
  double zones = 0.0, contacts = 0.0, kinetic = 0.0;
  // lost
  Dissipation dissipated;
  double local_damping = 0.0, viscous_damping = 0.0, removed = 0.0;
  bool has_pore_pressure = false;  ///< true for a body on whose contacts pore water presses
  bool loses_blocks = false;       ///< true for a body that blocks may leave

  /// Sums the entries of one side, without those of `dissipated`.
  double sum(LedgerSide side, double from = 0.0) const;
  double work_in() const { return sum(LedgerSide::put_in); }
  double accounted() const { return sum(LedgerSide::lost, sum(LedgerSide::held) + dissipated.total()); }
  double error() const { return work_in() - accounted(); }
  double elastic() const { return zones + contacts; }
  /// Returns kinetic over elastic energy; 0 where nothing is strained, but by round-off of a body that flies.
  double kinetic_over_elastic() const {
    constexpr double kRoundOff = 1e-38;
    return elastic() > kRoundOff * std::abs(kinetic) ? std::abs(kinetic) / elastic() : 0.0;
  }
};

/// Entries in the order of the history's columns; the columns of `dissipated` stand before the other losses.
inline constexpr auto kEnergies = std::to_array<LedgerEntry<EnergyLedger>>({
    {"loading", "energy_loading_J", LedgerSide::put_in, "loading",
     "work of prescribed motion and applied forces, and energy of velocities at the start",
     [](const EnergyLedger& e) { return e.loading; }},
    {"gravity", "energy_gravity_J", LedgerSide::put_in, "gravity", "work of the weight",
     [](const EnergyLedger& e) { return e.gravity; }},
    {"property_change", "energy_property_change_J", LedgerSide::put_in, "change of properties",
     "change of stored and dissipated energy when properties or thermal strains change",
     [](const EnergyLedger& e) { return e.property_change; }},
    {"pore_pressure", "energy_pore_pressure_J", LedgerSide::put_in, "pore pressure",
     "work of the pressure of pore water on contacts that open",
     [](const EnergyLedger& e) { return e.pore_pressure; },
     [](const EnergyLedger& e) { return e.has_pore_pressure; }},
    {"mass_scaling", "energy_mass_scaling_J", LedgerSide::put_in, "mass scaling",
     "change of kinetic energy when scaled masses follow the stiffness",
     [](const EnergyLedger& e) { return e.mass_scaling; }},
    {"elastic_zones", "energy_zones_J", LedgerSide::held, "stored in zones", "elastic, in zones",
     [](const EnergyLedger& e) { return e.zones; }},
    {"elastic_contacts", "energy_contacts_J", LedgerSide::held, "stored in contacts", "elastic, in contacts",
     [](const EnergyLedger& e) { return e.contacts; }},
    {"kinetic", "energy_kinetic_J", LedgerSide::held, "kinetic", "of the masses that move",
     [](const EnergyLedger& e) { return e.kinetic; }},
    {"local_damping", "energy_local_damping_J", LedgerSide::lost, "local damping", "to local damping",
     [](const EnergyLedger& e) { return e.local_damping; }},
    {"viscous_damping", "energy_viscous_damping_J", LedgerSide::lost, "viscous damping", "to viscous damping",
     [](const EnergyLedger& e) { return e.viscous_damping; }},
    {"removed", "energy_removed_J", LedgerSide::lost, "gone with pieces",
     "held by blocks that have left the body, and by what they ceased to press on",
     [](const EnergyLedger& e) { return e.removed; }, [](const EnergyLedger& e) { return e.loses_blocks; }},
    {"error", "energy_error_J", LedgerSide::error, "error", "energy put in, less energy held and lost",
     [](const EnergyLedger& e) { return e.error(); }},
});

inline double EnergyLedger::sum(LedgerSide side, double from) const {
  for (const auto& entry : kEnergies)
    if (entry.side == side) from += entry.value(*this);
  return from;
}

}  // namespace pyroclast
