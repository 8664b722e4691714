#pragma once

#include <functional>
#include <string>
#include <vector>

#include "pyroclast/deck/deck.hpp"
#include "pyroclast/material/concrete.hpp"
#include "pyroclast/material/curve_reader.hpp"
#include "pyroclast/material/thermal_strain.hpp"

namespace pyroclast {

/// What [materials] says of all solids.
struct MaterialRules {
  ExpansionReading expansion_reading = ExpansionReading::secant;
  OnCooling on_cooling = OnCooling::irreversible;
};

MaterialRules read_material_rules(const Section& root);

/// What [concrete] says of the concrete as a whole.
struct ReadConcrete {
  std::optional<Curve> thermal_strain;        ///< eps_c
  std::string place;                          ///< where it stands, for messages
  std::optional<StrainOfConcrete> of_phases;  ///< where those of the phases follow from it
};

/// Reads [concrete], which may be absent. Errors are recorded in the deck.
ReadConcrete read_concrete(const Section& root, const std::vector<std::string>& phases,
                           const MaterialRules& rules, CurveReader& curves);

/// Reads [materials]: a table for each phase, then one for each solid of bearings. `curves` must be of the
/// temperature. Errors are recorded in the deck.
std::vector<SolidMaterial> read_solids(const Section& root, const std::vector<std::string>& phases,
                                       const std::vector<std::string>& of_bearings,
                                       const MaterialRules& rules, const ReadConcrete& concrete,
                                       CurveReader& curves);

/// The same for heat conduction alone: of the phases only density, conductivity and specific heat; other
/// properties have no effect.
std::vector<SolidMaterial> read_conducting_solids(const Section& root, const std::vector<std::string>& phases,
                                                  CurveReader& curves);

/// Finds the contact law that a deck names. Throws CodeNotAllowed where it may not run, and Error when there
/// is none. \param named  the command line states it
using LawFinder = std::function<const LawTable&(const std::string& name, bool named)>;

/// Reads [contacts]. A property that is a plain constant follows the `temperature_ratio` of its interface.
/// \param matrix       phase whose own interface there must be
/// \param has_platens  whether there is a contact with platens, which then comes first of those of bearings
ContactParameters read_contacts(const Section& root, const std::vector<std::string>& phases,
                                const std::string& matrix, bool has_platens, OnCooling on_cooling,
                                const LawFinder& find_law, CurveReader& curves);

}  // namespace pyroclast
