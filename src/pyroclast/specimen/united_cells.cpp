#include "pyroclast/specimen/united_cells.hpp"

#include <algorithm>
#include <map>
#include <numbers>
#include <set>
#include <utility>

#include "pyroclast/specimen/polygon.hpp"
#include "pyroclast/specimen/regularisation.hpp"
#include "pyroclast/specimen/topology.hpp"

namespace pyroclast::specimen {
namespace {

using Cell = std::vector<int>;  // vertices, counter-clockwise

class Uniter {
 public:
  explicit Uniter(Cells<2>& cells) : cells_(cells), around_(cells.vertices.size()) {
    for (std::size_t c = 0; c < cells.cells.size(); ++c)
      for (const int v : cells.cells[c]) around_[v].insert(static_cast<int>(c));
  }

  /// Unites a group into its first cell, whose others become empty; leaves it as it is where that cannot be
  /// done.
  void unite(const std::vector<int>& group) {
    Cell outline = outline_of(group);
    if (outline.size() < 3) return;
    const std::set<int> members(group.begin(), group.end());
    // vertices that only one other cell has beside the group, by that cell
    std::map<int, Cell> others;
    Cell kept;
    for (const int v : outline) {
      int outside = 0, other = -1;
      for (const int c : around_[v])
        if (!members.contains(c)) {
          ++outside;
          other = c;
        }
      const bool goes = outside == 1 && !is_on_outline(v);
      if (!goes) kept.push_back(v);
      if (goes && !others.contains(other)) others[other] = cells_.cells[other];
      if (goes) std::erase(others[other], v);
    }
    if (!is_convex(kept)) return;
    for (const auto& [number, cell] : others)
      if (!is_convex(cell)) return;
    for (const int c : group)
      for (const int v : cells_.cells[c]) around_[v].erase(c);
    for (const int c : group) cells_.cells[c].clear();
    for (auto& [number, cell] : others) {
      for (const int v : cells_.cells[number]) around_[v].erase(number);
      for (const int v : cell) around_[v].insert(number);
      cells_.cells[number] = std::move(cell);
    }
    for (const int v : kept) around_[v].insert(group.front());
    cells_.cells[group.front()] = std::move(kept);
  }

  /// Leaves out empty cells and vertices without a cell. Returns the former number of each cell.
  std::vector<int> tidy() {
    std::vector<int> former;
    for (std::size_t c = 0; c < cells_.cells.size(); ++c)
      if (!cells_.cells[c].empty()) former.push_back(static_cast<int>(c));
    std::erase_if(cells_.cells, [](const Cell& cell) { return cell.empty(); });
    drop_unused(cells_);
    return former;
  }

 private:
  /// Returns the one loop around a group; empty where there are more.
  Cell outline_of(const std::vector<int>& group) const {
    std::set<std::pair<int, int>> edges;
    for (const int c : group) {
      const Cell& cell = cells_.cells[c];
      for (std::size_t i = 0; i < cell.size(); ++i) {
        const int from = cell[i], to = cell[(i + 1) % cell.size()];
        if (!edges.erase({to, from})) edges.insert({from, to});
      }
    }
    std::map<int, int> next;
    for (const auto& [from, to] : edges)
      if (!next.emplace(from, to).second) return {};
    Cell outline;
    if (next.empty()) return outline;
    int v = next.begin()->first;
    do {
      outline.push_back(v);
      const auto found = next.find(v);
      if (found == next.end()) return {};
      v = found->second;
    } while (v != outline.front() && outline.size() <= next.size());
    return outline.size() == next.size() ? outline : Cell{};
  }

  /// Tells whether a vertex of a group lies on the outline of the body: there an edge has one cell alone.
  bool is_on_outline(int v) const {
    std::map<int, int> ends;  // vertices beside v, and how many cells have the edge to them
    for (const int c : around_[v]) {
      const Cell& cell = cells_.cells[c];
      const auto at = std::ranges::find(cell, v) - cell.begin();
      const auto size = static_cast<std::ptrdiff_t>(cell.size());
      ++ends[cell[(at + 1) % size]];
      ++ends[cell[(at + size - 1) % size]];
    }
    return std::ranges::any_of(ends, [](const auto& end) { return end.second == 1; });
  }

  bool is_convex(const Cell& cell) const {
    if (cell.size() < 3) return false;
    std::vector<Vec<2>> polygon;
    for (const int v : cell) polygon.push_back(cells_.vertices[v]);
    return area(polygon) > 0.0 && largest_angle(polygon) <= largest_block_angle * std::numbers::pi / 180.0;
  }

  Cells<2>& cells_;
  std::vector<std::set<int>> around_;  ///< cells of each vertex
};

}  // namespace

std::vector<int> unite(Cells<2>& cells, const std::vector<std::vector<int>>& groups) {
  Uniter uniter(cells);
  for (const auto& group : groups)
    if (group.size() > 1) uniter.unite(group);
  return uniter.tidy();
}

}  // namespace pyroclast::specimen
