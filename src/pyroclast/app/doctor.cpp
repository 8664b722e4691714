#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <optional>
#include <string>

#include <fmt/format.h>
#include <sys/utsname.h>
#include <unistd.h>

#include "pyroclast/app/commands.hpp"
#include "pyroclast/app/python_package.hpp"
#include "pyroclast/base/child_process.hpp"
#include "pyroclast/base/error.hpp"
#include "pyroclast/base/memory.hpp"
#include "pyroclast/base/own_program.hpp"
#include "pyroclast/base/physics_version.hpp"
#include "pyroclast/base/processors.hpp"
#include "pyroclast/base/read_file.hpp"
#include "pyroclast/mechanics/instruction_set.hpp"
#include "pyroclast/plugin/compile.hpp"
#include "pyroclast/version.hpp"

namespace pyroclast::app {

namespace {

namespace fs = std::filesystem;

void tell(const char* what, const std::string& found) {
  fmt::print("{:<16}{}\n", what, found);
}

std::string gigabytes(double bytes) {
  return fmt::format("{:.1f} GB", bytes / 1e9);
}

std::string memory() {
  const double kilobytes = std::atof(entry_of("/proc/meminfo", "MemTotal").c_str());
  return fmt::format("{}, {} of it free", gigabytes(1024.0 * kilobytes), gigabytes(available_memory()));
}

std::string disk() {
  std::error_code error;
  const auto space = fs::space(".", error);
  return error ? "unknown: " + error.message()
               : gigabytes(static_cast<double>(space.available)) + " free here";
}

/// Returns the first line that a program prints for --version, or none where it cannot run.
std::optional<std::string> version_of(const std::string& program) {
  // a folder of its own: others could lay a link where a name in the folder of all can be guessed
  std::string folder = (fs::temp_directory_path() / "pyroclast-XXXXXX").string();
  if (mkdtemp(folder.data()) == nullptr) return std::nullopt;
  const fs::path output = fs::path(folder) / "version";
  std::optional<std::string> first;
  try {
    std::string line;
    const bool runs = run_program({program, "--version"}, output);
    std::ifstream stream(output);
    if (runs) std::getline(stream, line);
    if (!line.empty()) first = line;
  } catch (const Error&) {
    // that it cannot run is what is asked
  }
  std::error_code ignored;
  fs::remove_all(folder, ignored);
  return first;
}

int doctor() {
  tell("pyroclast", fmt::format("{} ({}), physics version {}", kVersion, kCommit, kPhysicsVersion));
  tell("program", own_program().string());
  utsname system{};
  uname(&system);
  tell("system", fmt::format("{}; {} {}, {}", entry_of("/etc/os-release", "PRETTY_NAME"), system.sysname,
                             system.release, system.machine));
  tell("processor", processor_name());
  tell("instructions",
       fmt::format("{} here, of {}", name(best_instruction_set()), describe_built_instruction_sets()));
  tell("threads", fmt::format("{} at most", free_processors()));
  tell("memory", memory());
  tell("disk", disk());
  const std::string compiler = LawCompiler{}.program;
  tell("compiler", version_of(compiler).value_or(
                       fmt::format("missing: no {}; contact laws in headers need g++", compiler)));
  tell("Slurm", version_of("sbatch").value_or("missing: no sbatch; studies run on this machine"));
  const auto child = start_package("pyroclast.doctor", {}, {});
  if (!child)
    tell("Python", "missing: " + no_python());
  else
    wait_for(*child, [] { return false; });
  return 0;
}

}  // namespace

Command add_doctor(CLI::App& cli) {
  auto* command = cli.add_subcommand(
      "doctor", "List the parts that are present and those that are missing; add this list to a bug report");
  return {command, [](const auto&) { return doctor(); }};
}

}  // namespace pyroclast::app
