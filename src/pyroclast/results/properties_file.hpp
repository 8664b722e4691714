#pragma once

#include <string>
#include <vector>

#include "pyroclast/material/concrete.hpp"
#include "pyroclast/material/curve_reader.hpp"

namespace pyroclast {

/// Returns the properties of phases and interfaces over the temperature, each under its path in a deck.
/// \param moves  true where the mechanical properties count
std::vector<ReadCurve> property_curves(const ConcreteMaterials& materials, bool moves);

/// Choice of the rows of a table of properties.
enum class PropertyRows {
  every_kelvin,  ///< rows 1 K apart at most
  /// Rows between which straight lines miss none of those of `every_kelvin` by more than 0.1 % of the
  /// greatest value.
  few
};

/// Returns the text of properties.csv: each property from 20 to 800 °C at least, and in the temperatures to
/// which the run may come, as far as its curve is defined.
/// \param run  temperatures to which the run may come, °C
std::string properties_csv(const std::vector<ReadCurve>& properties, const Interval& run, PropertyRows rows);

}  // namespace pyroclast
