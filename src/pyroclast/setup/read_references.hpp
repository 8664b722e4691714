#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "pyroclast/base/unit.hpp"
#include "pyroclast/deck/deck.hpp"

namespace pyroclast {

struct Setup;

/// Which rows of the history a figure draws as one curve.
enum class DrawnRows : std::uint8_t {
  all,
  from_zero,  ///< since the last stage of kind settle, from which displacements count
  heated,     ///< from the row before the first exchange of temperatures on, those after an exchange
  compressed  ///< the compression at the end, with the stages before it that moved the platen too
};

/// What stands at an axis of a figure.
struct DrawnQuantity {
  std::string name;    ///< in `of` and `over` of a deck
  std::string column;  ///< of the history
  const Unit* unit = &unit::dimensionless;
  double written = 1.0;  ///< a value of the column over the same in SI
  double sign = 1.0;     ///< of the drawn value over that of the column
};

/// A curve that figures draw beside the results.
struct Reference {
  std::string name;  ///< in the legend, and in the summary
  bool is_builtin = false;
  DrawnRows rows = DrawnRows::all;  ///< of the run, that it stands beside
  DrawnQuantity of, over;
  std::vector<double> x;          ///< in the unit of the history's column
  std::vector<double> low, high;  ///< likewise; the same where the curve is no range
};

/// Reads [[output.references]]. A wrong name, a file that cannot be read, and a reference that no figure of
/// the run draws are errors of the deck.
///
/// \param folder  from which a relative file name is taken
/// \param setup   all that it says beside the output
std::vector<Reference> read_references(const Section& output, const std::filesystem::path& folder,
                                       const Setup& setup);

/// The file from which figures take them: their names, what they are of, and their values in the units of the
/// history. Empty where there are none.
std::string json_of(const std::vector<Reference>& references);

}  // namespace pyroclast
