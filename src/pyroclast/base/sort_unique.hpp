#pragma once

#include <algorithm>
#include <vector>

namespace pyroclast {

/// Sorts the values in ascending order and keeps each value once.
template <class T>
void sort_unique(std::vector<T>& values) {
  std::ranges::sort(values);
  values.erase(std::unique(values.begin(), values.end()), values.end());  // Clang 14 cannot do ranges::unique
}

}  // namespace pyroclast
