#pragma once

#include <cstddef>
#include <vector>

#include "pyroclast/base/chunked_sum.hpp"

namespace pyroclast {

/// Sums over a body of which each rank adds its part now, while all parts travel later, in one message. They
/// have the bits of chunked_sum.
class KeptSums {
 public:
  /// Sums the values of the items of own chunks, and keeps the sums. All lists have the same chunks.
  template <class Value>
  void keep(const ChunkList& chunks, Value value) {
    chunks.for_each_own([&](int first, int last) {
      double& sum = of_chunk_.emplace_back();
      for (int item = first; item < last; ++item) sum += value(item);
    });
    ++count_;
  }
  void clear() {
    of_chunk_.clear();
    count_ = 0;
  }

  /// Returns the sums of all ranks, in the order in which they were kept: a collective.
  std::vector<double> totals(Ranks& ranks, CallPlace at = CallPlace::here()) const {
    const auto by_chunk = [&] {
      std::vector<double> own;
      own.reserve(of_chunk_.size());
      const std::size_t chunks = count_ == 0 ? 0 : of_chunk_.size() / count_;
      for (std::size_t chunk = 0; chunk < chunks; ++chunk)
        for (std::size_t i = 0; i < count_; ++i) own.push_back(of_chunk_[i * chunks + chunk]);
      return own;
    };
    std::vector<double> totals(count_);
    for (std::size_t i = 0; const double sum : ranks.collect_made<double>(by_chunk, at))
      totals[i++ % count_] += sum;
    return totals;
  }

 private:
  std::size_t count_ = 0;
  std::vector<double> of_chunk_;  ///< by sum, and for each by own chunk
};

}  // namespace pyroclast
