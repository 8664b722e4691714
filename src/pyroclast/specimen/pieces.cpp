#include "pyroclast/specimen/pieces.hpp"

#include <algorithm>
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

/// Distance below which vertices coincide in messages, as a share of the body's size.
constexpr double kCoincide = 1e-6;

/// Returns for each vertex the first one that lies nearer than a distance, or the vertex itself.
std::vector<int> firsts(std::span<const Vec<2>> vertices, double distance) {
  std::map<std::pair<double, double>, std::vector<int>> kept;  // by squares as wide as the distance
  std::vector<int> first(vertices.size());
  for (int v = 0; v < static_cast<int>(vertices.size()); ++v) {
    const double column = std::floor(vertices[v][0] / distance), row = std::floor(vertices[v][1] / distance);
    first[v] = v;
    for (const double x : {-1.0, 0.0, 1.0})
      for (const double y : {-1.0, 0.0, 1.0})
        if (const auto near = kept.find({column + x, row + y}); near != kept.end())
          for (const int other : near->second)
            if (norm(vertices[v] - vertices[other]) < distance) first[v] = std::min(first[v], other);
    if (first[v] == v) kept[{column, row}].push_back(v);
  }
  return first;
}

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

/// Returns a number for each cell; cells that are joined by edges have the same.
std::vector<int> pieces_of(std::size_t cells, std::span<const Edge> edges) {
  std::vector<int> piece(cells);
  std::iota(piece.begin(), piece.end(), 0);
  const auto root = [&](int c) {
    while (piece[c] != c) c = piece[c] = piece[piece[c]];
    return c;
  };
  for (const Edge& e : edges)
    if (e.right >= 0) piece[std::max(root(e.left), root(e.right))] = std::min(root(e.left), root(e.right));
  for (int c = 0; c < static_cast<int>(piece.size()); ++c) piece[c] = root(c);
  return piece;
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

std::string describe_pieces(const Tessellation& tessellation, std::span<const Edge> edges,
                            const Numbering& numbering) {
  const std::vector<int> piece = pieces_of(tessellation.cells.size(), edges);
  std::map<int, int> cells;
  for (const int p : piece) ++cells[p];
  if (cells.size() < 2) return {};
  const auto smallest = std::ranges::min_element(cells, {}, [](const auto& p) { return p.second; });
  std::vector<Vec<2>> polygon;
  corners(tessellation, smallest->first, polygon);
  const Vec<2> at = centroid(polygon);
  std::string text = fmt::format(
      "the cells are {} pieces that have no edge in common, and must be one: {} at ({:.6g}, {:.6g}) m is of "
      "a "
      "piece of {} cell{}",
      cells.size(), numbering.cell(smallest->first), at[0], at[1], smallest->second,
      smallest->second == 1 ? "" : "s");
  return text;
}

std::string describe_joinable(const Tessellation& tessellation) {
  const Box box = box_of(tessellation.vertices);
  const double near = kCoincide * std::max(box.width(), box.height());
  if (!(near > 0.0)) return {};
  const std::vector<int> first = firsts(tessellation.vertices, near);
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
  const std::vector<int> first = firsts(t.vertices, distance);
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
