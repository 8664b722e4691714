#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "pyroclast/base/chunked_sum.hpp"
#include "pyroclast/base/flat_array.hpp"
#include "pyroclast/base/lanes.hpp"
#include "pyroclast/model/model.hpp"

/// Layout of a model while it moves: the place of each block, zone, gridpoint, face and contact.
///
///     body    chunk 0                              | chunk 1          | ...   consecutive blocks
///     chunk   bundle  bundle  bundle  ...                                     blocks that step together
///
///     alike    lane 0   1   2   3   4   5   6   7       ragged, piece         one block over all lanes
///     pack 0   gridpoint 0 of eight blocks               0  1  2  3  4  5  6  7
///     pack 1   gridpoint 1 of the same blocks            8  9 10  .  .  .  .  .      . idle
///     ...
///
///     pack of faces     eight faces between the blocks of one pair of chunks, with one interface
///     packs of points   contact point 0 of the eight faces, then point 1, ... (2 in 2D, 3 to 15 in 3D)
///
/// lane     one of the eight numbers that go through the same arithmetic together
/// pack     eight gridpoints, zones, faces or contact points side by side, one a lane
/// slot     a place in a pack: slot = 8 pack + lane
/// offset   place where the vector of a slot begins in an array of numbers: Dim slot
/// idle     a place that nothing fills; nothing acts on it
/// bundle   blocks that go through a step together: `alike` ones, a `ragged` one, or a `piece`, which is a
///          block or a part of a large one
/// shape    the zones of a block, as numbers of its own gridpoints; alike blocks have the same shape
/// fan      a shape whose zones go round the last gridpoint, in the order of the others
/// centre   the last gridpoint of a block where it is the last corner of all its zones (3D)
/// chunk    consecutive blocks with bundles and packs of their own: the unit of sums, files and ranks
namespace pyroclast {

inline constexpr int slot_of(int pack, int lane) {
  return kLanes * pack + lane;
}

template <int Dim>
inline constexpr int offset_of(int slot) {
  return Dim * slot;
}

enum class BundleKind : std::uint8_t {
  /// Up to eight blocks with the same zones, one a lane: pack i holds the i-th gridpoint of each. Only in 2D:
  /// hardly two polyhedra have the same zones.
  alike,
  /// One block in 3D over all lanes, with a centre. Its zones look their corners up among its own gridpoints,
  /// and add their forces to sums of its own. Large blocks, and those without a centre, stand in pieces.
  ragged,
  /// One block over all lanes, or a part of a large block: its gridpoints and zones follow one another
  /// through the packs, piece after piece. The forces of zones on their corners are written first; then each
  /// gridpoint gathers its own, whatever pieces they come from. Threads share the parts of a block, so that
  /// all their corner forces are there before any part moves.
  piece
};

/// Range of items.
struct IndexRange {
  int first = 0, last = 0;  ///< [first, last)
};

/// Blocks, or a piece of a block, that go through a step together.
struct Bundle {
  BundleKind kind = BundleKind::alike;
  bool fan = false;              ///< alike: true where the shape is a fan
  bool is_part = false;          ///< piece: true where other pieces hold the rest of its block
  int first_pack = 0;            ///< first pack of gridpoints
  int packs = 0;                 ///< number of packs of gridpoints
  int first_zone_pack = 0;       ///< first pack of zones
  int zones = 0;                 ///< alike: zones of each block, a pack each; else its zones, eight a pack
  int first_corners = 0;         ///< entry of `shape_zones` (alike), `ragged_zones` or `piece_zones`
  int first_gathering_pack = 0;  ///< piece: entry of `corners_of_pack`
  int centre = -1;  ///< slot of the block's centre, from the bundle's first; -1 where none is here
  IndexRange corners_of_block;  ///< piece with a centre: entries of `piece_zones` of its whole block
  int last_face_pack = -1;      ///< last pack of faces that touches the bundle or one before it

  int zone_packs() const { return kind == BundleKind::alike ? zones : (zones + kLanes - 1) / kLanes; }
};

/// First three gridpoints of eight zones of a ragged bundle: places of fours, in numbers from the bundle's
/// first. The fourth gridpoint is the centre. An idle lane repeats a zone.
template <int Dim>
using RaggedCorners = std::array<std::array<std::uint16_t, kLanes>, Dim>;

/// Gridpoints of eight zones of a piece, as offsets.
template <int Dim>
struct ZoneCorners {
  std::array<std::array<int, kLanes>, Dim + 1> offset;
};

/// Frames of eight faces.
template <int Dim>
struct alignas(64) FacePack {
  double tangent[Dim - 1][Dim][kLanes];  ///< unit tangents; the normal follows from them
};

/// Contact points of eight faces, one of each.
struct alignas(64) PointPack {
  double area[kLanes];           ///< area, m²; 0 where idle
  std::array<int, kLanes> a, b;  ///< offsets of the two gridpoints
};

/// Contacts that act on the gridpoints of a pack, one on each. In 2D a corner of a block has two, one of each
/// edge.
struct ActingContacts {
  std::array<int, kLanes> contact;  ///< offset of each contact; of an idle contact where a lane has none
  std::uint32_t side_b = 0;         ///< bit of each lane: 1 where the gridpoint is on side b
};

/// Part of an array that a step touches if it damages nothing.
enum class Touched : std::uint8_t {
  none,
  all,
  alike,     ///< packs of alike bundles
  gathered,  ///< packs of other bundles; with finite kinematics all packs
  held,      ///< internal variables that are always written: the held jump
  combined   ///< all packs with combined damping, else none
};

/// Time for which the contents of an array last.
enum class Lasts : std::uint8_t {
  made,    ///< contents that follow from the model and its properties
  kept,    ///< contents that last from one step to the next: part of a checkpoint
  a_step,  ///< contents that each step computes anew
};

/// Things of which an array has one entry each; with `_end`, it has one more entry behind the last.
enum class Per : std::uint8_t {
  bundle,
  gridpoint,
  gridpoint_pack,
  gridpoint_slot,
  zone,
  zone_pack,
  zone_pack_or_bundle,  ///< pack of zones, or a bundle where all its zones share one entry
  face_pack,
  face_pack_end,
  point_pack,
  point_pack_or_idle,  ///< and the pack that idles, behind the last
  point_slot_or_idle,
  contact,
  entry  ///< entry of the array's own list; other arrays name the entries
};

/// Moments at which an array's numbers of gridpoints travel to other ranks, which read them, see Halo.
enum class Travels : std::uint8_t {
  never,
  each_step,
  each_call  ///< after the last step of a call: no step reads them of foreign gridpoints
};

/// Description of an array. Memory, traffic, checkpoints and copies of a body follow from the lists of
/// arrays.
struct ArrayInfo {
  const char* name;
  Per per;
  Touched read = Touched::none, written = Touched::none;
  Lasts lasts = Lasts::made;
  Travels travels = Travels::never;
};

/// Calls `f(ArrayInfo, array...)` for each array of a list; several lists of the same kind go side by side.
template <class F, class List, class... Others>
void for_each_array(F&& f, List& list, Others&... others) {
  std::remove_const_t<List>::each(f, list, others...);
}

/// Returns the bytes of all arrays of a list.
template <class List>
std::size_t memory(const List& list) {
  std::size_t bytes = 0;
  for_each_array([&](const ArrayInfo&, const auto& array) { bytes += bytes_of(array); }, list);
  return bytes;
}

template <class T>
using View = std::span<T>;
template <class T>
using ConstView = std::span<const T>;

/// Arrays of a layout, owned (FlatArray) or seen (ConstView).
template <int Dim, template <class> class Array>
struct LayoutArrays {
  Array<Bundle> bundles;
  Array<std::array<int, Dim + 1>> shape_zones;  ///< zones of each shape in turn, as gridpoints of a block
  Array<RaggedCorners<Dim>> ragged_zones;       ///< packs of zones of ragged bundles
  Array<ZoneCorners<Dim>> piece_zones;          ///< packs of zones of pieces
  Array<int> parts;                             ///< bundle of each part of a large block
  Array<FacePack<Dim>> faces;
  Array<int> first_point;   ///< first pack of points of each pack of faces, and of one more
  Array<PointPack> points;  ///< contact points of each pack of faces in turn
  /// Number of leading packs of gridpoints of its own chunk that the packs of faces before it read, for each
  /// pack of faces and one more.
  Array<int> packs_reached;
  Array<bool> between_chunks;          ///< true for a pack of faces that join two chunks
  Array<IndexRange> contacts_of_pack;  ///< entries of `acting` of each pack of gridpoints
  Array<ActingContacts> acting;
  Array<IndexRange> corners_of_pack;  ///< entries of `acting_corners` of each pack of gridpoints of pieces
  /// Offsets of the corner forces that act on the gridpoints of a pack, one on each; of an idle corner where
  /// a lane has none.
  Array<std::array<int, kLanes>> acting_corners;

  /// Slot of each gridpoint, zone and contact of the model.
  Array<int> gridpoint_slot, zone_slot, contact_slot;
  Array<int> bundle_of_pack;              ///< bundle of each pack of gridpoints
  Array<std::array<int, kLanes>> blocks;  ///< blocks of each bundle, by lane; -1 where the lane idles
  Array<int> face_pack_of_point;          ///< pack of faces of each pack of points but the last
  Array<int> contacts_by_chunk;           ///< contacts of the model, chunk by chunk

  template <class F, class... L>
  static void each(F&& f, L&... l) {
    f(ArrayInfo{"bundles", Per::bundle, Touched::all}, l.bundles...);
    f(ArrayInfo{"shape_zones", Per::entry}, l.shape_zones...);  // few, and always near
    f(ArrayInfo{"ragged_zones", Per::entry, Touched::all}, l.ragged_zones...);
    f(ArrayInfo{"piece_zones", Per::entry, Touched::all}, l.piece_zones...);
    f(ArrayInfo{"parts", Per::entry}, l.parts...);
    f(ArrayInfo{"faces", Per::face_pack, Touched::all}, l.faces...);
    f(ArrayInfo{"first_point", Per::face_pack_end, Dim == 2 ? Touched::none : Touched::all},
      l.first_point...);
    f(ArrayInfo{"points", Per::point_pack, Touched::all}, l.points...);
    f(ArrayInfo{"packs_reached", Per::face_pack_end, Touched::all}, l.packs_reached...);
    f(ArrayInfo{"between_chunks", Per::face_pack, Touched::all}, l.between_chunks...);
    f(ArrayInfo{"contacts_of_pack", Per::gridpoint_pack, Touched::all}, l.contacts_of_pack...);
    f(ArrayInfo{"acting", Per::entry, Touched::all}, l.acting...);
    f(ArrayInfo{"corners_of_pack", Per::entry, Touched::all}, l.corners_of_pack...);
    f(ArrayInfo{"acting_corners", Per::entry, Touched::all}, l.acting_corners...);
    f(ArrayInfo{"gridpoint_slot", Per::gridpoint}, l.gridpoint_slot...);
    f(ArrayInfo{"zone_slot", Per::zone}, l.zone_slot...);
    f(ArrayInfo{"contact_slot", Per::contact}, l.contact_slot...);
    f(ArrayInfo{"bundle_of_pack", Per::gridpoint_pack}, l.bundle_of_pack...);
    f(ArrayInfo{"blocks", Per::bundle}, l.blocks...);
    f(ArrayInfo{"face_pack_of_point", Per::point_pack}, l.face_pack_of_point...);
    f(ArrayInfo{"contacts_by_chunk", Per::contact}, l.contacts_by_chunk...);
  }

  /// Returns the first pack of points of a pack of faces; the packs of points end at the first of the next
  /// one.
  int first_point_of(int face_pack) const {
    if constexpr (Dim == 2)
      return 2 * face_pack;
    else
      return first_point[face_pack];
  }
};

/// Chunks of each list of a body.
struct Chunks {
  ChunkList blocks, gridpoints, zones;  ///< items of the model
  ChunkList contacts;                   ///< entries of contacts_by_chunk
  ChunkList bundles, face_packs;        ///< items of the layout
};

/// Parameters of the layout of a body. Speed depends on them; no force does.
struct LayoutParameters {
  /// Least blocks of a bundle: fewer would leave too many lanes idle, so each goes over all lanes.
  int fewest_blocks = 4;
  /// Zones of a piece, 8 or more; a block of more stands in several, as far as its gridpoints fill them.
  int most_zones = 64;
  /// Gridpoints of a ragged bundle, 16,384 or fewer; a block of more stands in pieces, which threads share.
  int most_gridpoints = 255;
};

/// Layout of a model. Blocks are taken in the order of the model, chunk by chunk. Within a chunk they are
/// ordered in layers, so that blocks that touch stand near each other in memory; in 2D blocks with the same
/// zones share lanes. A face between two chunks belongs to the earlier one. In a chunk packs of such faces
/// come first, then packs of the chunk's own faces by the later of their two bundles. So one sweep can take a
/// pack of faces and, soon after, move the bundles whose faces are all done.
template <int Dim>
struct Layout : LayoutArrays<Dim, FlatArray> {
  explicit Layout(const ModelOf<Dim>& model, const LayoutParameters& parameters = {});

  Chunks chunks;
  int gridpoint_packs = 0;
  int zone_packs = 0;
  int point_packs = 0;  ///< number of packs of points, with the one that idles
  int most_packs = 0;   ///< largest number of packs of gridpoints in one bundle

  int face_packs() const { return static_cast<int>(this->faces.size()); }
  /// Returns the number of entries of an array, by what it has one entry each of; none for lists of their
  /// own.
  std::optional<std::size_t> count_of(Per per) const;
  /// Returns the first pack of gridpoints of a bundle; behind the last bundle the number of packs.
  int first_pack_of(int bundle) const {
    return bundle < static_cast<int>(this->bundles.size()) ? this->bundles[bundle].first_pack
                                                           : gridpoint_packs;
  }
  int block_in(int bundle, int lane) const { return this->blocks[bundle][lane]; }
  int bundle_of(int gridpoint) const {
    return this->bundle_of_pack[this->gridpoint_slot[gridpoint] / kLanes];
  }
};

extern template struct Layout<2>;
extern template struct Layout<3>;

}  // namespace pyroclast
