#pragma once

#include <string>
#include <vector>

#include "pyroclast/base/team.hpp"
#include "pyroclast/solid/superposition.hpp"

namespace pyroclast::solid {

/// Aggregate of a range of sizes: what was asked for, and what became of it. Shares are of the volume of the
/// specimen.
struct SizeClass {
  int kind = 0;     ///< as of a stone
  double from, to;  ///< diameters, m
  double asked = 0.0;
  double placed = 0.0;
  double superposed = 0.0;
  int stones = 0;
  int without_a_block = 0;  ///< stones to which no block belongs
};

/// Quality of the blocks; lengths in m.
struct CellMetrics {
  double mean_size = 0.0;        ///< cube root of the mean volume, the block size
  double shortest_edge = 0.0;    ///< shortest edge of any block
  double lowest_zone = 0.0;      ///< least height of any zone over one of its faces
  int lowest_zone_cell = -1;     ///< cell of this zone
  double zones_per_block = 0.0;  ///< mean number of zones
  int most_corners = 0;          ///< most corners of a face between blocks
  double largest_bend = 0.0;     ///< largest bend of a face, see bend(); degrees
  int vertices_merged = 0;       ///< vertices that became one with another
  int edges_left_short = 0;      ///< edges that are shorter than asked for
  int seeds_redrawn = 0;         ///< seeds drawn anew because their cell was empty or matched no neighbour
};

/// Meso-scale specimen in space: blocks, their phases, and the outcome of the request.
struct SolidSpecimen {
  Prism body;
  Complex complex;
  std::vector<std::string> phases;  ///< phases that blocks can have
  std::vector<int> phase;           ///< phase of each cell, index into `phases`
  /// Ball of which each cell is, index into `balls` where these are known; -1: of none. May be empty where
  /// cells are made elsewhere.
  std::vector<int> grain;
  /// Size that each block was to have, m, which contact stiffnesses follow; empty where blocks are alike.
  std::vector<double> size;
  std::vector<Ball> balls;  ///< balls as placed, those of each kind largest first
  /// Volume of balls asked for and placed, and of blocks that are not matrix, over that of the specimen.
  double fraction_asked = 0.0, fraction_placed = 0.0, fraction_superposed = 0.0;
  double covered_fraction = 0.0;  ///< see SuperposedBalls
  std::vector<double> fraction;   ///< volume of the blocks of each phase over that of the specimen
  std::vector<SizeClass> classes;
  int small_stones = 0;  ///< stones that are smaller than three of the blocks around them
  CellMetrics metrics;
};

/// Makes a specimen by gradation, placement, tessellation and superposition, in this order, as in the plane
/// but with balls, by volume. Throws Error when a parameter is out of range, the aggregates do not fit, the
/// placed fraction is off by more than 0.01, or no tessellation can be made.
/// \param parameters  parameters, whose region is not read
/// \param team        team that shares the cells out; without a team the calling thread works alone
SolidSpecimen make_specimen(const specimen::SpecimenParameters& parameters, const Prism& body,
                            Team* team = nullptr);

/// Measures blocks.
/// \param metrics  metrics that say what has been done to the blocks, which stays in the result
CellMetrics measure(const Complex& complex, const Prism& body, CellMetrics metrics = {});

/// Returns what a user should know of a specimen that differs from the request, one line each.
std::vector<std::string> warnings(const SolidSpecimen& specimen);

}  // namespace pyroclast::solid
