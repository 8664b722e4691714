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
  std::string property{};   ///< "modulus"; a curve may stand in the place of another one of its property
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

  /// Returns the curve of a name; none where there is no such curve.
  const NamedCurve* find(std::string_view name) const;
  std::vector<std::string> names() const;

  /// Returns the curves of a property that hold everywhere in a range.
  std::vector<const NamedCurve*> of_property(std::string_view property, const Interval& range) const;

 private:
  std::string kind_;
  std::vector<NamedCurve> entries_;
};

}  // namespace pyroclast
