#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

namespace pyroclast {

/// Runs a program without a shell and returns true when the program ends with code 0. Both output streams of
/// the program go to a file; the program reads nothing. Throws Error when the program cannot be started.
///
/// The program and its own children are a process group of their own. None of them outlives this call, nor
/// this process, however the process ends.
/// \param words  the program, searched in PATH, and its arguments
/// \param poll   called many times a second while the program runs; an exception from it ends the program
bool run_program(
    const std::vector<std::string>& words, const std::filesystem::path& output,
    const std::function<void()>& poll = [] {});

}  // namespace pyroclast
