#pragma once

#include <algorithm>
#include <cstddef>
#include <numeric>
#include <vector>

namespace pyroclast {

/// Sets of numbers that grow by joining; the smallest member stands for its set.
class DisjointSets {
 public:
  explicit DisjointSets(int count) : parent_(static_cast<std::size_t>(count)) {
    std::iota(parent_.begin(), parent_.end(), 0);
  }

  int first_of(int i) {
    while (parent_[i] != i) i = parent_[i] = parent_[parent_[i]];
    return i;
  }

  void join(int i, int j) {
    i = first_of(i);
    j = first_of(j);
    parent_[std::max(i, j)] = std::min(i, j);
  }

 private:
  std::vector<int> parent_;
};

}  // namespace pyroclast
