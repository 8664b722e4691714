#pragma once

#include <filesystem>

#include "pyroclast/simulation/acting/spalling.hpp"

namespace pyroclast {

/// Files `spalls.csv`, the pieces that have left the body, and `spalled_blocks.csv`, their blocks. Both are
/// written whole, as a piece leaves.
class SpallFiles {
 public:
  /// Writes both files. Throws Error where they cannot be written.
  SpallFiles(std::filesystem::path folder, const Model& model, const Spalling& spalling);
  /// Writes them again where pieces have left since.
  void write(const Model& model, const Spalling& spalling);

 private:
  std::filesystem::path folder_;
  std::size_t written_ = 0;
};

}  // namespace pyroclast
