#include "pyroclast/specimen/pieces.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numeric>
#include <span>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "pyroclast/base/error.hpp"
#include "pyroclast/specimen/polygon.hpp"
#include "pyroclast/specimen/region.hpp"
#include "pyroclast/specimen/topology.hpp"

namespace pyroclast::specimen {
namespace {

/// Returns the edges that one cell alone has, each as the cell runs along it.
std::vector<Edge> free_edges(const Tessellation& tessellation) {
  std::map<std::pair<int, int>, int> count;
  const auto key = [](int a, int b) { return std::pair(std::min(a, b), std::max(a, b)); };
  const auto for_each = [&](auto f) {
    for (std::size_t c = 0; c < tessellation.cells.size(); ++c) {
      const auto& cell = tessellation.cells[c];
      for (std::size_t i = 0; i < cell.size(); ++i)
        f(cell[i], cell[i + 1 < cell.size() ? i + 1 : 0], static_cast<int>(c));
    }
  };
  for_each([&](int a, int b, int) { ++count[key(a, b)]; });
  std::vector<Edge> edges;
  for_each([&](int a, int b, int cell) {
    if (count[key(a, b)] == 1) edges.push_back({a, b, cell, -1});
  });
  return edges;
}

/// Vertex between the ends of an edge.
struct Hanging {
  std::size_t edge;  ///< index into the edges
  int vertex;
  double share;  ///< distance from the edge's first end, as a share of its length
};

/// Finds the vertices of edges that lie nearer than a distance to another of the edges. Returns them in the
/// order of the edges and along each.
std::vector<Hanging> hanging(const Tessellation& tessellation, std::span<const Edge> edges, double distance) {
  const auto& at = tessellation.vertices;
  std::vector<int> vertices;
  for (const Edge& e : edges) vertices.push_back(e.v0);
  std::ranges::sort(vertices);
  vertices.erase(std::unique(vertices.begin(), vertices.end()), vertices.end());
  std::ranges::sort(vertices, {}, [&](int v) { return std::pair(at[v][0], v); });
  std::vector<Hanging> found;
  for (std::size_t i = 0; i < edges.size(); ++i) {
    const Vec<2>&from = at[edges[i].v0], &to = at[edges[i].v1];
    const double length = norm(to - from);
    const std::size_t before = found.size();
    auto v = std::ranges::lower_bound(vertices, std::min(from[0], to[0]) - distance, {},
                                      [&](int number) { return at[number][0]; });
    for (; v != vertices.end() && at[*v][0] <= std::max(from[0], to[0]) + distance; ++v) {
      const double along = dot(at[*v] - from, to - from) / length;
      if (*v == edges[i].v0 || *v == edges[i].v1 || !(along > distance && length - along > distance))
        continue;
      if (std::abs(cross(at[*v] - from, to - from)) < distance * length)
        found.push_back({i, *v, along / length});
    }
    std::sort(found.begin() + static_cast<std::ptrdiff_t>(before), found.end(),
              [](const Hanging& a, const Hanging& b) { return a.share < b.share; });
  }
  return found;
}

void require_apart(const Cells& cells, const std::vector<int>& first, double distance) {
  for (std::size_t c = 0; c < cells.tessellation.cells.size(); ++c) {
    std::vector<int> corners;
    for (const int v : cells.tessellation.cells[c]) corners.push_back(first[v]);
    std::ranges::sort(corners);
    if (const auto twice = std::ranges::adjacent_find(corners); twice != corners.end()) {
      const Vec<2>& at = cells.tessellation.vertices[*twice];
      throw Error(
          fmt::format("{} has two corners near ({:.6g}, {:.6g}) m that are nearer to each other than "
                      "{:.6g} m, by which vertices are joined; join less",
                      Numbering{}.cell(c), at[0], at[1], distance));
    }
  }
}

/// Drops vertices that no cell has.
void drop_unused(Tessellation& tessellation) {
  std::vector<int> number(tessellation.vertices.size(), -1);
  for (const auto& cell : tessellation.cells)
    for (const int v : cell) number[v] = 0;
  std::vector<Vec<2>> vertices;
  for (std::size_t v = 0; v < number.size(); ++v)
    if (number[v] == 0) {
      number[v] = static_cast<int>(vertices.size());
      vertices.push_back(tessellation.vertices[v]);
    }
  for (auto& cell : tessellation.cells)
    for (int& v : cell) v = number[v];
  tessellation.vertices = std::move(vertices);
}

}  // namespace

template <int Dim>
std::vector<int> first_near(std::span<const Vec<Dim>> vertices, double distance) {
  using Square = std::array<double, Dim>;  // as wide as the distance, in space a cube
  std::map<Square, std::vector<int>> kept;
  constexpr int kAround = Dim == 2 ? 9 : 27;
  std::vector<int> first(vertices.size());
  for (int v = 0; v < static_cast<int>(vertices.size()); ++v) {
    Square own;
    for (int d = 0; d < Dim; ++d) own[d] = std::floor(vertices[v][d] / distance);
    first[v] = v;
    for (int number = 0; number < kAround; ++number) {
      Square square = own;
      for (int d = 0, rest = number; d < Dim; ++d, rest /= 3) square[d] += rest % 3 - 1;
      if (const auto near = kept.find(square); near != kept.end())
        for (const int other : near->second)
          if (norm(vertices[v] - vertices[other]) < distance) first[v] = std::min(first[v], other);
    }
    if (first[v] == v) kept[own].push_back(v);
  }
  return first;
}

template std::vector<int> first_near<2>(std::span<const Vec<2>>, double);
template std::vector<int> first_near<3>(std::span<const Vec<3>>, double);

std::vector<int> pieces_of(std::size_t cells, std::span<const std::pair<int, int>> neighbours) {
  std::vector<int> piece(cells);
  std::iota(piece.begin(), piece.end(), 0);
  const auto root = [&](int c) {
    while (piece[c] != c) c = piece[c] = piece[piece[c]];
    return c;
  };
  for (const auto& [cell, other] : neighbours)
    if (other >= 0) piece[std::max(root(cell), root(other))] = std::min(root(cell), root(other));
  for (int c = 0; c < static_cast<int>(piece.size()); ++c) piece[c] = root(c);
  return piece;
}

std::string describe_pieces(const std::vector<int>& piece, const char* shared,
                            const std::function<std::string(int)>& cell) {
  std::map<int, int> cells;
  for (const int p : piece) ++cells[p];
  if (cells.size() < 2) return {};
  const auto smallest = std::ranges::min_element(cells, {}, [](const auto& p) { return p.second; });
  return fmt::format(
      "the cells are {} pieces that have no {} in common, and must be one: {} is of a piece of {} cell{}",
      cells.size(), shared, cell(smallest->first), smallest->second, smallest->second == 1 ? "" : "s");
}

std::string describe_pieces(const Tessellation& tessellation, std::span<const Edge> edges,
                            const Numbering& numbering) {
  std::vector<std::pair<int, int>> neighbours;
  for (const Edge& e : edges) neighbours.emplace_back(e.left, e.right);
  return describe_pieces(pieces_of(tessellation.cells.size(), neighbours), "edge", [&](int cell) {
    std::vector<Vec<2>> polygon;
    corners(tessellation, cell, polygon);
    const Vec<2> at = centroid(polygon);
    return fmt::format("{} at ({:.6g}, {:.6g}) m", numbering.cell(cell), at[0], at[1]);
  });
}

std::string describe_joinable(const Tessellation& tessellation) {
  const Box box = box_of(tessellation.vertices);
  const double near = kCoincide * std::max(box.width(), box.height());
  if (!(near > 0.0)) return {};
  const std::vector<int> first = first_near<2>(tessellation.vertices, near);
  std::ptrdiff_t coincide = 0;
  for (int v = 0; v < static_cast<int>(first.size()); ++v)
    if (first[v] != v) ++coincide;
  Tessellation merged = tessellation;
  for (auto& cell : merged.cells)
    for (int& v : cell) v = first[v];
  const std::size_t hang = hanging(merged, free_edges(merged), near).size();
  if (coincide == 0 && hang == 0) return "; no vertices coincide, and none lie in edges of other cells";
  return fmt::format(
      "; {} vert{} with others, and {} in an edge of a cell without being a corner of it: join = \"{:.3g} "
      "m\" "
      "joins them",
      coincide, coincide == 1 ? "ex coincides" : "ices coincide",
      hang == 1 ? "1 lies" : fmt::format("{} lie", hang), near);
}

Cells joined(Cells cells, double distance) {
  if (!(distance > 0.0)) return cells;
  Tessellation& t = cells.tessellation;
  const std::vector<int> first = first_near<2>(t.vertices, distance);
  require_apart(cells, first, distance);
  for (auto& cell : t.cells)
    for (int& v : cell) v = first[v];
  const std::vector<Edge> edges = free_edges(t);
  std::vector<bool> is_moved(t.vertices.size(), false);
  const std::vector<Hanging> found = hanging(t, edges, distance);
  for (const Hanging& h : found) {
    if (is_moved[h.vertex]) continue;
    const Vec<2>&from = t.vertices[edges[h.edge].v0], &to = t.vertices[edges[h.edge].v1];
    t.vertices[h.vertex] = from + h.share * (to - from);
    is_moved[h.vertex] = true;
  }
  // from the last to the first, so that each goes right behind the first end of its edge
  for (auto h = found.rbegin(); h != found.rend(); ++h) {
    auto& cell = t.cells[edges[h->edge].left];
    if (std::ranges::find(cell, h->vertex) != cell.end()) continue;
    cell.insert(std::ranges::find(cell, edges[h->edge].v0) + 1, h->vertex);
  }
  drop_unused(t);
  return cells;
}

}  // namespace pyroclast::specimen
