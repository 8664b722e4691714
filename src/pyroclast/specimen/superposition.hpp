#pragma once

#include <span>
#include <vector>

#include "pyroclast/specimen/specimen.hpp"

namespace pyroclast::specimen {

/// Area fraction of each cell that the circles cover, in [0, 1]. Exact for circles that do not overlap.
std::vector<double> covered_fractions(const Tessellation& tessellation, const Box& box,
                                      std::span<const Aggregate> aggregates);

/// The covered fraction above which cells are aggregate so that their area comes as near as it can to that of
/// the circles, see Superposition::fit.
double fitting_fraction(const Tessellation& tessellation, const Box& box,
                        std::span<const Aggregate> aggregates);

/// What each cell is made of, by `parameters.superposition` and, but for the rule of the centroid,
/// `parameters.covered_fraction`: the phase of the circles that cover most of it, or the matrix.
std::vector<int> superpose(const Tessellation& tessellation, std::span<const Aggregate> aggregates,
                           const SpecimenParameters& parameters, int matrix);

/// Gives the cells that a fibre crosses its phase.
void superpose(const Tessellation& tessellation, std::span<const Fibre> fibres, std::vector<int>& phase);

}  // namespace pyroclast::specimen
