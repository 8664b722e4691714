#include "pyroclast/specimen/from_cells.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <utility>

#include <fmt/format.h>

#include "pyroclast/base/error.hpp"
#include "pyroclast/specimen/metrics.hpp"
#include "pyroclast/specimen/pieces.hpp"
#include "pyroclast/specimen/polygon.hpp"
#include "pyroclast/specimen/topology.hpp"

namespace pyroclast::specimen {
namespace {

/// Largest turn between two sides that count as one, radians.
constexpr double kStraight = 1e-6;
/// Largest difference between two coordinates that count as equal, as a share of the body's size.
constexpr double kSameLevel = 1e-9;

/// Returns the vertices along each loop of the outline, the cells on the left. Throws Error when the cells
/// are not one piece, or parts of the outline meet in one point.
std::vector<std::vector<int>> loops_of(const Tessellation& tessellation, const std::vector<Edge>& edges,
                                       const Numbering& numbering) {
  std::vector<int> next(tessellation.vertices.size(), -1);
  if (const std::string pieces = describe_pieces(tessellation, edges, numbering); !pieces.empty())
    throw Error(pieces);
  for (const Edge& e : edges) {
    if (e.right >= 0) continue;
    if (next[e.v0] >= 0)
      throw Error(fmt::format("parts of the outline meet in one point, ({:.6g}, {:.6g}) m",
                              tessellation.vertices[e.v0][0], tessellation.vertices[e.v0][1]));
    next[e.v0] = e.v1;
  }
  std::vector<std::vector<int>> loops;
  for (int first = 0; first < static_cast<int>(next.size()); ++first) {
    if (next[first] < 0) continue;
    auto& loop = loops.emplace_back();
    for (int at = first; next[at] >= 0;) {
      loop.push_back(at);
      at = std::exchange(next[at], -1);
    }
  }
  return loops;
}

/// Returns the corners of a loop: the vertices where it turns.
std::vector<Vec<2>> corners_of(const std::vector<int>& loop, const std::vector<Vec<2>>& vertices) {
  std::vector<Vec<2>> corners;
  const std::size_t n = loop.size();
  for (std::size_t i = 0; i < n; ++i) {
    const Vec<2>& here = vertices[loop[i]];
    const Vec<2> before = here - vertices[loop[(i + n - 1) % n]], after = vertices[loop[(i + 1) % n]] - here;
    if (std::abs(std::atan2(cross(before, after), dot(before, after))) > kStraight) corners.push_back(here);
  }
  return corners;
}

/// Returns the names of the sides from corner to corner. The first corner is the lowest, of several the
/// leftmost.
std::vector<std::string> names_of(const std::vector<Vec<2>>& corners, double tolerance) {
  const auto are_level = [&](int i, int j, int component) {
    return std::abs(corners[i][component] - corners[j][component]) <= tolerance;
  };
  if (corners.size() == 4 && are_level(0, 1, 1) && are_level(1, 2, 0) && are_level(2, 3, 1) &&
      are_level(3, 0, 0))
    return {"bottom", "right", "top", "left"};
  std::vector<std::string> names;
  for (std::size_t i = 0; i < corners.size(); ++i) names.push_back(fmt::format("side_{}", i + 1));
  return names;
}

void require_cells(const Cells& cells) {
  const Tessellation& t = cells.tessellation;
  require_lists(t.cells.size(), cells.phases, cells.phase, cells.size, cells.grain);
  for (std::size_t c = 0; c < t.cells.size(); ++c) {
    if (t.cells[c].size() < 3)
      throw Error(fmt::format("{} has {} corners, but needs 3", Numbering{}.cell(c), t.cells[c].size()));
    for (int v : t.cells[c])
      if (v < 0 || v >= std::ssize(t.vertices))
        throw Error(fmt::format("{} names vertex {} (from 0), but there are {}", Numbering{}.cell(c), v,
                                t.vertices.size()));
    std::vector<int> sorted = t.cells[c];
    std::ranges::sort(sorted);
    if (const auto twice = std::ranges::adjacent_find(sorted); twice != sorted.end())
      throw Error(fmt::format("{} names vertex {} (from 0) twice", Numbering{}.cell(c), *twice));
  }
  for (std::size_t v = 0; v < t.vertices.size(); ++v)
    if (!std::isfinite(t.vertices[v][0]) || !std::isfinite(t.vertices[v][1]))
      throw Error(fmt::format("vertex {} (from 0) is not finite", v));
}

Region outline_of_loops(const Tessellation& tessellation, const std::vector<Edge>& edges,
                        const Numbering& numbering) {
  std::vector<Vec<2>> outer;
  std::vector<Hole> holes;
  for (const auto& loop : loops_of(tessellation, edges, numbering)) {
    std::vector<Vec<2>> corners = corners_of(loop, tessellation.vertices);
    if (area(corners) < 0.0)
      holes.push_back({fmt::format("hole_{}", holes.size() + 1), std::move(corners)});
    else if (outer.empty())
      outer = std::move(corners);
    else
      throw Error("the cells have more than one outer outline: some lie upon others");
  }
  if (outer.size() < 3 || !(area(outer) > 0.0)) throw Error("the cells enclose no area");
  const Box box = box_of(outer);
  const double tolerance = kSameLevel * std::max(box.width(), box.height());
  const auto lowest = std::ranges::min_element(
      outer, {}, [&](const Vec<2>& p) { return std::pair(std::round(p[1] / tolerance), p[0]); });
  std::rotate(outer.begin(), lowest, outer.end());  // Clang 14 cannot do ranges::rotate
  const std::vector<std::string> names = names_of(outer, tolerance);
  const Vec<2> origin = outer.front(), opposite = outer[2];
  if (names.front() == "bottom" && origin == Vec<2>{})
    return Region::rectangle(opposite[0], opposite[1]).with_holes(holes);
  return Region::polygon(std::move(outer), names).with_holes(holes);
}

}  // namespace

Region outline_of(const Tessellation& tessellation, const Numbering& numbering) {
  const std::vector<Edge> all = edges(tessellation, numbering);
  try {
    return outline_of_loops(tessellation, all, numbering);
  } catch (const Error& error) {
    throw Error(error.what() + describe_joinable(tessellation));
  }
}

void require_lists(std::size_t cells, const std::vector<std::string>& phases, const std::vector<int>& phase,
                   const std::vector<double>& size, const std::vector<int>& grain) {
  if (cells == 0) throw Error("there are no cells");
  const auto require_one_each = [&](std::size_t count, const char* what) {
    if (count != cells) throw Error(fmt::format("there are {} cells, but the {} of {}", cells, what, count));
  };
  require_one_each(phase.size(), "phases");
  if (!size.empty()) require_one_each(size.size(), "sizes");
  if (!grain.empty()) require_one_each(grain.size(), "stones");
  const Numbering number;
  for (std::size_t c = 0; c < cells; ++c) {
    if (phase[c] < 0 || phase[c] >= std::ssize(phases))
      throw Error(fmt::format("{} is of phase {} (from 0), but there are {}", number.cell(c), phase[c],
                              phases.size()));
    if (!size.empty() && (!(size[c] > 0.0) || !std::isfinite(size[c])))
      throw Error(fmt::format("{} has the size {}; it must be greater than 0", number.cell(c), size[c]));
    if (!grain.empty() && grain[c] < -1)
      throw Error(
          fmt::format("{} is of stone {}; the least number is 0, or -1 for none", number.cell(c), grain[c]));
  }
}

Cells checked(Cells cells) {
  require_cells(cells);
  std::vector<Vec<2>> polygon;
  for (std::size_t c = 0; c < cells.tessellation.cells.size(); ++c) {
    corners(cells.tessellation, c, polygon);
    if (area(polygon) < 0.0) std::ranges::reverse(cells.tessellation.cells[c]);
  }
  return cells;
}

Specimen specimen_from(Cells cells) {
  cells = checked(std::move(cells));
  Region region = outline_of(cells.tessellation);
  return specimen_from(std::move(cells), std::move(region));
}

Specimen specimen_from(Cells cells, Region region) {
  auto [tessellation, phases, phase, size, grain, origin] = checked(std::move(cells));
  require_valid(tessellation, region, origin.empty() ? "The cells" : origin);
  Specimen specimen{};
  specimen.region = std::move(region);
  specimen.fraction.assign(phases.size(), 0.0);
  std::vector<Vec<2>> polygon;
  for (std::size_t c = 0; c < tessellation.cells.size(); ++c) {
    corners(tessellation, c, polygon);
    specimen.fraction[phase[c]] += area(polygon) / specimen.region.area();
  }
  specimen.metrics = measure(tessellation);
  specimen.tessellation = std::move(tessellation);
  specimen.phases = std::move(phases);
  specimen.phase = std::move(phase);
  specimen.size = std::move(size);
  specimen.grain = std::move(grain);
  return specimen;
}

}  // namespace pyroclast::specimen
