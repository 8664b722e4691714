#pragma once

#include <algorithm>
#include <iterator>

namespace pyroclast {

/// Returns the position of an item in a list; the length of the list where the item is not in it.
template <class List, class Item>
int place_in(const List& list, const Item& item) {
  return static_cast<int>(std::ranges::find(list, item) - std::ranges::begin(list));
}

/// Returns the position of an item in an ascending list; -1 where the item is not in it.
template <class List, class Item>
int place_in_ascending(const List& list, const Item& item) {
  const auto found = std::ranges::lower_bound(list, item);
  if (found == std::ranges::end(list) || *found != item) return -1;
  return static_cast<int>(found - std::ranges::begin(list));
}

}  // namespace pyroclast
