#include "pyroclast/specimen/specimen.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <string_view>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "pyroclast/base/error.hpp"
#include "pyroclast/base/place_in.hpp"
#include "pyroclast/base/random.hpp"
#include "pyroclast/specimen/blocks.hpp"
#include "pyroclast/specimen/from_cells.hpp"
#include "pyroclast/specimen/gradation.hpp"
#include "pyroclast/specimen/grain.hpp"
#include "pyroclast/specimen/grain_grid.hpp"
#include "pyroclast/specimen/metrics.hpp"
#include "pyroclast/specimen/placement.hpp"
#include "pyroclast/specimen/polygon.hpp"
#include "pyroclast/specimen/superposition.hpp"
#include "pyroclast/specimen/topology.hpp"

namespace pyroclast::specimen {
namespace {

/// Way out of a message about a notch in a grain.
constexpr std::string_view kOnlyCircles = ": notches cut through circles alone, so an outline must end there";
/// Largest change of the aggregates' area by superposition that gives no warning, as a share.
constexpr double kSmallChange = 0.1;

void require(bool condition, std::string_view what, double value, std::string_view allowed) {
  if (!condition) throw Error(fmt::format("{} is {:.6g}; allowed is {}.", what, value, allowed));
}

void require_valid(const AggregateParameters& p) {
  if (!p.stones.empty()) return;  // add_stones tests them
  require(p.fraction >= 0.0 && p.fraction < 1.0, "The aggregate fraction", p.fraction, "0 to below 1");
  if (p.fraction == 0.0) return;
  require(p.d_min > 0.0, "The smallest aggregate diameter", p.d_min, "a positive length");
  require(p.d_max > p.d_min, "The largest aggregate diameter", p.d_max, "more than the smallest");
  require(p.fuller_exponent > 0.0 && p.fuller_exponent <= 1.0, "The Fuller exponent", p.fuller_exponent,
          "above 0, up to 1");
  require(p.minimum_gap >= 0.0, "The minimum gap between aggregates", p.minimum_gap, "0 or more");
  require(p.attempts > 0, "The number of attempts to place an aggregate", p.attempts, "1 or more");
  const bool has_curve =
      p.passing.empty() || (p.passing.size() == p.sieves.size() && p.passing.front() == 0.0 &&
                            p.passing.back() == 1.0 && std::is_sorted(p.passing.begin(), p.passing.end()));
  if (!has_curve) throw Error("The shares that pass the sieves must ascend from 0 to 1, one for each sieve.");
  const bool ascending =
      std::adjacent_find(p.sieves.begin(), p.sieves.end(), std::greater_equal<>()) == p.sieves.end();
  if (p.sieves.size() < 2 || !ascending || p.sieves.front() != p.d_min || p.sieves.back() != p.d_max) {
    throw Error(
        fmt::format("The sieves are [{}] m; allowed are ascending sizes from d_min = {} m to d_max = {} m.",
                    fmt::join(p.sieves, ", "), p.d_min, p.d_max));
  }
}

void require_valid(const FibreParameters& p) {
  require(p.count >= 0, "The number of fibres", p.count, "0 or more");
  require(p.length > 0.0, "The length of fibres", p.length, "a positive length");
  require(p.minimum_gap >= 0.0, "The minimum gap of fibres", p.minimum_gap, "0 or more");
  require(p.attempts > 0, "The number of attempts to place a fibre", p.attempts, "1 or more");
}

void require_valid(const BlockParameters& p) {
  require(p.shortest_edge >= 0.0 && p.shortest_edge <= 0.5, "The shortest edge", p.shortest_edge,
          "0 to 0.5 of the mean edge");
  require(p.largest_bend >= 0.0 && p.largest_bend <= kMostBend, "The largest bend", p.largest_bend,
          "0 to pi / 6");
  if (p.tessellation && !p.phases.empty() && p.phase.size() != p.tessellation->cells.size())
    throw Error(fmt::format("The phases of {} blocks are known; allowed are the phases of all {}.",
                            p.phase.size(), p.tessellation->cells.size()));
  if (p.tessellation) return;
  require(p.count >= 1, "The number of blocks", p.count, "1 or more");
  require(p.radius_spread >= 0.0 && p.radius_spread < 1.0, "The radius spread", p.radius_spread,
          "0 to below 1");
  for (const FinerPart& part : p.finer) {
    require(part.size > 0.0 && part.size < p.largest_size, "The size of finer blocks", part.size,
            "above 0, below that of the others");
    require(part.distance >= 0.0, "The distance of finer blocks", part.distance, "0 or more");
  }
  require(p.relaxation >= 0, "The number of relaxation steps", p.relaxation, "0 or more");
}

}  // namespace

void require_valid(const SpecimenParameters& p) {
  require(p.covered_fraction >= 0.0 && p.covered_fraction < 1.0, "The covered fraction", p.covered_fraction,
          "0 to below 1");
  require_valid(p.aggregates);
  for (const Inclusions& kind : p.inclusions) std::visit([](const auto& k) { require_valid(k); }, kind);
  require_valid(p.blocks);
}

namespace {

/// Returns the end of a message that names the side or notch on which a grain with an outline lies; empty
/// where it lies on none.
std::string side_under(const Aggregate& grain, const Region& region, double tolerance) {
  if (!grain.shape) return {};
  const auto told = [&](const Side& side, const Vec<2>& from, const Vec<2>& to) {
    if (!are_closer(grain, from, to, -tolerance)) return std::string();
    return fmt::format(", but on \"{}\"{}", side.name, side.is_cut ? kOnlyCircles : "");
  };
  for (const auto& [from, to, side] : region.pieces())
    if (std::string text = told(region.sides()[side], from, to); !text.empty()) return text;
  for (const Notch& notch : region.notches())
    if (notch.width == 0.0)
      if (std::string text = told({notch.name, false, true}, notch.mouth, notch.tip); !text.empty())
        return text;
  return {};
}

/// Adds stones that are known. Throws Error where one does not lie in the specimen, or lies on another.
void add_stones(const SpecimenParameters& p, const AggregateParameters& asked, int kind, Specimen& specimen) {
  const Room<2> of_circles = room_in(p.region), of_outlines = room_of_blocks(p.region);
  GrainGrid<2> grid(p.region.box().low, p.region.box().high, 2.0 * asked.d_min);
  for (const Aggregate& circle : specimen.aggregates) grid.insert(circle);
  std::vector<Aggregate> circles;
  for (const Stone& stone : asked.stones) {
    const double tolerance = kTouching * stone.diameter;
    const auto fail = [&](std::string_view what) {
      throw Error(fmt::format("{}: {}: the stone of {:.6g} mm at ({:.6g}, {:.6g}) mm {}", asked.place,
                              stone.place, 1e3 * stone.diameter, 1e3 * stone.centre[0], 1e3 * stone.centre[1],
                              what));
    };
    const Aggregate circle{stone.centre, stone.diameter, place_in(specimen.phases, stone.phase), kind,
                           stone.shape};
    if (!lies_within(circle, stone.shape ? of_outlines : of_circles, -tolerance))
      fail("does not lie in the specimen, all of it" + side_under(circle, p.region, tolerance));
    if (grid.overlaps(circle, -tolerance)) fail("lies on another: stones may touch, and not overlap");
    grid.insert(circle);
    circles.push_back(circle);
  }
  std::stable_sort(circles.begin(), circles.end(),
                   [](const Aggregate& a, const Aggregate& b) { return a.diameter > b.diameter; });
  specimen.aggregates.insert(specimen.aggregates.end(), circles.begin(), circles.end());
}

/// Adds circles of one kind to those that the specimen has.
void add_aggregates(const SpecimenParameters& p, const AggregateParameters& asked, int kind, Random& random,
                    Specimen& specimen) {
  specimen.fraction_asked += asked.fraction;
  if (!asked.stones.empty()) return add_stones(p, asked, kind, specimen);
  if (asked.fraction == 0.0) return;
  const bool are_round = asked.shape.kind == GrainShape::circle;
  draw_and_place(are_round ? room_in(p.region) : room_of_blocks(p.region), asked,
                 place_in(specimen.phases, asked.phase), kind, random, specimen.aggregates);
}

void add_fibres(const SpecimenParameters& p, const FibreParameters& kind, Random& random,
                Specimen& specimen) {
  for (Fibre& fibre : place_fibres(kind, p.region, specimen.aggregates, random)) {
    fibre.phase = place_in(specimen.phases, kind.phase);
    specimen.fibres.push_back(fibre);
  }
}

/// Returns the share of the specimen's area that blocks take for which `counts(phase)` holds.
template <class Counts>
double fraction_of(const Specimen& specimen, Counts counts) {
  double sum = 0.0;
  std::vector<Vec<2>> polygon;
  for (std::size_t c = 0; c < specimen.phase.size(); ++c) {
    if (!counts(specimen.phase[c])) continue;
    corners(specimen.tessellation, c, polygon);
    sum += area(polygon);
  }
  return sum / specimen.region.area();
}

void add_once(const std::string& name, std::vector<std::string>& names) {
  if (std::ranges::find(names, name) == names.end()) names.push_back(name);
}

/// Adds the phases of stones.
void add_phases_of(const AggregateParameters& kind, std::vector<std::string>& names) {
  if (kind.stones.empty()) add_once(kind.phase, names);
  for (const Stone& stone : kind.stones) add_once(stone.phase, names);
}

}  // namespace

double block_size(const Specimen& specimen) {
  return std::sqrt(specimen.region.area() / static_cast<double>(specimen.tessellation.cells.size()));
}

std::vector<std::string> phases(const SpecimenParameters& parameters) {
  if (parameters.cells) return parameters.cells->phases;
  if (!parameters.blocks.phases.empty()) return parameters.blocks.phases;
  std::vector<std::string> names;
  add_phases_of(parameters.aggregates, names);
  for (const Inclusions& kind : parameters.inclusions)
    if (const auto* circles = std::get_if<AggregateParameters>(&kind))
      add_phases_of(*circles, names);
    else
      add_once(std::get<FibreParameters>(kind).phase, names);
  add_once(parameters.matrix, names);
  return names;
}

std::vector<std::string> phases_of_stones(const SpecimenParameters& parameters) {
  if (const auto& cells = parameters.cells)
    return phases_of_stones(cells->phases, cells->phase, cells->grain);
  if (!parameters.blocks.phases.empty()) return {};
  std::vector<std::string> names;
  add_phases_of(parameters.aggregates, names);
  for (const Inclusions& kind : parameters.inclusions)
    if (const auto* circles = std::get_if<AggregateParameters>(&kind)) add_phases_of(*circles, names);
  return names;
}

std::vector<std::string> phases_of_stones(const std::vector<std::string>& phases,
                                          const std::vector<int>& phase, const std::vector<int>& grain) {
  std::vector<std::string> names;
  for (std::size_t cell = 0; cell < grain.size(); ++cell)
    if (grain[cell] >= 0) add_once(phases[phase[cell]], names);
  return names;
}

std::vector<std::string> warnings(const Specimen& s) {
  if (s.fraction_placed == 0.0) return {};
  const double change = s.fraction_of_circles / s.fraction_placed - 1.0;
  if (std::abs(change) <= kSmallChange) return {};
  // blocks that follow grains have no covered fraction
  const char* const remedy =
      s.covered_fraction > 0.0 ? "more blocks, or [superposition] rule = \"fit\"" : "more blocks";
  return {
      fmt::format("aggregates take {:.3f} of the specimen as blocks, {:.0f} % {} than the {:.3f} that were "
                  "placed: blocks of {:.1f} mm are too large for them; {}",
                  s.fraction_of_circles, 100.0 * std::abs(change), change < 0.0 ? "less" : "more",
                  s.fraction_placed, 1e3 * s.metrics.mean_size, remedy)};
}

Specimen make_specimen(const SpecimenParameters& parameters, Team* team) {
  if (parameters.cells) {
    Specimen specimen = specimen_from(*parameters.cells, parameters.region);
    specimen.matrix = place_in(specimen.phases, parameters.matrix);
    return specimen;
  }
  require(parameters.region.area() > 0.0, "The area of the specimen", parameters.region.area(),
          "a positive area");
  require_valid(parameters);
  // Aggregates and blocks draw from streams of their own: another number of blocks leaves the aggregates
  // where they are.
  Random aggregate_random(2 * parameters.seed);
  Random block_random(2 * parameters.seed + 1);
  const double specimen_area = parameters.region.area();

  Specimen specimen{};
  specimen.region = parameters.region;
  specimen.phases = phases(parameters);
  int kind = 0;
  add_aggregates(parameters, parameters.aggregates, kind, aggregate_random, specimen);
  for (const Inclusions& inclusions : parameters.inclusions)
    if (const auto* circles = std::get_if<AggregateParameters>(&inclusions))
      add_aggregates(parameters, *circles, ++kind, aggregate_random, specimen);
    else
      add_fibres(parameters, std::get<FibreParameters>(inclusions), aggregate_random, specimen);
  specimen.fraction_placed = extent_of(std::span<const Aggregate>(specimen.aggregates)) / specimen_area;
  require_placed(specimen.fraction_placed, specimen.fraction_asked, parameters.aggregates);

  const bool follows = parameters.superposition == Superposition::follow;
  const std::span<const Aggregate> followed =
      follows ? std::span<const Aggregate>(specimen.aggregates) : std::span<const Aggregate>();
  Blocks blocks = make_blocks(parameters.blocks, parameters.region, block_random, team, followed);
  specimen.tessellation = std::move(blocks.tessellation);
  specimen.size = std::move(blocks.size);
  if (blocks.phase.empty()) {
    const int matrix = specimen.matrix = place_in(specimen.phases, parameters.matrix);
    if (follows) {
      specimen.grain = std::move(blocks.grain);
      specimen.grain.resize(specimen.tessellation.cells.size(), -1);
      for (const int grain : specimen.grain)
        specimen.phase.push_back(grain < 0 ? matrix : specimen.aggregates[grain].phase);
    } else {
      Superposed superposed = superpose(specimen.tessellation, specimen.aggregates, parameters, matrix);
      specimen.covered_fraction = superposed.covered_fraction;
      specimen.phase = std::move(superposed.phase);
      specimen.grain = std::move(superposed.grain);
    }
    specimen.fraction_of_circles = fraction_of(specimen, [&](int phase) { return phase != matrix; });
    superpose(specimen.tessellation, specimen.fibres, specimen.phase, specimen.grain);
    specimen.fraction_superposed = fraction_of(specimen, [&](int phase) { return phase != matrix; });
  } else {
    specimen.phase = std::move(blocks.phase);
  }
  for (int phase = 0; phase < static_cast<int>(specimen.phases.size()); ++phase)
    specimen.fraction.push_back(fraction_of(specimen, [&](int p) { return p == phase; }));

  specimen.metrics = measure(specimen.tessellation);
  specimen.metrics.edges_removed = blocks.edges_removed;
  specimen.metrics.edges_left_short = blocks.edges_left_short;
  specimen.metrics.seeds_redrawn = blocks.seeds_redrawn;
  return specimen;
}

}  // namespace pyroclast::specimen
