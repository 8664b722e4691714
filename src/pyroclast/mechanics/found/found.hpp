#pragma once

#include <algorithm>
#include <array>
#include <compare>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "pyroclast/laws/law.hpp"
#include "pyroclast/mechanics/found/parameters.hpp"
#include "pyroclast/mechanics/found/rows.hpp"

/// Contacts that are found while a body moves: its data.
///
///     facet   edge, or triangle of a zone, on the outline of a block; free where no contact joins it to
///             another block, where that contact is handed over, or on a bearing
///     bearing face whose law never breaks but lets go of what it pulls; a platen has no other faces
///     pair    two free facets of different blocks that may press each other (found/edge_pair.hpp,
///             found/triangle_pair.hpp)
///     point   end or corner of the overlap of a pair
///     row     eight pairs side by side, which go through a step together; the near pairs stand in rows
///     far     pairs near enough for the next searches; near: near enough to press before the next search
///
/// A pair that does not press is as if it had never been: it has the numbers of a new one, but for the energy
/// that it lost. A handed-over pair that does not press *rests*: its numbers stay until its gap falls below
/// that at which it bore nothing. So results do not depend on the time of a search, nor on the pairs that it
/// finds beside those that press.
namespace pyroclast {

/// Facet on the outline of a block, counter-clockwise as one sees it from outside.
template <int Dim>
struct BlockFacet {
  int block = 0;
  std::array<int, Dim> gridpoints{};
  int face = -1;  ///< face of the model that joins it to another block; -1 where none does
  bool is_free = false;
  bool begins_free = false;  ///< true for one that is free before any face is handed over
  double length = 0.0;       ///< length of the longest edge, m, without load
  double extent = 0.0;       ///< length, m, or area, m², without load
};

/// Numbers of a point of a pair.
template <int Dim>
struct PairPoint {
  double area = 0.0;       ///< m², of the last step; 0 where the point does not press
  Tangential<Dim> held{};  ///< elastic part of the tangential jump, m
  /// Tangential jump less the slide, m; the jump itself where the area is 0. In the plane the slide is that
  /// of EdgePair, in space the way since FoundPair::pressed_at.
  Tangential<Dim> shift{};
  double offset = 0.0;  ///< opening less the gap, m
  double damped = 0.0;  ///< force of damping in the last step, N
  double rest = 0.0;    ///< opening below which a point whose area is 0 goes through the law, m
};

/// Facets of a pair, the lower one first.
using PairKey = std::array<int, 2>;

/// Pair of facets.
template <int Dim>
struct FoundPair {
  PairKey facets{};
  bool is_handed_over = false;  ///< true for facets of the two sides of a face, as long as they overlap
  double ratio = 1.0;           ///< area of the face over that of the overlap
  double not_counted = 0.0;     ///< overlap at the pair's beginning that does not count, m or m²
  std::array<PairPoint<Dim>, kPointsOfPair<Dim>> points{};
  double stored = 0.0, applied = 0.0;  ///< energy, J, and sum of the magnitudes of forces, N
  double lost_area = 0.0;              ///< energy lost where the area changes, J
  double lost_damping = 0.0;           ///< energy lost to damping, J
  std::vector<double> internals;       ///< internal variables of the law at each point in turn
  std::vector<double> lost;            ///< losses of the law, times the area
  int interface = 0;                   ///< interface that gives the law
  int law = 0;                         ///< entry of State::laws
  std::array<int, kSetsOfPair<Dim>> sets = not_known();  ///< sets of parameters; -1: not known yet
  /// Places of the corners, those of a and then of b, in the last step in which the pair pressed, m. Their
  /// overlap tells which points there are. In space only.
  std::array<Vec<Dim>, Dim == 2 ? 0 : 2 * Dim> pressed_at{};
  /// Square of a way since the last search, over that of the way that ends the lists, up to which the pair
  /// can neither press nor change.
  double wakes = 0.0;
  bool is_near = true;  ///< true for a pair that may press before the next search, and is to stand in a row
  bool was_asked = false;  ///< true where the last step went through its overlap, whether it pressed or not
  int slot = -1;           ///< place in the rows: kLanes row + lane; -1 for a pair that is in none

  /// Tells whether the pair bore something in the last step.
  bool bears() const {
    for (const auto& point : points)
      if (point.area > 0.0) return true;
    return false;
  }
  /// Tells whether the pair was pressed in the last step.
  bool presses() const {
    for (const auto& point : points)
      if (point.damped != 0.0) return true;
    return not_counted > 0.0 || bears();
  }
  /// Tells whether the pair has numbers that a new one has not, beside energy that it lost.
  bool remembers() const { return is_handed_over || presses(); }
  bool has_lost() const {
    for (const double energy : lost)
      if (energy != 0.0) return true;
    return lost_area != 0.0 || lost_damping != 0.0;
  }
  static constexpr std::array<int, kSetsOfPair<Dim>> not_known() {
    std::array<int, kSetsOfPair<Dim>> sets{};
    sets.fill(-1);
    return sets;
  }
};

/// Pair that may press before the next search for such pairs.
struct FarPair {
  PairKey facets{};
  double way = 0.0;  ///< twice the way that gridpoints go at least until it may press, m
  auto operator<=>(const FarPair&) const = default;
};

/// Constants of a law for a set of parameters.
struct ConstantsOfSet {
  std::vector<std::byte> bytes;  ///< empty until they are asked for
  std::vector<double> numbers;
  ContactStiffness<double> stiffness;
};

/// Data of found contacts of a body.
template <int Dim>
struct FoundData {
  FoundParameters parameters;
  FoundArrays<Dim, FlatArray> arrays;
  FoundRows<Dim> seen;  ///< view of the arrays

  std::vector<BlockFacet<Dim>> facets;  ///< those of the outline, then both sides of each face
  /// First facet of each face, of its side a and then of its side b, and of one more; the first of all is the
  /// number of facets of the outline.
  std::vector<int> first_of_face;
  std::vector<double> broadest;    ///< area of the broad side of each block, m²
  std::vector<double> most_depth;  ///< depth from which on points do not count, by block, m
  std::vector<int> interfaces;     ///< interface of each pair of materials, row by row
  std::vector<int> of_body;        ///< interface of each block that is a loose body; else -1
  std::vector<int> first_contact;  ///< first contact of each interface; -1 where it has none
  std::vector<std::vector<int>> contacts_of_block;
  GridpointContacts at_gridpoint;
  std::vector<int> face_of_lane;     ///< face of each lane of the packs of faces; -1 where idle
  std::vector<bool> is_handed_over;  ///< by face of the model; true for those of gone blocks too
  std::vector<int> bearings;         ///< faces that are handed over once their sides have slid

  std::vector<FoundPair<Dim>> pairs;  ///< pairs that are near, or not as new ones, by key
  std::vector<FarPair> far;           ///< far pairs, by key
  std::vector<bool> is_listed;        ///< true for facets that these lists know: free, and not flown off
  FlatArray<Vec<Dim>> searched_far;   ///< displacement by slot at the last search for far pairs, m
  double mean_edge = 0.0;             ///< m
  std::vector<int> block_of_slot;     ///< block of each slot of gridpoints; 0 where idle
  /// Twice the way that the gridpoints of each block may go before the next search for far and near pairs, m:
  /// the faster a block, the longer.
  std::vector<double> skin, reach;
  std::vector<ConstantsOfSet> constants;   ///< by set of parameters
  bool has_far = false, has_near = false;  ///< true for lists that hold
  bool has_rows = false;                   ///< true where the near pairs stand in rows
  bool has_new_rows = false;               ///< true until the halo follows the rows

  // Where several ranks hold the body, each has all blocks and all facets. It lists the pairs that touch one
  // of its own blocks, so a pair of blocks of two ranks goes through the step on both.
  std::vector<int> rank_of_block;  ///< empty where one process holds the body
  bool knows_all = true;           ///< true where foreign gridpoints are where their owners have them
  std::int64_t searches = 0;       ///< number of searches for near pairs

  /// Returns the gridpoints of a pair: those of facet a, then those of facet b the other way round.
  std::array<int, 2 * Dim> corners(const PairKey& key) const {
    const auto &a = facets[key[0]].gridpoints, &b = facets[key[1]].gridpoints;
    if constexpr (Dim == 2)
      return {a[0], a[1], b[1], b[0]};
    else
      return {a[0], a[1], a[2], b[0], b[2], b[1]};
  }
  /// Returns the face whose two sides a pair is; -1 for other pairs.
  int face_of(const PairKey& key) const {
    const int face = facets[key[0]].face;
    return facets[key[1]].face == face ? face : -1;
  }
  /// Tells whether no contact of the beginning joins the facets of a pair.
  bool may_meet(const PairKey& key) const {
    const int face = face_of(key);
    return face < 0 || is_handed_over[face];
  }
  /// Tells whether a pair touches a block of a rank.
  bool is_of_rank(int rank, const PairKey& key) const {
    return rank_of_block.empty() || rank_of_block[facets[key[0]].block] == rank ||
           rank_of_block[facets[key[1]].block] == rank;
  }
  /// Returns the larger of a number of the two blocks of a pair.
  double larger_of(const std::vector<double>& of_blocks, const PairKey& key) const {
    return std::max(of_blocks[facets[key[0]].block], of_blocks[facets[key[1]].block]);
  }
  /// Returns the depth from which on points of a pair do not count, m.
  double most_depth_of(const PairKey& key) const {
    return std::min(most_depth[facets[key[0]].block], most_depth[facets[key[1]].block]);
  }
};

}  // namespace pyroclast
