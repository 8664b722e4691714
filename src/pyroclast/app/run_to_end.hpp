#pragma once

#include "pyroclast/app/deck_option.hpp"
#include "pyroclast/app/run_log.hpp"
#include "pyroclast/session/session.hpp"

namespace pyroclast::app {

/// Describes, for the screen, the run that is about to start.
std::string describe_start(Session& session);

/// Takes a run to its end, or until the user stops it, and writes its results. Returns the exit code.
int run_to_end(Session& session, RunLog& log, const RunOptions& options);

}  // namespace pyroclast::app
