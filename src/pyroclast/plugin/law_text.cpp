#include "pyroclast/plugin/law_text.hpp"

#include <algorithm>
#include <cctype>
#include <optional>
#include <string_view>
#include <utility>

#include <fmt/format.h>

#include "pyroclast/base/characters.hpp"
#include "pyroclast/base/error.hpp"
#include "pyroclast/base/read_file.hpp"
#include "pyroclast/base/sha256.hpp"
#include "pyroclast/base/shown.hpp"

namespace pyroclast {

namespace {

namespace fs = std::filesystem;

constexpr std::size_t kMostFiles = 1000;  // most files of the user that a header may take in

/// Line mark of a preprocessed text: `# 12 "file" 1`.
struct LineMark {
  std::string line, file;
  bool enters = false, returns = false;  // whether an included file begins, or ends
};

bool is_blank(char c) {
  return std::isspace(static_cast<unsigned char>(c)) != 0;
}

bool is_octal(char c) {
  return c >= '0' && c <= '7';
}

/// Returns the text of a literal without its escapes: GCC writes bytes beyond ASCII as three octal digits.
std::string without_escapes(std::string_view literal) {
  std::string text;
  for (std::size_t i = 0; i < literal.size(); ++i) {
    if (literal[i] != '\\' || i + 1 == literal.size()) {
      text += literal[i];
    } else if (i + 3 < literal.size() && std::ranges::all_of(literal.substr(i + 1, 3), is_octal)) {
      text += static_cast<char>((literal[i + 1] - '0') * 64 + (literal[i + 2] - '0') * 8 +
                                (literal[i + 3] - '0'));
      i += 3;
    } else {
      text += literal[++i];
    }
  }
  return text;
}

std::optional<LineMark> mark_of(std::string_view line) {
  if (!line.starts_with("# ") || line.size() < 3 || !is_digit(line[2])) return {};
  const auto open = line.find('"'), close = line.rfind('"');
  if (open == std::string_view::npos || close == open) return {};
  LineMark mark{std::string(line.substr(2, line.find(' ', 2) - 2)),
                without_escapes(line.substr(open + 1, close - open - 1)), false, false};
  const auto flags = line.substr(close + 1);
  mark.enters = flags.find(" 1") != std::string_view::npos;
  mark.returns = flags.find(" 2") != std::string_view::npos;
  return mark;
}

/// Returns the word of a directive; empty for a line that is none.
std::string directive_of(std::string_view line) {
  const auto skip = [&] {
    while (!line.empty() && is_blank(line.front())) line.remove_prefix(1);
  };
  skip();
  for (const std::string_view sign : {"#", "%:", "?\?="})
    if (line.starts_with(sign)) {
      line.remove_prefix(sign.size());
      skip();
      const auto end = std::ranges::find_if_not(
          line, [](char c) { return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_'; });
      return fmt::format("#{}", std::string(line.begin(), end));
    }
  return {};
}

/// Throws Error where a line of a preprocessed text would let the compiler read or define something more.
void require_no_directive(std::string_view line, const fs::path& header) {
  const std::string word = directive_of(line);
  if (word.empty() || word == "#pragma" || word == "#ident") return;
  throw Error(fmt::format(
      "{}: \"{}\" stays in the text when the header is preprocessed, so what is compiled would not "
      "be known; write the directive without macros, and no line of a text literal that begins with #",
      header.string(), shown_in_short(std::string(line))));
}

}  // namespace

std::vector<fs::path> files_of_rule(const std::string& rule) {
  std::vector<fs::path> files;
  std::string name;
  const auto end_name = [&] {
    if (!name.empty()) files.emplace_back(std::exchange(name, {}));
  };
  const auto colon = rule.find(": ");
  for (std::size_t i = colon == std::string::npos ? rule.size() : colon + 1; i < rule.size(); ++i) {
    const char c = rule[i], next = i + 1 < rule.size() ? rule[i + 1] : '\0';
    if (c == '\\' && next == '\n') {
      ++i;
      end_name();
    } else if ((c == '\\' && (next == ' ' || next == '\t' || next == '#' || next == ':')) ||
               (c == '$' && next == '$')) {
      name += next;
      ++i;
    } else if (c == '\n') {
      break;  // other rules, of no recipe, may follow
    } else if (is_blank(c)) {
      end_name();
    } else {
      name += c;
    }
  }
  end_name();
  return files;
}

LawText read_law_text(const fs::path& header, std::string text, const std::string& rule,
                      const std::function<bool(const fs::path&)>& is_installed) {
  LawText law;
  law.header = header;
  law.files = {header};
  for (const fs::path& file : files_of_rule(rule))
    if (std::ranges::find(law.files, file) == law.files.end() && !is_installed(file))
      law.files.push_back(file);
  if (law.files.size() > kMostFiles)
    throw Error(fmt::format("{}: includes {} files beside those of the system; at most {} can be copied",
                            header.string(), law.files.size() - 1, kMostFiles));
  std::string users;           // part of the text that comes from files of the user
  std::vector<fs::path> open;  // files that include one another, the innermost last
  bool is_users = false,
       is_own = false;  // whether the text stands in a file of the user, in the header itself
  const auto place_of = [&](const fs::path& file) { return std::ranges::find(law.files, file); };
  for (std::size_t begin = 0; begin < text.size();) {
    const std::size_t end = std::min(text.find('\n', begin), text.size());
    const std::string_view line(text.data() + begin, end - begin);
    begin = end + 1;
    const auto mark = mark_of(line);
    if (mark && mark->enters) open.emplace_back(mark->file);
    if (mark && mark->returns && !open.empty()) open.pop_back();
    std::string known(line);
    if (mark) {
      is_users = !open.empty() && place_of(open.back()) != law.files.end();
      is_own = !open.empty() && open.back() == header;
      if (const auto at = place_of(mark->file); at != law.files.end())
        known = fmt::format("# {} \"{}\"", mark->line, at - law.files.begin());
    } else {
      require_no_directive(line, header);
      if (is_own) law.own += known + "\n";
    }
    if (is_users) users += known + "\n";
    law.normalised += known + "\n";
  }
  law.text = std::move(text);
  std::string all;
  for (const fs::path& file : law.files) all += sha256(read_file(file)) + "\n";
  law.hash = sha256(all + sha256(users));
  return law;
}

}  // namespace pyroclast
