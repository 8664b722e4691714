#pragma once

#include <vector>

#include "pyroclast/specimen/specimen.hpp"

namespace pyroclast::specimen {

/// Circles in a box, found by place: each circle is listed in every bin that its bounding box touches.
class CircleGrid {
 public:
  /// Makes a grid over the box with square bins of about `bin` (m).
  CircleGrid(const Box& box, double bin);

  void insert(const Aggregate& circle);

  /// Tells whether a circle comes closer than `gap` to this one (m).
  bool overlaps(const Aggregate& circle, double gap) const;

  /// Collects the circles whose bins touch the box, each once, in the order of insertion.
  void collect(const Vec<2>& lower, const Vec<2>& upper, std::vector<Aggregate>& found) const;

  const std::vector<Aggregate>& circles() const { return circles_; }

 private:
  struct BinRange {
    int first_column, last_column, first_row, last_row;
  };
  BinRange bins(const Vec<2>& lower, const Vec<2>& upper) const;
  std::size_t bin_index(int column, int row) const {
    return static_cast<std::size_t>(row) * static_cast<std::size_t>(columns_) +
           static_cast<std::size_t>(column);
  }

  Vec<2> low_;
  double bin_;
  int columns_, rows_;
  std::vector<std::vector<int>> bins_;
  std::vector<Aggregate> circles_;
};

}  // namespace pyroclast::specimen
