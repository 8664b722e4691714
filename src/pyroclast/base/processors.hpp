#pragma once

#include <filesystem>
#include <optional>
#include <string>

namespace pyroclast {

/// Returns the share of the machine, in processors, that the control groups of this process leave it: 1.5
/// where the process may use 150 ms of processor time in each 100 ms. The smallest quota counts among the
/// process's own group and all groups above it that it can see, of both versions of control groups. Returns
/// none where no quota holds; a file that is missing or makes no sense sets no quota.
///
/// \param root  root of the file system whose `/proc/self` and mount points are read
std::optional<double> processor_quota(const std::filesystem::path& root = "/");

/// Returns the name of the processor, as the system gives it; "unknown" where it gives none.
std::string processor_name();

/// Returns the number of threads that `allowed` processors and a quota can keep going all the time; at least
/// 1.
///
/// The quota is rounded down. The system stops a group that has used up its quota for the rest of the period,
/// wherever the threads of the group stand. If one stops, all others wait for it at a barrier. The remainder
/// of the quota serves the rest of the group.
int whole_processors(int allowed, std::optional<double> quota);

/// Returns the number of processors that are free for this process: those on which it may run, limited by the
/// quota of its control groups. At least 1.
int free_processors();

/// Returns the number of threads for a run that asks for at most `most`, where 0 asks for as many as
/// possible: never more than the processors that are free for this process. Throws Error for a negative
/// number.
int usable_threads(int most);

}  // namespace pyroclast
