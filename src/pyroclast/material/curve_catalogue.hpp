#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "pyroclast/material/curve.hpp"

namespace pyroclast {

/// Curve with a name of its own, and what a user must know to choose it.
struct NamedCurve {
  std::string name;
  std::string description;  ///< quantity, and anything to mind
  std::string source;       ///< clause, table, equation or publication
  std::string unit;         ///< unit of the values; "1" for a ratio or strain
  Curve curve;              ///< curve, which describes itself as "<kind> <name> (<source>)"
};

/// Unchangeable list of curves to look up by name.
class CurveCatalogue {
 public:
  /// \param kind  word for one entry in messages, e.g. "built-in curve"
  CurveCatalogue(std::string kind, std::vector<NamedCurve> entries);

  /// Returns the entries in the order given.
  std::span<const NamedCurve> entries() const { return entries_; }

  /// Returns the curve of a name. Throws Error with the nearest name, if one is near, and all allowed names
  /// when there is no curve of this name.
  const NamedCurve& at(std::string_view name) const;

 private:
  std::string kind_;
  std::vector<NamedCurve> entries_;
};

}  // namespace pyroclast
