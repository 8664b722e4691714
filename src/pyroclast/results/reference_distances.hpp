#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "pyroclast/setup/read_references.hpp"
#include "pyroclast/simulation/run.hpp"

namespace pyroclast {

/// Points of a curve, in their order. Between two of them it is straight.
struct PlainCurve {
  std::vector<double> x, y;
};

/// How far a curve is from a reference; docs/method.md has the formulas. Each is empty where it cannot be
/// told.
struct CurveDistances {
  std::optional<double> rms;      ///< over the common range, over the reference's greatest size
  std::optional<double> at_peak;  ///< greatest of the curve in the reference's range over that of it, less 1
  std::optional<double> area;     ///< between both, over the common range, in the unit of y times that of x
  std::optional<double> covered;  ///< common range over that of the reference
};

/// Of both curves only points whose x exceeds all before make the line that ranges, distance and area are of.
CurveDistances distances(const PlainCurve& curve, const PlainCurve& reference);

/// What a run has in the place of a reference, in the units of the history: the rows that figures draw.
PlainCurve curve_beside(const Reference& reference, const Run& run);
/// The values of a reference; of a range those midway between both ends.
PlainCurve curve_of(const Reference& reference);

/// What a run comes to beside one of its references.
struct ReferenceDistances {
  std::string name;
  std::string area_unit;  ///< as names of results have it: "N_m"
  CurveDistances distances;
  std::vector<std::string> warnings;  ///< where it is most likely of another sign or unit
};

/// Of all references but those that the program has.
std::vector<ReferenceDistances> reference_distances(std::span<const Reference> references, const Run& run);

}  // namespace pyroclast
