#include "pyroclast/specimen/polyhedra_file.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <numeric>
#include <string_view>
#include <utility>

#include <fmt/format.h>

#include "pyroclast/base/error.hpp"
#include "pyroclast/base/read_file.hpp"
#include "pyroclast/specimen/from_cells.hpp"
#include "pyroclast/specimen/json_lists.hpp"
#include "pyroclast/specimen/pieces.hpp"
#include "pyroclast/specimen/polygon.hpp"

namespace pyroclast::specimen {

namespace {

/// Sine of the angle between two planes of the body below which a vertex on both has no place of its own.
constexpr double kParallel = 1e-4;

/// Reads the coordinates of a place; throws Json::exception for another number of them.
template <int Count>
Vec<Count> place_in_list(const Json& item) {
  const auto stated = item.get<std::array<double, Count>>();
  if (item.size() != Count) throw Json::other_error::create(501, "another number of coordinates", &item);
  return {stated};
}

/// Farthest way onto the line or point where planes meet, over the largest distance from one of them.
constexpr double kFarthest = 10.0;

/// Returns the size of a block in a body, m.
double block_size(double volume, const Cells<3>& cells) {
  return std::cbrt(volume / static_cast<double>(cells.cells.size()));
}

/// Lays corners of a section that jut into the body by no more than `slack` (m) onto the line between their
/// neighbours.
void straighten(std::vector<Vec<2>>& section, double slack) {
  const double sense = area(section) < 0.0 ? -1.0 : 1.0;
  const std::size_t n = section.size();
  for (std::size_t i = 0; i < n; ++i) {
    const Vec<2>&from = section[(i + n - 1) % n], &to = section[(i + 1) % n];
    const Vec<2> along = to - from, off = section[i] - from;
    const double in = sense * cross(along, off) / norm(along);
    if (in > kExact * norm(along) && in <= slack)
      section[i] = from + (dot(off, along) / dot(along, along)) * along;
  }
}

Prism body_in(const Json& json, const Cells<3>& cells) {
  const auto found = json.find("body");
  if (found == json.end() || !found->is_object()) throw Error("there is no table \"body\"");
  const auto sides = list_in(*found, "sides", "a name", text_in);
  auto corners = list_in(*found, "section_m", "a place, [x, y] in m", place_in_list<2>);
  const Json axis = found->value("axis", Json()), length = found->value("length_m", Json());
  if (axis != "y" && axis != "z") throw Error(R"(body: "axis" must be "y" or "z")");
  if (!length.is_number() || !(length.get<double>() > 0.0))
    throw Error("body: \"length_m\" must be a number above 0");
  if (sides.empty()) throw Error("body: \"sides\" must name a side");
  for (std::size_t i = 0; i < sides.size(); ++i)
    if (std::find(sides.begin(), sides.begin() + static_cast<std::ptrdiff_t>(i), sides[i]) !=
        sides.begin() + static_cast<std::ptrdiff_t>(i))
      throw Error(fmt::format("body: two sides are called \"{}\"", sides[i]));
  if (corners.size() >= 3)
    straighten(corners, kOffSide * block_size(std::abs(area(corners)) * length.get<double>(), cells));
  auto section = Region::polygon(std::move(corners), sides, sides.size() == 1);
  return {std::move(section), axis == "y" ? Prism::Axis::y : Prism::Axis::z, length.get<double>()};
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
    if (std::cmp_greater_equal(sorted.back(), there_are))
      throw Error(fmt::format("{} {} (from 0) names {} {} (from 0), but there are {}", item, i, of.one,
                              sorted.back(), there_are));
    if (const auto twice = std::ranges::adjacent_find(sorted); twice != sorted.end())
      throw Error(fmt::format("{} {} (from 0) names {} {} (from 0) twice", item, i, of.one, *twice));
  }
}

/// Tells for each face of a cell whether it goes counter-clockwise seen from outside. A face that shares an
/// edge with one before walks it the other way; then the volume tells in which sense all go.
std::vector<bool> outward_faces(const Cells<3>& cells, std::size_t cell) {
  const auto& faces = cells.cells[cell];
  std::map<std::pair<int, int>, std::vector<std::pair<std::size_t, bool>>> at_edge;  // face, walks it upwards
  const auto for_each_edge = [&](std::size_t i, auto f) {
    const auto& loop = cells.faces[faces[i]].corners;
    for (std::size_t k = 0; k < loop.size(); ++k) {
      const int from = loop[k], to = loop[(k + 1) % loop.size()];
      f(at_edge[std::minmax(from, to)], from < to);
    }
  };
  for (std::size_t i = 0; i < faces.size(); ++i)
    for_each_edge(i, [i](auto& its, bool is_up) { its.emplace_back(i, is_up); });
  std::vector<bool> is_outward(faces.size(), true), is_known(faces.size());
  std::vector<std::size_t> next{0};
  is_known[0] = true;
  while (!next.empty()) {
    const std::size_t i = next.back();
    next.pop_back();
    for_each_edge(i, [&](const auto& its, bool is_up) {
      for (const auto& [other, is_its_up] : its) {
        if (is_known[other]) continue;
        is_known[other] = true;
        is_outward[other] = is_outward[i] == (is_its_up != is_up);
        next.push_back(other);
      }
    });
  }
  double filled = 0.0;
  const Vec<3>& origin = cells.vertices[cells.faces[faces[0]].corners[0]];
  for (std::size_t i = 0; i < faces.size(); ++i) {
    const auto& loop = cells.faces[faces[i]].corners;
    for (std::size_t k = 1; k + 1 < loop.size(); ++k) {
      const Vec<3> a = cells.vertices[loop[0]] - origin, b = cells.vertices[loop[k]] - origin,
                   c = cells.vertices[loop[k + 1]] - origin;
      filled += dot(a, cross(b, c)) * (is_outward[i] ? 1.0 : -1.0);
    }
  }
  if (filled < 0.0) is_outward.flip();
  return is_outward;
}

/// Finds the cells on both sides of each face, and turns the faces of the surface outwards.
/// \param number  number of each face in the file
void find_neighbours(Cells<3>& cells, const std::vector<int>& number) {
  std::vector<std::vector<std::pair<int, bool>>> cells_of(cells.faces.size());
  for (std::size_t cell = 0; cell < cells.cells.size(); ++cell) {
    const auto is_outward = outward_faces(cells, cell);
    for (std::size_t i = 0; i < is_outward.size(); ++i)
      cells_of[cells.cells[cell][i]].emplace_back(static_cast<int>(cell), is_outward[i]);
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
  const double slack = kOffSide * block_size(body.extent(), cells),
               exact = kExact * norm(body.high() - body.low());
  std::vector<std::vector<const Plane*>> planes(cells.vertices.size());
  for (std::size_t f = 0; f < cells.faces.size(); ++f) {
    const Facet<3>& face = cells.faces[f];
    if (face.outer >= 0) continue;
    const auto [plane, farthest] = plane_of(face, cells, body);
    const Vec<3>& at = cells.vertices[farthest];
    if (const double off = std::abs(plane->distance(at)); off > slack)
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

void find_sides(Cells<3>& cells, const Prism& body) {
  for (Facet<3>& face : cells.faces)
    if (face.outer < 0) face.side = plane_of(face, cells, body).first->side;
}

bool are_in_space(const std::string& text) {
  return std::ranges::any_of(std::array{"\"faces\"", "\"body\""}, [&](std::string_view key) {
    for (std::size_t at = text.find(key); at != std::string::npos; at = text.find(key, at + 1))
      if (const std::size_t next = text.find_first_not_of(" \t\r\n", at + key.size());
          next != std::string::npos && text[next] == ':')
        return true;  // a key and no value
    return false;
  });
}

GivenCells<3> read_polyhedra(const std::filesystem::path& file, double join) {
  return polyhedra_from(read_file(file), file.string(), join);
}

GivenCells<3> polyhedra_from(const std::string& text, const std::string& name, double join) {
  GivenCells<3> read;
  read.origin = name;
  read_table(text, name, [&read, join](const Json& json) {
    if (!json.contains("faces") && !json.contains("body") && json.contains("cells"))
      throw Error(
          "holds cells of the plane, without \"faces\" and \"body\", and is read as blocks in space. Cells "
          "of "
          "the plane come by [specimen] shape = \"cells\"");
    read.phases = list_in(json, "phases", "a name", text_in);
    Cells<3>& cells = read.cells;
    cells.vertices = list_in(json, "vertices_m", "a place, [x, y, z] in m", place_in_list<3>);
    const auto corners = list_in(json, "faces", "a list of vertices, each by its number from 0", numbers_in);
    cells.cells = list_in(json, "cells", "a list of faces, each by its number from 0", numbers_in);
    read.phase = list_in(json, "phase", "the number of a phase, from 0", number_in);
    if (json.contains(kBlockSizeInMetres))
      read.size = list_in(json, kBlockSizeInMetres, "a size in m", real_in);
    if (json.contains(kStone)) read.grain = list_in(json, kStone, kStoneItem, number_or_none_in);
    require_lists(cells.cells.size(), read.phases, read.phase, read.size, read.grain);
    require_numbers(corners, "face", 3, {"vertex", "vertices"}, cells.vertices.size());
    require_numbers(cells.cells, "cell", 4, {"face", "faces"}, corners.size());
    for (const auto& of_face : corners) cells.faces.push_back({.corners = of_face});
    read.outline = body_in(json, cells);
    std::vector<int> number(cells.faces.size());
    std::iota(number.begin(), number.end(), 0);
    if (join > 0.0) number = specimen::join(cells, join);
    find_neighbours(cells, number);
    try {
      if (const std::string pieces = describe_pieces<3>(cells, cells.faces); !pieces.empty()) throw Error(pieces);
      lay_on_sides(cells, read.outline, number);
    } catch (const Error& error) {
      throw Error(error.what() + describe_joinable(cells));
    }
  });
  return read;
}

}  // namespace pyroclast::specimen
