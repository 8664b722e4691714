#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "pyroclast/laws/law.hpp"
#include "pyroclast/mechanics/found/parameters.hpp"
#include "pyroclast/mechanics/found/rows.hpp"

/// Contacts that are found while a plane body moves: its data.
///
///     facet   edge on the outline of a block; free where no contact joins it to another block, or where that
///             contact is broken and handed over
///     pair    two free facets of different blocks that may press each other (found/edge_pair.hpp)
///     row     eight pairs side by side, which go through a step together; the near pairs stand in rows
///     far     pairs near enough for the next searches; near: near enough to press before the next search
///
/// A pair that does not press is as if it had never been: it has the numbers of a new one, but for the energy
/// that it lost. A handed-over pair that does not press *rests*: its numbers stay until its gap falls below
/// that at which it bore nothing. So results do not depend on the time of a search, nor on the pairs that it
/// finds beside those that press.
namespace pyroclast {

/// Edge on the outline of a block, counter-clockwise.
struct BlockFacet {
  int block = 0;
  std::array<int, 2> gridpoints{};
  int face = -1;  ///< face of the model that joins it to another block; -1 where none does
  bool is_free = false;
  double length = 0.0;  ///< m, without load
};

/// Numbers of one end of a pair.
struct PairEnd {
  double area = 0.0;    ///< m², of the last step; 0 where the end does not press
  double held = 0.0;    ///< elastic part of the tangential jump, m
  double shift = 0.0;   ///< tangential jump less EdgePair::slide, m; the jump itself where the area is 0
  double offset = 0.0;  ///< opening less EdgePair::gap, m
  double damped = 0.0;  ///< force of damping in the last step, N
  double rest = 0.0;    ///< opening below which an end whose area is 0 goes through the law, m
};

/// Pair of facets.
struct FoundPair {
  std::array<int, 2> facets{};  ///< the lower one first: the pair's key
  bool is_handed_over = false;  ///< true for the two sides of a face, as long as they overlap
  double ratio = 1.0;           ///< area of the face over that of the overlap
  double not_counted = 0.0;     ///< overlap at the pair's beginning that does not count, m
  std::array<PairEnd, 2> ends{};
  double stored = 0.0, applied = 0.0;  ///< energy, J, and sum of the magnitudes of forces, N
  double lost_area = 0.0;              ///< energy lost where the area changes, J
  double lost_damping = 0.0;           ///< energy lost to damping, J
  std::vector<double> internals;       ///< internal variables of the law at both ends in turn
  std::vector<double> lost;            ///< losses of the law, times the area
  int interface = 0;                   ///< interface that gives the law
  int law = 0;                         ///< entry of State::laws
  std::array<int, 2> sets{-1, -1};     ///< set of parameters of each end; -1: not known yet
  /// Square of a way since the last search, over that of the way that ends the lists, up to which the pair
  /// can neither press nor change.
  double wakes = 0.0;
  bool is_near = true;  ///< true for a pair that stands in a row, or is to
  int slot = -1;        ///< place in the rows: kLanes row + lane; -1 for a pair that is in none

  /// Tells whether the pair was pressed in the last step.
  bool presses() const {
    return not_counted > 0.0 || ends[0].area > 0.0 || ends[1].area > 0.0 || ends[0].damped != 0.0 ||
           ends[1].damped != 0.0;
  }
  /// Tells whether the pair has numbers that a new one has not, beside energy that it lost.
  bool remembers() const { return is_handed_over || presses(); }
  bool has_lost() const {
    for (const double energy : lost)
      if (energy != 0.0) return true;
    return lost_area != 0.0 || lost_damping != 0.0;
  }
};

/// Constants of a law for a set of parameters.
struct ConstantsOfSet {
  std::vector<std::byte> bytes;  ///< empty until they are asked for
  std::vector<double> numbers;
  ContactStiffness<double> stiffness;
};

/// Data of found contacts of a body.
struct FoundData {
  FoundParameters parameters;
  FoundArrays<FlatArray> arrays;
  FoundRows seen;  ///< view of the arrays

  std::vector<BlockFacet> facets;  ///< those of the outline, then both sides of each face
  int outline = 0;                 ///< number of facets of the outline
  std::vector<double> longest;     ///< longest facet of each block, m
  std::vector<double> most_depth;  ///< depth from which on ends do not count, by block, m
  std::vector<int> interfaces;     ///< interface of each pair of materials, row by row
  std::vector<int> of_body;        ///< interface of each block that is a loose body; else -1
  std::vector<int> first_contact;  ///< first contact of each interface; -1 where it has none
  std::vector<std::vector<int>> contacts_of_block;
  GridpointContacts at_gridpoint;
  std::vector<int> face_of_lane;     ///< face of each lane of the packs of faces; -1 where idle
  std::vector<bool> is_handed_over;  ///< by face of the model; true for those of gone blocks too

  std::vector<FoundPair> pairs;         ///< pairs that are near, or not as new ones, by key
  std::vector<std::array<int, 2>> far;  ///< keys of far pairs, ascending
  std::vector<bool> is_listed;          ///< true for facets that these lists know: free, and not flown off
  FlatArray<Vec<2>> searched_far;       ///< displacement by slot at the last search for far pairs, m
  double mean_edge = 0.0;               ///< m
  std::vector<int> block_of_slot;       ///< block of each slot of gridpoints; 0 where idle
  /// Twice the way that the gridpoints of each block may go before the next search for far and near pairs, m:
  /// the faster a block, the longer.
  std::vector<double> skin, reach;
  std::vector<ConstantsOfSet> constants;   ///< by set of parameters
  bool has_far = false, has_near = false;  ///< true for lists that hold
  bool has_rows = false;                   ///< true where the near pairs stand in rows
  std::int64_t searches = 0;               ///< number of searches for near pairs
};

}  // namespace pyroclast
