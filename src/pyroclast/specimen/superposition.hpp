#pragma once

#include <span>
#include <vector>

#include "pyroclast/specimen/specimen.hpp"

namespace pyroclast::specimen {

/// What covers a cell.
struct Cover {
  double share = 0.0;  ///< of its area, by all circles together, in [0, 1]; exact where these do not overlap
  int phase = -1;      ///< of the circles that cover most of it; -1 where none does
};

/// Of each cell.
std::vector<Cover> covers_of(const Tessellation& tessellation, const Box& box,
                             std::span<const Aggregate> aggregates);

/// The covered fraction above which cells are aggregate so that their area comes as near as it can to that of
/// the circles, see Superposition::fit.
/// \param covers  of each cell, by these circles
double fitting_fraction(const Tessellation& tessellation, std::span<const Cover> covers,
                        std::span<const Aggregate> aggregates);

/// What circles make of a tessellation.
struct Superposed {
  std::vector<int> phase = {};    ///< of each cell: that of the circles which cover most of it, or the matrix
  double covered_fraction = 0.0;  ///< above which a cell is of the circles, as stated or as it fits
};

/// By `parameters.superposition`; the rule of the centroid asks for no covered fraction.
Superposed superpose(const Tessellation& tessellation, std::span<const Aggregate> aggregates,
                     const SpecimenParameters& parameters, int matrix);

/// Gives the cells that a fibre crosses its phase.
void superpose(const Tessellation& tessellation, std::span<const Fibre> fibres, std::vector<int>& phase);

}  // namespace pyroclast::specimen
