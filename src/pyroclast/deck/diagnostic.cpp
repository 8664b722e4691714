#include "pyroclast/deck/diagnostic.hpp"

#include <algorithm>
#include <tuple>
#include <utility>

#include <fmt/format.h>

#include "pyroclast/base/shown.hpp"

namespace pyroclast {
namespace {

std::string listed(const std::vector<Diagnostic>& diagnostics) {
  std::string lines;
  for (const Diagnostic& diagnostic : diagnostics) {
    if (!lines.empty()) lines += '\n';
    lines += to_string(diagnostic);
  }
  return lines;
}

}  // namespace

std::vector<Diagnostic> in_file_order(std::vector<Diagnostic> diagnostics) {
  std::stable_sort(diagnostics.begin(), diagnostics.end(), [](const Diagnostic& a, const Diagnostic& b) {
    return std::tie(a.is_missing, a.line, a.column) < std::tie(b.is_missing, b.line, b.column);
  });
  return diagnostics;
}

std::string to_string(const Diagnostic& diagnostic) {
  std::string line = shown(diagnostic.file);
  if (diagnostic.line > 0 && !diagnostic.is_changed)
    line += fmt::format(":{}:{}", diagnostic.line, diagnostic.column);
  return line + ": " + without_place(diagnostic);
}

std::string without_place(const Diagnostic& diagnostic) {
  std::string line;
  if (!diagnostic.key.empty()) {
    line += shown_in_short(diagnostic.key);
    if (!diagnostic.value.empty()) line += " = " + shown_in_short(diagnostic.value);
    line += ": ";
  }
  line += shown(diagnostic.message, true);
  if (!diagnostic.hint.empty()) line += "; " + shown(diagnostic.hint, true);
  return line;
}

DeckError::DeckError(std::vector<Diagnostic> diagnostics)
    : Error(listed(in_file_order(diagnostics))), diagnostics_(in_file_order(std::move(diagnostics))) {}

}  // namespace pyroclast
