#pragma once

#include <span>
#include <vector>

#include "pyroclast/specimen/specimen.hpp"

namespace pyroclast::specimen {

/// Area fraction of each cell that the circles cover, in [0, 1]. Exact for circles that do not overlap.
std::vector<double> covered_fractions(const Tessellation& tessellation, double width, double height,
                                      std::span<const Aggregate> aggregates);

/// What each cell is made of, by `parameters.superposition`.
std::vector<Constituent> superpose(const Tessellation& tessellation, std::span<const Aggregate> aggregates,
                                   const SpecimenParameters& parameters);

}  // namespace pyroclast::specimen
