#pragma once

#include <cstddef>
#include <utility>
#include <vector>

namespace pyroclast {

/// Chunks of a list of items: chunk i holds the items from [i] up to [i + 1]. Where the list belongs to a
/// part of a body, some chunks are foreign: another part sums their items.
class ChunkList {
 public:
  ChunkList() = default;
  /// \param begins      begin of each chunk, and the end of the last
  /// \param is_foreign  by chunk; empty: none is
  explicit ChunkList(std::vector<int> begins, std::vector<bool> is_foreign = {})
      : begins_(std::move(begins)), is_foreign_(std::move(is_foreign)) {}

  int count() const { return begins_.empty() ? 0 : static_cast<int>(begins_.size()) - 1; }
  /// Returns the begin of a chunk, for `count()` the end of the list.
  int operator[](int chunk) const { return begins_[static_cast<std::size_t>(chunk)]; }
  const std::vector<int>& begins() const { return begins_; }
  bool is_foreign(int chunk) const {
    return !is_foreign_.empty() && is_foreign_[static_cast<std::size_t>(chunk)];
  }
  /// Returns the number of items in chunks that are not foreign.
  int own_items() const {
    int items = 0;
    for (int chunk = 0; chunk < count(); ++chunk)
      if (!is_foreign(chunk)) items += (*this)[chunk + 1] - (*this)[chunk];
    return items;
  }

  /// Returns the same chunks of another list.
  ChunkList of(std::vector<int> begins) const { return ChunkList(std::move(begins), is_foreign_); }

  /// Returns the same chunks of a list of some of the items, in their order.
  /// \param place  returns the place in this list of item i of the other one, ascending
  template <class Place>
  ChunkList of_some(int items, Place place) const {
    std::vector<int> begins;
    begins.reserve(begins_.size());
    int item = 0;
    for (const int begin : begins_) {
      while (item < items && place(item) < begin) ++item;
      begins.push_back(item);
    }
    return of(std::move(begins));
  }
  ChunkList of_some(const std::vector<int>& places) const {
    return of_some(static_cast<int>(places.size()),
                   [&](int i) { return places[static_cast<std::size_t>(i)]; });
  }

 private:
  std::vector<int> begins_;
  std::vector<bool> is_foreign_;
};

/// Sums over the items of a body: every sum over a body is taken by this function. It adds item by item
/// within a chunk and then chunk by chunk, always in this order. So the sum depends on how the body is cut
/// into chunks, but neither on the number of threads or ranks nor on how blocks are bundled within a chunk of
/// gridpoints, zones or contacts. Of a part of a body it adds the part's own chunks.
///
/// \tparam Sum  a number, or any type that starts as {} and takes += of its own kind
/// \param add   called as `add(item, sum)`; adds the contribution of an item to the sum of its chunk
template <class Sum, class Add>
Sum chunked_sum(const ChunkList& chunks, Add add) {
  Sum total{};
  for (int chunk = 0; chunk < chunks.count(); ++chunk) {
    if (chunks.is_foreign(chunk)) continue;
    Sum sum{};
    for (int item = chunks[chunk]; item < chunks[chunk + 1]; ++item) add(item, sum);
    total += sum;
  }
  return total;
}

/// Sums the values of the items.
template <class Value>
double chunked_sum(const ChunkList& chunks, Value value) {
  return chunked_sum<double>(chunks, [&](int item, double& sum) { sum += value(item); });
}

}  // namespace pyroclast
