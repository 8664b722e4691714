#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace pyroclast {

/// Begins of the chunks of a list, and its end: chunk i holds the items from [i] up to [i + 1].
using ChunkBegins = std::span<const int>;

/// Number of places in a chunk of a list that is cut evenly: about the nodes or zones of a thousand blocks.
/// Places are numbered in the order of the blocks, so the places of a chunk lie together.
inline constexpr int kPlacesPerChunk = 4096;

/// Cuts a list into chunks of kPlacesPerChunk places.
/// \param place  returns the place of an item: 0 or more, ascending. A list of some of the nodes is cut at
///               the same places as the list of all nodes
template <class Place>
std::vector<int> chunk_begins(int count, Place place) {
  std::vector<int> begins{0};
  for (int item = 1; item < count; ++item)
    if (place(item) / kPlacesPerChunk != place(item - 1) / kPlacesPerChunk) begins.push_back(item);
  if (count > 0) begins.push_back(count);
  return begins;
}

/// Cuts a list whose items are the places themselves.
inline std::vector<int> chunk_begins(int count) {
  return chunk_begins(count, [](int item) { return item; });
}

/// Sums over the items of a body: every sum over a body is taken by this function. It adds item by item
/// within a chunk and then chunk by chunk, always in this order. So the sum depends on how the body is cut
/// into chunks, but neither on the number of threads or ranks nor on how blocks are bundled within a chunk of
/// gridpoints, zones or contacts.
///
/// \tparam Sum  a number, or any type that starts as {} and takes += of its own kind
/// \param add   called as `add(item, sum)`; adds the contribution of an item to the sum of its chunk
template <class Sum, class Add>
Sum chunked_sum(ChunkBegins chunks, Add add) {
  Sum total{};
  for (std::size_t chunk = 0; chunk + 1 < chunks.size(); ++chunk) {
    Sum sum{};
    for (int item = chunks[chunk]; item < chunks[chunk + 1]; ++item) add(item, sum);
    total += sum;
  }
  return total;
}

/// Sums the values of the items.
template <class Value>
double chunked_sum(ChunkBegins chunks, Value value) {
  return chunked_sum<double>(chunks, [&](int item, double& sum) { sum += value(item); });
}

}  // namespace pyroclast
