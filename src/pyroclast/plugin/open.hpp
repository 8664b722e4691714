#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "pyroclast/base/lasting.hpp"
#include "pyroclast/laws/table.hpp"

namespace pyroclast {

/// A header that this program compiled.
struct LawHeader {
  std::filesystem::path file;  ///< empty where there is none
  std::string text;
};

/// A contact law that is not part of the program: code that it was asked to run.
struct OpenedLaw {
  LawTable table;
  Dimensions dimensions = Dimensions::both;
  std::filesystem::path shared_object;
  LawHeader header;      ///< that it was compiled from by this program
  std::string compiler;  ///< as the shared object names it
};

/// Loads a shared object that pyroclast_add_law made, for the rest of the process; the same file once.
/// Throws Error where it is none, was made for another version or layout, or takes numbers for anything but
/// IEEE 754: with contraction, fast-math or flush to zero.
/// \param header  that it was compiled from by this program
PYROCLAST_LASTING const OpenedLaw& open_law(const std::filesystem::path& shared_object,
                                            LawHeader header = {});

/// Those that were loaded so far, in that order.
std::vector<const OpenedLaw*> opened_laws();

}  // namespace pyroclast
