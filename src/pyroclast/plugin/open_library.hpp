#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "pyroclast/base/lasting.hpp"
#include "pyroclast/laws/table.hpp"

namespace pyroclast {

/// Contact law that is not part of the program: code that the program was asked to run.
struct OpenedLaw {
  LawTable table;
  Dimensions dimensions = Dimensions::both;
  std::filesystem::path shared_object;
  /// Header from which this program compiled the law, and the user's files that it includes; else empty.
  std::vector<std::filesystem::path> headers;
  std::string compiler;  ///< compiler as the shared object names it
};

/// Opens a shared object that pyroclast_add_law made, for the rest of the process; the same file once. Throws
/// Error where the file is no such object, was made for another version or layout, or does not compute by
/// IEEE 754: with contraction, fast-math or flush to zero.
/// \param headers  header from which this program compiled it, and the user's files that it includes
PYROCLAST_LASTING const OpenedLaw& open_law(const std::filesystem::path& shared_object,
                                            std::vector<std::filesystem::path> headers = {});

/// Returns the laws that were opened so far, in that order.
std::vector<const OpenedLaw*> opened_laws();

}  // namespace pyroclast
