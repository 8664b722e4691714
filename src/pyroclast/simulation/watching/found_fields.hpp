#pragma once

#include <span>
#include <vector>

#include "pyroclast/mechanics/found/found_points.hpp"
#include "pyroclast/simulation/watching/fields.hpp"

namespace pyroclast {

/// Field of the contacts that are found: one value of each point of a pair that presses.
struct FoundField : FieldInfo {
  /// Function that writes the components of one point, those of vectors in space.
  void (*read)(const FoundPoint&, double* to);
};

/// Returns the fields of contacts that are found, in the order of the files, which files, Python and docs
/// follow.
const std::vector<FoundField>& found_fields();

/// Returns the values of a field, point by point and component by component; vectors have three.
std::vector<double> values_of(const FoundField& field, const std::vector<FoundPoint>& points);

}  // namespace pyroclast
