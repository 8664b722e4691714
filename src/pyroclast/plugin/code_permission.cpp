#include "pyroclast/plugin/code_permission.hpp"

#include <cerrno>
#include <cstring>
#include <ctime>
#include <sstream>
#include <vector>

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include "pyroclast/base/environment.hpp"
#include "pyroclast/base/read_file.hpp"
#include "pyroclast/base/shell_words.hpp"
#include "pyroclast/base/shown.hpp"

namespace pyroclast {

namespace {

namespace fs = std::filesystem;

CodePolicy policy_of(const std::string& word) {
  if (word.empty() || word == "ask") return CodePolicy::ask;
  if (word == "never") return CodePolicy::never;
  if (word == "always") return CodePolicy::always;
  throw Error(fmt::format("PYROCLAST_CODE = \"{}\": must be \"never\", \"ask\" or \"always\"", word));
}

fs::path list_file() {
  if (const auto config = environment("XDG_CONFIG_HOME"); !config.empty())
    return fs::path(config) / "pyroclast" / "allowed-code";
  if (const auto home = environment("HOME"); !home.empty())
    return fs::path(home) / ".config" / "pyroclast" / "allowed-code";
  return {};
}

/// Throws Error where the list of allowed code, or its folder, is there and others than the user may write
/// it.
void require_own(const fs::path& path, const char* mode) {
  struct stat is {};
  if (stat(path.c_str(), &is) != 0) return;
  if (is.st_uid == geteuid() && (is.st_mode & (S_IWGRP | S_IWOTH)) == 0) return;
  const std::string quoted = shell_path(path);
  throw Error(fmt::format(
      "{}: others than you may write there, so the list of allowed code is not trusted; it must "
      "be yours alone: look through the list, then {}chmod {} {}",
      path.string(), is.st_uid == geteuid() ? "" : fmt::format("chown {} {} and ", geteuid(), quoted), mode,
      quoted));
}

/// Tells whether a list has the hash. Throws Error where others than the user may write the list or its
/// folder.
bool is_listed(const fs::path& list, const std::string& hash) {
  if (list.empty()) return false;
  require_own(list.parent_path(), "0700");
  require_own(list, "0600");
  if (!fs::exists(list)) return false;
  std::istringstream lines(read_file(list));
  for (std::string line; std::getline(lines, line);)
    if (line.starts_with(fmt::format("{} ", hash))) return true;
  return false;
}

void add_to_list(const fs::path& list, const std::string& hash, const std::string& what) {
  std::error_code ignored;
  fs::create_directories(list.parent_path().parent_path(), ignored);
  mkdir(list.parent_path().c_str(), S_IRWXU);  // not as wide as the user's mask lets other folders be
  const std::time_t now = std::time(nullptr);
  char date[sizeof "2000-01-01"];
  std::strftime(date, sizeof date, "%F", std::localtime(&now));
  const std::string line = fmt::format("{} {} {}\n", hash, date, shown(what));
  const int file =
      open(list.c_str(), O_WRONLY | O_CREAT | O_APPEND | O_NOFOLLOW | O_CLOEXEC, S_IRUSR | S_IWUSR);
  const bool written =
      file >= 0 && write(file, line.data(), line.size()) == static_cast<ssize_t>(line.size());
  const int cause = errno;
  if (file >= 0) close(file);
  if (!written)
    throw Error(fmt::format("{}: that code is allowed cannot be kept there ({})", list.string(),
                            std::strerror(cause)));
}

}  // namespace

CodePermission CodePermission::of_environment() {
  return {policy_of(environment("PYROCLAST_CODE")), false, list_file()};
}

void CodePermission::require(const Code& code, bool named) const {
  if (policy == CodePolicy::always) return;
  if (policy == CodePolicy::never) {
    if (named) return;
    throw CodeNotAllowed(
        fmt::format("{}: is code that came with a file, and PYROCLAST_CODE = \"never\" lets none of it run",
                    code.what),
        code);
  }
  if (!code.unknown.empty()) {
    if (allow || named) return;
    throw CodeNotAllowed(
        fmt::format(
            "{}: is code, and runs only with your permission: read it, then say --allow-code. It needs your "
            "permission each time, because {}",
            code.what, code.unknown),
        code);
  }
  if (is_listed(list, code.hash)) return;
  if (allow) {
    if (list.empty()) throw Error("--allow-code: there is no folder to keep it in; set XDG_CONFIG_HOME");
    add_to_list(list, code.hash, code.what);
    return;
  }
  if (!named)
    throw CodeNotAllowed(
        fmt::format(
            "{}: is code, and runs only with your permission: read it, then say --allow-code once. Until it "
            "changes it is known by its hash, {:.12}",
            code.what, code.hash),
        code);
  try {
    if (!list.empty()) add_to_list(list, code.hash, code.what);
  } catch (const Error&) {  // a home that cannot be written: a file that names the code needs permission
  }
}

}  // namespace pyroclast
