#pragma once

#include <filesystem>
#include <optional>

namespace pyroclast {

/// Share of the machine that the control groups of this process leave it, in processors: 1.5 where it may use
/// 150 ms of processor time in each 100 ms. The smallest of its own group and of all above it that it can
/// see, of both versions of control groups. None where nothing bounds it; a file that is missing or makes no
/// sense bounds nothing.
///
/// \param root  of the file system whose `/proc/self` and mount points are read
std::optional<double> processor_quota(const std::filesystem::path& root = "/");

/// Threads that `allowed` processors and a quota can keep going all the time; at least 1.
///
/// The quota is rounded down. The system stops a group that has used up its quota for the rest of the period,
/// wherever its threads stand, and all wait for one that is stopped at a barrier. What is left over serves
/// the rest of the group.
int whole_processors(int allowed, std::optional<double> quota);

/// Processors that are free for this process: those that it may run on, as far as the quota of its control
/// groups goes. At least 1.
int free_processors();

/// Threads for a run of which at most `most` were asked for, 0 for as many as there are: no more than
/// processors are free for this process. Throws Error for a negative number.
int usable_threads(int most);

}  // namespace pyroclast
