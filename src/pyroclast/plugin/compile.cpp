#include "pyroclast/plugin/compile.hpp"

#include <cctype>
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <iterator>
#include <set>
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

/// Returns the lines of the compiler's messages that a reader of the law needs, each message once: errors,
/// messages on the law's own lines, and the excerpts of code below them.
std::string essence(const std::string& messages, const fs::path& header) {
  constexpr int kMostLines = 40;
  std::istringstream stream(messages);
  std::string kept;
  std::set<std::string> told;
  const std::string place = header.string() + ":";
  const auto is_of_law = [&](const std::string& line) {  // "mine.hpp:57:40: ..."
    return line.starts_with(place) && line.size() > place.size() &&
           std::isdigit(static_cast<unsigned char>(line[place.size()])) != 0;
  };
  int lines = 0;
  bool of_interest = false;
  for (std::string line; std::getline(stream, line) && lines < kMostLines;) {
    const auto first = line.find_first_not_of(" 0123456789");
    const bool excerpt = line.starts_with(' ') && first != std::string::npos && line[first] == '|';
    if (!excerpt)
      of_interest =
          (is_of_law(line) || line.find("error: ") != std::string::npos) && told.insert(line).second;
    if (!of_interest) continue;
    kept += "\n  " + line;
    ++lines;
  }
  return kept;
}

/// Returns what a law has to have, and which functions lanes have, where errors of the compiler are of these.
/// \param type  name of the law: "mine::Law"
std::string advice(const std::string& messages, const std::string& type) {
  const auto has = [](const std::string& text, const std::string& words) {
    return text.find(words) != std::string::npos;
  };
  std::istringstream stream(messages);
  bool lacks_member = false, lacks_function = false;
  for (std::string line; std::getline(stream, line);) {
    if (!has(line, "error: ")) continue;
    lacks_member = lacks_member || has(line, "is not a member of ‘" + type) || has(line, "' in '" + type);
    lacks_function = lacks_function || has(line, "Lanes<") || has(line, "Mask<") ||
                     (has(line, "no matching function") && has(messages, "Lanes<"));
  }
  std::string told;
  if (lacks_member)
    told +=
        "\nA law has name, meaning, Properties, Constants, Internals, Losses, derive, check, stiffness and "
        "update: <pyroclast/laws/law.hpp> tells them, <pyroclast/laws/elastic.hpp> is the shortest law";
  if (lacks_function)
    told +=
        "\nA Real may be lanes, eight contact points at once, and a condition on it one of lanes. Lanes have "
        "+ - * / < <= > >= & | !, select(condition, yes, no), smaller, larger, abs, sqrt, signed_like, "
        "and exp of <pyroclast/base/exp.hpp>. Write select in the place of if (unless around "
        "any(condition)), smaller and larger in that of min and max, and make other functions of these, as "
        "examples/own_law/ppr.hpp does pow; <pyroclast/base/lanes.hpp> has them all";
  return told;
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

/// Returns the source of which the preprocessor makes the text of a law.
std::string source_of(const fs::path& header) {
  // the assertion comes first because a pragma at the very beginning could load a precompiled header
  return fmt::format(R"(// Written by pyroclast to preprocess a contact law.
static_assert(true);
#include {}
#include "pyroclast/mechanics/step/compiled_law.hpp"
#include "pyroclast/plugin/stamp.hpp"
)",
                     fmt::format("\"{}\"", header.string()));
}

/// Returns the code that hands a law over; it follows the preprocessed text of the law.
std::string code_of(const std::string& type, const LawCompiler& compiler) {
  const auto set = static_cast<std::size_t>(compiler.instructions);
  const auto dimensions = compiler.dimension == 2 ? "plane" : "space";
  std::string packs[kInstructionSets]{"nullptr", "nullptr", "nullptr"};
  packs[set] = fmt::format("&pyroclast::Compiled<pyroclast::{}, {}, pyroclast::Dimensions::{}>::law",
                           build_settings::kTypeOfSet[set], type, dimensions);
  return fmt::format(R"(
# 1 "code of pyroclast that hands over {0}"
extern "C" [[gnu::visibility("default")]] const pyroclast_law* pyroclast_law_v1() {{
  static const pyroclast_law law = pyroclast::describe_law<{0}, pyroclast::Dimensions::{1}>(
      "{2}", pyroclast::CompiledForSets{{{{{3}, {4}, {5}}}}});
  return &law;
}}
)",
                     type, dimensions, build_settings::kVersion, packs[0], packs[1], packs[2]);
}

/// Returns the words that call the compiler for a law, with the flags that change its numbers.
std::vector<std::string> command_of(const LawCompiler& compiler, const fs::path& header) {
  std::vector<std::string> words{compiler.program};
  for (const auto& more : {flags_of(compiler.instructions), include_flags()})
    words.insert(words.end(), more.begin(), more.end());
  // else a text that names its own file would depend on the folder
  words.push_back(fmt::format("-fmacro-prefix-map={}=", (header.parent_path() / "").string()));
  return words;
}

/// Runs a command. Throws Error with the words of the compiler where the command fails.
/// \param what  what is wrong with the header then
/// \param type  name of the law; empty before it is known
void attempt(const std::vector<std::string>& words, const fs::path& header, const std::string& what,
             const std::string& type, const LawCompiler& compiler) {
  const fs::path messages = compiler.cache / "messages.txt";
  if (run_program(words, messages, compiler.poll)) return;
  const std::string said = read_file(messages);
  throw Error(fmt::format("{}: {}; the compiler says:{}{}\nIt was run as: {}\nAll that it says: {}",
                          header.string(), what, essence(said, header), advice(said, type),
                          shell_command(words), messages.string()));
}

/// Returns what a program says. Throws Error where the program fails.
std::string said_by(const std::vector<std::string>& words, const LawCompiler& compiler) {
  const fs::path messages = compiler.cache / "messages.txt";
  if (!run_program(words, messages, compiler.poll))
    throw Error(fmt::format("{}: fails; see {}", shell_command(words), messages.string()));
  return read_file(messages);
}

/// Levels of folders of headers below those searched in which links are followed.
constexpr int kDeepestLink = 1;

bool is_below(const fs::path& file, const fs::path& folder) {
  return std::mismatch(folder.begin(), folder.end(), file.begin(), file.end()).first == folder.end();
}

/// Returns the folders of headers that belong to the compiler, the system or this program. The environment
/// may name further folders to the compiler; files there are the user's.
std::vector<fs::path> installed_folders(const LawCompiler& compiler) {
  std::vector<fs::path> folders;
  for (const std::string& flag : include_flags()) folders.emplace_back(flag.substr(2));
  std::istringstream lines(said_by({"env", "-u", "CPATH", "-u", "CPLUS_INCLUDE_PATH", "LC_ALL=C",
                                    compiler.program, "-v", "-E", "-x", "c++", "/dev/null"},
                                   compiler));
  bool is_folder = false;
  for (std::string line; std::getline(lines, line);) {
    if (line == "End of search list.") break;
    if (is_folder && line.starts_with(' ')) folders.emplace_back(line.substr(1));
    is_folder = is_folder || line == "#include <...> search starts here:";
  }
  // Headers may be links of the system to others, by whose names the compiler tells them: asm on Debian 13.
  const std::vector<fs::path> searched = folders;
  for (const fs::path& folder : searched) {
    std::error_code ignored;
    for (auto entry = fs::recursive_directory_iterator(folder, ignored); entry != fs::end(entry);
         entry.increment(ignored)) {
      if (entry.depth() >= kDeepestLink) entry.disable_recursion_pending();
      if (!entry->is_symlink(ignored)) continue;
      const fs::path real = fs::weakly_canonical(entry->path(), ignored);
      if (fs::path there = entry->is_directory(ignored) ? real : real.parent_path();
          is_below(there, "/usr") && std::ranges::find(folders, there) == folders.end())
        folders.push_back(std::move(there));
    }
  }
  return folders;
}

/// Tells whether a file lies in one of the folders by its name and by its real place: a link elsewhere that
/// points there does not.
bool lies_in(const fs::path& file, const std::vector<fs::path>& folders) {
  std::error_code ignored;
  const fs::path real = fs::weakly_canonical(file, ignored), named = fs::absolute(file).lexically_normal();
  const auto holds = [&](const fs::path& name, const fs::path& folder) {
    return is_below(name, folder.has_filename() ? folder : folder.parent_path());
  };
  return std::ranges::any_of(
             folders, [&](const fs::path& folder) { return holds(named, folder.lexically_normal()); }) &&
         std::ranges::any_of(folders, [&](const fs::path& folder) {
           std::error_code none;
           return holds(real, fs::weakly_canonical(folder, none));
         });
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

LawText preprocess_law(const fs::path& header, const LawCompiler& compiler) {
  const fs::path file = fs::canonical(header);
  if (file.string().find_first_of("\"\\\n") != std::string::npos)
    throw Error(
        fmt::format("{}: a name with quotes, backslashes or line breaks cannot be included", file.string()));
  make_private(compiler.cache);
  const FileLock lock(compiler.cache / "lock");
  const std::string version = said_by({compiler.program, "--version"}, compiler);
  require_new(version);
  const fs::path source = compiler.cache / "law.cpp", preprocessed = compiler.cache / "law.ii",
                 rule = compiler.cache / "law.d";
  write(source, source_of(file));
  // macros may grow without end, and nobody has allowed this header yet
  std::vector<std::string> words{"prlimit", "--cpu=60", "--fsize=268435456"};
  for (const auto& more : {command_of(compiler, file),
                           {"-E", "-Werror=date-time", source.string(), "-o", preprocessed.string(), "-MD",
                            "-MT", "law", "-MF", rule.string()}})
    words.insert(words.end(), more.begin(), more.end());
  attempt(words, file, "the preprocessor refuses this contact law", "", compiler);
  const auto folders = installed_folders(compiler);
  LawText law = read_law_text(file, read_file(preprocessed), read_file(rule), [&](const fs::path& named) {
    return named == source || lies_in(named, folders);
  });
  law.version = version;
  for (const fs::path& aside : {preprocessed, rule}) fs::remove(aside);
  return law;
}

fs::path compile_law(const LawText& law, const std::string& type, const LawCompiler& compiler) {
  make_private(compiler.cache);
  const FileLock lock(compiler.cache / "lock");
  const auto in_cache = [&](const std::string& name) { return compiler.cache / name; };
  const std::string code = code_of(type, compiler);
  const std::string key = sha256(fmt::format("{}\n{}\n{}\n{}\n{} {} {:016x}", law.normalised, code,
                                             law.version, fmt::join(flags_of(compiler.instructions), " "),
                                             build_settings::kVersion, kLawTableVersion, layout_hash()));
  const fs::path kept = in_cache(key + ".so");
  if (fs::exists(kept)) return kept;
  const fs::path preprocessed = in_cache("law.ii"), object = in_cache("law.so"), rule = in_cache("law.d");
  write(preprocessed, law.text + code);
  auto words = command_of(compiler, law.header);
  for (const std::string& word : {std::string("-shared"), preprocessed.string(), std::string("-o"),
                                  object.string(), std::string("-pipe")})
    words.push_back(word);
  // the assembler tells what it reads; that of Clang itself does not
  if (law.version.find("clang") != std::string::npos)
    words.insert(words.end(), {"-fno-integrated-as", "-fno-addrsig"});
  words.insert(words.end(), {"-Xassembler", "--MD", "-Xassembler", rule.string()});
  compiler.tell(shell_command(words));
  attempt(words, law.header, fmt::format("does not compile as the contact law {}", type), type, compiler);
  for (const fs::path& read : files_of_rule(read_file(rule))) {
    // the rule names the text itself, and a file that the compiler made for the assembler and then removed
    if (read == in_cache("law.cpp") || read == preprocessed || !fs::exists(read)) continue;
    fs::remove(object);
    throw Error(
        fmt::format("{}: the assembler reads {}, as asm with .incbin or .include asks it to; the hash of the "
                    "law does not cover that file, so write its content into the header",
                    law.header.string(), read.string()));
  }
  for (const fs::path& aside : {preprocessed, rule}) fs::remove(aside);
  fs::rename(object, kept);
  return kept;
}

}  // namespace pyroclast
