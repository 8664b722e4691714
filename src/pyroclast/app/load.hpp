#pragma once

#include "pyroclast/app/commands.hpp"
#include "pyroclast/experiment/case.hpp"
#include "pyroclast/results/run_folder.hpp"

namespace pyroclast::app {

/// Deck and case of the options, with what the command line says in place and the threads set.
struct Loaded {
  explicit Loaded(const RunOptions& options);

  Deck deck;
  Case c;
  int threads;
};

/// Where the results shall be.
std::filesystem::path output_folder(const RunOptions& options);

/// The folder for the results, made, with deck and manifest in it.
RunFolder make_run_folder(const Loaded& loaded, const RunOptions& options);

/// What came of the specimen, for the screen.
std::string describe(const specimen::Specimen& specimen);

/// A duration as one reads it, e.g. "3 min 20 s".
std::string duration(double seconds);

}  // namespace pyroclast::app
