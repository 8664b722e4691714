#pragma once

#include <functional>

#include "pyroclast/app/deck_option.hpp"
#include "pyroclast/app/run_log.hpp"
#include "pyroclast/session/session.hpp"

namespace pyroclast::app {

/// Describes, for the screen, the run that is about to start.
std::string describe_start(Session& session);

/// Returns what `act` returns for the ranks of an MPI job, which come into the options. The first one alone
/// writes and speaks.
int run_on_ranks(RunOptions& options, const std::function<int()>& act);

/// Takes a run to its end, or until the user stops it, and writes its results. Returns the exit code.
int run_to_end(Session& session, RunLog& log, const RunOptions& options);

}  // namespace pyroclast::app
