#include "pyroclast/mechanics/layout.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <span>
#include <tuple>
#include <utility>

namespace pyroclast {

namespace {

/// Number of places that RaggedCorners can tell apart; a four has four of them.
constexpr int kMostPlaces = 1 << 16;
/// Thickness of a layer, in blocks.
constexpr double kLayerThickness = 2.0;
/// Largest distance between the later bundles of a chunk's own faces that share lanes, in bundles.
constexpr int kBundlesToShare = 64;

/// Returns the blocks of a chunk in layers across its longest extent; within a layer, along the other axes.
template <int Dim>
std::vector<int> order_blocks(const ModelOf<Dim>& model, int first_block, int last_block) {
  const int count = last_block - first_block;
  std::vector<Vec<Dim>> centre(count);
  Vec<Dim> low, high;
  for (int i = 0; i < count; ++i) {
    const int first = model.block_gridpoints[first_block + i],
              last = model.block_gridpoints[first_block + i + 1];
    for (int g = first; g < last; ++g) centre[i] += model.position[g] * (1.0 / (last - first));
    for (int d = 0; d < Dim; ++d) {
      low[d] = i == 0 ? centre[i][d] : std::min(low[d], centre[i][d]);
      high[d] = i == 0 ? centre[i][d] : std::max(high[d], centre[i][d]);
    }
  }
  std::array<int, Dim> axis;
  std::iota(axis.begin(), axis.end(), 0);
  std::stable_sort(axis.begin(), axis.end(),
                   [&](int i, int j) { return high[i] - low[i] > high[j] - low[j]; });
  double space = 1.0;
  int dimensions = 0;
  for (int d = 0; d < Dim; ++d)
    if (high[d] > low[d]) {
      space *= high[d] - low[d];
      ++dimensions;
    }
  const double size = dimensions > 0 ? std::pow(space / count, 1.0 / dimensions) : 1.0;
  const auto layer = [&](int i, int d) {
    return std::floor((centre[i][axis[d]] - low[axis[d]]) / (kLayerThickness * size));
  };
  std::vector<int> order(count);
  std::iota(order.begin(), order.end(), 0);
  std::stable_sort(order.begin(), order.end(), [&](int a, int b) {
    for (int d = 0; d + 1 < Dim; ++d)
      if (layer(a, d) != layer(b, d)) return layer(a, d) < layer(b, d);
    return centre[a][axis[Dim - 1]] < centre[b][axis[Dim - 1]];
  });
  for (int& block : order) block += first_block;
  return order;
}

/// Tells whether the zones go round the last gridpoint, in the order of the others.
bool is_fan(const std::vector<std::array<int, 3>>& zones) {
  const int count = static_cast<int>(zones.size());
  for (int z = 0; z < count; ++z)
    if (zones[z] != std::array{z, z + 1 < count ? z + 1 : 0, count}) return false;
  return count > 2;
}

template <int Dim>
class LayoutBuilder {
 public:
  LayoutBuilder(const ModelOf<Dim>& model, const LayoutParameters& parameters, Layout<Dim>& layout)
      : model_(model), parameters_(parameters), layout_(layout) {}

  void take_chunks() {
    layout_.chunks.blocks = model_.chunks();
    layout_.chunks.gridpoints = model_.gridpoint_chunks();
    layout_.chunks.zones = model_.zone_chunks();
    auto by_chunk = contacts_by_chunk(model_);
    layout_.contacts_by_chunk = FlatArray<int>(by_chunk.contacts);
    layout_.chunks.contacts = std::move(by_chunk.chunks);
  }

  void place_blocks() {
    layout_.gridpoint_slot = FlatArray<int>(model_.position.size());
    layout_.zone_slot = FlatArray<int>(model_.zones.size());
    const ChunkList& blocks = layout_.chunks.blocks;
    std::vector<int> begins{0};
    for (int chunk = 0; chunk < blocks.count(); ++chunk) {
      place_chunk(blocks[chunk], blocks[chunk + 1]);
      begins.push_back(bundle_count());
    }
    layout_.chunks.bundles = blocks.of(std::move(begins));
    layout_.shape_zones = FlatArray<std::array<int, Dim + 1>>(shape_zones_);
    layout_.ragged_zones = FlatArray<RaggedCorners<Dim>>(ragged_zones_);
    layout_.piece_zones = FlatArray<ZoneCorners<Dim>>(piece_zones_);
    layout_.parts = FlatArray<int>(parts_);
    layout_.bundle_of_pack = FlatArray<int>(bundle_of_pack_);
    layout_.blocks = FlatArray<std::array<int, kLanes>>(blocks_);
  }

  void place_faces() {
    const std::vector<int> block_of = gridpoint_blocks(model_);
    const ChunkList& blocks = layout_.chunks.blocks;
    const std::vector<int> chunk_of_block = blocks.of_items();

    std::vector<FaceToPlace> faces(model_.face_count());
    for (int f = 0; f < model_.face_count(); ++f) {
      const int first = model_.face_contacts[f];
      const auto& c = model_.contacts[first];
      const int a = block_of[c.a], b = block_of[c.b];
      const auto [own, other] = std::minmax(chunk_of_block[a], chunk_of_block[b]);
      faces[f] = {f, own, other, later_bundle(f), c.interface, model_.face_contacts[f + 1] - first};
    }
    // faces between chunks first
    std::stable_sort(faces.begin(), faces.end(), [](const FaceToPlace& f, const FaceToPlace& g) {
      const auto key = [](const FaceToPlace& x) {
        return std::tuple(x.chunk, x.chunk == x.other, x.chunk == x.other ? x.later_bundle : 0);
      };
      return key(f) < key(g);
    });

    layout_.contact_slot = FlatArray<int>(model_.contacts.size());
    std::vector<int> begins{0};
    auto next = faces.begin();
    for (int chunk = 0; chunk < blocks.count(); ++chunk) {
      const auto end =
          std::find_if(next, faces.end(), [&](const FaceToPlace& f) { return f.chunk != chunk; });
      place_faces_of_chunk(next, end);
      next = end;
      begins.push_back(static_cast<int>(faces_.size()));
    }
    layout_.chunks.face_packs = blocks.of(std::move(begins));
    finish_faces();
  }

  /// Lists the contacts of each gridpoint in the order of their numbers, so that their sum has one order.
  void gather_contacts() {
    const auto of_gridpoint = gridpoint_contacts(model_);
    const int idle = kLanes * (layout_.point_packs - 1);
    std::vector<int> gridpoint(static_cast<std::size_t>(layout_.gridpoint_packs) * kLanes, -1);
    for (int g = 0; g < model_.gridpoint_count(); ++g) gridpoint[layout_.gridpoint_slot[g]] = g;
    std::vector<IndexRange> ranges(layout_.gridpoint_packs);
    std::vector<ActingContacts> all;
    for (int pack = 0; pack < layout_.gridpoint_packs; ++pack) {
      const int begin = static_cast<int>(all.size());
      int most = 0;
      for (int lane = 0; lane < kLanes; ++lane)
        if (const int g = gridpoint[slot_of(pack, lane)]; g >= 0)
          most = std::max(most, of_gridpoint.begin[g + 1] - of_gridpoint.begin[g]);
      for (int k = 0; k < most; ++k) {
        ActingContacts acting;
        for (int lane = 0; lane < kLanes; ++lane) {
          acting.contact[lane] = offset_of<Dim>(idle);
          const int g = gridpoint[slot_of(pack, lane)];
          if (g < 0 || of_gridpoint.begin[g] + k >= of_gridpoint.begin[g + 1]) continue;
          const int side = of_gridpoint.contact_side[of_gridpoint.begin[g] + k];
          acting.contact[lane] = offset_of<Dim>(layout_.contact_slot[side / 2]);
          if (side % 2 == 1) acting.side_b |= 1U << lane;
        }
        all.push_back(acting);
      }
      ranges[pack] = {begin, static_cast<int>(all.size())};
    }
    layout_.contacts_of_pack = FlatArray<IndexRange>(ranges);
    layout_.acting = FlatArray<ActingContacts>(all);
  }

  /// Lists the corner forces of each gridpoint in pieces in the order in which a bundle of another kind would
  /// add them; see step/zones.hpp. Those at a centre are not listed.
  void gather_corners() {
    const int idle = kLanes * (Dim + 1) * static_cast<int>(piece_zones_.size());
    std::vector<std::vector<int>> of_slot(static_cast<std::size_t>(gathering_packs_) * kLanes);
    for (std::size_t index = 0; index < bundles_.size(); ++index) {
      const Bundle& bundle = bundles_[index];
      if (bundle.kind != BundleKind::piece) continue;
      // the packs of a block's pieces stand one after the other, in either list
      const int shift = slot_of(bundle.first_gathering_pack - bundle.first_pack, 0);
      const auto list = [&](int z, int n) {
        const int pack = bundle.first_corners + z / kLanes, lane = z % kLanes;
        const int slot = piece_zones_[pack].offset[n][lane] / offset_of<Dim>(1);
        of_slot[slot + shift].push_back(slot_of(pack * (Dim + 1) + n, lane));
      };
      if constexpr (Dim == 2) {
        for (int z = 0; z < bundle.zones; ++z)
          for (int n = 0; n <= Dim; ++n) list(z, n);
      } else {
        const int corners = has_centre(blocks_[index][0]) ? Dim : Dim + 1;
        for (int first = 0; first < bundle.zones; first += kLanes)
          for (int n = 0; n < corners; ++n)
            for (int z = first; z < std::min(first + kLanes, bundle.zones); ++z) list(z, n);
      }
    }
    std::vector<IndexRange> ranges;
    std::vector<std::array<int, kLanes>> all;
    for (int pack = 0; pack < gathering_packs_; ++pack) {
      const auto first = of_slot.begin() + slot_of(pack, 0);
      const std::size_t most = std::max_element(first, first + kLanes, [](const auto& a, const auto& b) {
                                 return a.size() < b.size();
                               })->size();
      const int begin = static_cast<int>(all.size());
      for (std::size_t k = 0; k < most; ++k) {
        std::array<int, kLanes> acting;
        for (int lane = 0; lane < kLanes; ++lane)
          acting[lane] = offset_of<Dim>(k < first[lane].size() ? first[lane][k] : idle);
        all.push_back(acting);
      }
      ranges.push_back({begin, static_cast<int>(all.size())});
    }
    layout_.corners_of_pack = FlatArray<IndexRange>(ranges);
    layout_.acting_corners = FlatArray<std::array<int, kLanes>>(all);
  }

 private:
  using Zones = std::vector<std::array<int, Dim + 1>>;
  struct Shape {
    int first_corners = 0;  ///< entry of shape_zones
    bool fan = false;
  };

  struct FaceToPlace {
    int face;
    int chunk, other;  ///< chunks of its two blocks, the earlier one first
    int later_bundle;
    int interface;
    int points;
  };
  using FaceIterator = typename std::vector<FaceToPlace>::const_iterator;

  int bundle_count() const { return static_cast<int>(bundles_.size()); }

  void place_chunk(int first_block, int last_block) {
    if constexpr (Dim == 2)
      bundle_alike(first_block, last_block);
    else
      bundle_alone(first_block, last_block);
  }

  /// Bundles each block of a chunk by itself.
  void bundle_alone(int first_block, int last_block) {
    for (int block : order_blocks(model_, first_block, last_block)) {
      const int gridpoints = model_.block_gridpoints[block + 1] - model_.block_gridpoints[block];
      if (gridpoints <= std::min(parameters_.most_gridpoints, kMostPlaces / 4) && has_centre(block))
        add_ragged(block);
      else
        add_pieces(block);
    }
  }

  /// Bundles the blocks of a chunk. Blocks with the same zones share lanes, whatever their distance: a chunk
  /// fits into a cache. Groups that do not fill all lanes come last, in the order in which the chunk, not the
  /// body, meets their shapes.
  void bundle_alike(int first_block, int last_block) {
    std::map<int, std::size_t> group_of_shape;
    std::vector<std::pair<int, std::vector<int>>> waiting;  // shapes and their blocks
    for (int block : order_blocks(model_, first_block, last_block)) {
      const int shape = shape_of(block);
      const auto [place, is_new] = group_of_shape.try_emplace(shape, waiting.size());
      if (is_new) waiting.push_back({shape, {}});
      auto& group = waiting[place->second].second;
      group.push_back(block);
      if (group.size() < kLanes) continue;
      add_bundle(shape, group);
      group.clear();
    }
    for (const auto& [shape, group] : waiting)
      if (!group.empty()) add_bundle(shape, group);
  }

  int shape_of(int block) {
    const int first = model_.block_gridpoints[block];
    Zones zones(model_.zones.begin() + model_.block_zones[block],
                model_.zones.begin() + model_.block_zones[block + 1]);
    for (auto& zone : zones)
      for (int& g : zone) g -= first;
    const int gridpoints = model_.block_gridpoints[block + 1] - first;
    const auto [it, is_new] =
        shape_index_.try_emplace({gridpoints, std::move(zones)}, static_cast<int>(shapes_.size()));
    if (is_new) {
      const Zones& kept = it->first.second;
      Shape shape{static_cast<int>(shape_zones_.size())};
      if constexpr (Dim == 2) shape.fan = is_fan(kept);
      shape_zones_.insert(shape_zones_.end(), kept.begin(), kept.end());
      shapes_.push_back(shape);
    }
    return it->second;
  }

  void add_bundle(int shape, const std::vector<int>& blocks) {
    if (static_cast<int>(blocks.size()) < parameters_.fewest_blocks) {
      for (int block : blocks) add_pieces(block);
      return;
    }
    Bundle bundle;
    bundle.first_corners = shapes_[shape].first_corners;
    bundle.fan = shapes_[shape].fan;
    const int block = blocks.front();
    bundle.packs = model_.block_gridpoints[block + 1] - model_.block_gridpoints[block];
    bundle.zones = model_.block_zones[block + 1] - model_.block_zones[block];
    start(bundle);
    for (int lane = 0; lane < static_cast<int>(blocks.size()); ++lane) {
      const int b = blocks[lane];
      for (int i = 0; i < bundle.packs; ++i)
        layout_.gridpoint_slot[model_.block_gridpoints[b] + i] = slot_of(bundle.first_pack + i, lane);
      for (int i = 0; i < bundle.zones; ++i)
        layout_.zone_slot[model_.block_zones[b] + i] = slot_of(bundle.first_zone_pack + i, lane);
    }
    std::array<int, kLanes> lanes;
    lanes.fill(-1);
    std::copy(blocks.begin(), blocks.end(), lanes.begin());
    finish(bundle, lanes);
  }

  /// Tells whether the last gridpoint of a block is the last corner of all its zones.
  bool has_centre(int block) const {
    if constexpr (Dim == 2) return false;
    const int last = model_.block_gridpoints[block + 1] - 1;
    return std::all_of(model_.zones.begin() + model_.block_zones[block],
                       model_.zones.begin() + model_.block_zones[block + 1],
                       [&](const auto& zone) { return zone[Dim] == last; });
  }

  /// Gives the gridpoints and zones of a block that goes over all lanes their slots, and returns its zones in
  /// the order of these. In 3D zones of one face stand in different packs: they share a corner, and one sum
  /// would wait for the one before.
  std::vector<int> place_over_all_lanes(int block) {
    const int first_gridpoint = model_.block_gridpoints[block], first_zone = model_.block_zones[block];
    const int last_zone = model_.block_zones[block + 1];
    for (int g = first_gridpoint; g < model_.block_gridpoints[block + 1]; ++g)
      layout_.gridpoint_slot[g] = slot_of(layout_.gridpoint_packs, g - first_gridpoint);
    const int stride = Dim == 2 ? 1 : packs_of(last_zone - first_zone);
    std::vector<int> zones;
    for (int begin = first_zone; begin < first_zone + stride; ++begin)
      for (int z = begin; z < last_zone; z += stride) zones.push_back(z);
    for (int i = 0; i < static_cast<int>(zones.size()); ++i)
      layout_.zone_slot[zones[i]] = slot_of(layout_.zone_packs, i);
    return zones;
  }

  void add_ragged(int block) {
    const int first_gridpoint = model_.block_gridpoints[block];
    const int gridpoints = model_.block_gridpoints[block + 1] - first_gridpoint;
    const std::vector<int> zones = place_over_all_lanes(block);
    Bundle bundle;
    bundle.kind = BundleKind::ragged;
    bundle.packs = packs_of(gridpoints);
    bundle.zones = static_cast<int>(zones.size());
    bundle.centre = gridpoints - 1;
    bundle.first_corners = static_cast<int>(ragged_zones_.size());
    for_each_lane(zones, ragged_zones_, [&](RaggedCorners<Dim>& corners, std::size_t lane, int zone) {
      for (int n = 0; n < Dim; ++n)
        corners[n][lane] = static_cast<std::uint16_t>(4 * (model_.zones[zone][n] - first_gridpoint));
    });
    start(bundle);
    std::array<int, kLanes> lanes;
    lanes.fill(block);
    finish(bundle, lanes);
  }

  /// Places a block over all lanes, in pieces of about the same size.
  void add_pieces(int block) {
    const int gridpoints = model_.block_gridpoints[block + 1] - model_.block_gridpoints[block];
    const std::vector<int> in_order = place_over_all_lanes(block);
    const auto zones = static_cast<int>(in_order.size());
    const int packs = packs_of(gridpoints), zone_packs = packs_of(zones);
    const int most_packs = std::max(1, parameters_.most_zones / kLanes);
    const int pieces = std::min(packs, (zone_packs + most_packs - 1) / most_packs);
    std::array<int, kLanes> lanes;
    lanes.fill(block);
    const int first_corners = static_cast<int>(piece_zones_.size());
    for (int i = 0; i < pieces; ++i) {
      Bundle bundle;
      bundle.kind = BundleKind::piece;
      bundle.is_part = pieces > 1;
      const auto share = [&](std::int64_t of, int piece) { return static_cast<int>(of * piece / pieces); };
      bundle.packs = share(packs, i + 1) - share(packs, i);
      const int zone = kLanes * share(zone_packs, i);
      bundle.zones = std::min(zones, kLanes * share(zone_packs, i + 1)) - zone;
      bundle.first_corners = static_cast<int>(piece_zones_.size());
      start(bundle);
      for_each_lane(std::span(in_order).subspan(zone, bundle.zones), piece_zones_,
                    [&](ZoneCorners<Dim>& corners, std::size_t lane, int its) {
                      for (int n = 0; n <= Dim; ++n)
                        corners.offset[n][lane] =
                            offset_of<Dim>(layout_.gridpoint_slot[model_.zones[its][n]]);
                    });
      if (i + 1 == pieces && has_centre(block)) {
        bundle.centre = gridpoints - 1 - slot_of(share(packs, i), 0);
        bundle.corners_of_block = {first_corners, first_corners + zone_packs};
      }
      bundle.first_gathering_pack = gathering_packs_;
      gathering_packs_ += bundle.packs;
      if (bundle.is_part) parts_.push_back(bundle_count());
      finish(bundle, lanes);
    }
  }

  /// Adds packs for zones of a block, and calls `fill(pack, lane, zone)` for each lane. An idle lane repeats
  /// its pack's first zone, whose forces are then left out.
  template <class Pack, class Fill>
  static void for_each_lane(std::span<const int> zones, std::vector<Pack>& packs, Fill fill) {
    for (std::size_t first = 0; first < zones.size(); first += kLanes) {
      Pack& pack = packs.emplace_back();
      for (std::size_t lane = 0; lane < kLanes; ++lane)
        fill(pack, lane, zones[first + lane < zones.size() ? first + lane : first]);
    }
  }

  static int packs_of(int items) { return (items + kLanes - 1) / kLanes; }

  void start(Bundle& bundle) {
    bundle.first_pack = layout_.gridpoint_packs;
    bundle.first_zone_pack = layout_.zone_packs;
    layout_.gridpoint_packs += bundle.packs;
    layout_.zone_packs += bundle.zone_packs();
    layout_.most_packs = std::max(layout_.most_packs, bundle.packs);
  }

  void finish(const Bundle& bundle, const std::array<int, kLanes>& lanes) {
    bundle_of_pack_.resize(bundle_of_pack_.size() + static_cast<std::size_t>(bundle.packs), bundle_count());
    bundles_.push_back(bundle);
    blocks_.push_back(lanes);
  }

  /// Returns the last bundle that a face touches.
  int later_bundle(int face) const {
    int later = 0;
    for (int c = model_.face_contacts[face]; c < model_.face_contacts[face + 1]; ++c)
      for (const int g : {model_.contacts[c].a, model_.contacts[c].b})
        later = std::max(later, layout_.bundle_of(g));
    return later;
  }

  /// Places the faces of a chunk. Faces that share a pack have one interface, one number of points and one
  /// pair of chunks.
  void place_faces_of_chunk(FaceIterator first, FaceIterator last) {
    using Key = std::tuple<int, int, int>;  // other chunk, interface, points
    std::map<Key, std::vector<FaceToPlace>> waiting;
    for (auto f = first; f != last; ++f) {
      const bool own = f->chunk == f->other;
      // all faces between chunks get their packs before the first face of the chunk's own
      if (own && f != first && std::prev(f)->other != f->chunk) flush(waiting);
      auto& group = waiting[{f->other, f->interface, f->points}];
      group.push_back(*f);
      if (group.size() == kLanes) {
        add_faces(group);
        group.clear();
      }
      if (!own) continue;
      for (auto& [key, others] : waiting)
        if (!others.empty() && f->later_bundle - others.front().later_bundle > kBundlesToShare) {
          add_faces(others);
          others.clear();
        }
    }
    flush(waiting);
  }

  template <class Waiting>
  void flush(Waiting& waiting) {
    for (auto& [key, group] : waiting)
      if (!group.empty()) add_faces(group);
    waiting.clear();
  }

  void add_faces(const std::vector<FaceToPlace>& faces) {
    FacePack<Dim> pack{};
    const int first_point = static_cast<int>(points_.size());
    for (int point = 0; point < faces.front().points; ++point) {
      PointPack points{};
      for (int lane = 0; lane < kLanes; ++lane) {
        const bool idle = lane >= static_cast<int>(faces.size());
        const int contact = model_.face_contacts[(idle ? faces.front() : faces[lane]).face] + point;
        const auto& c = model_.contacts[contact];
        points.a[lane] = offset_of<Dim>(layout_.gridpoint_slot[c.a]);
        // an idle lane has the same gridpoint on both sides, so that it never opens
        points.b[lane] = offset_of<Dim>(layout_.gridpoint_slot[idle ? c.a : c.b]);
        points.area[lane] = idle ? 0.0 : c.area;
        for (int i = 0; i < Dim; ++i)
          for (int t = 0; t + 1 < Dim; ++t) pack.tangent[t][i][lane] = c.tangents[t][i];
        if (!idle) layout_.contact_slot[contact] = slot_of(first_point + point, lane);
      }
      points_.push_back(points);
      face_pack_of_point_.push_back(static_cast<int>(faces_.size()));
    }
    faces_.push_back(pack);
    first_point_.push_back(first_point);
    // within its own chunk a pack reaches as far as the later bundles of its faces
    int reached = 0;
    for (const FaceToPlace& f : faces)
      if (f.chunk == f.other)
        reached = std::max(reached, bundles_[f.later_bundle].first_pack + bundles_[f.later_bundle].packs);
    reached_by_pack_.push_back(reached);
    between_chunks_.push_back(faces.front().chunk != faces.front().other);
    faces_of_pack_.push_back(faces);
  }

  void finish_faces() {
    for (std::size_t r = 0; r < faces_of_pack_.size(); ++r)
      for (const FaceToPlace& f : faces_of_pack_[r])
        for (int i = model_.face_contacts[f.face]; i < model_.face_contacts[f.face + 1]; ++i)
          for (const int g : {model_.contacts[i].a, model_.contacts[i].b}) {
            int& last = bundles_[layout_.bundle_of(g)].last_face_pack;
            last = std::max(last, static_cast<int>(r));
          }
    for (std::size_t i = 1; i < bundles_.size(); ++i)
      bundles_[i].last_face_pack = std::max(bundles_[i].last_face_pack, bundles_[i - 1].last_face_pack);
    std::vector<int> packs_reached{0};
    for (int reached : reached_by_pack_) packs_reached.push_back(std::max(packs_reached.back(), reached));

    layout_.point_packs = static_cast<int>(points_.size()) + 1;
    first_point_.push_back(static_cast<int>(points_.size()));
    layout_.bundles = FlatArray<Bundle>(bundles_);
    layout_.faces = FlatArray<FacePack<Dim>>(faces_);
    layout_.first_point = FlatArray<int>(first_point_);
    layout_.points = FlatArray<PointPack>(points_);
    layout_.packs_reached = FlatArray<int>(packs_reached);
    layout_.between_chunks = FlatArray<bool>(between_chunks_.size());
    std::copy(between_chunks_.begin(), between_chunks_.end(), layout_.between_chunks.begin());
    layout_.face_pack_of_point = FlatArray<int>(face_pack_of_point_);
  }

  const ModelOf<Dim>& model_;
  const LayoutParameters parameters_;
  Layout<Dim>& layout_;

  // lists that grow while things are placed
  std::map<std::pair<int, Zones>, int> shape_index_;
  std::vector<Shape> shapes_;
  std::vector<std::array<int, Dim + 1>> shape_zones_;
  std::vector<RaggedCorners<Dim>> ragged_zones_;
  std::vector<ZoneCorners<Dim>> piece_zones_;
  std::vector<int> parts_, bundle_of_pack_;
  int gathering_packs_ = 0;  // packs of gridpoints of pieces
  std::vector<Bundle> bundles_;
  std::vector<std::array<int, kLanes>> blocks_;
  std::vector<FacePack<Dim>> faces_;
  std::vector<PointPack> points_;
  std::vector<int> first_point_, face_pack_of_point_, reached_by_pack_;
  std::vector<bool> between_chunks_;  // by pack of faces
  std::vector<std::vector<FaceToPlace>> faces_of_pack_;
};

}  // namespace

template <int Dim>
Layout<Dim>::Layout(const ModelOf<Dim>& model, const LayoutParameters& parameters) {
  LayoutBuilder<Dim> builder(model, parameters, *this);
  builder.take_chunks();
  builder.place_blocks();
  builder.place_faces();
  builder.gather_contacts();
  builder.gather_corners();
}

template <int Dim>
std::optional<std::size_t> Layout<Dim>::count_of(Per per) const {
  switch (per) {
    case Per::bundle:
      return this->bundles.size();
    case Per::gridpoint:
      return this->gridpoint_slot.size();
    case Per::gridpoint_pack:
      return gridpoint_packs;
    case Per::gridpoint_slot:
      return kLanes * gridpoint_packs;
    case Per::zone:
      return this->zone_slot.size();
    case Per::zone_pack:
      return zone_packs;
    case Per::face_pack:
      return this->faces.size();
    case Per::face_pack_end:
      return this->faces.size() + 1;
    case Per::point_pack:
      return this->points.size();
    case Per::point_pack_or_idle:
      return point_packs;
    case Per::point_slot_or_idle:
      return kLanes * point_packs;
    case Per::contact:
      return this->contact_slot.size();
    case Per::zone_pack_or_bundle:
    case Per::entry:
      break;
  }
  return std::nullopt;
}

template struct Layout<2>;
template struct Layout<3>;

}  // namespace pyroclast
