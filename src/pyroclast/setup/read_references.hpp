#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "pyroclast/base/unit.hpp"
#include "pyroclast/deck/deck.hpp"

namespace pyroclast {

struct Setup;

/// Rows of the history that a figure draws as one curve.
enum class DrawnRows : std::uint8_t {
  all,
  from_zero,  ///< rows since the last stage of kind settle, from which displacements count
  heated,     ///< rows after an exchange of temperatures, with the row before the first
  compressed  ///< rows of the compression at the end, with the stages before it that moved the platen too
};

/// Quantity at an axis of a figure.
struct DrawnQuantity {
  std::string name;    ///< name in `of` and `over` of a deck
  std::string column;  ///< column of the history
  const Unit* unit = &unit::dimensionless;
  double written = 1.0;  ///< value of the column over the same value in SI
  double sign = 1.0;     ///< drawn value over the value of the column: 1 or -1
};

/// Curve that figures draw beside the results.
struct Reference {
  std::string name;  ///< name in the legend, and in the summary
  bool is_builtin = false;
  DrawnRows rows = DrawnRows::all;  ///< rows of the run beside which the curve stands
  DrawnQuantity of, over;
  std::vector<double> x;  ///< abscissae, in the unit of the history's column
  /// Values, in the unit of the history's column; the same where the curve is no range.
  std::vector<double> low, high;
};

/// Reads [[output.references]]. A wrong name, a file that cannot be read, and a reference that no figure of
/// the run draws are errors of the deck.
///
/// \param folder  folder to which a file name is relative
/// \param setup   content of the deck beside the output
std::vector<Reference> read_references(const Section& output, const std::filesystem::path& folder,
                                       const Setup& setup);

/// Returns the file from which figures take references: their names, quantities and values in the units of
/// the history. Empty where there are none.
std::string json_of(const std::vector<Reference>& references);

}  // namespace pyroclast
