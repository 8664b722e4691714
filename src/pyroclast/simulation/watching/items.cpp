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

/// Rows of the items that this rank tells of, in the order of the whole body. Those of a contact are one.
class RowsOfItems {
 public:
  RowsOfItems(Item item, const Model& model, int columns)
      : of_contact_(std::max(1, items_of_contact(item, model.dimension()))), columns_(columns) {
    if (model.part) {
      own_ = own_of_part(item, model);
      whole_ = &whole_numbers(item, *model.part);
    } else {
      count_ = count_of(item, model) / of_contact_;
    }
  }

  int of_contact() const { return of_contact_; }
  int width() const { return of_contact_ * columns_; }
  /// Returns the rows that a slice has at most.
  int in_slice() const { return std::max(1, kNumbers / width()); }
  int own_count() const { return whole_ ? static_cast<int>(own_.size()) : count_; }
  /// Returns the number in the whole body of an own row.
  int in_whole(int own) const { return whole_ ? (*whole_)[own_[own]] : own; }
  /// Returns the first item of a row of the whole body.
  std::int64_t first_item(int whole) const { return std::int64_t{whole} * of_contact_; }
  template <class T>
  void read(int own, const std::function<void(int item, T* row)>& read, T* row) const {
    const int here = whole_ ? own_[own] : own;
    for (int i = 0; i < of_contact_; ++i) read(of_contact_ * here + i, row + i * columns_);
  }

 private:
  static constexpr int kNumbers = 1 << 16;  // of a slice

  int of_contact_, columns_, count_ = 0;
  std::vector<int> own_;
  const std::vector<int>* whole_ = nullptr;
};

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
void in_own_slices(Item item, const Model& model, int columns,
                   const std::function<void(int item, T* row)>& read,
                   const std::function<void(std::int64_t first, const std::vector<T>& rows)>& take) {
  const RowsOfItems of(item, model, columns);
  std::vector<T> rows;
  for (int i = 0, first = 0; i < of.own_count(); ++i) {
    if (rows.empty()) first = of.in_whole(i);
    rows.resize(rows.size() + static_cast<std::size_t>(of.width()));
    of.read(i, read, rows.data() + rows.size() - of.width());
    const int next = first + static_cast<int>(rows.size()) / of.width();
    if (next < first + of.in_slice() && i + 1 < of.own_count() && of.in_whole(i + 1) == next) continue;
    take(of.first_item(first), rows);
    rows.clear();
  }
}

template void in_own_slices(Item, const Model&, int, const std::function<void(int, float*)>&,
                            const std::function<void(std::int64_t, const std::vector<float>&)>&);
template void in_own_slices(Item, const Model&, int, const std::function<void(int, double*)>&,
                            const std::function<void(std::int64_t, const std::vector<double>&)>&);

void in_slices(Item item, const Model& model, int columns,
               const std::function<void(int item, double* row)>& read,
               const std::function<void(std::int64_t first, const std::vector<double>& rows)>& take) {
  if (!model.part) return in_own_slices(item, model, columns, read, take);
  const RowsOfItems of(item, model, columns);
  const int count = count_of(item, model) / of.of_contact(), width = of.width();
  std::vector<double> own, sorted;  // each own row behind its place in the slice
  for (int first = 0, next = 0; first < count; first += of.in_slice()) {
    own.clear();
    for (; next < of.own_count() && of.in_whole(next) < first + of.in_slice(); ++next) {
      own.push_back(of.in_whole(next) - first);
      own.resize(own.size() + static_cast<std::size_t>(width));
      of.read(next, read, own.data() + own.size() - width);
    }
    const std::vector<double> all = model.ranks().collect_at_first(own);
    if (!model.ranks().is_first()) continue;
    sorted.resize(all.size() / (width + 1) * width);
    for (auto row = all.begin(); row != all.end(); row += width + 1)
      std::copy_n(row + 1, width, sorted.begin() + static_cast<std::ptrdiff_t>(*row) * width);
    take(of.first_item(first), sorted);
  }
}

}  // namespace pyroclast
