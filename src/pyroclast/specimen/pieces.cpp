#include "pyroclast/specimen/pieces.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <map>
#include <numeric>
#include <span>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "pyroclast/base/error.hpp"
#include "pyroclast/base/sort_unique.hpp"
#include "pyroclast/specimen/polygon.hpp"
#include "pyroclast/specimen/region.hpp"
#include "pyroclast/specimen/topology.hpp"

namespace pyroclast::specimen {
namespace {

/// Vertex between the ends of an edge.
struct Hanging {
  std::size_t edge;  ///< index into the edges
  int vertex;
  double share;  ///< distance from the edge's first end, as a share of its length
};

/// Finds the vertices of edges that lie nearer than a distance to another of the edges. Returns them in the
/// order of the edges and along each.
std::vector<Hanging> hanging(const Cells<2>& cells, std::span<const Facet<2>> edges, double distance) {
  const auto& at = cells.vertices;
  std::vector<int> vertices;
  for (const Facet<2>& e : edges) vertices.push_back(e.corners[0]);
  sort_unique(vertices);
  std::ranges::sort(vertices, {}, [&](int v) { return std::pair(at[v][0], v); });
  std::vector<Hanging> found;
  for (std::size_t i = 0; i < edges.size(); ++i) {
    const Vec<2>&from = at[edges[i].corners[0]], &to = at[edges[i].corners[1]];
    const double length = norm(to - from);
    const std::size_t before = found.size();
    auto v = std::ranges::lower_bound(vertices, std::min(from[0], to[0]) - distance, {},
                                      [&](int number) { return at[number][0]; });
    for (; v != vertices.end() && at[*v][0] <= std::max(from[0], to[0]) + distance; ++v) {
      const double along = dot(at[*v] - from, to - from) / length;
      if (*v == edges[i].corners[0] || *v == edges[i].corners[1] ||
          !(along > distance && length - along > distance))
        continue;
      if (std::abs(cross(at[*v] - from, to - from)) < distance * length)
        found.push_back({i, *v, along / length});
    }
    std::sort(found.begin() + static_cast<std::ptrdiff_t>(before), found.end(),
              [](const Hanging& a, const Hanging& b) { return a.share < b.share; });
  }
  return found;
}

/// Throws Error where two corners of an item are as near to each other as vertices that are joined.
/// \param corners_of  function from an item to its corners
/// \param item        word for an item, "cell" or "face"
template <int Dim>
void require_apart(const Cells<Dim>& cells, const auto& items, auto corners_of, const char* item,
                   const std::vector<int>& first, double distance) {
  for (std::size_t i = 0; i < items.size(); ++i) {
    std::vector<int> corners;
    for (const int v : corners_of(items[i])) corners.push_back(first[v]);
    std::ranges::sort(corners);
    if (const auto twice = std::ranges::adjacent_find(corners); twice != corners.end())
      throw Error(
          fmt::format("{} {} (from 0) has two corners near ({:.6g}) m that are nearer to each other "
                      "than {:.6g} m, by which vertices are joined; join less",
                      item, i, fmt::join(cells.vertices[*twice].c, ", "), distance));
  }
}

/// Returns the corners of a face from the lowest on, towards the lower of its neighbours: the same for two
/// faces that have the same corners in turn.
std::vector<int> from_lowest(std::vector<int> corners) {
  std::rotate(corners.begin(), std::ranges::min_element(corners), corners.end());
  if (corners.back() < corners[1]) std::reverse(corners.begin() + 1, corners.end());
  return corners;
}

/// Returns for each face the first one with the same corners in turn, or the face itself.
/// \param first  vertex that stands for each vertex
std::vector<int> first_alike(const Cells<3>& cells, const std::vector<int>& first) {
  std::map<std::vector<int>, int> known;
  std::vector<int> alike;
  for (const Facet<3>& face : cells.faces) {
    std::vector<int> corners;
    for (const int v : face.corners) corners.push_back(first[v]);
    alike.push_back(
        known.emplace(from_lowest(std::move(corners)), static_cast<int>(alike.size())).first->second);
  }
  return alike;
}

/// Returns the distance below which vertices coincide in messages, m; 0 where all lie at one place.
template <int Dim>
double coincidence_of(const std::vector<Vec<Dim>>& vertices) {
  double size = 0.0;
  for (int d = 0; d < Dim; ++d) {
    const auto [low, high] = std::ranges::minmax(vertices, {}, [d](const Vec<Dim>& v) { return v[d]; });
    size = std::max(size, high[d] - low[d]);
  }
  return kCoincide * size;
}

/// Returns how many items are not the first of their kind.
std::ptrdiff_t repeats(const std::vector<int>& first) {
  std::ptrdiff_t count = 0;
  for (int i = 0; i < static_cast<int>(first.size()); ++i) count += first[i] != i ? 1 : 0;
  return count;
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

template <int Dim>
std::string describe_pieces(const Cells<Dim>& cells, std::span<const Facet<Dim>> facets,
                            const Numbering& numbering) {
  std::vector<std::pair<int, int>> neighbours;
  for (const Facet<Dim>& facet : facets) neighbours.emplace_back(facet.inner, facet.outer);
  const std::vector<int> piece = pieces_of(cells.cells.size(), neighbours);
  std::map<int, int> count;
  for (const int p : piece) ++count[p];
  if (count.size() < 2) return {};
  const auto smallest = std::ranges::min_element(count, {}, [](const auto& p) { return p.second; });
  const auto cell = static_cast<std::size_t>(smallest->first);
  return fmt::format(
      "the cells are {} pieces that have no {} in common, and must be one: {} at ({:.6g}) m is "
      "of a piece of {} cell{}",
      count.size(), Dim == 2 ? "edge" : "face", numbering.cell(cell),
      fmt::join(centroid(cells, cell).c, ", "), smallest->second, smallest->second == 1 ? "" : "s");
}

template std::string describe_pieces<2>(const Cells<2>&, std::span<const Facet<2>>, const Numbering&);
template std::string describe_pieces<3>(const Cells<3>&, std::span<const Facet<3>>, const Numbering&);

std::string describe_joinable(const Cells<2>& cells) {
  const double near = coincidence_of(cells.vertices);
  if (!(near > 0.0)) return {};
  const std::vector<int> first = first_near<2>(cells.vertices, near);
  const std::ptrdiff_t coincide = repeats(first);
  Cells<2> merged = cells;
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

GivenCells<2> joined(GivenCells<2> cells, double distance) {
  if (!(distance > 0.0)) return cells;
  Cells<2>& t = cells.cells;
  const std::vector<int> first = first_near<2>(t.vertices, distance);
  require_apart(t, t.cells, std::identity(), "cell", first, distance);
  for (auto& cell : t.cells)
    for (int& v : cell) v = first[v];
  const std::vector<Facet<2>> edges = free_edges(t);
  std::vector<bool> is_moved(t.vertices.size(), false);
  const std::vector<Hanging> found = hanging(t, edges, distance);
  for (const Hanging& h : found) {
    if (is_moved[h.vertex]) continue;
    const Vec<2>&from = t.vertices[edges[h.edge].corners[0]], &to = t.vertices[edges[h.edge].corners[1]];
    t.vertices[h.vertex] = from + h.share * (to - from);
    is_moved[h.vertex] = true;
  }
  // from the last to the first, so that each goes right behind the first end of its edge
  for (auto h = found.rbegin(); h != found.rend(); ++h) {
    auto& cell = t.cells[edges[h->edge].inner];
    if (std::ranges::find(cell, h->vertex) != cell.end()) continue;
    cell.insert(std::ranges::find(cell, edges[h->edge].corners[0]) + 1, h->vertex);
  }
  drop_unused(t);
  return cells;
}

std::vector<int> join(Cells<3>& cells, double distance) {
  const std::vector<int> first = first_near<3>(cells.vertices, distance);
  require_apart(cells, cells.faces, std::mem_fn(&Facet<3>::corners), "face", first, distance);
  const std::vector<int> alike = first_alike(cells, first);
  for (Facet<3>& face : cells.faces)
    for (int& v : face.corners) v = first[v];
  for (auto& cell : cells.cells)
    for (int& face : cell) face = alike[face];
  return drop_unused(cells);
}

std::string describe_joinable(const Cells<3>& cells) {
  const double near = coincidence_of(cells.vertices);
  if (!(near > 0.0)) return {};
  const std::vector<int> first = first_near<3>(cells.vertices, near);
  const std::ptrdiff_t vertices = repeats(first), faces = repeats(first_alike(cells, first));
  if (vertices == 0 && faces == 0) return "; no vertices coincide, and no face has the corners of another";
  const std::string coincide =
      fmt::format("; {} vert{} with others", vertices, vertices == 1 ? "ex coincides" : "ices coincide");
  if (faces == 0)
    return coincide + ", but no face has the corners of another then: neighbours must share whole faces";
  return fmt::format("{}, and {} the corners of another: join = \"{:.3g} m\" joins them", coincide,
                     faces == 1 ? "1 face has" : fmt::format("{} faces have", faces), near);
}

}  // namespace pyroclast::specimen
