#include "pyroclast/plugin/compile.hpp"

#include <cctype>
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <iterator>
#include <sstream>
#include <string_view>
#include <utility>
#include <vector>

#include <dlfcn.h>
#include <fcntl.h>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include "pyroclast/base/child_process.hpp"
#include "pyroclast/base/error.hpp"
#include "pyroclast/base/own_program.hpp"
#include "pyroclast/base/read_file.hpp"
#include "pyroclast/base/sha256.hpp"
#include "pyroclast/base/shell_words.hpp"
#include "pyroclast/plugin/build_settings.hpp"
#include "pyroclast/plugin/cpp_lines.hpp"
#include "pyroclast/plugin/stamp.hpp"

namespace pyroclast {

namespace {

namespace fs = std::filesystem;

void write(const fs::path& file, const std::string& text) {
  std::ofstream stream(file, std::ios::binary | std::ios::trunc);
  stream << text;
  if (!stream.flush()) throw Error(fmt::format("{}: cannot be written", file.string()));
}

/// Splits code into names, and every other character alone.
std::vector<std::string> words_of(const std::string& code) {
  std::vector<std::string> words;
  for (std::size_t i = 0; i < code.size();) {
    std::size_t end = i + 1;
    if (is_of_name(code[i]))
      while (end < code.size() && is_of_name(code[end])) ++end;
    if (std::isspace(static_cast<unsigned char>(code[i])) == 0) words.push_back(code.substr(i, end - i));
    i = end;
  }
  return words;
}

/// Makes a folder that only its owner may read and write. Throws Error where a folder there is not such a
/// one.
void make_private(const fs::path& folder) {
  std::error_code error;
  fs::create_directories(folder.parent_path(), error);
  if (mkdir(folder.c_str(), S_IRWXU) != 0 && errno != EEXIST)
    throw Error(fmt::format("{}: cannot be made: {}", folder.string(), std::strerror(errno)));
  struct stat is {};
  if (lstat(folder.c_str(), &is) != 0 || !S_ISDIR(is.st_mode))
    throw Error(fmt::format("{}: is not a folder, so compiled laws cannot be kept there", folder.string()));
  if (is.st_uid != geteuid() || (is.st_mode & (S_IRWXG | S_IRWXO)) != 0)
    throw Error(fmt::format(
        "{}: others than you may write or read it, so code from it is not trusted; it must be yours, with "
        "mode 0700",
        folder.string()));
}

/// Lock on a file for one process at a time, while the object lives.
class FileLock {
 public:
  explicit FileLock(const fs::path& file)
      : descriptor_(open(file.c_str(), O_CREAT | O_RDWR | O_CLOEXEC | O_NOFOLLOW, S_IRUSR | S_IWUSR)) {
    if (descriptor_ < 0 || flock(descriptor_, LOCK_EX) != 0)
      throw Error(fmt::format("{}: cannot be locked: {}", file.string(), std::strerror(errno)));
  }
  ~FileLock() { close(descriptor_); }
  FileLock(const FileLock&) = delete;
  FileLock& operator=(const FileLock&) = delete;

 private:
  int descriptor_;
};

/// Returns the lines of the compiler's messages that a reader of the law needs: errors, messages on the law's
/// own lines, and the excerpts of code below them.
std::string essence(const std::string& messages, const fs::path& header) {
  constexpr int kMostLines = 40;
  std::istringstream stream(messages);
  std::string kept;
  int lines = 0;
  bool of_interest = false;
  for (std::string line; std::getline(stream, line) && lines < kMostLines;) {
    const auto first = line.find_first_not_of(" 0123456789");
    const bool excerpt = line.starts_with(' ') && first != std::string::npos && line[first] == '|';
    if (!excerpt)
      of_interest =
          line.find(header.string() + ":") != std::string::npos || line.find("error: ") != std::string::npos;
    if (!of_interest) continue;
    kept += "\n  " + line;
    ++lines;
  }
  return kept;
}

/// Returns the file that holds this code: a module of another program, or the program; empty where it is not
/// found.
fs::path own_module() {
  Dl_info info{};
  static const char here = 0;
  if (dladdr(&here, &info) == 0 || !info.dli_fname) return {};
  std::error_code ignored;
  return fs::canonical(info.dli_fname, ignored);
}

/// Returns flags with the folders that hold the headers of this program: beside an installed program, above
/// an installed module, or in the source tree of a built program.
std::vector<std::string> include_flags() {
  const fs::path installed = own_prefix() / build_settings::kInstalledInclude;
  std::vector<std::vector<fs::path>> places{{installed}};
  for (fs::path above = own_module().parent_path(); above.has_relative_path(); above = above.parent_path())
    places.push_back({above / build_settings::kInstalledInclude});
  places.push_back({build_settings::kSourceInclude, build_settings::kGeneratedInclude});
  places.push_back({build_settings::kFullInclude});
  for (const std::vector<fs::path>& folders : places) {
    if (!fs::exists(folders.front() / "pyroclast" / "plugin" / "stamp.hpp")) continue;
    std::vector<std::string> flags;
    for (const auto& folder : folders) flags.push_back("-I" + folder.string());
    return flags;
  }
  throw Error(
      fmt::format("the headers of pyroclast, which a law in a header needs, are in none of {}, {}, {}; "
                  "install pyroclast with them",
                  installed.string(), build_settings::kSourceInclude, build_settings::kFullInclude));
}

std::vector<std::string> flags_of(InstructionSet set) {
  std::istringstream stream(fmt::format("{} {}", build_settings::kLawFlags,
                                        build_settings::kFlagsOfSet[static_cast<std::size_t>(set)]));
  return {std::istream_iterator<std::string>(stream), {}};
}

/// Throws Error where the version of a compiler is that of a GCC before 11, which lacks parts of C++20.
void require_new(const std::string& version) {
  constexpr int kOldest = 11;
  const auto number = version.find(") ");  // c++ (Debian 12.2.0-14) 12.2.0
  if (version.find("Free Software Foundation") == std::string::npos || number == std::string::npos) return;
  const int major = std::atoi(version.c_str() + number + 2);
  if (major > 0 && major < kOldest)
    throw Error(fmt::format("{}: too old for contact laws, which need GCC {} or later",
                            version.substr(0, version.find('\n')), kOldest));
}

std::string source_of(const fs::path& header, const std::string& type, const LawCompiler& compiler) {
  const auto set = static_cast<std::size_t>(compiler.instructions);
  const auto dimensions = compiler.dimension == 2 ? "plane" : "space";
  std::string packs[kInstructionSets]{"nullptr", "nullptr", "nullptr"};
  packs[set] = fmt::format("&pyroclast::Compiled<pyroclast::{}, {}, pyroclast::Dimensions::{}>::law",
                           build_settings::kTypeOfSet[set], type, dimensions);
  return fmt::format(R"(// Written by pyroclast to compile a contact law.
#include {0}

#include "pyroclast/mechanics/step/compiled_law.hpp"
#include "pyroclast/plugin/stamp.hpp"

extern "C" [[gnu::visibility("default")]] const pyroclast_law* pyroclast_law_v1() {{
  static const pyroclast_law law = pyroclast::describe_law<{1}, pyroclast::Dimensions::{2}>(
      "{3}", pyroclast::CompiledForSets{{{{{4}, {5}, {6}}}}});
  return &law;
}}
)",
                     fmt::format("\"{}\"", header.string()), type, dimensions, build_settings::kVersion,
                     packs[0], packs[1], packs[2]);
}

}  // namespace

std::string law_type(const fs::path& header, const std::string& text) {
  const auto words = words_of(without_literals(text));
  std::vector<std::string> scopes;  // name of each open brace; empty where neither namespace nor struct
  std::vector<std::string> types;
  std::string opens;  // name of the scope that the next brace opens
  for (std::size_t i = 0; i < words.size(); ++i) {
    const std::string& word = words[i];
    if (word == "namespace" || word == "struct" || word == "class") {
      opens.clear();
      for (std::size_t j = i + 1;
           j < words.size() && (std::isalnum(static_cast<unsigned char>(words[j][0])) != 0 ||
                                words[j][0] == '_' || words[j] == ":");
           ++j) {
        // the colon of a base class stands alone, that of a nested namespace twice
        if (words[j] == ":" && (j + 1 == words.size() || words[j + 1] != ":") && words[j - 1] != ":") break;
        if (words[j] != "final") opens += words[j];
      }
    } else if (word == ";" || word == ")") {
      opens.clear();
    } else if (word == "{") {
      scopes.push_back(std::exchange(opens, {}));
    } else if (word == "}") {
      if (!scopes.empty()) scopes.pop_back();
    } else if (word == "name" && i + 1 < words.size() && words[i + 1] == "=" && !scopes.empty()) {
      bool constant = false;
      for (std::size_t j = i; j-- > 0 && words[j] != ";" && words[j] != "{" && words[j] != "}";)
        constant = constant || words[j] == "constexpr";
      std::vector<std::string> path;
      for (const auto& scope : scopes)
        if (!scope.empty()) path.push_back(scope);
      if (constant && !scopes.back().empty()) types.push_back(fmt::format("{}", fmt::join(path, "::")));
    }
  }
  if (types.size() == 1) return types.front();
  if (types.empty())
    throw Error(
        fmt::format("{}: holds no contact law: no struct with `static constexpr const char* name = ...`",
                    header.string()));
  throw Error(fmt::format("{}: holds {} contact laws: {}; say which one, as {}:{}", header.string(),
                          types.size(), fmt::join(types, ", "), header.filename().string(), types.front()));
}

fs::path compile_law(const fs::path& header, const std::string& type, const LawCompiler& compiler) {
  const fs::path file = fs::canonical(header);
  if (file.string().find_first_of("\"\\\n") != std::string::npos)
    throw Error(
        fmt::format("{}: a name with quotes, backslashes or line breaks cannot be included", file.string()));
  make_private(compiler.cache);
  const FileLock lock(compiler.cache / "lock");
  const auto in_cache = [&](const char* name) { return compiler.cache / name; };
  const fs::path source = in_cache("law.cpp"), messages = in_cache("messages.txt");
  write(source, source_of(file, type, compiler));

  const auto flags = flags_of(compiler.instructions);
  std::vector<std::string> command{compiler.program};
  command.insert(command.end(), flags.begin(), flags.end());
  const auto folders = include_flags();
  command.insert(command.end(), folders.begin(), folders.end());
  const auto with = [&](std::vector<std::string> more) {
    auto words = command;
    words.insert(words.end(), more.begin(), more.end());
    return words;
  };
  const auto attempt = [&](const std::vector<std::string>& words) {
    if (!run_program(words, messages, compiler.poll))
      throw Error(fmt::format(
          "{}: does not compile as the contact law {}; the compiler says:{}\nIt was run as: {}\n"
          "All that it says: {}",
          file.string(), type, essence(read_file(messages), file), shell_command(words), messages.string()));
  };
  if (!run_program({compiler.program, "--version"}, messages, compiler.poll))
    throw Error(fmt::format("{}: does not tell its version; see {}", compiler.program, messages.string()));
  const std::string version = read_file(messages);
  require_new(version);
  const fs::path preprocessed = in_cache("law.ii");
  // without -P the text would hold the places of its headers, and a run that goes on has copies of its own
  attempt(with({"-E", "-P", source.string(), "-o", preprocessed.string()}));
  const std::string key =
      sha256(fmt::format("{}\n{}\n{}\n{} {} {:016x}", read_file(preprocessed), version, fmt::join(flags, " "),
                         build_settings::kVersion, kLawTableVersion, layout_hash()));
  fs::remove(preprocessed);
  const fs::path kept = compiler.cache / (key + ".so");
  if (fs::exists(kept)) return kept;
  const fs::path aside = in_cache("law.so");
  const auto words = with({"-shared", source.string(), "-o", aside.string()});
  compiler.tell(shell_command(words));
  attempt(words);
  fs::rename(aside, kept);
  return kept;
}

}  // namespace pyroclast
