#include "pyroclast/plugin/code_permission.hpp"

#include <algorithm>
#include <cctype>
#include <cerrno>
#include <cstring>
#include <ctime>
#include <sstream>
#include <string_view>
#include <vector>

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include "pyroclast/base/environment.hpp"
#include "pyroclast/base/read_file.hpp"
#include "pyroclast/base/sha256.hpp"
#include "pyroclast/base/shown.hpp"
#include "pyroclast/plugin/cpp_lines.hpp"

namespace pyroclast {

namespace {

namespace fs = std::filesystem;

constexpr std::size_t kMostFiles = 1000;  // most files that a header may include

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
  throw Error(
      fmt::format("{}: others than you may write there, so the list of allowed code is not trusted; it must "
                  "be yours alone: "
                  "look through the list, then {}chmod {} '{}'",
                  path.string(),
                  is.st_uid == geteuid() ? "" : fmt::format("chown {} '{}' and ", geteuid(), path.string()),
                  mode, path.string()));
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

/// Returns the text behind the word of a line that takes in another file; empty for other lines.
std::string included_by(const std::string& line) {
  std::string_view rest = line;
  const auto skip = [&] {
    while (!rest.empty() && std::isspace(static_cast<unsigned char>(rest.front())) != 0)
      rest.remove_prefix(1);
  };
  skip();
  for (const std::string_view sign : {"#", "%:", "?\?="})
    if (rest.starts_with(sign)) {
      rest.remove_prefix(sign.size());
      skip();
      for (const std::string_view word : {"include_next", "include", "import", "embed"})
        if (rest.starts_with(word)) {
          rest.remove_prefix(word.size());
          skip();
          return std::string(rest);
        }
      return {};
    }
  return {};
}

/// Adds the header, and the files that it includes in quotes where they lie beside it, each once.
void add_files(const fs::path& header, std::vector<fs::path>& files) {
  if (std::ranges::find(files, header) != files.end()) return;
  if (files.size() >= kMostFiles)
    throw Error(fmt::format("{}: includes more than {} files", files.front().string(), kMostFiles));
  files.push_back(header);
  for (const std::string& line : logical_lines(read_file(header))) {
    const std::string included = included_by(line);
    if (included.empty() || included[0] == '<') continue;
    const auto end = included.find('"', 1);
    if (included[0] != '"' || end == std::string::npos)
      throw Error(
          fmt::format("{}: includes a file by a macro, so which code it is is not known; name the file",
                      header.string()));
    const fs::path file = header.parent_path() / included.substr(1, end - 1);
    if (fs::exists(file)) add_files(fs::canonical(file), files);
  }
}

}  // namespace

CodePermission CodePermission::of_environment() {
  return {policy_of(environment("PYROCLAST_CODE")), false, list_file()};
}

void CodePermission::require(const std::string& what, const std::string& hash, bool named) const {
  if (policy == CodePolicy::always) return;
  if (policy == CodePolicy::never) {
    if (named) return;
    throw CodeNotAllowed(
        fmt::format("{}: is code that came with a file, and PYROCLAST_CODE = \"never\" lets none of it run",
                    what),
        what);
  }
  if (is_listed(list, hash)) return;
  if (allow) {
    if (list.empty()) throw Error("--allow-code: there is no folder to keep it in; set XDG_CONFIG_HOME");
    add_to_list(list, hash, what);
    return;
  }
  if (!named)
    throw CodeNotAllowed(
        fmt::format(
            "{}: is code, and runs only after your word: read it, then say --allow-code once. Until it "
            "changes it is known by its hash, {:.12}",
            what, hash),
        what);
  try {
    if (!list.empty()) add_to_list(list, hash, what);
  } catch (const Error&) {  // a home that cannot be written: a file that names the code needs permission
  }
}

std::vector<fs::path> files_of_header(const fs::path& header) {
  std::vector<fs::path> files;
  add_files(fs::canonical(header), files);
  return files;
}

std::string hash_of_files(const std::vector<fs::path>& files) {
  std::vector<std::string> texts;
  for (const fs::path& file : files) texts.push_back(read_file(file));
  return hash_of_texts(texts);
}

std::string hash_of_texts(const std::vector<std::string>& texts) {
  std::string all;
  for (const std::string& text : texts) all += fmt::format("{}\n", sha256(text));
  return sha256(all);
}

}  // namespace pyroclast
