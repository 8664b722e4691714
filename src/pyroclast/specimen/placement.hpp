#pragma once

#include <span>
#include <vector>

#include "pyroclast/base/random.hpp"
#include "pyroclast/specimen/specimen.hpp"

namespace pyroclast::specimen {

/// Take-and-place: puts a circle of each diameter (m, largest first) at a random centre in
/// [0, width] x [0, height] where it keeps `minimum_gap` to the others and to the outline. Throws Error, and
/// says how much is missing, when one finds no place within `attempts` centres.
std::vector<Aggregate> place(std::span<const double> diameters, double width, double height,
                             const AggregateParameters& parameters, Random& random);

}  // namespace pyroclast::specimen
