#pragma once

#include <functional>
#include <string>
#include <vector>

#include "pyroclast/deck/deck.hpp"
#include "pyroclast/material/concrete.hpp"
#include "pyroclast/material/curve_reader.hpp"
#include "pyroclast/material/thermal_strain.hpp"

namespace pyroclast {

/// Rules of [materials] for all blocks.
struct MaterialRules {
  ExpansionReading expansion_reading = ExpansionReading::secant;
  OnCooling on_cooling = OnCooling::irreversible;
};

MaterialRules read_material_rules(const Section& root);

/// Content of [concrete] on the concrete as a whole.
struct ReadConcrete {
  std::optional<Curve> thermal_strain;        ///< eps_c
  bool is_readable = true;                    ///< false where the deck has an error in the strain
  std::string place;                          ///< place of the strain in the deck, for messages
  std::optional<StrainOfConcrete> of_phases;  ///< strain, where the strains of the phases follow from it
};

/// Reads [concrete], which may be absent. Errors are recorded in the deck.
ReadConcrete read_concrete(const Section& root, const std::vector<std::string>& phases,
                           const MaterialRules& rules, CurveReader& curves);

/// Reads [materials]: a table for each phase, then one for each material of bearings. `curves` must be of the
/// temperature. Errors are recorded in the deck.
std::vector<BlockMaterial> read_block_materials(const Section& root, const std::vector<std::string>& phases,
                                                const std::vector<std::string>& of_bearings,
                                                const MaterialRules& rules, const ReadConcrete& concrete,
                                                CurveReader& curves);

/// Reads [materials] for heat conduction alone: of the phases only density, conductivity and specific heat;
/// other properties have no effect.
std::vector<BlockMaterial> read_conducting_materials(const Section& root,
                                                     const std::vector<std::string>& phases,
                                                     CurveReader& curves);

/// Function that finds the contact law that a deck names. It throws CodeNotAllowed where the law may not run,
/// and Error when there is none.
/// \param named  true where the command line states the law
using LawFinder = std::function<const LawTable&(const std::string& name, bool named)>;

/// Table of [contacts] that is no interface: contacts that are found.
inline constexpr const char* kFoundTable = "found";

/// Reads [contacts]. A property that is a plain constant follows the `temperature_ratio` of its interface.
/// \param of_stones    phases whose blocks belong to stones that are known
/// \param matrix       phase that must have an interface with itself
/// \param has_platens  true where there is a contact with platens, which then comes first of those of
///                     bearings
ContactParameters read_contacts(const Section& root, const std::vector<std::string>& phases,
                                const std::vector<std::string>& of_stones, const std::string& matrix,
                                bool has_platens, OnCooling on_cooling, const LawFinder& find_law,
                                CurveReader& curves);

}  // namespace pyroclast
