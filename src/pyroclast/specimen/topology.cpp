#include "pyroclast/specimen/topology.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <utility>

#include <fmt/format.h>

#include "pyroclast/base/error.hpp"
#include "pyroclast/specimen/convex_parts.hpp"
#include "pyroclast/specimen/from_cells.hpp"
#include "pyroclast/specimen/polygon.hpp"

namespace pyroclast::specimen {
namespace {

/// Largest difference of the cells' area from that of the body, over it.
constexpr double kAreaError = 1e-10;

/// Tells whether a corner of a cell bends inwards by more than rounding.
/// \param slack  distance from the line between its neighbours that counts as none, m
bool bends_inwards(const std::vector<Vec<2>>& polygon, double slack) {
  const std::size_t n = polygon.size();
  for (std::size_t i = 0; i < n; ++i) {
    if (interior_angle(polygon, i) <= std::numbers::pi + kInwards) continue;
    if (distance_from_segment(polygon[i], polygon[(i + n - 1) % n], polygon[(i + 1) % n]) > slack)
      return true;
  }
  return false;
}

/// Calls f(from, to, cell) for the edges of each cell in turn.
void for_each_edge(const Cells<2>& cells, auto f) {
  for (std::size_t c = 0; c < cells.cells.size(); ++c) {
    const auto& cell = cells.cells[c];
    for (std::size_t i = 0; i < cell.size(); ++i)
      f(cell[i], cell[i + 1 < cell.size() ? i + 1 : 0], static_cast<int>(c));
  }
}

/// Edge as a cell runs along it.
struct DirectedEdge {
  std::array<int, 2> ends;
  int cell;
};

/// Edges of all cells, in the order of their ends.
class DirectedEdges {
 public:
  explicit DirectedEdges(const Cells<2>& cells) {
    for_each_edge(cells, [this](int from, int to, int cell) { edges_.push_back({{from, to}, cell}); });
    std::ranges::stable_sort(edges_, {}, &DirectedEdge::ends);
  }

  /// Returns the number of cells that run from one vertex to the other, and the last of them (-1: none).
  std::pair<int, int> find(int from, int to) const {
    // Clang 14 cannot do ranges::equal_range
    const std::array ends{from, to};
    const auto begin = std::ranges::lower_bound(edges_, ends, {}, &DirectedEdge::ends);
    auto end = begin;
    while (end != edges_.end() && end->ends == ends) ++end;
    return {static_cast<int>(end - begin), end == begin ? -1 : (end - 1)->cell};
  }

 private:
  std::vector<DirectedEdge> edges_;
};

/// Keeps the items that are used, and renumbers them in `lists`. Returns the number that each had.
template <class T, class Numbers>
std::vector<int> keep_used(std::vector<T>& items, Numbers& lists, auto numbers_of) {
  std::vector<int> number(items.size(), -1), former;
  for (const auto& list : lists)
    for (const int i : numbers_of(list)) number[i] = 0;
  std::vector<T> kept;
  for (std::size_t i = 0; i < items.size(); ++i) {
    if (number[i] < 0) continue;
    number[i] = static_cast<int>(kept.size());
    former.push_back(static_cast<int>(i));
    kept.push_back(std::move(items[i]));
  }
  for (auto& list : lists)
    for (int& i : numbers_of(list)) i = number[i];
  items = std::move(kept);
  return former;
}

}  // namespace

std::string Numbering::cell(std::size_t number) const {
  return in_file.empty() ? fmt::format("cell {} (from 0)", number)
                         : fmt::format("cell {} (from 1)", in_file[number]);
}

void corners(const Cells<2>& cells, std::size_t cell, std::vector<Vec<2>>& result) {
  result.clear();
  for (const int v : cells.cells[cell]) result.push_back(cells.vertices[static_cast<std::size_t>(v)]);
}

void drop_unused(Cells<2>& cells) {
  keep_used(
      cells.vertices, cells.cells, [](auto& cell) -> auto& { return cell; });
}

std::vector<int> drop_unused(Cells<3>& cells) {
  const auto former = keep_used(
      cells.faces, cells.cells, [](auto& cell) -> auto& { return cell; });
  keep_used(
      cells.vertices, cells.faces, [](auto& face) -> auto& { return face.corners; });
  return former;
}

double extent(const Cells<2>& cells, std::size_t cell) {
  std::vector<Vec<2>> polygon;
  corners(cells, cell, polygon);
  return area(polygon);
}

Vec<2> centroid(const Cells<2>& cells, std::size_t cell) {
  std::vector<Vec<2>> polygon;
  corners(cells, cell, polygon);
  return centroid(polygon);
}

std::vector<Facet<2>> facets(const Cells<2>& cells, const Numbering& numbering) {
  const DirectedEdges directed(cells);
  std::vector<Facet<2>> result;
  for_each_edge(cells, [&](int v0, int v1, int cell) {
    const auto [partners, other] = directed.find(v1, v0);
    if (partners > 1 || directed.find(v0, v1).first > 1) {
      const Vec<2>&from = cells.vertices[v0], &to = cells.vertices[v1];
      throw Error(fmt::format(
          "{} overlaps another: both have the edge from ({:.6g}, {:.6g}) to ({:.6g}, {:.6g}) m, in the "
          "same sense",
          numbering.cell(static_cast<std::size_t>(cell)), from[0], from[1], to[0], to[1]));
    }
    if (other < 0 || other > cell) result.push_back({{v0, v1}, cell, other});
  });
  return result;
}

std::vector<Facet<2>> free_edges(const Cells<2>& cells) {
  const DirectedEdges directed(cells);
  std::vector<Facet<2>> edges;
  for_each_edge(cells, [&](int a, int b, int cell) {
    if (directed.find(a, b).first + directed.find(b, a).first == 1) edges.push_back({{a, b}, cell});
  });
  return edges;
}

std::vector<int> mismatched_cells(const Cells<2>& cells, const Region& region) {
  const DirectedEdges directed(cells);
  std::vector<LineSet> on;
  for (const Vec<2>& p : cells.vertices) on.push_back(region.lines_at(p));
  std::vector<char> is_matched;
  for (const auto& cell : cells.cells) is_matched.push_back(cell.size() >= 3);
  for_each_edge(cells, [&](int v0, int v1, int cell) {
    const int partners = region.is_outline(on[v0], on[v1]) ? 0 : 1;
    if (directed.find(v0, v1).first != 1 || directed.find(v1, v0).first != partners) is_matched[cell] = 0;
  });
  std::vector<int> result;
  for (std::size_t c = 0; c < is_matched.size(); ++c)
    if (!is_matched[c]) result.push_back(static_cast<int>(c));
  return result;
}

void require_valid(const Cells<2>& cells, const Region& region, const std::string& origin,
                   const Numbering& numbering) {
  const std::vector<int> mismatched = mismatched_cells(cells, region);
  if (!mismatched.empty()) {
    const Vec<2>& at = cells.vertices[cells.cells[mismatched.front()].front()];
    throw Error(fmt::format(
        "{}: {} of {} cells do not fit together with their neighbours, the first is {} near "
        "({:.6g}, {:.6g}) m.",
        origin, mismatched.size(), cells.cells.size(), numbering.cell(mismatched.front()), at[0], at[1]));
  }
  double total = 0.0;
  const double slack = kOffSide * std::sqrt(region.extent() / static_cast<double>(cells.cells.size()));
  std::vector<Vec<2>> polygon;
  for (std::size_t c = 0; c < cells.cells.size(); ++c) {
    corners(cells, c, polygon);
    const double cell_area = area(polygon);
    total += cell_area;
    if (!(cell_area > 0.0) || bends_inwards(polygon, slack) || !(thinnest_zone(polygon) > 0.0)) {
      throw Error(fmt::format("{}: {} near ({:.6g}, {:.6g}) m is not convex or has no area.", origin,
                              numbering.cell(c), polygon.front()[0], polygon.front()[1]));
    }
  }
  if (std::abs(total - region.extent()) > kAreaError * region.extent())
    throw Error(fmt::format(
        "{}: the cells cover {:.12g} m^2, the body has {:.12g} m^2; both may differ by {:g} of it.", origin,
        total, region.extent(), kAreaError));
}

}  // namespace pyroclast::specimen
