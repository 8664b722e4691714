#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "pyroclast/base/unit.hpp"

namespace pyroclast {

/// Quantity that the name of a column may say.
struct ColumnMeaning {
  std::string_view name;  ///< name in messages, such as "radius"
  const Unit& unit;
  /// Words that say it. A letter alone counts in this case only, longer words in either.
  std::vector<std::string_view> words;
  /// True where the word rules the others of a name: "temperature rise" is a rise, "sieve no" a sieve.
  bool rules = false;
};

/// Quantities of columns that readers of tables know by name.
namespace meaning {
extern const ColumnMeaning index, x, y, z, diameter, radius, area, phase, grain, sieve, passing, retained,
    time, temperature, temperature_rise, strain, stress, force, displacement, opening;
}

using ColumnMeanings = std::vector<const ColumnMeaning*>;

/// Returns the quantities of a vocabulary that a name may say. Empty where no word of it is known, or where
/// its words say unlike quantities, as in "load cell temperature".
ColumnMeanings meanings_of_name(std::string_view name, const ColumnMeanings& vocabulary);

}  // namespace pyroclast
