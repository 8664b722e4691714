#include "pyroclast/specimen/from_cells.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <limits>
#include <numeric>
#include <utility>

#include <fmt/format.h>

#include "pyroclast/base/error.hpp"
#include "pyroclast/specimen/pieces.hpp"
#include "pyroclast/specimen/polygon.hpp"
#include "pyroclast/specimen/polyhedron.hpp"
#include "pyroclast/specimen/topology.hpp"
#include "pyroclast/specimen/walls.hpp"

namespace pyroclast::specimen {
namespace {

/// Sine of the angle between two planes of the body below which a vertex on both has no place of its own.
constexpr double kParallel = 1e-4;
/// Farthest way onto the line or point where planes meet, over the largest distance from one of them.
constexpr double kFarthest = 10.0;
/// Height of a triangle, over the length of a face, below which three of its corners lie on one line.
constexpr double kOnOneLine = 1e-6;

/// Returns the vertices along each loop of the outline, the cells on the left. Throws Error when the cells
/// are not one piece, or parts of the outline meet in one point.
std::vector<std::vector<int>> loops_of(const Cells<2>& cells, const std::vector<Facet<2>>& edges,
                                       const Numbering& numbering) {
  std::vector<int> next(cells.vertices.size(), -1);
  if (const std::string pieces = describe_pieces<2>(cells, edges, numbering); !pieces.empty())
    throw Error(pieces);
  for (const Facet<2>& e : edges) {
    if (e.outer >= 0) continue;
    if (next[e.corners[0]] >= 0)
      throw Error(fmt::format("parts of the outline meet in one point, ({:.6g}, {:.6g}) m",
                              cells.vertices[e.corners[0]][0], cells.vertices[e.corners[0]][1]));
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
double slack_of(const Cells<2>& cells) {
  double whole = 0.0;
  std::vector<Vec<2>> polygon;
  for (std::size_t c = 0; c < cells.cells.size(); ++c) {
    corners(cells, c, polygon);
    whole += std::abs(area(polygon));
  }
  return kOffSide * std::sqrt(whole / static_cast<double>(cells.cells.size()));
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

Region outline_of_loops(const Cells<2>& cells, const std::vector<Facet<2>>& edges,
                        const Numbering& numbering) {
  const double slack = slack_of(cells);
  std::vector<Vec<2>> outer;
  std::vector<Hole> holes;
  for (const auto& loop : loops_of(cells, edges, numbering)) {
    std::vector<Vec<2>> corners = places_of(corners_of(loop, cells.vertices, slack), loop, cells.vertices);
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

/// Throws Error, naming the cell, counted from 0, when there are no cells, when a list has another length,
/// when a vertex is not finite, and when a cell is of a phase that does not exist, has a size that is not
/// above 0, or a stone below -1.
template <int Dim>
void require_lists(const GivenCells<Dim>& given) {
  const std::size_t cells = given.cells.cells.size();
  if (cells == 0) throw Error("there are no cells");
  const auto require_one_each = [&](std::size_t count, const char* what) {
    if (count != cells) throw Error(fmt::format("there are {} cells, but the {} of {}", cells, what, count));
  };
  require_one_each(given.phase.size(), "phases");
  if (!given.size.empty()) require_one_each(given.size.size(), "sizes");
  if (!given.stone.empty()) require_one_each(given.stone.size(), "stones");
  for (std::size_t v = 0; v < given.cells.vertices.size(); ++v)
    if (!std::ranges::all_of(given.cells.vertices[v].c, [](double x) { return std::isfinite(x); }))
      throw Error(fmt::format("vertex {} (from 0) is not finite", v));
  const Numbering number;
  for (std::size_t c = 0; c < cells; ++c) {
    if (const int phase = given.phase[c]; phase < 0 || phase >= std::ssize(given.phases))
      throw Error(fmt::format("{} is of phase {} (from 0), but there are {}", number.cell(c), phase,
                              given.phases.size()));
    if (!given.size.empty() && (!(given.size[c] > 0.0) || !std::isfinite(given.size[c])))
      throw Error(
          fmt::format("{} has the size {}; it must be greater than 0", number.cell(c), given.size[c]));
    if (!given.stone.empty() && given.stone[c] < -1)
      throw Error(fmt::format("{} is of stone {}; the least number is 0, or -1 for none", number.cell(c),
                              given.stone[c]));
  }
}

/// What the numbers of a list count, in words.
struct Counted {
  const char *one, *many;
};

/// Throws Error where a list has too few numbers, one twice, or one that nothing has.
void require_numbers(const std::vector<std::vector<int>>& lists, const char* item, std::size_t fewest,
                     const Counted& of, std::size_t there_are) {
  for (std::size_t i = 0; i < lists.size(); ++i) {
    std::vector<int> sorted = lists[i];
    std::ranges::sort(sorted);
    if (sorted.size() < fewest)
      throw Error(
          fmt::format("{} {} (from 0) has {} {}, but needs {}", item, i, sorted.size(), of.many, fewest));
    if (const int wrong = sorted.front() < 0 ? sorted.front() : sorted.back();
        wrong < 0 || std::cmp_greater_equal(wrong, there_are))
      throw Error(fmt::format("{} {} (from 0) names {} {} (from 0), but there are {}", item, i, of.one, wrong,
                              there_are));
    if (const auto twice = std::ranges::adjacent_find(sorted); twice != sorted.end())
      throw Error(fmt::format("{} {} (from 0) names {} {} (from 0) twice", item, i, of.one, *twice));
  }
}

/// Finds the cells on both sides of each face, and turns the faces of the surface outwards. A face goes
/// counter-clockwise seen from outside of a convex cell where its area points away from the cell's middle.
/// \param number  number of each face in the file
void find_neighbours(Cells<3>& cells, const std::vector<int>& number) {
  std::vector<std::vector<std::pair<int, bool>>> cells_of(cells.faces.size());
  for (std::size_t cell = 0; cell < cells.cells.size(); ++cell) {
    Vec<3> sum{};
    double corners = 0.0;
    for (const int f : cells.cells[cell])
      for (const int v : cells.faces[f].corners) {
        sum += cells.vertices[v];
        ++corners;
      }
    for (const int f : cells.cells[cell]) {
      const Facet<3>& face = cells.faces[f];
      const Vec<3> away = cells.vertices[face.corners.front()] - sum * (1.0 / corners);
      cells_of[f].emplace_back(static_cast<int>(cell), dot(area_vector(cells, face), away) > 0.0);
    }
  }
  for (std::size_t f = 0; f < cells.faces.size(); ++f) {
    Facet<3>& face = cells.faces[f];
    const auto& its_cells = cells_of[f];
    if (its_cells.empty() || its_cells.size() > 2)
      throw Error(
          fmt::format("face {} (from 0) is of {} cells, but must be of 1 or 2", number[f], its_cells.size()));
    const auto [first, is_of_first] = its_cells[0];
    if (its_cells.size() == 1) {
      face.inner = first;
      if (!is_of_first) std::reverse(face.corners.begin() + 1, face.corners.end());
    } else {
      face.inner = its_cells[is_of_first ? 0 : 1].first;
      face.outer = its_cells[is_of_first ? 1 : 0].first;
    }
  }
}

/// Turns the fans of faces whose corners stand on their edges too, where smaller cells meet a larger one: in
/// a triangle of three corners on one line a zone would have no volume.
void turn_flat_fans(Cells<3>& cells) {
  for (Facet<3>& face : cells.faces)
    if (lowest_of_fan(cells.vertices, face.corners) < kOnOneLine * std::sqrt(norm(area_vector(cells, face))))
      turn_to_best_fan(cells.vertices, face.corners, std::numeric_limits<double>::infinity());
}

/// Finds the plane of the body nearest to all corners of a face. Returns it, and the corner farthest from it.
std::pair<const Plane*, int> plane_of(const Facet<3>& face, const Cells<3>& cells, const Prism& body) {
  std::pair<const Plane*, int> found{};
  double nearest = std::numeric_limits<double>::infinity();
  for (const Plane& plane : body.planes()) {
    const auto off = [&](int v) { return std::abs(plane.distance(cells.vertices[v])); };
    const int farthest = *std::ranges::max_element(face.corners, {}, off);
    if (off(farthest) >= nearest) continue;
    nearest = off(farthest);
    found = {&plane, farthest};
  }
  return found;
}

/// Returns a place laid onto some planes, in turn.
/// \param slack  farthest way onto a plane, m: where planes hardly differ, their common line may be far away
Vec<3> laid_on(const std::vector<const Plane*>& planes, Vec<3> place, double slack) {
  std::vector<Vec<3>> taken;  // directions in which it may not move any more
  for (const Plane* plane : planes) {
    Vec<3> way = plane->normal;
    for (const Vec<3>& direction : taken) way = way - dot(way, direction) * direction;
    const double length = norm(way), far = plane->distance(place) / length;
    if (length < kParallel || std::abs(far) > slack) continue;
    way *= 1.0 / length;
    place = place - far * way;
    taken.push_back(way);
    for (int d = 0; d < 3; ++d)  // exactly, where the plane is across an axis
      if (std::ranges::count(plane->normal.c, 0.0) == 2 && plane->normal[d] != 0.0)
        place[d] = plane->offset * plane->normal[d];
  }
  return place;
}

/// Lays vertices that are off by rounding onto the sides of their faces. Throws Error where a face of the
/// surface lies on no side.
/// \param number  number of each face in the file
void lay_on_sides(Cells<3>& cells, const Prism& body, const std::vector<int>& number) {
  const double slack = kOffSide * side_of<3>(body.extent() / static_cast<double>(cells.cells.size())),
               exact = kExact * norm(body.high() - body.low());
  std::vector<std::vector<const Plane*>> planes(cells.vertices.size());
  for (std::size_t f = 0; f < cells.faces.size(); ++f) {
    Facet<3>& face = cells.faces[f];
    if (face.outer >= 0) continue;
    const auto [plane, farthest] = plane_of(face, cells, body);
    const Vec<3>& at = cells.vertices[farthest];
    const double off = std::abs(plane->distance(at));
    if (off > slack && !body.walls().empty()) {
      face.side = nearest_wall(face, cells, body);
      continue;
    }
    if (off > slack)
      throw Error(fmt::format(
          "face {} (from 0), of cell {} alone, lies on no side of the body: its corner ({:.6g}, "
          "{:.6g}, {:.6g}) m is {:.3g} m off \"{}\", the nearest; {:.3g} m is allowed, {:g} of a block",
          number[f], face.inner, at[0], at[1], at[2], off, body.sides()[plane->side].name, slack, kOffSide));
    for (const int v : face.corners)
      if (std::ranges::find(planes[v], plane) == planes[v].end()) planes[v].push_back(plane);
  }
  for (std::size_t v = 0; v < planes.size(); ++v) {
    const Vec<3> laid = laid_on(planes[v], cells.vertices[v], kFarthest * slack);
    if (norm(laid - cells.vertices[v]) > exact) cells.vertices[v] = laid;
  }
}

}  // namespace

void lay_on_sides(Cells<2>& cells) {
  auto& at = cells.vertices;
  std::vector<std::vector<int>> loops;
  try {
    loops = loops_of(cells, facets(cells), {});
  } catch (const Error&) {
    return;
  }
  const double slack = slack_of(cells);
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

Region outline_of(const Cells<2>& cells, const Numbering& numbering) {
  const std::vector<Facet<2>> all = facets(cells, numbering);
  try {
    return outline_of_loops(cells, all, numbering);
  } catch (const Error& error) {
    throw Error(error.what() + describe_joinable(cells));
  }
}

GivenCells<2> checked(GivenCells<2> given) {
  Cells<2>& cells = given.cells;
  require_lists(given);
  require_numbers(cells.cells, "cell", 3, {"vertex", "vertices"}, cells.vertices.size());
  std::vector<Vec<2>> polygon;
  for (std::size_t c = 0; c < cells.cells.size(); ++c) {
    corners(cells, c, polygon);
    if (area(polygon) < 0.0) std::ranges::reverse(cells.cells[c]);
  }
  return given;
}

GivenCells<2> completed(GivenCells<2> given, double join) {
  given = joined(checked(std::move(given)), join);
  lay_on_sides(given.cells);
  given.outline = outline_of(given.cells);
  return given;
}

GivenCells<3> completed(GivenCells<3> given, double join) {
  Cells<3>& cells = given.cells;
  require_lists(given);
  std::vector<std::vector<int>> loops;
  for (const Facet<3>& face : cells.faces) loops.push_back(face.corners);
  require_numbers(loops, "face", 3, {"vertex", "vertices"}, cells.vertices.size());
  require_numbers(cells.cells, "cell", 4, {"face", "faces"}, cells.faces.size());
  std::vector<int> number(cells.faces.size());
  std::iota(number.begin(), number.end(), 0);
  if (join > 0.0) number = specimen::join(cells, join);
  find_neighbours(cells, number);
  try {
    if (const std::string pieces = describe_pieces<3>(cells, cells.faces); !pieces.empty())
      throw Error(pieces);
    lay_on_sides(cells, given.outline, number);
    turn_flat_fans(cells);
  } catch (const Error& error) {
    throw Error(error.what() + describe_joinable(cells));
  }
  return given;
}

namespace {

/// Tells whether blocks of a body in space need not fill it exactly.
bool is_cut(const Prism& body) {
  return !body.walls().empty();
}
bool is_cut(const Region& /*region*/) {
  return false;
}

}  // namespace

template <int Dim>
Specimen<Dim> specimen_from(GivenCells<Dim> given) {
  const OutlineOf<Dim>& outline = given.outline;
  const std::string origin = given.origin.empty() ? "The cells" : given.origin;
  if constexpr (Dim == 3)
    for (Facet<3>& face : given.cells.faces)  // those on walls have their side already
      if (face.outer < 0 && (face.side < 0 || outline.walls().empty()))
        face.side = plane_of(face, given.cells, outline).first->side;
  if (!is_cut(outline))
    require_valid(given.cells, outline, origin);
  else if constexpr (Dim == 3)
    require_filled(given.cells, outline, origin);
  Specimen<Dim> specimen{.outline = std::move(given.outline),
                         .cells = std::move(given.cells),
                         .phases = std::move(given.phases),
                         .phase = std::move(given.phase),
                         .stone = std::move(given.stone),
                         .size = std::move(given.size)};
  measure(specimen);
  return specimen;
}

template Specimen<2> specimen_from<2>(GivenCells<2>);
template Specimen<3> specimen_from<3>(GivenCells<3>);

}  // namespace pyroclast::specimen
