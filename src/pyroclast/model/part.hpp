#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <set>
#include <vector>

#include "pyroclast/model/model.hpp"

namespace pyroclast {

/// Shares the chunks of a body out to ranks: runs of chunks with about as many zones each. Returns the rank
/// of each chunk. Throws Error where there are more ranks than chunks.
/// \param zones  first zone of each chunk, and the number of all zones
std::vector<int> ranks_of_chunks(const std::vector<int>& zones, int ranks);
std::vector<int> ranks_of_chunks(const Model& whole, int ranks);

/// Returns, for each chunk of a whole body, the other chunks that have a gridpoint in the place of one of its
/// own: those whose faces, directly or through others, join it to theirs.
std::vector<std::vector<int>> neighbours_of_chunks(const Model& whole);

/// Blocks of other ranks that a part holds beside its own.
enum class ForeignBlocks : std::uint8_t {
  touching,  ///< those that share a face, or a thermal node, with an own block
  all        ///< all: where contacts are found, any block may come to meet any other
};

/// Makes the part of a body that a rank holds: its own chunks, and blocks of others. Sets are cut and stay
/// where they become empty; all else that is not of an item stays as it is.
///
/// \param whole          the whole; where no block of others comes along but those that touch own ones, it
///                       may be those chunks alone that are of this rank or neighbours of its own, see
///                       neighbours_of_chunks
/// \param rank_of_chunk  rank of each chunk of `whole`
/// \param nodes          thermal node of each gridpoint, below 0 for none: blocks at a node of an own block
///                       then come along, with the faces between foreign blocks. Empty: no heat flows
template <int Dim>
ModelOf<Dim> part_of(const ModelOf<Dim>& whole, std::shared_ptr<Ranks> ranks,
                     const std::vector<int>& rank_of_chunk, const std::vector<int>& nodes = {},
                     ForeignBlocks foreign = ForeignBlocks::touching);

/// Makes the part of a body of either dimension, shared out by ranks_of_chunks.
std::unique_ptr<Model> part_of(const Model& whole, std::shared_ptr<Ranks> ranks,
                               const std::vector<int>& nodes = {},
                               ForeignBlocks foreign = ForeignBlocks::touching);

/// Gridpoints of a part that faces join to gridpoints of another rank: the own ones, and those of the other
/// rank. Ascending here as in the whole.
struct SharedGridpoints {
  std::set<int> own, foreign;
};

/// Returns the gridpoints that a part shares with each of the other ranks.
std::map<int, SharedGridpoints> shared_gridpoints(const Model& part);

extern template ModelOf<2> part_of(const ModelOf<2>&, std::shared_ptr<Ranks>, const std::vector<int>&,
                                   const std::vector<int>&, ForeignBlocks);
extern template ModelOf<3> part_of(const ModelOf<3>&, std::shared_ptr<Ranks>, const std::vector<int>&,
                                   const std::vector<int>&, ForeignBlocks);

}  // namespace pyroclast
