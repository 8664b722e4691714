#pragma once

#include <filesystem>
#include <string>

#include "pyroclast/simulation/loop/run.hpp"

namespace pyroclast {

/// Returns `run.json` as a text: what a run is, known before its first step, for readers that do not know the
/// names of its columns and results.
std::string run_facts_text(const Run& run);
/// Writes `run.json`.
void write_run_facts(const std::filesystem::path& path, const Run& run);

}  // namespace pyroclast
