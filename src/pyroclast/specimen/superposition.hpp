#pragma once

#include <span>
#include <vector>

#include "pyroclast/specimen/specimen.hpp"

namespace pyroclast::specimen {

/// Cover of a cell by stones.
struct Cover {
  /// Share of the cell, by all stones together, in [0, 1]; exact where these do not overlap.
  double share = 0.0;
  int phase = -1;  ///< phase of the stones that cover most of the cell; -1 where none does
  int stone = -1;  ///< stone that covers most of the cell; -1 where none does
};

/// What a cell and a stone have in common.
struct CommonPart {
  int cell;
  int stone;
  double extent;  ///< m², in space m³
};

/// Returns the parts that cells have in common with stones, cell by cell.
template <int Dim>
std::vector<CommonPart> common_parts(const Cells<Dim>& cells, const OutlineOf<Dim>& outline,
                                     std::span<const Stone<Dim>> stones);

/// Returns the cover of each cell.
/// \param parts  parts that the cells have in common with these stones
template <int Dim>
std::vector<Cover> covers_of(const Cells<Dim>& cells, std::span<const CommonPart> parts,
                             std::span<const Stone<Dim>> stones);

/// Result of superposing stones on cells.
struct Superposed {
  /// Phase of each cell: that of the stones which cover most of it, or the matrix.
  std::vector<int> phase = {};
  std::vector<int> stone = {};    ///< stone of which each cell is, index into the stones; -1: of none
  double covered_fraction = 0.0;  ///< share above which a cell is of the stones, as stated or as it fits
};

/// Superposes stones by `parameters.superposition`; the rule of the centroid needs no covered fraction. By
/// the rule `fit` the cells that are covered most become aggregate, while that brings their extent nearer to
/// that of the stones. By the rule `each` every stone, the largest first, takes one cell before: the one of
/// which it covers most and that no larger stone took.
template <int Dim>
Superposed superpose(const Cells<Dim>& cells, const OutlineOf<Dim>& outline,
                     std::span<const Stone<Dim>> stones, const SpecimenParameters& parameters, int matrix);

/// Gives the cells that a fibre crosses its phase; they are of no stone then.
template <int Dim>
void superpose(const Cells<Dim>& cells, std::span<const Fibre<Dim>> fibres, std::vector<int>& phase,
               std::vector<int>& stone);

}  // namespace pyroclast::specimen
