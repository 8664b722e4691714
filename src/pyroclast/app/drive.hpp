#pragma once

#include <functional>

#include "pyroclast/app/load.hpp"
#include "pyroclast/app/run_log.hpp"
#include "pyroclast/results/checkpoints.hpp"
#include "pyroclast/results/folder_lock.hpp"
#include "pyroclast/results/recorder.hpp"
#include "pyroclast/simulation/run.hpp"

namespace pyroclast::app {

/// What a run will be, for the screen.
std::string describe_start(const Simulation& simulation, const Loaded& loaded);
/// Shows all that a run keeps to a visitor.
using StateVisit = std::function<void(StateVisitor&)>;
/// Of this run; both are kept by reference.
StateVisit state_of(Run& run, Recorder& recorder);

/// What a checkpoint of this run is made of. All are kept by reference.
/// \param inputs  their hash
Checkpoints::Sources checkpoint_sources(Run& run, Recorder& recorder, const RunLog& log, std::string inputs);

/// Takes a run to its end, or to where the user stops it, and writes what comes. Returns the exit code.
int drive(Run& run, Recorder& recorder, Checkpoints& checkpoints, RunLog& log,
          const std::filesystem::path& folder, const RunOptions& options);

}  // namespace pyroclast::app
