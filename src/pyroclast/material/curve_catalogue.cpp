#include "pyroclast/material/curve_catalogue.hpp"

#include <algorithm>
#include <utility>

#include <fmt/format.h>

#include "pyroclast/base/error.hpp"
#include "pyroclast/base/nearest.hpp"

namespace pyroclast {

CurveCatalogue::CurveCatalogue(std::string kind, std::vector<NamedCurve> entries)
    : kind_(std::move(kind)), entries_(std::move(entries)) {
  for (NamedCurve& entry : entries_) {
    entry.curve = entry.curve.described_as(fmt::format("{} {} ({})", kind_, entry.name, entry.source));
  }
}

const NamedCurve* CurveCatalogue::find(std::string_view name) const {
  const auto found = std::ranges::find(entries_, name, &NamedCurve::name);
  return found == entries_.end() ? nullptr : &*found;
}

std::vector<std::string> CurveCatalogue::names() const {
  std::vector<std::string> all;
  for (const NamedCurve& entry : entries_) all.push_back(entry.name);
  return all;
}

const NamedCurve& CurveCatalogue::at(std::string_view name) const {
  if (const NamedCurve* found = find(name)) return *found;
  const std::vector<std::string> allowed = names();
  const auto meant = nearest(name, allowed);
  throw Error(fmt::format("there is no {} \"{}\"{}; allowed are {}", kind_, name,
                          meant ? fmt::format(", the nearest is \"{}\"", allowed[*meant]) : "",
                          quoted_list(allowed)));
}

std::vector<const NamedCurve*> CurveCatalogue::of_property(std::string_view property,
                                                           const Interval& range) const {
  std::vector<const NamedCurve*> found;
  if (property.empty()) return found;
  for (const NamedCurve& entry : entries_)
    if (entry.property == property && entry.curve.holds(range)) found.push_back(&entry);
  return found;
}

}  // namespace pyroclast
