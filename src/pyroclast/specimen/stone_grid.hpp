#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <span>
#include <vector>

#include "pyroclast/base/sort_unique.hpp"
#include "pyroclast/specimen/stone.hpp"

namespace pyroclast::specimen {

/// Round stones in a box, found by place: each is listed in every bin that its bounding box touches.
template <int Dim>
class StoneGrid {
 public:
  /// Makes a grid over a box.
  /// \param bin  edge of its bins, about, m
  StoneGrid(const Vec<Dim>& low, const Vec<Dim>& high, double bin) : low_(low), bin_(bin) {
    std::size_t bins = 1;
    for (int d = 0; d < Dim; ++d) {
      count_[d] = std::max(1, static_cast<int>(std::ceil((high[d] - low[d]) / bin)));
      bins *= static_cast<std::size_t>(count_[d]);
    }
    bins_.resize(bins);
  }
  /// Makes a grid over a box for stones, and inserts them. Its bins are twice as wide as the smallest.
  StoneGrid(const Vec<Dim>& low, const Vec<Dim>& high, std::span<const Stone<Dim>> stones)
      : StoneGrid(low, high, bin_for(low, high, stones)) {
    for (const Stone<Dim>& stone : stones) insert(stone);
  }

  void insert(const Stone<Dim>& stone) {
    const int number = static_cast<int>(stones_.size());
    stones_.push_back(stone);
    for_each_bin(bins_, reach(stone, 0.0), [&](std::vector<int>& bin) {
      bin.push_back(number);
      return true;
    });
  }

  /// Tells whether a stone comes closer than `gap` to this one (m).
  bool overlaps(const Stone<Dim>& stone, double gap) const {
    const auto are_all_away = [&](auto is_closer) {
      return for_each_bin(bins_, reach(stone, gap), [&](const std::vector<int>& bin) {
        return std::ranges::none_of(bin, [&](int number) { return is_closer(stone, stones_[number], gap); });
      });
    };
    // most stones that lie on another one are found out by the balls within both
    return (stone.shape && !are_all_away(are_surely_closer<Dim>)) || !are_all_away(are_closer<Dim>);
  }

  /// Collects the numbers of the stones whose bins touch a box, each once, in the order of insertion.
  void collect(const Vec<Dim>& lower, const Vec<Dim>& upper, std::vector<int>& found) const {
    found.clear();
    for_each_bin(bins_, Reach{lower, upper}, [&](const std::vector<int>& bin) {
      found.insert(found.end(), bin.begin(), bin.end());
      return true;
    });
    sort_unique(found);
  }

  const std::vector<Stone<Dim>>& stones() const { return stones_; }

 private:
  struct Reach {
    Vec<Dim> lower, upper;
  };
  static double bin_for(const Vec<Dim>& low, const Vec<Dim>& high, std::span<const Stone<Dim>> stones) {
    double bin = norm(high - low);
    for (const Stone<Dim>& stone : stones) bin = std::min(bin, 2.0 * stone.diameter);
    return bin;
  }
  static Reach reach(const Stone<Dim>& stone, double gap) {
    Vec<Dim> radius;
    radius.c.fill(specimen::reach(stone) + gap);
    return {stone.centre - radius, stone.centre + radius};
  }

  /// Calls `f(bin)` for the bins that a box touches while it returns true. Tells whether it always did.
  template <class Bins, class F>
  bool for_each_bin(Bins& bins, const Reach& box, F f) const {
    std::array<int, Dim> first, last;
    for (int d = 0; d < Dim; ++d) {
      const auto index = [&](double x) {
        return static_cast<int>(std::clamp(std::floor((x - low_[d]) / bin_), 0.0, count_[d] - 1.0));
      };
      first[d] = index(box.lower[d]);
      last[d] = index(box.upper[d]);
    }
    std::array<int, Dim> at = first;
    while (true) {
      std::size_t bin = 0;
      for (int d = Dim - 1; d >= 0; --d) bin = bin * static_cast<std::size_t>(count_[d]) + at[d];
      if (!f(bins[bin])) return false;
      int d = 0;
      for (; d < Dim; ++d) {
        if (++at[d] <= last[d]) break;
        at[d] = first[d];
      }
      if (d == Dim) return true;
    }
  }

  Vec<Dim> low_;
  double bin_;
  std::array<int, Dim> count_;
  std::vector<std::vector<int>> bins_;
  std::vector<Stone<Dim>> stones_;
};

}  // namespace pyroclast::specimen
