#pragma once

#include <cstddef>
#include <span>

namespace pyroclast {

/// Where the chunks of a list begin: chunk i holds items [i] to [i + 1].
using ChunkBegins = std::span<const int>;

/// Every sum over a body is one of these. It is taken chunk by chunk, item by item within a chunk, and then
/// over the chunks, in that one order; so it depends on how the body is cut into chunks, but neither on the
/// number of threads or ranks nor on how blocks are bundled within a chunk of gridpoints, zones or contacts.
///
/// \tparam Sum  a number, or anything that starts as {} and takes += of its own kind
/// \param add   called as `add(item, sum)`; adds what an item brings to the sum of its chunk
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

/// Sum of the values of the items.
template <class Value>
double chunked_sum(ChunkBegins chunks, Value value) {
  return chunked_sum<double>(chunks, [&](int item, double& sum) { sum += value(item); });
}

}  // namespace pyroclast
