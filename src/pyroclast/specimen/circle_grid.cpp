#include "pyroclast/specimen/circle_grid.hpp"

#include <algorithm>
#include <cmath>

namespace pyroclast::specimen {

CircleGrid::CircleGrid(const Box& box, double bin)
    : low_(box.low),
      bin_(bin),
      columns_(std::max(1, static_cast<int>(std::ceil(box.width() / bin)))),
      rows_(std::max(1, static_cast<int>(std::ceil(box.height() / bin)))),
      bins_(static_cast<std::size_t>(columns_) * static_cast<std::size_t>(rows_)) {}

CircleGrid::BinRange CircleGrid::bins(const Vec<2>& lower, const Vec<2>& upper) const {
  const auto index = [&](double x, int axis, int count) {
    return static_cast<int>(std::clamp(std::floor((x - low_[axis]) / bin_), 0.0, count - 1.0));
  };
  return {index(lower[0], 0, columns_), index(upper[0], 0, columns_), index(lower[1], 1, rows_),
          index(upper[1], 1, rows_)};
}

void CircleGrid::insert(const Aggregate& circle) {
  const int id = static_cast<int>(circles_.size());
  circles_.push_back(circle);
  const Vec<2> reach{{0.5 * circle.diameter, 0.5 * circle.diameter}};
  const BinRange range = bins(circle.centre - reach, circle.centre + reach);
  for (int row = range.first_row; row <= range.last_row; ++row) {
    for (int column = range.first_column; column <= range.last_column; ++column) {
      bins_[bin_index(column, row)].push_back(id);
    }
  }
}

bool CircleGrid::overlaps(const Aggregate& circle, double gap) const {
  const double reach = 0.5 * circle.diameter + gap;
  const BinRange range = bins(circle.centre - Vec<2>{{reach, reach}}, circle.centre + Vec<2>{{reach, reach}});
  for (int row = range.first_row; row <= range.last_row; ++row) {
    for (int column = range.first_column; column <= range.last_column; ++column) {
      for (const int id : bins_[bin_index(column, row)]) {
        const Aggregate& other = circles_[static_cast<std::size_t>(id)];
        const Vec<2> between = other.centre - circle.centre;
        const double closest = reach + 0.5 * other.diameter;
        if (dot(between, between) < closest * closest) return true;
      }
    }
  }
  return false;
}

void CircleGrid::collect(const Vec<2>& lower, const Vec<2>& upper, std::vector<Aggregate>& found) const {
  std::vector<int> ids;
  const BinRange range = bins(lower, upper);
  for (int row = range.first_row; row <= range.last_row; ++row) {
    for (int column = range.first_column; column <= range.last_column; ++column) {
      const std::vector<int>& bin = bins_[bin_index(column, row)];
      ids.insert(ids.end(), bin.begin(), bin.end());
    }
  }
  std::sort(ids.begin(), ids.end());
  ids.erase(std::unique(ids.begin(), ids.end()), ids.end());
  found.clear();
  for (const int id : ids) found.push_back(circles_[static_cast<std::size_t>(id)]);
}

}  // namespace pyroclast::specimen
