#include "pyroclast/simulation/watching/items.hpp"

#include <array>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "pyroclast/base/error.hpp"

namespace pyroclast {

namespace {

constexpr std::array<std::string_view, 5> kItemNames{"gridpoint", "zone", "contact", "contact_end", "found"};

/// Returns how many items belong to a contact; 0 for items of blocks.
int items_of_contact(Item item, int dimension) {
  return item == Item::contact ? 1 : item == Item::contact_end ? ends_of_contact(dimension) : 0;
}

/// Returns the gridpoints, zones or contacts of a part that this rank tells of, ascending.
std::vector<int> own_of_part(Item item, const Model& model) {
  std::vector<int> own;
  if (items_of_contact(item, model.dimension()) == 0) {
    const ChunkList chunks = item == Item::gridpoint ? model.gridpoint_chunks() : model.zone_chunks();
    for (auto [i, last] = chunks.own(); i < last; ++i) own.push_back(i);
    return own;
  }
  const ContactsByChunk by_chunk = contacts_by_chunk(model);
  const auto [first, last] = by_chunk.chunks.own();
  own.assign(by_chunk.contacts.begin() + first, by_chunk.contacts.begin() + last);
  std::ranges::sort(own);
  return own;
}

/// Returns the numbers in the whole body of the items of a part.
const std::vector<int>& whole_numbers(Item item, const PartOfBody& part) {
  return item == Item::gridpoint ? part.gridpoint : item == Item::zone ? part.zone : part.contact;
}

}  // namespace

const char* name_of(Item item) {
  return kItemNames[static_cast<std::size_t>(item)].data();
}

Item item_of(std::string_view name) {
  const auto found = std::ranges::find(kItemNames, name);
  if (found == kItemNames.end())
    throw Error(fmt::format("item \"{}\": must be one of {}", name, fmt::join(kItemNames, ", ")));
  return static_cast<Item>(found - kItemNames.begin());
}

int count_of(Item item, const Model& model) {
  switch (item) {
    case Item::gridpoint:
      return model.gridpoint_chunks().whole_count();
    case Item::zone:
      return model.whole_zone_count();
    case Item::contact:
    case Item::contact_end:
      break;
    case Item::found:
      throw Error("the contacts that are found are no part of the model");
  }
  const int contacts = model.part ? contacts_by_chunk(model).chunks.whole_count() : model.contact_count();
  return items_of_contact(item, model.dimension()) * contacts;
}

template <class T>
void in_slices(Item item, const Model& model, int columns, const std::function<void(int item, T* row)>& read,
               const std::function<void(std::int64_t first, const std::vector<T>& rows)>& take) {
  constexpr int kNumbers = 1 << 16;  // of a slice
  const int of_contact = std::max(1, items_of_contact(item, model.dimension()));
  const int count = count_of(item, model) / of_contact;
  const int width = of_contact * columns, length = std::max(1, kNumbers / width);
  const std::vector<int> own = model.part ? own_of_part(item, model) : std::vector<int>();
  const int own_count = model.part ? static_cast<int>(own.size()) : count;
  std::vector<int> places;  // in the slice
  std::vector<T> rows, sorted;
  for (int first = 0, next = 0; first < count; first += length) {
    places.clear();
    rows.clear();
    for (; next < own_count; ++next) {
      const int here = model.part ? own[next] : next;
      const int place = (model.part ? whole_numbers(item, *model.part)[here] : here) - first;
      if (place >= length) break;
      places.push_back(place);
      rows.resize(rows.size() + static_cast<std::size_t>(width));
      for (int i = 0; i < of_contact; ++i)
        read(of_contact * here + i, rows.data() + rows.size() - width + i * columns);
    }
    const std::int64_t first_item = std::int64_t{first} * of_contact;
    if (!model.part) {
      take(first_item, rows);
      continue;
    }
    const auto all_places = model.ranks().collect_at_first(places);
    const auto all_rows = model.ranks().collect_at_first(rows);
    if (!model.ranks().is_first()) continue;
    sorted.resize(all_rows.size());
    for (std::size_t i = 0; i < all_places.size(); ++i)
      std::copy_n(all_rows.begin() + static_cast<std::ptrdiff_t>(i) * width, width,
                  sorted.begin() + static_cast<std::ptrdiff_t>(all_places[i]) * width);
    take(first_item, sorted);
  }
}

template void in_slices(Item, const Model&, int, const std::function<void(int, float*)>&,
                        const std::function<void(std::int64_t, const std::vector<float>&)>&);
template void in_slices(Item, const Model&, int, const std::function<void(int, double*)>&,
                        const std::function<void(std::int64_t, const std::vector<double>&)>&);

}  // namespace pyroclast
