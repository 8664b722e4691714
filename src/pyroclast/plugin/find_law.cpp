#include "pyroclast/plugin/find_law.hpp"

#include <algorithm>
#include <regex>
#include <string>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "pyroclast/base/environment.hpp"
#include "pyroclast/base/error.hpp"
#include "pyroclast/base/read_file.hpp"
#include "pyroclast/base/sha256.hpp"
#include "pyroclast/base/shown.hpp"
#include "pyroclast/laws/registry.hpp"
#include "pyroclast/plugin/open_library.hpp"

namespace pyroclast {

namespace {

namespace fs = std::filesystem;

fs::path cache_folder() {
  if (const auto own = environment("PYROCLAST_CACHE"); !own.empty()) return fs::path(own) / "laws";
  if (const auto shared = environment("XDG_CACHE_HOME"); !shared.empty())
    return fs::path(shared) / "pyroclast" / "laws";
  if (const auto home = environment("HOME"); !home.empty())
    return fs::path(home) / ".cache" / "pyroclast" / "laws";
  return {};
}

/// Returns the table of a law. Throws Error where a law of the program has its name, for which it would be
/// taken.
const LawTable& with_own_name(const OpenedLaw& law) {
  for (const LawTable* own : built_in_laws())
    if (std::string_view(own->name) == law.table.name)
      throw Error(fmt::format(
          "{}: its law is called \"{}\", as one that is part of the program; give it another name",
          law.shared_object.string(), own->name));
  return law.table;
}

/// Tells whether a file lies in a folder that the user named.
bool in_folders(const fs::path& file, const LawSources& sources) {
  std::error_code ignored;
  return std::ranges::any_of(sources.folders, [&](const fs::path& folder) {
    return fs::equivalent(folder, file.has_parent_path() ? file.parent_path() : ".", ignored);
  });
}

/// Throws Error where a type is not a name: nothing else of a deck becomes source.
void require_type(const fs::path& header, const std::string& type) {
  static const std::regex kType("(::)?[A-Za-z_][A-Za-z0-9_]*(::[A-Za-z_][A-Za-z0-9_]*)*");
  if (!std::regex_match(type, kType))
    throw Error(fmt::format("{}: the type of a law is a name such as mine::Law, not \"{}\"", header.string(),
                            shown_in_short(type)));
}

void require_code(const Code& code, const LawSources& sources, bool named) {
  sources.permission.require(code, named || in_folders(code.files.front(), sources));
}

const LawTable& law_of_header(const fs::path& header, std::string type, const LawSources& sources,
                              bool named) {
  if (!fs::exists(header))
    throw Error(fmt::format("{}: there is no such header of a contact law", header.string()));
  if (!sources.may_compile)
    throw Error(
        fmt::format("{}: is a contact law in a header, and compiling is switched off (--no-compile, "
                    "PYROCLAST_NO_COMPILE); "
                    "build it with pyroclast_add_law and state its shared object",
                    header.string()));
  if (sources.compiler.cache.empty())
    throw Error(fmt::format("{}: no folder for compiled laws: set PYROCLAST_CACHE", header.string()));
  if (!type.empty()) require_type(header, type);
  const LawText law = preprocess_law(header, sources.compiler);
  if (type.empty()) type = law_type(header, law.own);
  std::vector<fs::path> files = law.files;
  files.front() = header;
  require_code({header.string(), law.hash, files, {}}, sources, named);
  return with_own_name(open_law(compile_law(law, type, sources.compiler), law.files));
}

const LawTable& law_of_object(const fs::path& file, const LawSources& sources, bool named) {
  if (!fs::exists(file))
    throw Error(fmt::format("{}: there is no such shared object of a contact law", file.string()));
  require_code({file.string(), sha256(read_file(file)), {file}, {}}, sources, named);
  const OpenedLaw& law = open_law(file);
  if (const int dim = sources.compiler.dimension; !includes(law.dimensions, dim))
    throw Error(fmt::format("{}: the contact law \"{}\" is made for bodies in {}D, not in {}D", file.string(),
                            law.table.name, dim == 2 ? 3 : 2, dim));
  return with_own_name(law);
}

/// Splits "mine.hpp:a::Law" into header and type; the type is empty where none is stated, both where no
/// header is.
std::pair<std::string, std::string> header_and_type(std::string_view stated) {
  for (const char* const ending : {".hpp", ".hh", ".hxx", ".h"}) {
    if (stated.ends_with(ending)) return {std::string(stated), {}};
    if (const auto at = stated.find(fmt::format("{}:", ending)); at != std::string_view::npos) {
      const auto end = at + std::string_view(ending).size();
      return {std::string(stated.substr(0, end)), std::string(stated.substr(end + 1))};
    }
  }
  return {};
}

}  // namespace

LawSources LawSources::of_environment() {
  LawSources sources;
  const std::string path = environment("PYROCLAST_LAW_PATH");
  for (std::size_t begin = 0; begin < path.size();) {
    const auto end = std::min(path.find(':', begin), path.size());
    if (end > begin) sources.folders.emplace_back(path.substr(begin, end - begin));
    begin = end + 1;
  }
  const std::string refused = environment("PYROCLAST_NO_COMPILE");
  sources.may_compile = refused.empty() || refused == "0";
  if (const auto compiler = environment("CXX"); !compiler.empty()) sources.compiler.program = compiler;
  sources.compiler.cache = cache_folder();
  sources.permission = CodePermission::of_environment();
  return sources;
}

const LawTable& find_law(std::string_view stated, const fs::path& deck_folder, const LawSources& sources,
                         bool named) {
  for (const LawTable* law : built_in_laws())
    if (law->name == stated) return *law;
  if (const auto [header, type] = header_and_type(stated); !header.empty())
    return law_of_header(deck_folder / header, type, sources, named);
  if (stated.ends_with(".so")) return law_of_object(deck_folder / stated, sources, named);

  std::vector<std::string> searched, names;
  std::vector<fs::path> folders{deck_folder};
  folders.insert(folders.end(), sources.folders.begin(), sources.folders.end());
  if (stated.find('/') == std::string_view::npos && !stated.empty())
    for (const fs::path& folder : folders) {
      const fs::path file = folder / fmt::format("{}.so", stated);
      if (fs::exists(file)) return law_of_object(file, sources, named);
      searched.push_back(folder.empty() ? "." : folder.string());
    }
  for (const LawTable* law : built_in_laws()) names.emplace_back(law->name);
  throw Error(
      fmt::format("the contact law \"{0}\" is neither part of the program ({1}) nor is there a {0}.so in "
                  "{2}; allowed are these "
                  "names, a shared object (mine.so), and a header (mine.hpp)",
                  stated, fmt::join(names, ", "), fmt::join(searched, ", ")));
}

}  // namespace pyroclast
