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
#include "pyroclast/specimen/cells.hpp"
#include "pyroclast/specimen/region.hpp"
#include "pyroclast/specimen/surface.hpp"

namespace pyroclast::specimen {

/// Largest seed of the random numbers of a specimen; decks and the command line take 0 and up.
inline constexpr std::int64_t kLargestSeed = 9'000'000'000'000'000;

/// Aggregate as placed, before blocks take its place: a circle, in a solid a ball, or a shape of its own.
template <int Dim>
struct Stone {
  Vec<Dim> centre;  ///< m
  /// Diameter, m; of another shape its width: the sieve that it passes.
  double diameter;
  int phase = 0;  ///< index into the specimen's phases
  int kind = 0;   ///< 0 for the first aggregates, then counting the inclusions that are stones, in turn
  std::shared_ptr<const Surface<Dim>> shape = {};  ///< shape around the centre; none: it is round
};

/// Straight fibre as placed: the blocks that it crosses become its phase.
template <int Dim>
struct Fibre {
  Vec<Dim> from, to;  ///< m
  int phase = 0;      ///< index into Specimen::phases
};

/// Stone that is known, read from a list.
template <int Dim>
struct KnownStone {
  Vec<Dim> centre;    ///< m
  double diameter;    ///< m, as of a stone
  std::string phase;  ///< phase of the stone
  std::string place;  ///< place that states the stone, "stones.csv:7", for errors
  std::shared_ptr<const Surface<Dim>> shape = {};  ///< shape around the centre; none: it is round
};
/// Stones that are known, of a plane or of a solid.
using KnownStones = std::variant<std::vector<KnownStone<2>>, std::vector<KnownStone<3>>>;

enum class StoneShape : std::uint8_t {
  circle,    ///< a ball in a solid
  ellipse,   ///< an ellipse of this elongation, in a solid an ellipsoid
  polygon,   ///< convex, with corners at random on an ellipse (Wang, Kwan and Chan 1999); so in a solid
  harmonics  ///< r(angle) = 1 + sum D_n cos(n angle + phase_n) with n from 3 on, drawn out to the elongation;
             ///< in a solid with spherical harmonics of the degrees n
};

/// Numbers between two bounds, each as likely as the other.
struct Spread {
  double low, high;
};

/// Shapes of stones asked for.
struct ShapeParameters {
  StoneShape kind = StoneShape::circle;
  Spread elongation{1.0, 1.0};                ///< length over width
  Spread flatness{1.0, 1.0};                  ///< in a solid: width over thickness
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
  KnownStones stones = {};  ///< stones as they lie; with any nothing is drawn or placed
  ShapeParameters shape = {};
  double minimum_gap = 0.0;  ///< smallest distance between aggregates and to the outline, m
  int attempts = 0;          ///< random centres tried for one aggregate before placing fails
  std::string place = "";    ///< place that asks for them, "mine.toml:12: aggregates", for errors

  /// Tells whether the stones are known.
  bool are_known() const {
    return std::visit([](const auto& list) { return !list.empty(); }, stones);
  }
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
  each,      ///< the same, but each stone, the largest first, has a block before
  centroid,  ///< a block is of the aggregate in whose circle its centroid lies
  follow     ///< nothing is superposed: blocks follow the surfaces of stones, by mirrored seeds
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
  int relaxation = 0;          ///< Lloyd iterations; 0 leaves the seeds at random
  double shortest_edge = 0.0;  ///< edges below this fraction of the mean edge are removed, in [0, 0.5]
  double largest_bend = 0.0;   ///< of a face between blocks of a solid, in [0, kMostBend], rad
  /// Tessellation of the region, made elsewhere and still to be regularised; then only `shortest_edge`
  /// counts.
  std::optional<Cells<2>> cells;
  /// Names of the phases of these cells, where they are known; `phase` holds the index of
  /// each cell into them. Then nothing is superposed.
  std::vector<std::string> phases = {};
  std::vector<int> phase = {};
  std::string place = {};  ///< place in a deck, which begins messages: "deck.toml:12: blocks"; may be empty
};

/// Blocks that are made elsewhere.
template <int Dim>
struct GivenCells {
  Cells<Dim> cells;
  std::vector<std::string> phases;  ///< phases that the blocks can have
  std::vector<int> phase;           ///< phase of each block, index into `phases`
  std::vector<double> size = {};    ///< size that each block was to have, m; empty where blocks are alike
  std::vector<int> stone = {};  ///< number of the stone of each block; -1: none. Empty where none are known
  OutlineOf<Dim> outline = {};  ///< outline of all cells together; in the plane `completed` finds it
  std::string origin = {};      ///< text that begins messages, such as the name of a file; may be empty
};

/// Specimen that is asked for, in the plane or in space.
struct SpecimenParameters {
  std::variant<Region, Prism> outline;
  /// Cells of the whole specimen; then only the outline, the matrix and the number of blocks count beside
  /// them.
  std::variant<std::monostate, GivenCells<2>, GivenCells<3>> cells;
  std::uint64_t seed = 0;
  std::string matrix = "mortar";  ///< phase of the blocks that nothing else covers
  AggregateParameters aggregates;
  std::vector<Inclusions> inclusions;  ///< placed after the aggregates, in turn; none overlap
  BlockParameters blocks;
  Superposition superposition = Superposition::area;
  /// Fraction of a block above which it is aggregate, for Superposition::area.
  double covered_fraction = 0.5;

  /// Returns the region or the prism; null where the outline is the other.
  const Region* region() const { return std::get_if<Region>(&outline); }
  const Prism* prism() const { return std::get_if<Prism>(&outline); }
  int dimension() const { return prism() ? 3 : 2; }  ///< Returns 2 or 3.
  const std::vector<Side>& sides() const;            ///< Returns the sides of the outline.
  std::vector<FlatPart> flat_parts() const;          ///< Returns the flat parts of the outline.
  Vec<3> low() const;                                ///< Returns the lower corner of the box around it, m.
  Vec<3> high() const;                               ///< Returns the upper corner, m.
  /// Returns the distance of a point from the outline, m, negative or 0 within the specimen.
  double distance(const Vec<3>& point) const;
  double extent() const;  ///< Returns the area, m², of a solid the volume, m³.
  /// Tells whether all blocks come from a file; then no seed counts.
  bool is_of_file() const { return cells.index() > 0; }
  /// Returns the size of a block as foreseen, m: the root of the mean area, of a solid of the mean volume. 0
  /// where the number of blocks is not known.
  double block_size() const;
  /// Returns the size of blocks far from finer ones, m; as above where blocks are alike.
  double largest_block_size() const;
};

/// Throws Error when a parameter other than the outline is out of range.
void require_valid(const SpecimenParameters& parameters);

/// Tells whether stones of a kind have shapes, and are not all round.
bool has_shapes(const AggregateParameters& kind);

/// Returns the kinds of stones: the aggregates, then the inclusions that are stones.
std::vector<const AggregateParameters*> stone_kinds(const SpecimenParameters& parameters);

/// Returns the names of the phases that the blocks can have: those of cells, of the blocks' own phases, or
/// aggregates, inclusions, matrix; each once.
std::vector<std::string> phases(const SpecimenParameters& parameters);

/// Returns those of these phases, but for the matrix, whose blocks belong to stones that are known.
std::vector<std::string> phases_of_stones(const SpecimenParameters& parameters);

/// Quality of blocks in the plane or in space; lengths in m.
struct CommonMetrics {
  double mean_size = 0.0;        ///< root of the mean area, cube root of the mean volume: the block size
  double shortest_edge = 0.0;    ///< shortest edge of any block
  double zones_per_block = 0.0;  ///< mean number of zones
  int vertices_merged = 0;       ///< vertices that became one with another; in the plane edges that are gone
  int edges_left_short = 0;      ///< edges left by regularisation that are shorter than asked for
  int seeds_redrawn = 0;         ///< seeds drawn anew because their cell could not be made valid
};

template <int Dim>
struct Metrics;

/// Quality of blocks in the plane.
template <>
struct Metrics<2> : CommonMetrics {
  double mean_edge = 0.0;
  int shortest_edge_cell = -1;
  Vec<2> shortest_edge_at{};
  double smallest_angle = 0.0;  ///< smallest angle of any zone, degrees
  int smallest_angle_cell = -1;
};

/// Quality of blocks in space.
template <>
struct Metrics<3> : CommonMetrics {
  double lowest_zone = 0.0;   ///< least height of any zone over one of its faces
  int lowest_zone_cell = -1;  ///< cell of this zone
  int most_corners = 0;       ///< most corners of a face between blocks
  double largest_bend = 0.0;  ///< largest bend of a face, see bend(); degrees
};

/// Measures blocks.
/// \param done  metrics that say what has been done to the blocks, which stays in the result
Metrics<2> measure(const Cells<2>& cells, const Metrics<2>& done = {});
Metrics<3> measure(const Cells<3>& cells, const Prism& body, const Metrics<3>& done = {});

/// Stones of a range of sizes: what was asked for, and what became of it. Shares are of the extent of the
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

/// Meso-scale specimen: blocks, their phases, and the outcome of the request. Shares are of its area, in
/// space of its volume.
template <int Dim>
struct Specimen {
  OutlineOf<Dim> outline = {};
  Cells<Dim> cells = {};
  std::vector<std::string> phases = {};  ///< phases that blocks can have
  int matrix = -1;                       ///< index into `phases`; -1: not known
  std::vector<int> phase = {};           ///< phase of each cell, index into `phases`
  /// Stone of which each cell is, index into `stones` where these are known; -1: of none. May be empty where
  /// cells are made elsewhere.
  std::vector<int> stone = {};
  /// Size that each block was to have, m, which contact stiffnesses follow; empty where blocks are alike.
  std::vector<double> size = {};
  std::vector<Stone<Dim>> stones = {};  ///< stones as placed, those of each kind largest first
  std::vector<Fibre<Dim>> fibres = {};  ///< fibres as placed
  /// Share of stones asked for and placed, and of blocks that are not matrix.
  double fraction_asked = 0.0, fraction_placed = 0.0, fraction_superposed = 0.0;
  double fraction_of_stones = 0.0;      ///< superposed share before fibres were superposed
  double covered_fraction = 0.0;        ///< share of a block above which it became aggregate
  std::vector<double> fraction = {};    ///< share of the blocks of each phase
  std::vector<SizeClass> classes = {};  ///< stones asked for by their sizes
  int small_stones = 0;  ///< stones in space that are smaller than three of the blocks around them
  Metrics<Dim> metrics = {};
};

/// Makes a specimen of cells as they are, or by gradation, placement, tessellation, regularisation and
/// superposition, in this order. The same parameters give the same specimen; aggregates and blocks draw from
/// streams of their own, so neither depends on the other's parameters. Throws Error when a parameter is out
/// of range, the aggregates do not fit, the placed fraction is off by more than 0.01, or no valid
/// tessellation can be made.
/// \param team  team that shares the cells of the tessellation out; without a team the calling thread works
///              alone
template <int Dim = 2>
Specimen<Dim> make_specimen(const SpecimenParameters& parameters, Team* team = nullptr);

/// Measures a specimen whose cells and their phases are known: adds the shares of phases and the metrics.
template <int Dim>
void measure(Specimen<Dim>& specimen, const Metrics<Dim>& done = {});

/// Returns the block size as a deck foresees it, m: of the mean extent.
template <int Dim>
double block_size(const Specimen<Dim>& specimen) {
  return side_of<Dim>(specimen.outline.extent() / static_cast<double>(specimen.cells.cells.size()));
}

/// Returns what a user should know of a specimen that differs from the request, one line each.
std::vector<std::string> warnings(const Specimen<2>& specimen);
std::vector<std::string> warnings(const Specimen<3>& specimen);

}  // namespace pyroclast::specimen
