#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "pyroclast/base/flat_array.hpp"
#include "pyroclast/base/lanes.hpp"
#include "pyroclast/model/model.hpp"

namespace pyroclast {

/// Eight gridpoints, zones or contacts side by side are a row; a slot is a place in a row: slot = 8 row +
/// lane. Places that nothing fills are idle: nothing acts on them.
inline constexpr int slot_of(int row, int lane) {
  return kLanes * row + lane;
}

/// Where the vector of a slot begins in an array of numbers.
template <int Dim>
inline constexpr int offset_of(int slot) {
  return Dim * slot;
}

/// How the blocks of a bundle share its lanes.
enum class BundleKind : std::uint8_t {
  alike,  ///< up to eight blocks with the same zones, one a lane: row i holds the i-th gridpoint of each
  spread  ///< one block over all lanes: its gridpoints and zones follow one another through the rows
};

/// Blocks that go through a step together.
struct Bundle {
  BundleKind kind = BundleKind::alike;
  int shape = -1;     ///< BundleKind::alike: index into Layout::shapes
  bool fan = false;   ///< BundleKind::alike: zones go round the last gridpoint, in the order of the others
  int first_row = 0;  ///< of gridpoints
  int rows = 0;       ///< of gridpoints
  int first_zone_row = 0;    ///< of zones
  int zones = 0;             ///< alike: of each block, a row each; spread: of the block, eight a row
  int first_spread_row = 0;  ///< spread: entries of Layout::spread_zones
  int last_face_row = -1;    ///< no row of faces above it touches the bundle; never falls along the bundles
  std::vector<int> blocks;

  /// Block in a lane, or -1 where the lane idles.
  int block_in(int lane) const {
    if (kind == BundleKind::spread) return blocks.front();
    return lane < static_cast<int>(blocks.size()) ? blocks[lane] : -1;
  }
  int zone_rows() const { return kind == BundleKind::alike ? zones : (zones + kLanes - 1) / kLanes; }
};

/// Gridpoints of eight zones of a spread block, as offsets.
template <int Dim>
struct ZoneCorners {
  std::array<std::array<int, kLanes>, Dim + 1> offset;
};

/// Eight faces of one interface.
template <int Dim>
struct alignas(64) FaceRow {
  double tangent[Dim - 1][Dim][kLanes];           ///< the normal follows from them
  double area[kLanes];                            ///< of one contact point, m²; 0 where idle
  std::array<std::array<int, kLanes>, Dim> a, b;  ///< offsets of the gridpoints at each point
};

/// Which contact points act on the gridpoints of a row. In 2D a corner of a block has two, one of each edge.
struct ContactsOfRow {
  int begin = 0, end = 0;  ///< entries of Layout::acting
};

struct ActingContacts {
  std::array<int, kLanes> contact;  ///< offset; that of an idle contact where a lane has none
  std::uint32_t side_b = 0;         ///< bit per lane: the gridpoint is on side b
};

/// How a body is laid out. Speed depends on it; no force does.
struct LayoutParameters {
  int fewest_blocks = 4;  ///< a bundle of fewer leaves too many lanes idle: its blocks are spread
};

/// Where everything of a model stands while it moves.
///
/// Blocks are ordered along the body in layers, so that what touches stands near in memory; among near ones
/// those with the same zones share lanes. Faces are ordered by the later of their two bundles, so that one
/// sweep can take a row of faces and, soon after, move the bundles whose faces are all done.
template <int Dim>
struct Layout {
  explicit Layout(const Model<Dim>& model, const LayoutParameters& parameters = {});

  std::vector<Bundle> bundles;
  std::vector<std::vector<std::array<int, Dim + 1>>> shapes;  ///< zones of a block, as its own gridpoints
  std::vector<ZoneCorners<Dim>> spread_zones;                 ///< by row of zones of spread blocks
  FlatArray<FaceRow<Dim>> faces;
  /// By row of faces, and one more: rows of gridpoints that rows of faces before it reach, those below in
  /// all.
  std::vector<int> rows_reached;
  std::vector<ContactsOfRow> contacts_of_row;  ///< of each row of gridpoints
  FlatArray<ActingContacts> acting;

  int gridpoint_rows = 0;
  int zone_rows = 0;
  int most_rows = 0;                ///< of gridpoints, in one bundle
  std::vector<int> gridpoint_slot;  ///< of each gridpoint of the model
  std::vector<int> zone_slot;       ///< of each zone
  std::vector<int> contact_slot;    ///< of each contact
  std::vector<int> bundle_of_block;

  int face_rows() const { return static_cast<int>(faces.size()); }
  /// Rows of contact points: Dim for every row of faces, and one that idles.
  int contact_rows() const { return Dim * face_rows() + 1; }
  /// Bytes of all arrays.
  std::size_t memory() const;
};

extern template struct Layout<2>;
extern template struct Layout<3>;

}  // namespace pyroclast
