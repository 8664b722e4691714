#pragma once

#include <span>
#include <vector>

#include "pyroclast/specimen/specimen.hpp"

namespace pyroclast::specimen {

/// Cover of a cell by circles.
struct Cover {
  /// Share of the cell's area, by all circles together, in [0, 1]; exact where these do not overlap.
  double share = 0.0;
  int phase = -1;  ///< phase of the grains that cover most of the cell; -1 where none does
  int grain = -1;  ///< grain that covers most of the cell; -1 where none does
};

/// Returns the cover of each cell.
std::vector<Cover> covers_of(const Tessellation& tessellation, const Box& box,
                             std::span<const Aggregate> aggregates);

/// Returns the covered fraction above which cells are aggregate so that their area comes as near as it can to
/// that of the circles, see Superposition::fit.
/// \param covers  cover of each cell by these circles
double fitting_fraction(const Tessellation& tessellation, std::span<const Cover> covers,
                        std::span<const Aggregate> aggregates);

/// Result of superposing circles on a tessellation.
struct Superposed {
  /// Phase of each cell: that of the circles which cover most of it, or the matrix.
  std::vector<int> phase = {};
  std::vector<int> grain = {};    ///< grain of which each cell is, index into the grains; -1: of none
  double covered_fraction = 0.0;  ///< fraction above which a cell is of the circles, as stated or as it fits
};

/// Superposes circles by `parameters.superposition`; the rule of the centroid needs no covered fraction.
Superposed superpose(const Tessellation& tessellation, std::span<const Aggregate> aggregates,
                     const SpecimenParameters& parameters, int matrix);

/// Gives the cells that a fibre crosses its phase; they are of no grain then.
void superpose(const Tessellation& tessellation, std::span<const Fibre> fibres, std::vector<int>& phase,
               std::vector<int>& grain);

}  // namespace pyroclast::specimen
