#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

namespace pyroclast {

/// Runs a program without a shell; both its streams go to a file, and it reads nothing. True when it ends
/// with code 0. Throws Error when it cannot be started.
///
/// The program and its own children are a process group of their own. None of them outlives this process,
/// however it ends, nor this call.
/// \param words  the program, searched in PATH, and its arguments
/// \param poll   called many times a second while the program runs; what it throws ends the program
bool run_program(
    const std::vector<std::string>& words, const std::filesystem::path& output,
    const std::function<void()>& poll = [] {});

}  // namespace pyroclast
