#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "pyroclast/setup/setup.hpp"

namespace pyroclast {

/// File that a deck names: a table, a tessellation, a law.
struct InputFile {
  std::filesystem::path source;
  std::string name;  ///< name in the folder of a run: "inputs/..."
  std::string contents;
  std::string verdict = {};  ///< verdict on the run that wrote the file, see verdict_on_run_of; may be empty
};

/// Inputs of a run, as its folder keeps them.
struct Inputs {
  /// Text of the deck, with the seed of the run, and files by their names in the folder: run there it gives
  /// the same results.
  std::string deck_text;
  std::vector<InputFile> files;
  std::string references = {};  ///< references for figures, see json_of; may be empty

  /// Returns the hash of the deck and its files.
  std::string hash() const;
};

/// Reads the files that a deck names. Throws Error when one cannot be read.
/// \param setup  setup as read from the deck, perhaps with another seed
Inputs inputs_of(const Deck& deck, const Setup& setup);

}  // namespace pyroclast
