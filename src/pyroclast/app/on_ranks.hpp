#pragma once

#include <functional>
#include <memory>
#include <string>

#include "pyroclast/base/ranks.hpp"

namespace pyroclast::app {

/// Tells the user of the exception that is being handled, and returns the exit code. Of several copies of the
/// program that a launcher started the first one speaks, and then ends; another one speaks only where the
/// first has not ended all soon.
int tell_failure();

/// Ranks of a run, with the threads that each has by default.
struct RanksOfRun {
  std::shared_ptr<Ranks> ranks;
  int threads = 1;
};

/// Joins the other ranks by MPI and returns what `act` returns, once all ranks have come to its end. An
/// exception of one rank ends all. Throws Error where the program has no MPI.
int on_ranks(const std::function<int(const RanksOfRun&)>& act);

/// Throws Error where a launcher started several copies of a command that writes into one folder.
void require_one_copy(const std::string& remedy);

}  // namespace pyroclast::app
