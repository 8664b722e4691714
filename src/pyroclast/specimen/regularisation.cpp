#include "pyroclast/specimen/regularisation.hpp"

#include <algorithm>
#include <array>
#include <numbers>
#include <numeric>
#include <span>
#include <utility>
#include <vector>

#include "pyroclast/base/sort_unique.hpp"
#include "pyroclast/specimen/polygon.hpp"
#include "pyroclast/specimen/topology.hpp"

namespace pyroclast::specimen {
namespace {

constexpr double largest_angle_allowed = largest_block_angle * std::numbers::pi / 180.0;

/// Places along an edge at which its two ends may merge, as shares of it, best first: one near the middle
/// disturbs the blocks least.
constexpr std::array<double, 9> merge_positions{0.5, 0.35, 0.65, 0.2, 0.8, 0.1, 0.9, 0.0, 1.0};

struct Shape {
  double largest_angle;  ///< radians
  double thinnest_zone;  ///< m
};

Shape shape_of(Corners polygon) {
  if (area(polygon) <= 0.0) return {2.0 * std::numbers::pi, 0.0};
  return {largest_angle(polygon), thinnest_zone(polygon)};
}

class Regulariser {
 public:
  Regulariser(Cells<2>& cells, const Region& region, double shortest_edge, const BlockSizes& sizes)
      : cells_(cells),
        share_(shortest_edge),
        sizes_(sizes),
        edges_(facets(cells)),
        kept_(cells.vertices.size()),
        around_(cells.vertices.size()) {
    std::iota(kept_.begin(), kept_.end(), 0);
    for (const Vec<2>& p : cells_.vertices) lines_.push_back(region.lines_at(p));
    for (std::size_t c = 0; c < cells_.cells.size(); ++c) {
      for (const int v : cells_.cells[c]) cells_around(v).push_back(static_cast<int>(c));
    }
  }

  RegularisedCells run() {
    int removed = 0;
    std::vector<Facet<2>> left = short_edges();
    // Each pass raises the mean edge a little and may shorten edges beside a merge, so passes go on until
    // one finds nothing to do.
    for (int before = -1; before < removed && !left.empty();) {
      before = removed;
      for (const Facet<2>& edge : left)
        if (merge(edge.corners[0], edge.corners[1])) ++removed;
      if (removed > before) left = short_edges();
    }
    std::vector<int> unfit = unfit_cells(left);
    drop_unused(cells_);
    return {removed, static_cast<int>(left.size()), std::move(unfit)};
  }

 private:
  Vec<2>& at(int v) { return cells_.vertices[v]; }
  const LineSet& lines_of(int v) const { return lines_[v]; }
  std::vector<int>& cells_around(int v) { return around_[v]; }
  std::vector<int>& cell(int c) { return cells_.cells[c]; }
  bool merged_away(int v) { return cells_around(v).empty(); }

  /// Returns the size of blocks in the middle of an edge over the mean size.
  double relative_at(int v0, int v1) { return sizes_.relative(0.5 * (at(v0) + at(v1))); }

  /// Sets the limits from the mean of the edges as they are now. Returns the edges that are too short,
  /// shortest first.
  std::vector<Facet<2>> short_edges() {
    follow_merges();
    std::vector<double> length;  // over the relative size of the blocks there
    length.reserve(edges_.size());
    double sum = 0.0, relative = 0.0;
    for (const Facet<2>& e : edges_) {
      const double all = norm(at(e.corners[1]) - at(e.corners[0])),
                   size = relative_at(e.corners[0], e.corners[1]);
      length.push_back(all / size);
      sum += all;
      relative += size;
    }
    shortest_ = share_ * sum / relative;
    thinnest_ = sliver_share * shortest_;

    std::vector<std::size_t> order;
    for (std::size_t i = 0; i < length.size(); ++i)
      if (length[i] < shortest_) order.push_back(i);
    std::ranges::stable_sort(order, {}, [&](std::size_t i) { return length[i]; });
    std::vector<Facet<2>> found;
    for (const std::size_t i : order) found.push_back(edges_[i]);
    return found;
  }

  /// Gives edges the vertices that merges have left as their ends, and drops edges whose ends are merged.
  void follow_merges() {
    for (Facet<2>& e : edges_) {
      e.corners[0] = kept(e.corners[0]);
      e.corners[1] = kept(e.corners[1]);
    }
    std::erase_if(edges_, [](const Facet<2>& e) { return e.corners[0] == e.corners[1]; });
  }

  /// Returns the vertex that stands for `v` after all merges.
  int kept(int v) {
    int& next = kept_[v];
    if (next != v) next = kept(next);
    return next;
  }

  /// Merges the two ends of an edge at a place where every block around stays fit. Returns false when there
  /// is no such place, or the edge is not too short any more.
  bool merge(int a, int b) {
    if (merged_away(a) || merged_away(b) || norm(at(b) - at(a)) >= shortest_ * relative_at(a, b))
      return false;
    std::span<const double> positions = merge_positions;
    if (!(lines_of(a) == lines_of(b))) {
      // The end on more lines stays in place. Where each end has lines of its own, no place is on all of
      // them.
      const auto lines = both(lines_of(a), lines_of(b));
      if (lines != lines_of(a) && lines != lines_of(b)) return false;
      positions = lines == lines_of(a) ? positions.last(2).first(1) : positions.last(1);
    }
    gather_blocks(a, b);
    const Vec<2> from = at(a);
    const Vec<2> edge = at(b) - at(a);
    for (const double t : positions) {
      const Vec<2> place = t == 1.0 ? at(b) : from + t * edge;
      if (all_fit(a, b, place)) {
        carry_out(a, b, place);
        return true;
      }
    }
    return false;
  }

  /// Collects the blocks that a merge of a and b touches, and their shapes before it.
  void gather_blocks(int a, int b) {
    touched_ = cells_around(a);
    touched_.insert(touched_.end(), cells_around(b).begin(), cells_around(b).end());
    sort_unique(touched_);
    before_.clear();
    for (const int c : touched_) {
      corners(cells_, c, polygon_);
      before_.push_back(shape_of(polygon_));
    }
  }

  bool all_fit(int a, int b, const Vec<2>& place) {
    const double thinnest = thinnest_ * sizes_.relative(place);
    for (std::size_t i = 0; i < touched_.size(); ++i) {
      polygon_.clear();
      bool moved = false;
      for (const int v : cell(touched_[i])) {
        if (v != a && v != b) {
          polygon_.push_back(at(v));
        } else if (!moved) {
          polygon_.push_back(place);
          moved = true;
        }
      }
      if (polygon_.size() < 3) return false;
      const Shape after = shape_of(polygon_);
      if (after.largest_angle > std::max(largest_angle_allowed, before_[i].largest_angle)) return false;
      if (after.thinnest_zone < std::min(thinnest, before_[i].thinnest_zone)) return false;
    }
    return true;
  }

  void carry_out(int a, int b, const Vec<2>& place) {
    at(a) = place;
    lines_[a] = *both(lines_of(a), lines_of(b));
    for (const int c : cells_around(b)) {
      auto& vertices = cell(c);
      if (std::find(vertices.begin(), vertices.end(), a) != vertices.end()) {
        std::erase(vertices, b);
      } else {
        std::replace(vertices.begin(), vertices.end(), b, a);
      }
    }
    cells_around(b).clear();
    kept_[b] = a;
    cells_around(a) = touched_;
  }

  /// Returns the cells whose seeds stand in the way of fit blocks.
  std::vector<int> unfit_cells(const std::vector<Facet<2>>& left_short) {
    areas_.clear();
    std::vector<int> unfit;
    std::vector<std::size_t> flat;
    for (std::size_t c = 0; c < cells_.cells.size(); ++c) {
      corners(cells_, c, polygon_);
      areas_.push_back(area(polygon_));
      const Shape shape = shape_of(polygon_);
      if (shape.thinnest_zone <= thinnest_ * sizes_.relative(polygon_.front()))
        unfit.push_back(static_cast<int>(c));
      if (shape.largest_angle > largest_angle_allowed) flat.push_back(c);
    }
    for (const std::size_t c : flat) {
      for (const int v : flat_corners(c)) unfit.push_back(smallest_neighbour(v, static_cast<int>(c)));
    }
    for (const Facet<2>& e : left_short)
      unfit.push_back(e.outer < 0 || areas_[e.inner] < areas_[e.outer] ? e.inner : e.outer);
    sort_unique(unfit);
    return unfit;
  }

  std::vector<int> flat_corners(std::size_t c) {
    std::vector<int> flat;
    corners(cells_, c, polygon_);
    for (std::size_t i = 0; i < polygon_.size(); ++i)
      if (interior_angle(polygon_, i) > largest_angle_allowed) flat.push_back(cells_.cells[c][i]);
    return flat;
  }

  /// Returns the smallest of the other cells at a corner where one cell is flat. Two of the others have seeds
  /// close together: this makes the corner flat, whatever cell lies there.
  int smallest_neighbour(int v, int flat) {
    int smallest = flat;
    for (const int c : cells_around(v))
      if (c != flat && (smallest == flat || areas_[c] < areas_[smallest])) smallest = c;
    return smallest;
  }

  Cells<2>& cells_;
  double share_;
  const BlockSizes& sizes_;
  double shortest_ = 0.0, thinnest_ = 0.0;  ///< limits where blocks have their mean size, m
  std::vector<Facet<2>> edges_;
  std::vector<int> kept_;                 ///< vertex into which each one was merged, or itself
  std::vector<LineSet> lines_;            ///< lines of the region on which each vertex lies
  std::vector<std::vector<int>> around_;  ///< cells around each vertex, ascending; empty: merged away
  std::vector<int> touched_;
  std::vector<Shape> before_;
  std::vector<double> areas_;  ///< area of each cell, m^2
  std::vector<Vec<2>> polygon_;
};

}  // namespace

RegularisedCells regularise(Cells<2>& cells, const Region& region, const RegularCells& asked,
                            const BlockSizes& sizes) {
  return Regulariser(cells, region, asked.shortest_edge, sizes).run();
}

}  // namespace pyroclast::specimen
