#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <numbers>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "pyroclast/base/team.hpp"
#include "pyroclast/base/vec.hpp"
#include "pyroclast/specimen/block_sizes.hpp"
#include "pyroclast/specimen/region.hpp"
#include "pyroclast/specimen/surface.hpp"

namespace pyroclast::specimen {

/// Largest seed of the random numbers of a specimen; decks and the command line take 0 and up.
inline constexpr std::int64_t kLargestSeed = 9'000'000'000'000'000;

/// Aggregate as placed, before blocks take its place: a circle, in a solid a ball, or a shape of its own.
template <int Dim>
struct Grain {
  Vec<Dim> centre;  ///< m
  /// Diameter, m; of another shape its width: the sieve that it passes.
  double diameter;
  int phase = 0;  ///< index into the specimen's phases
  int kind = 0;   ///< 0 for the first aggregates, then counting the inclusions that are grains, in turn
  std::shared_ptr<const Surface<Dim>> shape = {};  ///< shape around the centre; none: it is round
};
using Aggregate = Grain<2>;

/// Straight fibre as placed: the blocks that it crosses become its phase.
struct Fibre {
  Vec<2> from, to;  ///< m
  int phase = 0;    ///< index into Specimen::phases
};

/// Stone that is known, read from a list.
struct Stone {
  Vec<2> centre;                                 ///< m
  double diameter;                               ///< m, as of a grain
  std::string phase;                             ///< phase of the stone
  std::string place;                             ///< place that states the stone, "stones.csv:7", for errors
  std::shared_ptr<const Surface<2>> shape = {};  ///< shape around the centre; none: a circle
};

enum class GrainShape : std::uint8_t {
  circle,    ///< a ball in a solid
  ellipse,   ///< an ellipse of this elongation
  polygon,   ///< convex, with corners at random on an ellipse (Wang, Kwan and Chan 1999)
  harmonics  ///< r(angle) = 1 + sum D_n cos(n angle + phase_n) with n from 3 on, drawn out to the elongation
};

/// Numbers between two bounds, each as likely as the other.
struct Spread {
  double low, high;
};

/// Shapes of grains asked for.
struct ShapeParameters {
  GrainShape kind = GrainShape::circle;
  Spread elongation{1.0, 1.0};                ///< length over width
  Spread orientation{0.0, std::numbers::pi};  ///< angle of the length from the x axis, radians
  Spread corners{5.0, 8.0};                   ///< number of corners of a polygon
  Spread roughness{0.0, 0.0};                 ///< D_3 of harmonics
  double decay = 5.0 / 3.0;  ///< D_n falls as n^-decay (Barclay and Buckingham 2009, of sands)
};

/// Coarse aggregate asked for: Fuller's curve P(d) = (d/d_max)^nf between d_min and d_max (paper, Eq. 16), a
/// measured grading curve, or the stones themselves. With a fraction of 0 the other members are not read.
/// Fractions and curves are by the area of circles; in a solid by the volume of balls.
struct AggregateParameters {
  std::string phase = "aggregate";
  double fraction = 0.0;         ///< fraction of coarse aggregate asked for, in [0, 1)
  double d_min = 0.0;            ///< smallest diameter, m
  double d_max = 0.0;            ///< largest diameter, m
  double fuller_exponent = 0.0;  ///< nf
  std::vector<double> sieves;    ///< ascending bounds of the size intervals, m; first d_min, last d_max
  /// Share of the area that passes each sieve, from 0 to 1; empty: by Fuller's curve. With these shares nf is
  /// 1, for which a curve is straight between sieves.
  std::vector<double> passing = {};
  std::vector<Stone> stones = {};  ///< stones as they lie; then nothing is drawn or placed
  ShapeParameters shape = {};
  double minimum_gap = 0.0;  ///< smallest distance between aggregates and to the outline, m
  int attempts = 0;          ///< random centres tried for one aggregate before placing fails
  std::string place = "";    ///< place that asks for them, "mine.toml:12: aggregates", for errors
};

/// Fibres asked for: each at a random place, in a random direction.
struct FibreParameters {
  std::string phase;
  int count = 0;
  double length = 0.0;       ///< m
  double minimum_gap = 0.0;  ///< smallest distance of a fibre to aggregates and to the outline, m
  int attempts = 0;          ///< random places tried for one fibre before placing fails
  std::string place = "";    ///< place that asks for them, for errors
};

/// Inclusions in the matrix beside the first aggregates.
using Inclusions = std::variant<AggregateParameters, FibreParameters>;

enum class Superposition : std::uint8_t {
  area,      ///< a block is aggregate where circles cover more than a stated fraction of it
  fit,       ///< a block is aggregate above the fraction by which the blocks take the area of the circles
  centroid,  ///< a block is of the aggregate in whose circle its centroid lies
  follow     ///< nothing is superposed: blocks follow the surfaces of grains, by mirrored seeds
};

/// Convex cells that tile a region exactly; neighbours share vertices.
struct Tessellation {
  std::vector<Vec<2>> vertices;         ///< m
  std::vector<std::vector<int>> cells;  ///< vertex indices of each cell, counter-clockwise
};

/// Numbering of the cells of a tessellation in messages.
struct Numbering {
  std::vector<int>
      in_file;  ///< number of each cell in a file that counts from 1; empty: numbers from 0, as they stand

  /// Returns the name of a cell, "cell 3 (from 0)", "cell 4 (from 1)".
  std::string cell(std::size_t number) const;
};

/// Largest bend that may be allowed to the faces between blocks of a solid, rad: triangles of a face that is
/// bent by more look different ways.
inline constexpr double kMostBend = std::numbers::pi / 6.0;

/// Tessellation asked for.
struct BlockParameters {
  int count = 0;  ///< number of blocks, with the finer ones
  /// Parts near which blocks are finer; empty: blocks are alike.
  std::vector<FinerPart> finer = {};
  double largest_size = 0.0;  ///< size of blocks far from these parts, m, see SizedExtent
  /// Spread of the Laguerre radii, which are uniform in [1 - spread, 1 + spread] x mean spacing / 2; in [0,
  /// 1), 0: plain Voronoi.
  double radius_spread = 0.0;
  int relaxation = 0;  ///< Lloyd iterations; 0 leaves the seeds at random
  double shortest_edge = 0.0;  ///< edges below this fraction of the mean edge are removed, in [0, 0.5]
  double largest_bend = 0.0;   ///< of a face between blocks of a solid, in [0, kMostBend], rad
  /// Tessellation of the region, made elsewhere and still to be regularised; then only `shortest_edge`
  /// counts.
  std::optional<Tessellation> tessellation;
  /// Names of the phases of the cells of `tessellation`, where they are known; `phase` holds the index of
  /// each cell into them. Then nothing is superposed.
  std::vector<std::string> phases = {};
  std::vector<int> phase = {};
  std::string place = {};  ///< place in a deck, which begins messages: "deck.toml:12: blocks"; may be empty
};

/// Blocks that are made elsewhere.
struct Cells {
  Tessellation tessellation;
  std::vector<std::string> phases;  ///< phases that the blocks can have
  std::vector<int> phase;           ///< phase of each block, index into `phases`
  /// Size that each block was to have, in the unit of the vertices, as Specimen has it; empty where blocks
  /// are alike.
  std::vector<double> size = {};
  std::vector<int> grain = {};  ///< number of the stone of each block; -1: none. Empty where none are known
  std::string origin = {};      ///< text that begins messages, such as the name of a file; may be empty
};

struct SpecimenParameters {
  Region region;
  /// Cells of the whole specimen, whose outline is the region; then only the matrix counts of the members
  /// below.
  std::optional<Cells> cells;
  std::uint64_t seed = 0;
  std::string matrix = "mortar";  ///< phase of the blocks that nothing else covers
  AggregateParameters aggregates;
  std::vector<Inclusions> inclusions;  ///< placed after the aggregates, in turn; none overlap
  BlockParameters blocks;
  Superposition superposition = Superposition::area;
  /// Fraction of a block above which it is aggregate, for Superposition::area.
  double covered_fraction = 0.5;
};

/// Throws Error when a parameter other than the region is out of range.
void require_valid(const SpecimenParameters& parameters);

/// Returns the names of the phases that the blocks can have: those of cells, of the blocks' own phases, or
/// aggregates, inclusions, matrix; each once.
std::vector<std::string> phases(const SpecimenParameters& parameters);

/// Returns those of these phases whose blocks belong to stones that are known.
std::vector<std::string> phases_of_stones(const SpecimenParameters& parameters);
/// Returns the same of cells that are made elsewhere, from the stone of each.
std::vector<std::string> phases_of_stones(const std::vector<std::string>& phases,
                                          const std::vector<int>& phase, const std::vector<int>& grain);

/// Edge of a tessellation. `left` is the cell that sees it counter-clockwise from `v0` to `v1`.
struct Edge {
  int v0, v1;
  int left;
  int right;  ///< other cell, or -1 on the outline
};

/// Returns the edges of a tessellation, each once, in the order in which the cells meet them. Throws Error
/// when an edge belongs to more than two cells or two cells see it in the same sense.
std::vector<Edge> edges(const Tessellation& tessellation, const Numbering& numbering = {});

/// Quality of the blocks; lengths in m.
struct BlockMetrics {
  double mean_edge, shortest_edge;
  int shortest_edge_cell;
  Vec<2> shortest_edge_at;
  /// Edges removed by regularisation, and edges left that are shorter than asked for.
  int edges_removed, edges_left_short;
  int seeds_redrawn;      ///< seeds drawn anew because their cell could not be made valid
  double smallest_angle;  ///< smallest angle of any zone, degrees
  int smallest_angle_cell;
  double mean_size;        ///< sqrt(mean area), the block size
  double zones_per_block;  ///< mean number of zones
};

/// Meso-scale specimen: blocks, their phases, and the outcome of the request.
struct Specimen {
  Region region;
  Tessellation tessellation;
  std::vector<std::string> phases;  ///< phases that blocks can have
  int matrix = -1;                  ///< index into `phases`; -1: not known
  std::vector<int> phase;           ///< phase of each cell, index into `phases`
  /// Grain of which each cell is, index into `aggregates` where these are known; -1: of none. May be empty
  /// where cells are made elsewhere.
  std::vector<int> grain;
  /// Size that each block was to have, m, which contact stiffnesses follow; empty where blocks are alike.
  std::vector<double> size;
  std::vector<Aggregate> aggregates;  ///< circles as placed, those of each kind largest first
  std::vector<Fibre> fibres;          ///< fibres as placed
  /// Area of circles asked for and placed, and of blocks that are not matrix, over that of the specimen.
  double fraction_asked, fraction_placed, fraction_superposed;
  double fraction_of_circles;    ///< superposed fraction before fibres were superposed
  double covered_fraction;       ///< fraction of a block above which it became aggregate
  std::vector<double> fraction;  ///< area of the blocks of each phase over that of the specimen
  BlockMetrics metrics;
};

/// Makes a specimen of cells as they are, or by gradation, placement, tessellation, regularisation and
/// superposition, in this order. The same parameters give the same specimen; aggregates and blocks draw from
/// streams of their own, so neither depends on the other's parameters. Throws Error when a parameter is out
/// of range, the aggregates do not fit, the placed fraction is off by more than 0.01, or no valid
/// tessellation can be made.
/// \param team  team that shares the cells of the tessellation out; without a team the calling thread works
///              alone
Specimen make_specimen(const SpecimenParameters& parameters, Team* team = nullptr);

/// Returns what a user should know of a specimen that differs from the request, one line each.
std::vector<std::string> warnings(const Specimen& specimen);

/// Returns the block size as a deck foresees it: square root of the specimen's area over the number of
/// blocks, m.
double block_size(const Specimen& specimen);

/// Block cut into zones.
struct ZonedBlock {
  std::vector<Vec<2>> gridpoints;         ///< the cell's vertices in its order, then interior points; m
  std::vector<std::array<int, 3>> zones;  ///< counter-clockwise gridpoint indices
};

/// Cuts a convex cell (corners counter-clockwise, m) into triangles around its centroid, one for each edge.
ZonedBlock zone_block(const std::vector<Vec<2>>& corners);

}  // namespace pyroclast::specimen
