#include "pyroclast/solid/specimen.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>
#include <variant>

#include <fmt/format.h>

#include "pyroclast/base/error.hpp"
#include "pyroclast/base/place_in.hpp"
#include "pyroclast/base/random.hpp"
#include "pyroclast/solid/laguerre.hpp"
#include "pyroclast/solid/regularisation.hpp"
#include "pyroclast/specimen/gradation.hpp"
#include "pyroclast/specimen/grain.hpp"
#include "pyroclast/specimen/placement.hpp"

namespace pyroclast::solid {

namespace {

/// Diameter, in block sizes, below which the shape of a stone depends on the blocks, and the strength of the
/// body with it (docs/validation/solid_strengths.md, "The size of blocks").
constexpr double kSmallestStone = 3.0;
/// Largest number of rounds in which seeds are drawn anew. Seeds that keep their distance need one.
constexpr int kMostRounds = 20;

/// Throws Error for cells that a solid cannot have.
void require_own_cells(const specimen::SpecimenParameters& p) {
  if (p.cells || p.blocks.tessellation || !p.blocks.phases.empty())
    throw Error("a solid cannot be made of cells of a plane");
  if (p.blocks.relaxation != 0) throw Error("the cells of a solid cannot be relaxed yet");
}

/// Returns the kinds of aggregate: the first, and inclusions that are round. Throws Error for others.
std::vector<const specimen::AggregateParameters*> kinds_of(const specimen::SpecimenParameters& p) {
  std::vector<const specimen::AggregateParameters*> kinds{&p.aggregates};
  for (const auto& inclusions : p.inclusions) {
    const auto* const round = std::get_if<specimen::AggregateParameters>(&inclusions);
    if (round == nullptr) throw Error("a solid cannot have fibres yet");
    kinds.push_back(round);
  }
  for (const auto* const kind : kinds)
    if (!kind->stones.empty()) throw Error("a solid cannot have stones from a list yet");
  return kinds;
}

void add_balls(const std::vector<const specimen::AggregateParameters*>& kinds, Random& random,
               SolidSpecimen& specimen) {
  const Prism& body = specimen.body;
  const specimen::Room<3> room = room_in(body);
  for (int kind = 0; kind < static_cast<int>(kinds.size()); ++kind) {
    const auto& asked = *kinds[kind];
    specimen.fraction_asked += asked.fraction;
    if (asked.fraction == 0.0) continue;
    specimen::draw_and_place(room, asked, place_in(specimen.phases, asked.phase), kind, random,
                             specimen.balls);
  }
  for (const Ball& ball : specimen.balls)
    specimen.fraction_placed += specimen::extent_of_round<3>(ball.diameter) / body.volume();
  const auto with_largest = std::ranges::max_element(
      kinds, {}, [](const auto* kind) { return kind->fraction > 0.0 ? kind->d_min : 0.0; });
  specimen::require_placed(specimen.fraction_placed, specimen.fraction_asked, **with_largest);
}

/// Tessellates the body. Seeds whose cells fail are drawn anew.
Complex tessellate(const specimen::BlockParameters& p, const specimen::BlockSizes& sizes, const Prism& body,
                   Random& random, Team* team, CellMetrics& done) {
  SolidSeeds seeds = spaced_seeds(body, sizes, p.count, p.radius_spread, random);
  const std::string what = fmt::format("Tessellation of {} blocks", p.count);
  for (int round = 0; round < kMostRounds; ++round) {
    LaguerreComplex result = laguerre_complex(seeds, body, team);
    if (result.broken.empty()) {
      require_valid(result.complex, body, what);
      if (p.shortest_edge > 0.0) {
        const auto regular =
            regularise(result.complex, body, result.plane, {p.shortest_edge, p.largest_bend}, sizes);
        done.vertices_merged = regular.vertices_merged;
        done.edges_left_short = regular.edges_left_short;
        require_valid(result.complex, body, what);
      }
      return std::move(result.complex);
    }
    done.seeds_redrawn += static_cast<int>(result.broken.size());
    redraw(seeds, result.broken, body, sizes, random);
  }
  throw Error(
      fmt::format("{}no tessellation of {} blocks came about in {} rounds: take blocks that are more "
                  "alike (radius_spread), or another seed",
                  p.place.empty() ? "" : p.place + ": ", p.count, kMostRounds));
}

/// Returns the least height of a tetrahedron over one of its faces, m.
double least_height(const std::array<Vec<3>, 4>& x) {
  const Vec<3> a = x[1] - x[0], b = x[2] - x[0], c = x[3] - x[0];
  const double widest =
      std::max({norm(cross(a, b)), norm(cross(b, c)), norm(cross(c, a)), norm(cross(b - a, c - a))});
  return std::abs(dot(a, cross(b, c))) / widest;
}

/// Returns the size classes of all kinds: the intervals between their sieves.
std::vector<SizeClass> classes_of(const std::vector<const specimen::AggregateParameters*>& kinds,
                                  const SolidSpecimen& specimen, const std::vector<double>& volumes) {
  std::vector<double> superposed(specimen.balls.size());
  for (std::size_t cell = 0; cell < volumes.size(); ++cell)
    if (const int grain = specimen.grain[cell]; grain >= 0)
      superposed[grain] += volumes[cell] / specimen.body.volume();
  std::vector<SizeClass> classes;
  for (int kind = 0; kind < static_cast<int>(kinds.size()); ++kind) {
    const auto& asked = *kinds[kind];
    if (asked.fraction == 0.0) continue;
    for (std::size_t i = 1; i < asked.sieves.size(); ++i) {
      const double from = asked.sieves[i - 1], to = asked.sieves[i];
      SizeClass& its = classes.emplace_back(SizeClass{.kind = kind, .from = from, .to = to});
      its.asked = asked.fraction * (specimen::passing(asked, to) - specimen::passing(asked, from));
      const bool is_last = i + 1 == asked.sieves.size();
      for (std::size_t b = 0; b < specimen.balls.size(); ++b) {
        const Ball& ball = specimen.balls[b];
        if (ball.kind != kind || ball.diameter < from || (is_last ? ball.diameter > to : ball.diameter >= to))
          continue;
        ++its.stones;
        its.placed += specimen::extent_of_round<3>(ball.diameter) / specimen.body.volume();
        its.superposed += superposed[b];
        if (superposed[b] == 0.0) ++its.without_a_block;
      }
    }
  }
  return classes;
}

}  // namespace

CellMetrics measure(const Complex& complex, const Prism& body, CellMetrics metrics) {
  metrics.shortest_edge = std::numeric_limits<double>::infinity();
  std::size_t zones = 0;
  for (const CellFace& face : complex.faces) {
    const auto corners = static_cast<int>(face.corners.size());
    zones += static_cast<std::size_t>(corners - 2) * (face.outer >= 0 ? 2 : 1);
    if (face.outer >= 0) {
      metrics.most_corners = std::max(metrics.most_corners, corners);
      metrics.largest_bend =
          std::max(metrics.largest_bend, bend(complex.vertices, face.corners) * 180.0 / std::numbers::pi);
    }
    for (int i = 0; i < corners; ++i)
      metrics.shortest_edge = std::min(
          metrics.shortest_edge,
          norm(complex.vertices[face.corners[(i + 1) % corners]] - complex.vertices[face.corners[i]]));
  }
  metrics.lowest_zone = std::numeric_limits<double>::infinity();
  for (std::size_t cell = 0; cell < complex.cells.size(); ++cell) {
    const ZonedCell zoned = zone_cell(complex, cell);
    for (const auto& [a, b, c, d] : zoned.zones) {
      const auto& x = zoned.gridpoints;
      const double height = least_height({x[a], x[b], x[c], x[d]});
      if (height >= metrics.lowest_zone) continue;
      metrics.lowest_zone = height;
      metrics.lowest_zone_cell = static_cast<int>(cell);
    }
  }
  metrics.zones_per_block = static_cast<double>(zones) / static_cast<double>(complex.cells.size());
  metrics.mean_size = std::cbrt(body.volume() / static_cast<double>(complex.cells.size()));
  return metrics;
}

std::vector<std::string> warnings(const SolidSpecimen& s) {
  std::vector<std::string> lines;
  if (s.small_stones > 0)
    lines.push_back(fmt::format(
        "{} of {} stones are smaller than {:g} blocks{}: such a stone is one or a few blocks, whatever its "
        "shape, and blocks 1.7 times finer, which show more of it, raise f_c by some 6 %",
        s.small_stones, s.balls.size(), kSmallestStone,
        s.size.empty() ? fmt::format(" of {:.1f} mm", 1e3 * s.metrics.mean_size) : " there"));
  int without = 0;
  for (const SizeClass& c : s.classes) without += c.without_a_block;
  if (without > 0)
    lines.push_back(
        fmt::format("{} of {} stones have no block of their own: more blocks are needed, or a larger "
                    "[aggregates] d_min",
                    without, s.balls.size()));
  return lines;
}

SolidSpecimen make_specimen(const specimen::SpecimenParameters& p, const Prism& body, Team* team) {
  // Aggregates and blocks draw from streams of their own: another number of blocks leaves the aggregates
  // where they are.
  Random aggregate_random(2 * p.seed), block_random(2 * p.seed + 1);
  require_own_cells(p);
  const auto kinds = kinds_of(p);
  specimen::require_valid(p);
  SolidSpecimen specimen;
  specimen.body = body;
  specimen.phases = specimen::phases(p);
  const int matrix = place_in(specimen.phases, p.matrix);
  add_balls(kinds, aggregate_random, specimen);
  const specimen::BlockSizes sizes(std::cbrt(body.volume() / p.blocks.count), p.blocks.largest_size,
                                   p.blocks.finer);
  specimen.complex = tessellate(p.blocks, sizes, body, block_random, team, specimen.metrics);
  specimen.small_stones = static_cast<int>(std::ranges::count_if(specimen.balls, [&](const Ball& ball) {
    return ball.diameter < kSmallestStone * sizes.at(ball.centre);
  }));
  SuperposedBalls superposed = superpose(specimen.complex, body, specimen.balls, p);
  specimen.covered_fraction = superposed.covered_fraction;
  specimen.grain = std::move(superposed.grain);
  std::vector<double> volumes;
  specimen.fraction.assign(specimen.phases.size(), 0.0);
  for (std::size_t cell = 0; cell < specimen.complex.cells.size(); ++cell) {
    const int grain = specimen.grain[cell];
    specimen.phase.push_back(grain < 0 ? matrix : specimen.balls[grain].phase);
    volumes.push_back(volume(specimen.complex, cell));
    if (!sizes.is_even())
      specimen.size.push_back(sizes.at(zone_cell(specimen.complex, cell).gridpoints.back()));
    specimen.fraction[specimen.phase.back()] += volumes.back() / body.volume();
    if (specimen.phase.back() != matrix) specimen.fraction_superposed += volumes.back() / body.volume();
  }
  specimen.classes = classes_of(kinds, specimen, volumes);
  specimen.metrics = measure(specimen.complex, body, specimen.metrics);
  return specimen;
}

}  // namespace pyroclast::solid
