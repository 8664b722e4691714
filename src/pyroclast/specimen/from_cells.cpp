#include "pyroclast/specimen/from_cells.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <utility>

#include <fmt/format.h>

#include "pyroclast/base/error.hpp"
#include "pyroclast/specimen/pieces.hpp"
#include "pyroclast/specimen/polygon.hpp"
#include "pyroclast/specimen/polyhedra_file.hpp"
#include "pyroclast/specimen/polyhedron.hpp"
#include "pyroclast/specimen/topology.hpp"

namespace pyroclast::specimen {
namespace {

/// Returns the vertices along each loop of the outline, the cells on the left. Throws Error when the cells
/// are not one piece, or parts of the outline meet in one point.
std::vector<std::vector<int>> loops_of(const Cells<2>& tessellation, const std::vector<Facet<2>>& edges,
                                       const Numbering& numbering) {
  std::vector<int> next(tessellation.vertices.size(), -1);
  if (const std::string pieces = describe_pieces<2>(tessellation, edges, numbering); !pieces.empty())
    throw Error(pieces);
  for (const Facet<2>& e : edges) {
    if (e.outer >= 0) continue;
    if (next[e.corners[0]] >= 0)
      throw Error(fmt::format("parts of the outline meet in one point, ({:.6g}, {:.6g}) m",
                              tessellation.vertices[e.corners[0]][0],
                              tessellation.vertices[e.corners[0]][1]));
    next[e.corners[0]] = e.corners[1];
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

/// Returns the largest distance of a vertex from its side, m (`kOffSide`).
double slack_of(const Cells<2>& tessellation) {
  double whole = 0.0;
  std::vector<Vec<2>> polygon;
  for (std::size_t c = 0; c < tessellation.cells.size(); ++c) {
    corners(tessellation, c, polygon);
    whole += std::abs(area(polygon));
  }
  return kOffSide * std::sqrt(whole / static_cast<double>(tessellation.cells.size()));
}

/// Adds the corners between two vertices of a loop: of those farther than `slack` from the line between the
/// ends, the farthest, and the corners on both of its sides (Douglas and Peucker 1973).
void add_corners(const std::vector<int>& loop, const std::vector<Vec<2>>& at, std::size_t first,
                 std::size_t last, double slack, std::vector<std::size_t>& found) {
  std::vector<std::pair<std::size_t, std::size_t>> stretches{{first, last}};
  const std::size_t n = loop.size();
  while (!stretches.empty()) {
    const auto [from, to] = stretches.back();
    stretches.pop_back();
    double farthest = slack;
    std::size_t corner = from;
    for (std::size_t i = from + 1; i < to; ++i) {
      const double off = distance_from_segment(at[loop[i % n]], at[loop[from % n]], at[loop[to % n]]);
      if (off <= farthest) continue;
      farthest = off;
      corner = i;
    }
    if (corner == from) continue;
    found.push_back(corner % n);
    stretches.emplace_back(from, corner);
    stretches.emplace_back(corner, to);
  }
}

/// Returns the corners of a loop, ascending: the places of the vertices where it turns.
std::vector<std::size_t> corners_of(const std::vector<int>& loop, const std::vector<Vec<2>>& at,
                                    double slack) {
  const auto farthest_from = [&](const Vec<2>& point) {
    std::size_t farthest = 0;
    for (std::size_t i = 1; i < loop.size(); ++i)
      if (norm(at[loop[i]] - point) > norm(at[loop[farthest]] - point)) farthest = i;
    return farthest;
  };
  // the vertex farthest from any point is a corner, whatever is off by rounding
  const std::size_t first = farthest_from(at[loop.front()]), second = farthest_from(at[loop[first]]);
  std::vector<std::size_t> found{first, second};
  add_corners(loop, at, std::min(first, second), std::max(first, second), slack, found);
  add_corners(loop, at, std::max(first, second), std::min(first, second) + loop.size(), slack, found);
  std::ranges::sort(found);
  // of a stretch along a line between two others, all vertices are as far from it: any of them may be found
  for (std::size_t i = 0; i < found.size() && found.size() > 3;) {
    const std::size_t n = found.size(), before = found[(i + n - 1) % n], after = found[(i + 1) % n];
    if (distance_from_segment(at[loop[found[i]]], at[loop[before]], at[loop[after]]) <= slack)
      found.erase(found.begin() + static_cast<std::ptrdiff_t>(i));
    else
      ++i;
  }
  return found;
}

/// Returns the places of the corners of a loop, m.
std::vector<Vec<2>> places_of(const std::vector<std::size_t>& corner, const std::vector<int>& loop,
                              const std::vector<Vec<2>>& at) {
  std::vector<Vec<2>> places;
  for (const std::size_t i : corner) places.push_back(at[loop[i]]);
  return places;
}

/// Returns the lowest of some corners, of several the leftmost.
/// \param slack  difference of heights that counts as none, m
std::size_t lowest_of(const std::vector<Vec<2>>& corners, double slack) {
  double low = corners.front()[1];
  for (const Vec<2>& corner : corners) low = std::min(low, corner[1]);
  std::size_t lowest = corners.size();
  for (std::size_t i = 0; i < corners.size(); ++i)
    if (corners[i][1] <= low + slack && (lowest == corners.size() || corners[i][0] < corners[lowest][0]))
      lowest = i;
  return lowest;
}

/// Tells whether four corners, the lowest first, are a rectangle along the axes.
bool are_upright(const std::vector<Vec<2>>& corners, double slack) {
  const auto are_level = [&](int i, int j, int component) {
    return std::abs(corners[i][component] - corners[j][component]) <= slack;
  };
  return corners.size() == 4 && are_level(0, 1, 1) && are_level(1, 2, 0) && are_level(2, 3, 1) &&
         are_level(3, 0, 0);
}

/// Returns the names of the sides from corner to corner, the lowest first.
std::vector<std::string> names_of(const std::vector<Vec<2>>& corners, double slack) {
  if (are_upright(corners, slack)) return {"bottom", "right", "top", "left"};
  std::vector<std::string> names;
  for (std::size_t i = 0; i < corners.size(); ++i) names.push_back(fmt::format("side_{}", i + 1));
  return names;
}

/// Moves the corners of a rectangle along the axes to the same height, or place along x, two and two.
void make_upright(std::vector<Vec<2>>& corners, double slack) {
  const std::size_t lowest = lowest_of(corners, slack);
  std::rotate(corners.begin(), corners.begin() + static_cast<std::ptrdiff_t>(lowest), corners.end());
  if (are_upright(corners, slack))
    for (const auto& [i, j, component] :
         {std::array{0, 1, 1}, std::array{1, 2, 0}, std::array{2, 3, 1}, std::array{3, 0, 0}}) {
      const double middle = 0.5 * (corners[i][component] + corners[j][component]);
      corners[i][component] = corners[j][component] = std::abs(middle) <= slack ? 0.0 : middle;
    }
  std::rotate(corners.begin(), corners.end() - static_cast<std::ptrdiff_t>(lowest), corners.end());
}

void require_cells(const GivenCells<2>& cells) {
  const Cells<2>& t = cells.cells;
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

Region outline_of_loops(const Cells<2>& tessellation, const std::vector<Facet<2>>& edges,
                        const Numbering& numbering) {
  const double slack = slack_of(tessellation);
  std::vector<Vec<2>> outer;
  std::vector<Hole> holes;
  for (const auto& loop : loops_of(tessellation, edges, numbering)) {
    std::vector<Vec<2>> corners =
        places_of(corners_of(loop, tessellation.vertices, slack), loop, tessellation.vertices);
    if (area(corners) < 0.0)
      holes.push_back({fmt::format("hole_{}", holes.size() + 1), std::move(corners)});
    else if (outer.empty())
      outer = std::move(corners);
    else
      throw Error("the cells have more than one outer outline: some lie upon others");
  }
  if (outer.size() < 3 || !(area(outer) > 0.0)) throw Error("the cells enclose no area");
  const auto lowest = static_cast<std::ptrdiff_t>(lowest_of(outer, slack));
  std::rotate(outer.begin(), outer.begin() + lowest, outer.end());  // Clang 14 cannot do ranges::rotate
  const std::vector<std::string> names = names_of(outer, slack);
  const Vec<2> origin = outer.front(), opposite = outer[2];
  if (names.front() == "bottom" && origin == Vec<2>{})
    return Region::rectangle(opposite[0], opposite[1]).with_holes(holes);
  return Region::polygon(std::move(outer), names).with_holes(holes);
}

}  // namespace

void lay_on_sides(Cells<2>& tessellation) {
  auto& at = tessellation.vertices;
  std::vector<std::vector<int>> loops;
  try {
    loops = loops_of(tessellation, facets(tessellation), {});
  } catch (const Error&) {
    return;
  }
  const double slack = slack_of(tessellation);
  const Box box = box_of(at);
  const double exact = kExact * std::max(box.width(), box.height());
  const auto move = [&](int vertex, const Vec<2>& to) {
    if (norm(at[vertex] - to) > exact) at[vertex] = to;
  };
  for (const auto& loop : loops) {
    const std::vector<std::size_t> corner = corners_of(loop, at, slack);
    if (corner.size() < 3) continue;
    std::vector<Vec<2>> places = places_of(corner, loop, at);
    if (area(places) > 0.0) make_upright(places, slack);
    for (std::size_t k = 0; k < corner.size(); ++k) {
      const Vec<2> from = places[k], along = places[(k + 1) % corner.size()] - from;
      move(loop[corner[k]], from);
      const std::size_t end = k + 1 < corner.size() ? corner[k + 1] : corner.front() + loop.size();
      for (std::size_t i = corner[k] + 1; i < end; ++i) {
        const int v = loop[i % loop.size()];
        move(v, from + (dot(at[v] - from, along) / dot(along, along)) * along);
      }
    }
  }
}

Region outline_of(const Cells<2>& tessellation, const Numbering& numbering) {
  const std::vector<Facet<2>> all = facets(tessellation, numbering);
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

GivenCells<2> checked(GivenCells<2> cells) {
  require_cells(cells);
  std::vector<Vec<2>> polygon;
  for (std::size_t c = 0; c < cells.cells.cells.size(); ++c) {
    corners(cells.cells, c, polygon);
    if (area(polygon) < 0.0) std::ranges::reverse(cells.cells.cells[c]);
  }
  return cells;
}

Specimen<2> specimen_from(GivenCells<2> cells) {
  cells = checked(std::move(cells));
  lay_on_sides(cells.cells);
  const Region region = outline_of(cells.cells);
  return specimen_from(std::move(cells), region);
}

template <int Dim>
Specimen<Dim> specimen_from(GivenCells<Dim> given, const OutlineOf<Dim>& outline) {
  const std::string origin = given.origin.empty() ? "The cells" : given.origin;
  if constexpr (Dim == 2)
    given = checked(std::move(given));
  else
    find_sides(given.cells, outline);
  require_valid(given.cells, outline, origin);
  Specimen<Dim> specimen{.outline = outline,
                         .cells = std::move(given.cells),
                         .phases = std::move(given.phases),
                         .phase = std::move(given.phase),
                         .grain = std::move(given.grain),
                         .size = std::move(given.size)};
  measure(specimen);
  return specimen;
}

template Specimen<2> specimen_from<2>(GivenCells<2>, const Region&);
template Specimen<3> specimen_from<3>(GivenCells<3>, const Prism&);

}  // namespace pyroclast::specimen
