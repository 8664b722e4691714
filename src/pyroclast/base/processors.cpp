#include "pyroclast/base/processors.hpp"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <sstream>
#include <string>
#include <string_view>
#include <thread>
#include <vector>

#include <fmt/format.h>
#include <sched.h>

#include "pyroclast/base/error.hpp"
#include "pyroclast/base/read_file.hpp"

namespace pyroclast {

namespace {

namespace fs = std::filesystem;

/// Place where control groups of one kind are mounted, and the group that stands there.
struct Mount {
  fs::path folder;
  std::string group;
};

bool has_item(const std::string& list, std::string_view item) {
  std::istringstream items(list);
  for (std::string found; std::getline(items, found, ',');)
    if (found == item) return true;
  return false;
}

/// Decodes a path of the kernel, which writes a space as `\040`.
std::string decoded(const std::string& path) {
  const auto is_octal = [](char c) { return c >= '0' && c <= '7'; };
  std::string text;
  for (std::size_t i = 0; i < path.size(); ++i)
    if (path[i] == '\\' && i + 3 < path.size() && std::all_of(&path[i + 1], &path[i + 4], is_octal)) {
      text += static_cast<char>((path[i + 1] - '0') * 64 + (path[i + 2] - '0') * 8 + (path[i + 3] - '0'));
      i += 3;
    } else {
      text += path[i];
    }
  return text;
}

/// Finds the place where control groups are mounted.
/// \param of_version_2  true for groups of version 2; else those of version 1 that share out processors
std::optional<Mount> mount_of_groups(const fs::path& root, bool of_version_2) {
  std::ifstream mounts(root / "proc/self/mountinfo");
  for (std::string line; std::getline(mounts, line);) {
    // number, parent, device, group at that place, folder, options, tags ..., "-", kind, source, options of
    // the kind
    std::istringstream words(line);
    std::string word, group, folder, kind, source, options;
    words >> word >> word >> word >> group >> folder;
    while (words >> word && word != "-") continue;
    words >> kind >> source >> options;
    if (of_version_2 ? kind == "cgroup2" : kind == "cgroup" && has_item(options, "cpu"))
      return Mount{root / fs::path(decoded(folder)).relative_path(), decoded(group)};
  }
  return {};
}

/// Returns the group of this process, as a path from the root of all groups that it can see.
std::optional<std::string> group_of_process(const fs::path& root, bool of_version_2) {
  std::ifstream groups(root / "proc/self/cgroup");
  for (std::string line; std::getline(groups, line);) {  // number:controllers:group
    const auto first = line.find(':');
    const auto second = first == std::string::npos ? first : line.find(':', first + 1);
    if (second == std::string::npos) continue;
    const std::string controllers = line.substr(first + 1, second - first - 1);
    if (of_version_2 ? line.starts_with("0::") : has_item(controllers, "cpu")) return line.substr(second + 1);
  }
  return {};
}

std::optional<double> share(double time, double period) {
  if (!(time > 0.0) || !(period > 0.0)) return {};
  return time / period;
}

/// Reads `cpu.max` of a group of version 2: "150000 100000" or "max 100000".
std::optional<double> quota_of_version_2(const fs::path& group) {
  std::ifstream file(group / "cpu.max");
  double time = 0.0, period = 0.0;
  if (!(file >> time >> period)) return {};
  return share(time, period);
}

/// Reads the quota of a group of version 1, where a time of -1 is no bound.
std::optional<double> quota_of_version_1(const fs::path& group) {
  std::ifstream time_file(group / "cpu.cfs_quota_us"), period_file(group / "cpu.cfs_period_us");
  double time = 0.0, period = 0.0;
  if (!(time_file >> time) || !(period_file >> period)) return {};
  return share(time, period);
}

/// Returns the folders of the process's group and of those above it, of one version, the process's own last.
std::vector<fs::path> groups_above(const fs::path& root, bool of_version_2) {
  const auto mount = mount_of_groups(root, of_version_2);
  const auto group = group_of_process(root, of_version_2);
  if (!mount || !group) return {};
  std::vector<fs::path> folders{mount->folder};
  // In a container that shows the groups from its own on downwards, the group has a name of the machine's
  // root.
  const fs::path below = fs::path(*group).lexically_relative(mount->group);
  if (below.empty() || *below.begin() == "..") return folders;
  for (const auto& name : below)
    if (name != ".") folders.push_back(folders.back() / name);
  return folders;
}

int allowed_processors() {
  constexpr int kMost = 1 << 16;
  for (int count = CPU_SETSIZE; count <= kMost; count *= 2) {
    std::vector<cpu_set_t> sets(static_cast<std::size_t>(count / CPU_SETSIZE));
    const std::size_t size = sets.size() * sizeof(cpu_set_t);
    if (sched_getaffinity(0, size, sets.data()) == 0) return CPU_COUNT_S(size, sets.data());
  }
  return static_cast<int>(std::thread::hardware_concurrency());
}

}  // namespace

std::optional<double> processor_quota(const fs::path& root) {
  std::optional<double> smallest;
  for (const bool of_version_2 : {false, true})
    for (const fs::path& group : groups_above(root, of_version_2)) {
      const auto quota = of_version_2 ? quota_of_version_2(group) : quota_of_version_1(group);
      if (quota && (!smallest || *quota < *smallest)) smallest = quota;
    }
  return smallest;
}

std::string processor_name() {
  return entry_of("/proc/cpuinfo", "model name");
}

int whole_processors(int allowed, std::optional<double> quota) {
  if (quota && *quota < allowed) allowed = static_cast<int>(std::floor(*quota));
  return std::max(1, allowed);
}

int free_processors() {
  return whole_processors(allowed_processors(), processor_quota());
}

int usable_threads(int most) {
  if (most < 0) throw Error(fmt::format("the number of threads is {}, but it must be at least 1", most));
  const int free = free_processors();
  return most > 0 ? std::min(most, free) : free;
}

}  // namespace pyroclast
