#pragma once

#include <algorithm>
#include <array>
#include <vector>

#include "pyroclast/mechanics/body.hpp"
#include "pyroclast/mechanics/found/found.hpp"

namespace pyroclast {

/// Returns what pairs of the whole body give, in the order of their keys: a collective. So sums over pairs
/// depend neither on ranks nor on chunks. A pair counts for the owner of the block of its first facet.
/// \tparam Given  plain data
/// \param give     `give(pair, add)` calls `add` with what an own pair gives, any number of times
/// \param to_all  false: the first rank alone gets it
template <class Given, int Dim, class Give>
std::vector<Given> of_all_pairs(const Body<Dim>& body, Give give, bool to_all = true,
                                CallPlace at = CallPlace::here()) {
  struct OfPair {
    std::array<int, 2> key;
    Given given;
  };
  const FoundData<Dim>& found = *body.found;
  Ranks& ranks = body.model.ranks();
  const auto own = [&] {
    std::vector<OfPair> given;
    for (const FoundPair<Dim>& pair : found.pairs)
      if (found.rank_of_block.empty() ||
          found.rank_of_block[found.facets[pair.facets[0]].block] == ranks.me())
        give(pair, [&](const Given& one) { given.push_back({pair.facets, one}); });
    return given;
  };
  auto all = to_all ? ranks.collect_made<OfPair>(own, at) : ranks.collect_at_first(own(), at);
  if (ranks.count() > 1) std::ranges::stable_sort(all, {}, &OfPair::key);
  std::vector<Given> result;
  result.reserve(all.size());
  for (const OfPair& one : all) result.push_back(one.given);
  return result;
}

}  // namespace pyroclast
