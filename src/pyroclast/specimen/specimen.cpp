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
#include "pyroclast/specimen/placement.hpp"
#include "pyroclast/specimen/polygon.hpp"
#include "pyroclast/specimen/stone.hpp"
#include "pyroclast/specimen/stone_grid.hpp"
#include "pyroclast/specimen/superposition.hpp"
#include "pyroclast/specimen/topology.hpp"

namespace pyroclast::specimen {
namespace {

/// Way out of a message about a notch in a stone.
constexpr std::string_view kOnlyCircles = ": notches cut through circles alone, so an outline must end there";
/// Largest change of the aggregates' area by superposition that gives no warning, as a share.
constexpr double kSmallChange = 0.1;
/// Diameter, in block sizes, below which the shape of a stone in space depends on the blocks, and the
/// strength of the body with it (docs/validation/solid_strengths.md, "The size of blocks").
constexpr double kSmallestStone = 3.0;

void require(bool condition, std::string_view what, double value, std::string_view allowed) {
  if (!condition) throw Error(fmt::format("{} is {:.6g}; allowed is {}.", what, value, allowed));
}

void require_valid(const AggregateParameters& p) {
  if (p.are_known()) return;  // add_stones tests them
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
  if (p.cells && !p.phases.empty() && p.phase.size() != p.cells->cells.size())
    throw Error(fmt::format("The phases of {} blocks are known; allowed are the phases of all {}.",
                            p.phase.size(), p.cells->cells.size()));
  if (p.cells) return;
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

/// Returns the end of a message that names the side or notch on which a stone with an outline lies; empty
/// where it lies on none.
std::string side_under(const Stone<2>& stone, const Region& region, double tolerance) {
  if (!stone.shape) return {};
  const auto told = [&](const Side& side, const Vec<2>& from, const Vec<2>& to) {
    if (!are_closer(stone, from, to, -tolerance)) return std::string();
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

/// Nothing that a stone in space lies on is named yet.
std::string side_under(const Stone<3>& /*stone*/, const Prism& /*body*/, double /*tolerance*/) {
  return {};
}

/// Adds stones that are known. Throws Error where one does not lie in the specimen, or lies on another.
template <int Dim>
void add_listed(const AggregateParameters& asked, int kind, Specimen<Dim>& specimen) {
  const auto* const listed = std::get_if<std::vector<KnownStone<Dim>>>(&asked.stones);
  if (!listed) throw Error(fmt::format("{}: the stones belong to another dimension", asked.place));
  const Room<Dim> of_round = room_in(specimen.outline), of_shapes = room_of_blocks(specimen.outline);
  StoneGrid<Dim> grid(specimen.outline.low(), specimen.outline.high(), 2.0 * asked.d_min);
  for (const Stone<Dim>& stone : specimen.stones) grid.insert(stone);
  std::vector<Stone<Dim>> stones;
  for (const KnownStone<Dim>& known : *listed) {
    const double tolerance = kTouching * known.diameter;
    const auto fail = [&](std::string_view what) {
      std::vector<std::string> at;
      for (const double x : known.centre.c) at.push_back(fmt::format("{:.6g}", 1e3 * x));
      throw Error(fmt::format("{}: {}: the stone of {:.6g} mm at ({}) mm {}", asked.place, known.place,
                              1e3 * known.diameter, fmt::join(at, ", "), what));
    };
    const Stone<Dim> stone{known.centre, known.diameter, place_in(specimen.phases, known.phase), kind,
                           known.shape};
    if (!lies_within(stone, stone.shape ? of_shapes : of_round, -tolerance))
      fail("does not lie in the specimen, all of it" + side_under(stone, specimen.outline, tolerance));
    if (grid.overlaps(stone, -tolerance)) fail("lies on another: stones may touch, and not overlap");
    grid.insert(stone);
    stones.push_back(stone);
  }
  std::ranges::stable_sort(stones, std::greater<>(), &Stone<Dim>::diameter);
  specimen.stones.insert(specimen.stones.end(), stones.begin(), stones.end());
}

/// Adds stones of one kind to those that the specimen has.
template <int Dim>
void add_stones(const AggregateParameters& asked, int kind, Random& random, Specimen<Dim>& specimen) {
  specimen.fraction_asked += asked.fraction;
  if (asked.are_known()) return add_listed(asked, kind, specimen);
  if (asked.fraction == 0.0) return;
  draw_and_place(
      asked.shape.kind == StoneShape::circle ? room_in(specimen.outline) : room_of_blocks(specimen.outline),
      asked, place_in(specimen.phases, asked.phase), kind, random, specimen.stones);
}

template <int Dim>
void add_fibres(const FibreParameters& kind, Random& random, Specimen<Dim>& specimen) {
  for (Fibre<Dim>& fibre : place_fibres<Dim>(kind, specimen.outline, specimen.stones, random)) {
    fibre.phase = place_in(specimen.phases, kind.phase);
    specimen.fibres.push_back(fibre);
  }
}

/// Adds all stones and fibres, kind by kind in the order of the parameters.
template <int Dim>
void add_inclusions(const SpecimenParameters& p, Random& random, Specimen<Dim>& specimen) {
  int kind = 0;
  add_stones(p.aggregates, kind, random, specimen);
  for (const Inclusions& inclusions : p.inclusions)
    if (const auto* stones = std::get_if<AggregateParameters>(&inclusions))
      add_stones(*stones, ++kind, random, specimen);
    else
      add_fibres(std::get<FibreParameters>(inclusions), random, specimen);
  specimen.fraction_placed =
      extent_of(std::span<const Stone<Dim>>(specimen.stones)) / specimen.outline.extent();
  const auto kinds = stone_kinds(p);
  const auto with_largest = std::ranges::max_element(
      kinds, {}, [](const auto* asked) { return asked->fraction > 0.0 ? asked->d_min : 0.0; });
  require_placed(specimen.fraction_placed, specimen.fraction_asked, **with_largest);
}

/// Returns the share of the specimen that blocks take which are not of the matrix.
template <int Dim>
double share_beside_matrix(const Specimen<Dim>& specimen) {
  double sum = 0.0;
  for (std::size_t cell = 0; cell < specimen.phase.size(); ++cell)
    if (specimen.phase[cell] != specimen.matrix) sum += extent(specimen.cells, cell);
  return sum / specimen.outline.extent();
}

/// Throws Error for what a solid cannot have yet.
void require_of_space(const SpecimenParameters& p) {
  if (p.blocks.cells) throw Error("a solid cannot be made of cells of a plane");
  if (p.blocks.relaxation != 0) throw Error("the cells of a solid cannot be relaxed yet");
  for (const auto* const kind : stone_kinds(p)) {
    if (has_shapes(*kind) && p.superposition != Superposition::follow &&
        p.superposition != Superposition::centroid)
      throw Error("shapes of a solid are superposed by the centroids of blocks, or followed");
  }
}

/// Returns the size classes of all kinds: the intervals between their sieves.
template <int Dim>
std::vector<SizeClass> classes_of(const SpecimenParameters& p, const Specimen<Dim>& specimen) {
  const auto kinds = stone_kinds(p);
  const double whole = specimen.outline.extent();
  std::vector<double> superposed(specimen.stones.size());
  for (std::size_t cell = 0; cell < specimen.stone.size(); ++cell)
    if (const int stone = specimen.stone[cell]; stone >= 0)
      superposed[stone] += extent(specimen.cells, cell) / whole;
  std::vector<SizeClass> classes;
  for (int kind = 0; kind < static_cast<int>(kinds.size()); ++kind) {
    const auto& asked = *kinds[kind];
    if (asked.fraction == 0.0 || asked.are_known()) continue;
    for (std::size_t i = 1; i < asked.sieves.size(); ++i) {
      const double from = asked.sieves[i - 1], to = asked.sieves[i];
      SizeClass& its = classes.emplace_back(SizeClass{.kind = kind, .from = from, .to = to});
      its.asked = asked.fraction * (passing(asked, to) - passing(asked, from));
      const bool is_last = i + 1 == asked.sieves.size();
      for (std::size_t b = 0; b < specimen.stones.size(); ++b) {
        const Stone<Dim>& stone = specimen.stones[b];
        if (stone.kind != kind || stone.diameter < from ||
            (is_last ? stone.diameter > to : stone.diameter >= to))
          continue;
        ++its.stones;
        its.placed += extent(stone) / whole;
        its.superposed += superposed[b];
        if (superposed[b] == 0.0) ++its.without_a_block;
      }
    }
  }
  return classes;
}

void add_once(const std::string& name, std::vector<std::string>& names) {
  if (std::ranges::find(names, name) == names.end()) names.push_back(name);
}

/// Adds the phases of stones.
void add_phases_of(const AggregateParameters& kind, std::vector<std::string>& names) {
  if (!kind.are_known()) add_once(kind.phase, names);
  std::visit(
      [&](const auto& list) {
        for (const auto& stone : list) add_once(stone.phase, names);
      },
      kind.stones);
}

/// Calls a function of the cells that are made elsewhere.
template <class F>
auto of_cells(const SpecimenParameters& p, F f) {
  const auto* solid = std::get_if<GivenCells<3>>(&p.cells);
  return solid ? f(*solid) : f(std::get<GivenCells<2>>(p.cells));
}

}  // namespace

const std::vector<Side>& SpecimenParameters::sides() const {
  return std::visit(
      [](const auto& o) -> const auto& { return o.sides(); }, outline);
}

std::vector<FlatPart> SpecimenParameters::flat_parts() const {
  return std::visit([](const auto& o) { return o.flat_parts(); }, outline);
}

Vec<3> SpecimenParameters::low() const {
  return std::visit([](const auto& o) { return resized<3>(o.low()); }, outline);
}

Vec<3> SpecimenParameters::high() const {
  return std::visit([](const auto& o) { return resized<3>(o.high()); }, outline);
}

double SpecimenParameters::distance(const Vec<3>& point) const {
  return prism() ? prism()->distance(point) : region()->distance(resized<2>(point));
}

double SpecimenParameters::extent() const {
  return std::visit([](const auto& o) { return o.extent(); }, outline);
}

double SpecimenParameters::block_size() const {
  if (blocks.count == 0) return 0.0;
  return prism() ? side_of<3>(extent() / blocks.count) : side_of<2>(extent() / blocks.count);
}

double SpecimenParameters::largest_block_size() const {
  return blocks.finer.empty() ? block_size() : blocks.largest_size;
}

bool has_shapes(const AggregateParameters& kind) {
  if (!kind.are_known()) return kind.shape.kind != StoneShape::circle;
  return std::visit(
      [](const auto& list) {
        return std::ranges::any_of(list, [](const auto& stone) { return stone.shape != nullptr; });
      },
      kind.stones);
}

std::vector<const AggregateParameters*> stone_kinds(const SpecimenParameters& parameters) {
  std::vector<const AggregateParameters*> kinds{&parameters.aggregates};
  for (const Inclusions& inclusions : parameters.inclusions)
    if (const auto* stones = std::get_if<AggregateParameters>(&inclusions)) kinds.push_back(stones);
  return kinds;
}

std::vector<std::string> phases(const SpecimenParameters& parameters) {
  if (parameters.is_of_file()) return of_cells(parameters, [](const auto& given) { return given.phases; });
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
  std::vector<std::string> names;
  if (parameters.is_of_file()) {
    of_cells(parameters, [&](const auto& given) {
      for (std::size_t cell = 0; cell < given.stone.size(); ++cell)
        if (given.stone[cell] >= 0) add_once(given.phases[given.phase[cell]], names);
    });
  } else if (parameters.blocks.phases.empty()) {
    for (const auto* const kind : stone_kinds(parameters)) add_phases_of(*kind, names);
  }
  std::erase(names, parameters.matrix);
  return names;
}

std::vector<std::string> warnings(const Specimen<2>& s) {
  if (s.fraction_placed == 0.0) return {};
  const double change = s.fraction_of_stones / s.fraction_placed - 1.0;
  if (std::abs(change) <= kSmallChange) return {};
  // blocks that follow stones have no covered fraction
  const char* const remedy =
      s.covered_fraction > 0.0 ? "more blocks, or [superposition] rule = \"fit\"" : "more blocks";
  return {
      fmt::format("aggregates take {:.3f} of the specimen as blocks, {:.0f} % {} than the {:.3f} that were "
                  "placed: blocks of {:.1f} mm are too large for them; {}",
                  s.fraction_of_stones, 100.0 * std::abs(change), change < 0.0 ? "less" : "more",
                  s.fraction_placed, 1e3 * s.metrics.mean_size, remedy)};
}

std::vector<std::string> warnings(const Specimen<3>& s) {
  std::vector<std::string> lines;
  if (s.small_stones > 0)
    lines.push_back(fmt::format(
        "{} of {} stones are smaller than {:g} blocks{}: such a stone is one or a few blocks, whatever its "
        "shape, and blocks 1.7 times finer, which show more of it, raise f_c by some 6 %",
        s.small_stones, s.stones.size(), kSmallestStone,
        s.size.empty() ? fmt::format(" of {:.1f} mm", 1e3 * s.metrics.mean_size) : " there"));
  int without = 0;
  for (const SizeClass& c : s.classes) without += c.without_a_block;
  if (without > 0)
    lines.push_back(
        fmt::format("{} of {} stones have no block of their own: more blocks are needed, or a larger "
                    "[aggregates] d_min",
                    without, s.stones.size()));
  return lines;
}

template <int Dim>
void measure(Specimen<Dim>& s, const Metrics<Dim>& done) {
  // areas are summed, and shares of volume: so the committed references are rounded
  const double whole = s.outline.extent(), unit = Dim == 2 ? 1.0 : whole;
  s.fraction.assign(s.phases.size(), 0.0);
  for (std::size_t cell = 0; cell < s.phase.size(); ++cell)
    s.fraction[s.phase[cell]] += extent(s.cells, cell) / unit;
  for (double& share : s.fraction) share /= whole / unit;
  if constexpr (Dim == 2)
    s.metrics = measure(s.cells, done);
  else
    s.metrics = measure(s.cells, s.outline, done);
}

template <int Dim>
Specimen<Dim> make_specimen(const SpecimenParameters& p, Team* team) {
  const auto& outline = std::get<OutlineOf<Dim>>(p.outline);
  if (p.is_of_file()) {
    GivenCells<Dim> given = std::get<GivenCells<Dim>>(p.cells);
    given.outline = outline;  // with patches
    Specimen<Dim> specimen = specimen_from(std::move(given));
    specimen.matrix = place_in(specimen.phases, p.matrix);
    return specimen;
  }
  if constexpr (Dim == 3) require_of_space(p);
  require(outline.extent() > 0.0, Dim == 2 ? "The area of the specimen" : "The volume of the specimen",
          outline.extent(), Dim == 2 ? "a positive area" : "a positive volume");
  require_valid(p);
  // Aggregates and blocks draw from streams of their own: another number of blocks leaves the aggregates
  // where they are.
  Random aggregate_random(2 * p.seed), block_random(2 * p.seed + 1);
  Specimen<Dim> specimen{.outline = outline, .phases = phases(p)};
  add_inclusions(p, aggregate_random, specimen);

  const std::span<const Stone<Dim>> stones(specimen.stones);
  const bool follows = p.superposition == Superposition::follow;
  Blocks<Dim> blocks =
      make_blocks(p.blocks, outline, block_random, team, follows ? stones : std::span<const Stone<Dim>>());
  specimen.cells = std::move(blocks.cells);
  specimen.size = std::move(blocks.size);
  if (blocks.phase.empty()) {
    const int matrix = specimen.matrix = place_in(specimen.phases, p.matrix);
    if (follows) {
      specimen.stone = std::move(blocks.stone);
      specimen.stone.resize(specimen.cells.cells.size(), -1);
      for (const int stone : specimen.stone)
        specimen.phase.push_back(stone < 0 ? matrix : specimen.stones[stone].phase);
    } else {
      Superposed superposed = superpose<Dim>(specimen.cells, outline, stones, p, matrix);
      specimen.covered_fraction = superposed.covered_fraction;
      specimen.phase = std::move(superposed.phase);
      specimen.stone = std::move(superposed.stone);
    }
    specimen.fraction_of_stones = share_beside_matrix(specimen);
    superpose<Dim>(specimen.cells, specimen.fibres, specimen.phase, specimen.stone);
    specimen.fraction_superposed = share_beside_matrix(specimen);
  } else {
    specimen.phase = std::move(blocks.phase);
  }
  if constexpr (Dim == 3) {
    const BlockSizes sizes = sizes_of<3>(p.blocks, outline);
    specimen.small_stones = static_cast<int>(std::ranges::count_if(stones, [&](const Stone<3>& stone) {
      return stone.diameter < kSmallestStone * sizes.at(stone.centre);
    }));
  }
  specimen.classes = classes_of(p, specimen);
  measure(specimen, blocks.done);
  return specimen;
}

template void measure<2>(Specimen<2>&, const Metrics<2>&);
template void measure<3>(Specimen<3>&, const Metrics<3>&);
template Specimen<2> make_specimen<2>(const SpecimenParameters&, Team*);
template Specimen<3> make_specimen<3>(const SpecimenParameters&, Team*);

}  // namespace pyroclast::specimen
