#pragma once

#include <algorithm>
#include <cstdint>
#include <functional>
#include <string_view>
#include <vector>

#include "pyroclast/base/vec.hpp"
#include "pyroclast/model/model.hpp"

namespace pyroclast {

/// Kind of items of which a field has one value each.
enum class Item : std::uint8_t {
  gridpoint,
  zone,
  contact,  ///< contact point
  /// Corners of the cell by which files show a contact point, see ends_of_contact.
  contact_end,
  found  ///< end of a pair of edges that presses; a body has now more of them and now fewer, see found_fields
};

/// Returns the number of corners of the cell by which files show a contact point. In the plane it is a line
/// from the point to the middle of its edge. In space it is a quadrangle: the point, the middle of the edge
/// to the next corner of its face, the middle of the face, the middle of the edge before.
/// \param dimension  dimension of the body, 2 or 3
constexpr int ends_of_contact(int dimension) {
  return dimension == 2 ? 2 : 4;
}

/// Returns a vector at an end of a contact's cell, from its values at the contact points of a face.
template <class Value>
Vec<3> at_end(const Model& model, int contact, int end, Value value) {
  if (end == 0) return value(contact);
  const auto after = std::ranges::upper_bound(model.face_contacts, contact);
  const int first = *(after - 1), count = *after - first;
  const auto next_to = [&](int step) { return first + (contact - first + step + count) % count; };
  if (end != 2) return 0.5 * (value(contact) + value(next_to(end == 1 ? 1 : -1)));
  Vec<3> sum{};
  for (int i = 0; i < count; ++i) sum += value(first + i);
  return sum * (1.0 / count);
}

/// Returns the name of an item, such as "gridpoint".
const char* name_of(Item item);
/// Returns the item of a name. Throws Error for another name.
Item item_of(std::string_view name);
/// Returns the number of items of the whole body, not of those that are found: a collective.
int count_of(Item item, const Model& model);

/// Reads rows of numbers, one of each item, and hands them out slice by slice. A slice takes half a megabyte
/// at most, however large the body is. Where several ranks hold the body, each reads the items in its own
/// chunks and is handed their rows. The items of a slice follow each other in the whole body.
/// \tparam T       float or double
/// \param columns  numbers of a row
/// \param read     writes the row of an item of this rank, over zeros
/// \param take     called with the number in the whole of the first item of a slice, and its rows
template <class T>
void in_own_slices(Item item, const Model& model, int columns,
                   const std::function<void(int item, T* row)>& read,
                   const std::function<void(std::int64_t first, const std::vector<T>& rows)>& take);
/// Hands rows out in the order of the whole body, to the first rank alone: a collective; else as above.
void in_slices(Item item, const Model& model, int columns,
               const std::function<void(int item, double* row)>& read,
               const std::function<void(std::int64_t first, const std::vector<double>& rows)>& take);

}  // namespace pyroclast
