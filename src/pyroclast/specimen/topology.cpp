#include "pyroclast/specimen/topology.hpp"

#include <cmath>
#include <numbers>
#include <numeric>
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

/// Edges of all cells as the cells run along them, listed by the vertex from which they start.
class DirectedEdges {
 public:
  struct Entry {
    int to;
    int cell;
  };

  explicit DirectedEdges(const Cells<2>& tessellation) : first_(tessellation.vertices.size() + 1, 0) {
    std::size_t total = 0;
    for (const auto& cell : tessellation.cells) {
      total += cell.size();
      for (const int v : cell) ++first_[static_cast<std::size_t>(v) + 1];
    }
    std::partial_sum(first_.begin(), first_.end(), first_.begin());
    entries_.resize(total);
    std::vector<std::size_t> next(first_.begin(), first_.end() - 1);
    for (std::size_t c = 0; c < tessellation.cells.size(); ++c) {
      const auto& cell = tessellation.cells[c];
      for (std::size_t i = 0; i < cell.size(); ++i) {
        const int to = cell[i + 1 < cell.size() ? i + 1 : 0];
        entries_[next[static_cast<std::size_t>(cell[i])]++] = {to, static_cast<int>(c)};
      }
    }
  }

  /// Returns the number of cells that run from one vertex to the other, and the last of them (-1: none).
  std::pair<int, int> find(int from, int to) const {
    std::pair<int, int> found{0, -1};
    for (std::size_t i = first_[static_cast<std::size_t>(from)];
         i < first_[static_cast<std::size_t>(from) + 1]; ++i) {
      if (entries_[i].to == to) found = {found.first + 1, entries_[i].cell};
    }
    return found;
  }

 private:
  std::vector<std::size_t> first_;
  std::vector<Entry> entries_;
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

void corners(const Cells<2>& tessellation, std::size_t cell, std::vector<Vec<2>>& result) {
  result.clear();
  for (const int v : tessellation.cells[cell])
    result.push_back(tessellation.vertices[static_cast<std::size_t>(v)]);
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

std::vector<Facet<2>> facets(const Cells<2>& tessellation, const Numbering& numbering) {
  const DirectedEdges directed(tessellation);
  std::vector<Facet<2>> result;
  for (std::size_t c = 0; c < tessellation.cells.size(); ++c) {
    const auto& cell = tessellation.cells[c];
    for (std::size_t i = 0; i < cell.size(); ++i) {
      const int v0 = cell[i];
      const int v1 = cell[i + 1 < cell.size() ? i + 1 : 0];
      const auto [partners, other] = directed.find(v1, v0);
      if (partners > 1 || directed.find(v0, v1).first > 1) {
        const Vec<2>&from = tessellation.vertices[v0], &to = tessellation.vertices[v1];
        throw Error(fmt::format(
            "{} overlaps another: both have the edge from ({:.6g}, {:.6g}) to ({:.6g}, {:.6g}) m, in the "
            "same sense",
            numbering.cell(c), from[0], from[1], to[0], to[1]));
      }
      const int left = static_cast<int>(c);
      if (other < 0 || other > left) result.push_back({{v0, v1}, left, other});
    }
  }
  return result;
}

std::vector<int> mismatched_cells(const Cells<2>& tessellation, const Region& region) {
  const DirectedEdges directed(tessellation);
  std::vector<LineSet> on;
  for (const Vec<2>& p : tessellation.vertices) on.push_back(region.lines_at(p));
  std::vector<int> result;
  for (std::size_t c = 0; c < tessellation.cells.size(); ++c) {
    const auto& cell = tessellation.cells[c];
    bool matched = cell.size() >= 3;
    for (std::size_t i = 0; matched && i < cell.size(); ++i) {
      const int v0 = cell[i];
      const int v1 = cell[i + 1 < cell.size() ? i + 1 : 0];
      const bool on_outline =
          region.is_outline(on[static_cast<std::size_t>(v0)], on[static_cast<std::size_t>(v1)]);
      matched = directed.find(v0, v1).first == 1 && directed.find(v1, v0).first == (on_outline ? 0 : 1);
    }
    if (!matched) result.push_back(static_cast<int>(c));
  }
  return result;
}

void require_valid(const Cells<2>& tessellation, const Region& region, const std::string& origin,
                   const Numbering& numbering) {
  const std::vector<int> mismatched = mismatched_cells(tessellation, region);
  if (!mismatched.empty()) {
    const Vec<2>& at = tessellation.vertices[tessellation.cells[mismatched.front()].front()];
    throw Error(
        fmt::format("{}: {} of {} cells do not fit together with their neighbours, the first is {} near "
                    "({:.6g}, {:.6g}) m.",
                    origin, mismatched.size(), tessellation.cells.size(), numbering.cell(mismatched.front()),
                    at[0], at[1]));
  }
  double total = 0.0;
  const double slack = kOffSide * std::sqrt(region.extent() / static_cast<double>(tessellation.cells.size()));
  std::vector<Vec<2>> polygon;
  for (std::size_t c = 0; c < tessellation.cells.size(); ++c) {
    corners(tessellation, c, polygon);
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
