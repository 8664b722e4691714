#include "pyroclast/material/curve_catalogue.hpp"

#include <algorithm>
#include <numeric>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "pyroclast/base/error.hpp"

namespace pyroclast {
namespace {

/// Levenshtein distance: insertions, deletions and replacements that turn one text into the other.
std::size_t edit_distance(std::string_view from, std::string_view to) {
  std::vector<std::size_t> row(to.size() + 1);
  std::iota(row.begin(), row.end(), std::size_t{0});
  for (std::size_t i = 0; i < from.size(); ++i) {
    std::size_t diagonal = row[0];
    row[0] = i + 1;
    for (std::size_t j = 0; j < to.size(); ++j) {
      const std::size_t replaced = diagonal + (from[i] == to[j] ? 0 : 1);
      diagonal = row[j + 1];
      row[j + 1] = std::min({replaced, row[j] + 1, diagonal + 1});
    }
  }
  return row.back();
}

}  // namespace

CurveCatalogue::CurveCatalogue(std::string kind, std::vector<NamedCurve> entries)
    : kind_(std::move(kind)), entries_(std::move(entries)) {
  for (NamedCurve& entry : entries_) {
    entry.curve = entry.curve.described_as(fmt::format("{} {} ({})", kind_, entry.name, entry.source));
  }
}

const NamedCurve& CurveCatalogue::at(std::string_view name) const {
  const auto found = std::ranges::find(entries_, name, &NamedCurve::name);
  if (found != entries_.end()) return *found;
  const auto nearest = std::ranges::min_element(
      entries_, {}, [name](const NamedCurve& entry) { return edit_distance(name, entry.name); });
  std::vector<std::string_view> names;
  for (const NamedCurve& entry : entries_) names.push_back(entry.name);
  throw Error(fmt::format("there is no {} \"{}\"; the nearest is \"{}\". Allowed: {}", kind_, name,
                          nearest->name, fmt::join(names, ", ")));
}

}  // namespace pyroclast
