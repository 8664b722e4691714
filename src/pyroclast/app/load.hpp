#pragma once

#include "pyroclast/app/commands.hpp"
#include "pyroclast/experiment/case.hpp"

namespace pyroclast::app {

/// Deck and case of the options, with the seed of the command line in place and the threads set.
struct Loaded {
  explicit Loaded(const RunOptions& options);

  Deck deck;
  Case c;
  int threads;
};

/// The folder for the results.
std::filesystem::path output_folder(const RunOptions& options);

/// What came of the specimen, for the screen.
std::string describe(const specimen::Specimen& specimen);

/// A duration as one reads it, e.g. "3 min 20 s".
std::string duration(double seconds);

}  // namespace pyroclast::app
