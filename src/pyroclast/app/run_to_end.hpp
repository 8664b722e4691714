#pragma once

#include "pyroclast/app/open.hpp"
#include "pyroclast/app/run_log.hpp"
#include "pyroclast/session/session.hpp"

namespace pyroclast::app {

/// What a run will be, for the screen.
std::string describe_start(Session& session);

/// Takes a run to its end, or to where the user stops it, and writes what comes. Returns the exit code.
int run_to_end(Session& session, RunLog& log, const RunOptions& options);

}  // namespace pyroclast::app
