#pragma once

#include <cstddef>
#include <utility>
#include <vector>

#include "pyroclast/base/ranks.hpp"

namespace pyroclast {

/// Chunks of a list of items: chunk i holds the items from [i] up to [i + 1]. Where several ranks hold a
/// body, the list is of one part, and chunks that belong to other ranks are foreign. The own ones follow each
/// other, and ranks hold them in the order of the whole.
class ChunkList {
 public:
  ChunkList() = default;
  /// \param begins      begin of each chunk, and the end of the last
  /// \param is_foreign  by chunk; empty: none is
  explicit ChunkList(std::vector<int> begins, std::vector<bool> is_foreign = {}, Ranks& ranks = one_rank())
      : begins_(std::move(begins)), is_foreign_(std::move(is_foreign)), ranks_(&ranks) {}

  int count() const { return begins_.empty() ? 0 : static_cast<int>(begins_.size()) - 1; }
  /// Returns the begin of a chunk, for `count()` the end of the list.
  int operator[](int chunk) const { return begins_[static_cast<std::size_t>(chunk)]; }
  const std::vector<int>& begins() const { return begins_; }
  bool is_foreign(int chunk) const {
    return !is_foreign_.empty() && is_foreign_[static_cast<std::size_t>(chunk)];
  }
  Ranks& ranks() const { return *ranks_; }

  /// Returns the chunk of each item.
  std::vector<int> of_items() const {
    std::vector<int> chunk_of;
    for (int chunk = 0; chunk < count(); ++chunk)
      chunk_of.resize(static_cast<std::size_t>((*this)[chunk + 1]), chunk);
    return chunk_of;
  }

  /// Items from `first` up to `last`.
  struct Items {
    int first = 0, last = 0;
    bool contain(int item) const { return item >= first && item < last; }
  };
  /// Returns the items in own chunks.
  Items own() const {
    int first = 0, last = count();
    while (first < last && is_foreign(first)) ++first;
    while (last > first && is_foreign(last - 1)) --last;
    return count() == 0 ? Items{} : Items{(*this)[first], (*this)[last]};
  }
  bool is_own(int item) const { return own().contain(item); }
  /// Calls `f(first, last)` for each own chunk, with its first item and the one behind its last.
  template <class F>
  void for_each_own(F f) const {
    for (int chunk = 0; chunk < count(); ++chunk)
      if (!is_foreign(chunk)) f((*this)[chunk], (*this)[chunk + 1]);
  }
  /// Returns the number of items on all ranks, each counted by its owner: a collective.
  int whole_count(CallPlace at = CallPlace::here()) const {
    const auto [first, last] = own();
    return static_cast<int>(ranks_->sum(last - first, at));
  }

  /// Returns the same chunks of another list.
  ChunkList of(std::vector<int> begins) const { return ChunkList(std::move(begins), is_foreign_, *ranks_); }

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
  Ranks* ranks_ = &one_rank();
};

/// Sums over the items of a body: every sum over a body is taken by this function or the next. It adds item
/// by item within a chunk and then chunk by chunk, always in this order. So the sum depends on how the body
/// is cut into chunks, but neither on the number of threads or ranks nor on how blocks are bundled within a
/// chunk of gridpoints, zones or contacts. Each rank adds its own chunks; all get the sum of the whole: a
/// collective.
///
/// \tparam Sum  a number, or any plain type that starts as {} and takes += of its own kind
/// \param add   called as `add(item, sum)`; adds the contribution of an item to the sum of its chunk
template <class Sum, class Add>
Sum chunked_sum(const ChunkList& chunks, Add add, CallPlace at = CallPlace::here()) {
  const auto own = [&] {
    std::vector<Sum> of_chunk;
    of_chunk.reserve(static_cast<std::size_t>(chunks.count()));
    chunks.for_each_own([&](int first, int last) {
      Sum& sum = of_chunk.emplace_back();
      for (int item = first; item < last; ++item) add(item, sum);
    });
    return of_chunk;
  };
  Sum total{};
  for (const Sum& sum : chunks.ranks().collect_made<Sum>(own, at)) total += sum;
  return total;
}

/// Sums the values of the items.
template <class Value>
double chunked_sum(const ChunkList& chunks, Value value, CallPlace at = CallPlace::here()) {
  return chunked_sum<double>(
      chunks, [&](int item, double& sum) { sum += value(item); }, at);
}

/// Takes several sums at a time: `add(item, sums)` adds to some of `count` sums.
template <class Sum, class Add>
std::vector<Sum> chunked_sums(const ChunkList& chunks, std::size_t count, Add add,
                              CallPlace at = CallPlace::here()) {
  const auto own = [&] {
    std::vector<Sum> of_chunk;
    chunks.for_each_own([&](int first, int last) {
      of_chunk.resize(of_chunk.size() + count);
      const std::span<Sum> sums(of_chunk.data() + (of_chunk.size() - count), count);
      for (int item = first; item < last; ++item) add(item, sums);
    });
    return of_chunk;
  };
  const std::vector<Sum> of_chunk = chunks.ranks().collect_made<Sum>(own, at);
  std::vector<Sum> totals(count);
  for (std::size_t i = 0; i < of_chunk.size(); ++i) totals[i % count] += of_chunk[i];
  return totals;
}

}  // namespace pyroclast
