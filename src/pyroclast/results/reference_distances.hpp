#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "pyroclast/setup/read_references.hpp"
#include "pyroclast/simulation/loop/run.hpp"

namespace pyroclast {

/// Points of a curve, in their order. Between two points the curve is straight.
struct PlainCurve {
  std::vector<double> x, y;
};

/// Distances of a curve from a reference; docs/understand/theory.md has the formulas. Each is empty where it
/// cannot be computed.
struct CurveDistances {
  std::optional<double> rms;  ///< root mean square over the common range, over the reference's greatest size
  /// Greatest size of the curve in the reference's range over the reference's, less 1.
  std::optional<double> at_peak;
  /// Area between both, over the common range, in the unit of y times the unit of x.
  std::optional<double> area;
  std::optional<double> covered;  ///< common range over the range of the reference
};

/// Computes the distances of two curves. Only points whose x exceeds all before count for ranges, distance
/// and area.
CurveDistances distances(const PlainCurve& curve, const PlainCurve& reference);

/// Returns the results of a run in the place of a reference, in the units of the history: the rows that
/// figures draw.
PlainCurve curve_beside(const Reference& reference, const Run& run);
/// Returns the values of a reference; of a range the values midway between both ends.
PlainCurve curve_of(const Reference& reference);

/// Distances of a run from one of its references.
struct ReferenceDistances {
  std::string name;
  std::string area_unit;  ///< unit of the area as names of results have it: "N_m"
  CurveDistances distances;
  std::vector<std::string> warnings;  ///< warnings where the reference is most likely of another sign or unit
};

/// Returns the distances from all references except those that the program has.
std::vector<ReferenceDistances> reference_distances(std::span<const Reference> references, const Run& run);

}  // namespace pyroclast
