#include "pyroclast/specimen/convex_parts.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

namespace pyroclast::specimen {
namespace {

/// Largest number of corners of a polygon that is cut; cells have some ten.
constexpr std::size_t kMostCorners = 100;

/// Returns the angle from one direction to another, counter-clockwise, radians in [0, 2 pi).
double turn(const Vec<2>& from, const Vec<2>& to) {
  const double angle = std::atan2(cross(from, to), dot(from, to));
  return angle < 0.0 ? angle + 2.0 * std::numbers::pi : angle;
}

bool touch_each_other(const Vec<2>& a, const Vec<2>& b, const Vec<2>& c, const Vec<2>& d) {
  const auto side = [](const Vec<2>& from, const Vec<2>& to, const Vec<2>& p) {
    return cross(to - from, p - from);
  };
  return side(a, b, c) * side(a, b, d) <= 0.0 && side(c, d, a) * side(c, d, b) <= 0.0;
}

/// Part of a polygon: its corners and their numbers.
struct Part {
  std::vector<Vec<2>> corners;
  std::vector<int> numbers;

  std::size_t size() const { return corners.size(); }
  const Vec<2>& at(std::size_t i) const { return corners[i % size()]; }

  /// Returns the smallest of the four angles that a cut from one corner to another makes, radians; not
  /// positive where the cut does not run within the part.
  double smallest_angle_of_cut(std::size_t from, std::size_t to) const {
    double smallest = 2.0 * std::numbers::pi;
    for (const auto& [here, there] : {std::pair{from, to}, std::pair{to, from}}) {
      const double before = turn(at(here + 1) - at(here), at(there) - at(here));
      smallest = std::min({smallest, before, interior_angle(corners, here) - before});
    }
    for (std::size_t i = 0; i < size(); ++i) {
      const std::size_t next = (i + 1) % size();
      if (i == from || i == to || next == from || next == to) continue;
      if (touch_each_other(at(from), at(to), at(i), at(next))) return 0.0;
    }
    return smallest;
  }

  /// Returns the part with the corners from one to another.
  Part stretch(std::size_t from, std::size_t to) const {
    Part part;
    for (std::size_t i = from;; i = (i + 1) % size()) {
      part.corners.push_back(corners[i]);
      part.numbers.push_back(numbers[i]);
      if (i == to) return part;
    }
  }
};

void cut(const Part& part, std::vector<std::vector<int>>& parts) {
  std::size_t dent = 0;
  double widest = 0.0;
  for (std::size_t i = 0; i < part.size(); ++i) {
    const double angle = interior_angle(part.corners, i);
    if (angle > widest) {
      widest = angle;
      dent = i;
    }
  }
  std::size_t best = dent;
  if (widest > std::numbers::pi + kInwards && part.size() <= kMostCorners) {
    double best_angle = 0.0;
    for (std::size_t step = 2; step + 1 < part.size(); ++step) {
      const std::size_t other = (dent + step) % part.size();
      const double angle = part.smallest_angle_of_cut(dent, other);
      if (angle > best_angle) {
        best_angle = angle;
        best = other;
      }
    }
  }
  if (best == dent) {
    parts.push_back(part.numbers);
    return;
  }
  cut(part.stretch(dent, best), parts);
  cut(part.stretch(best, dent), parts);
}

}  // namespace

std::vector<std::vector<int>> convex_parts(Corners polygon) {
  Part whole{.corners = {polygon.begin(), polygon.end()}, .numbers = {}};
  for (int i = 0; i < static_cast<int>(polygon.size()); ++i) whole.numbers.push_back(i);
  std::vector<std::vector<int>> parts;
  cut(whole, parts);
  return parts;
}

}  // namespace pyroclast::specimen
