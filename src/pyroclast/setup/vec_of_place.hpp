#pragma once

#include <utility>

#include "pyroclast/base/vec.hpp"

namespace pyroclast {

/// Returns a place of a deck as a vector, m.
inline Vec<2> vec_of(const std::pair<double, double>& place) {
  return {{place.first, place.second}};
}

}  // namespace pyroclast
