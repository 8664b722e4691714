#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <vector>

#include "pyroclast/base/vec.hpp"

namespace pyroclast {

/// Returns, for every point, the lowest number among the points that stand for the same place: those that
/// differ in no component by more than a distance, and those that such points join.
template <int Dim>
std::vector<int> same_points(const std::vector<Vec<Dim>>& points, double distance) {
  std::vector<int> parent(points.size());
  std::iota(parent.begin(), parent.end(), 0);
  const auto root = [&](int i) {
    while (parent[i] != i) i = parent[i] = parent[parent[i]];
    return i;
  };
  // Points are taken along an axis that no wall of a body is likely to be square to, so that few lie near
  // each other by it.
  constexpr std::array<double, 3> kAxis{0.5773, 0.4259, 0.6968};
  struct Place {
    double along;
    int point;
  };
  std::vector<Place> places;
  places.reserve(points.size());
  double reach = 0.0;
  for (int d = 0; d < Dim; ++d) reach += kAxis[d] * distance;
  for (const Vec<Dim>& p : points) {
    double along = 0.0;
    for (int d = 0; d < Dim; ++d) along += kAxis[d] * p[d];
    places.push_back({along, static_cast<int>(places.size())});
  }
  std::ranges::sort(places, {}, &Place::along);
  for (std::size_t i = 0; i < places.size(); ++i)
    for (std::size_t j = i + 1; j < places.size() && places[j].along - places[i].along <= 2.0 * reach; ++j) {
      const Vec<Dim> between = points[places[j].point] - points[places[i].point];
      if (std::ranges::any_of(between.c, [&](double b) { return std::abs(b) > distance; })) continue;
      const int a = root(places[i].point), b = root(places[j].point);
      parent[std::max(a, b)] = std::min(a, b);
    }
  for (int i = 0; i < static_cast<int>(parent.size()); ++i) parent[i] = root(i);
  return parent;
}

}  // namespace pyroclast
