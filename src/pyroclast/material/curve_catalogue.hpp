#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "pyroclast/material/curve.hpp"

namespace pyroclast {

/// A curve that has a name of its own, with what a user must know to choose it.
struct NamedCurve {
  std::string name;
  std::string description;  ///< The quantity, and anything to mind.
  std::string source;       ///< Clause, table, equation or publication.
  std::string unit;         ///< Of the values; "1" for a ratio or strain.
  Curve curve;              ///< Describes itself as "<kind> <name> (<source>)".
};

/// An unchangeable list of curves to look up by name.
class CurveCatalogue {
 public:
  /// `kind` is what one entry is called in messages, e.g. "built-in curve".
  CurveCatalogue(std::string kind, std::vector<NamedCurve> entries);

  /// In the order given.
  std::span<const NamedCurve> entries() const { return entries_; }

  /// Throws Error with the nearest name, if one is near, and all allowed names when there is none of this
  /// name.
  const NamedCurve& at(std::string_view name) const;

 private:
  std::string kind_;
  std::vector<NamedCurve> entries_;
};

}  // namespace pyroclast
