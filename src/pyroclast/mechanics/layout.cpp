#include "pyroclast/mechanics/layout.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>

namespace pyroclast {

namespace {

/// Layers are this many blocks thick.
constexpr double kLayerThickness = 2.0;
/// Blocks that share lanes stand within as many layers of each other.
constexpr double kLayersToShare = 2.0;
/// Faces that share lanes have their later bundles within as many of each other.
constexpr int kBundlesToShare = 64;

/// Blocks in layers across the body's longest extent, along the others within a layer.
template <int Dim>
struct BlockOrder {
  std::vector<int> blocks;
  int per_layer = 1;
};

template <int Dim>
BlockOrder<Dim> order_blocks(const Model<Dim>& model) {
  const int count = model.block_count();
  std::vector<Vec<Dim>> centre(count);
  Vec<Dim> low, high;
  for (int b = 0; b < count; ++b) {
    const int first = model.block_gridpoints[b], last = model.block_gridpoints[b + 1];
    for (int g = first; g < last; ++g) centre[b] += model.position[g] * (1.0 / (last - first));
    for (int i = 0; i < Dim; ++i) {
      low[i] = b == 0 ? centre[b][i] : std::min(low[i], centre[b][i]);
      high[i] = b == 0 ? centre[b][i] : std::max(high[i], centre[b][i]);
    }
  }
  std::array<int, Dim> axis;
  std::iota(axis.begin(), axis.end(), 0);
  std::stable_sort(axis.begin(), axis.end(),
                   [&](int i, int j) { return high[i] - low[i] > high[j] - low[j]; });
  double space = 1.0;
  int dimensions = 0;
  for (int i = 0; i < Dim; ++i)
    if (high[i] > low[i]) {
      space *= high[i] - low[i];
      ++dimensions;
    }
  const double size = dimensions > 0 ? std::pow(space / count, 1.0 / dimensions) : 1.0;
  const auto layer = [&](int b, int i) {
    return std::floor((centre[b][axis[i]] - low[axis[i]]) / (kLayerThickness * size));
  };
  BlockOrder<Dim> order;
  order.blocks.resize(count);
  std::iota(order.blocks.begin(), order.blocks.end(), 0);
  std::stable_sort(order.blocks.begin(), order.blocks.end(), [&](int a, int b) {
    for (int i = 0; i + 1 < Dim; ++i)
      if (layer(a, i) != layer(b, i)) return layer(a, i) < layer(b, i);
    return centre[a][axis[Dim - 1]] < centre[b][axis[Dim - 1]];
  });
  const double layers = 1.0 + (high[axis[0]] - low[axis[0]]) / (kLayerThickness * size);
  order.per_layer = std::max(1, static_cast<int>(count / layers));
  return order;
}

/// Zones go round the last gridpoint, in the order of the others.
bool is_fan(const std::vector<std::array<int, 3>>& zones) {
  const int count = static_cast<int>(zones.size());
  for (int z = 0; z < count; ++z)
    if (zones[z] != std::array{z, z + 1 < count ? z + 1 : 0, count}) return false;
  return count > 2;
}

template <int Dim>
class LayoutBuilder {
 public:
  LayoutBuilder(const Model<Dim>& model, const LayoutParameters& parameters, Layout<Dim>& layout)
      : model_(model), parameters_(parameters), layout_(layout) {}

  void place_blocks() {
    const auto order = order_blocks(model_);
    const int span = static_cast<int>(kLayersToShare * order.per_layer) + kLanes;
    layout_.gridpoint_slot.resize(model_.position.size());
    layout_.zone_slot.resize(model_.zones.size());
    layout_.bundle_of_block.resize(order.blocks.size());
    struct Waiting {
      std::vector<int> blocks;
      int since = 0;
    };
    std::map<int, Waiting> waiting;  // by shape
    for (int place = 0; place < static_cast<int>(order.blocks.size()); ++place) {
      const int block = order.blocks[place];
      const int shape = shape_of(block);
      auto& group = waiting[shape];
      if (group.blocks.empty()) group.since = place;
      group.blocks.push_back(block);
      if (group.blocks.size() == kLanes) {
        add_bundle(shape, group.blocks);
        waiting.erase(shape);
      }
      for (auto it = waiting.begin(); it != waiting.end();) {
        if (place - it->second.since < span) {
          ++it;
          continue;
        }
        add_bundle(it->first, it->second.blocks);
        it = waiting.erase(it);
      }
    }
    for (const auto& [shape, group] : waiting) add_bundle(shape, group.blocks);
  }

  void place_faces() {
    const int faces = model_.contact_count() / Dim;
    std::vector<int> block_of(model_.position.size());
    for (int b = 0; b < model_.block_count(); ++b)
      for (int g = model_.block_gridpoints[b]; g < model_.block_gridpoints[b + 1]; ++g) block_of[g] = b;
    const auto bundle = [&](int gridpoint) { return layout_.bundle_of_block[block_of[gridpoint]]; };
    const auto later = [&](int f) {
      const auto& c = model_.contacts[f * Dim];
      return std::max(bundle(c.a), bundle(c.b));
    };
    std::vector<int> order(faces);
    std::iota(order.begin(), order.end(), 0);
    std::stable_sort(order.begin(), order.end(), [&](int f, int g) { return later(f) < later(g); });

    layout_.contact_slot.resize(model_.contacts.size());
    const int bundles = static_cast<int>(layout_.bundles.size());
    std::map<int, std::vector<int>> waiting;  // by interface
    for (int f : order) {
      auto& group = waiting[model_.contacts[f * Dim].interface];
      group.push_back(f);
      const bool full = group.size() == kLanes;
      if (full) {
        add_faces(group);
        group.clear();
      }
      for (auto& [interface, others] : waiting)
        if (!others.empty() && later(f) - later(others.front()) > kBundlesToShare) {
          add_faces(others);
          others.clear();
        }
    }
    for (const auto& [interface, group] : waiting)
      if (!group.empty()) add_faces(group);
    layout_.faces = FlatArray<FaceRow<Dim>>(faces_);
    for (int r = 0; r < layout_.face_rows(); ++r)
      for (int f : faces_of_row_[r])
        for (int g : {model_.contacts[f * Dim].a, model_.contacts[f * Dim].b}) {
          int& last = layout_.bundles[bundle(g)].last_face_row;
          last = std::max(last, r);
        }
    for (int i = 1; i < bundles; ++i)
      layout_.bundles[i].last_face_row =
          std::max(layout_.bundles[i].last_face_row, layout_.bundles[i - 1].last_face_row);
    layout_.rows_reached.push_back(0);
    for (const auto& row : faces_of_row_) {
      int reached = layout_.rows_reached.back();
      for (int f : row) {
        const Bundle& b = layout_.bundles[later(f)];
        reached = std::max(reached, b.first_row + b.rows);
      }
      layout_.rows_reached.push_back(reached);
    }
  }

  /// Contacts of a gridpoint in the order of their numbers, so that their sum has one order.
  void gather_contacts() {
    const auto of_gridpoint = gridpoint_contacts(model_);
    const int idle = kLanes * (layout_.contact_rows() - 1);
    std::vector<int> gridpoint(static_cast<std::size_t>(layout_.gridpoint_rows) * kLanes, -1);
    for (int g = 0; g < model_.gridpoint_count(); ++g) gridpoint[layout_.gridpoint_slot[g]] = g;
    layout_.contacts_of_row.resize(layout_.gridpoint_rows);
    for (int row = 0; row < layout_.gridpoint_rows; ++row) {
      const int begin = static_cast<int>(acting_.size());
      int most = 0;
      for (int lane = 0; lane < kLanes; ++lane)
        if (const int g = gridpoint[slot_of(row, lane)]; g >= 0)
          most = std::max(most, of_gridpoint.begin[g + 1] - of_gridpoint.begin[g]);
      for (int k = 0; k < most; ++k) {
        ActingContacts acting;
        for (int lane = 0; lane < kLanes; ++lane) {
          acting.contact[lane] = offset_of<Dim>(idle);
          const int g = gridpoint[slot_of(row, lane)];
          if (g < 0 || of_gridpoint.begin[g] + k >= of_gridpoint.begin[g + 1]) continue;
          const int side = of_gridpoint.contact_side[of_gridpoint.begin[g] + k];
          acting.contact[lane] = offset_of<Dim>(layout_.contact_slot[side / 2]);
          if (side % 2 == 1) acting.side_b |= 1U << lane;
        }
        acting_.push_back(acting);
      }
      layout_.contacts_of_row[row] = {begin, static_cast<int>(acting_.size())};
    }
    layout_.acting = FlatArray<ActingContacts>(acting_);
  }

 private:
  int shape_of(int block) {
    const int first = model_.block_gridpoints[block];
    std::vector<std::array<int, Dim + 1>> zones(model_.zones.begin() + model_.block_zones[block],
                                                model_.zones.begin() + model_.block_zones[block + 1]);
    for (auto& zone : zones)
      for (int& g : zone) g -= first;
    const int gridpoints = model_.block_gridpoints[block + 1] - first;
    const auto [it, is_new] =
        shape_.try_emplace({gridpoints, std::move(zones)}, static_cast<int>(layout_.shapes.size()));
    if (is_new) layout_.shapes.push_back(it->first.second);
    return it->second;
  }

  void add_bundle(int shape, const std::vector<int>& blocks) {
    if (static_cast<int>(blocks.size()) < parameters_.fewest_blocks) {
      for (int block : blocks) add_spread(block);
      return;
    }
    Bundle bundle;
    bundle.shape = shape;
    const int block = blocks.front();
    bundle.rows = model_.block_gridpoints[block + 1] - model_.block_gridpoints[block];
    bundle.zones = model_.block_zones[block + 1] - model_.block_zones[block];
    if constexpr (Dim == 2) bundle.fan = is_fan(layout_.shapes[shape]);
    start(bundle);
    for (int lane = 0; lane < static_cast<int>(blocks.size()); ++lane) {
      const int b = blocks[lane];
      for (int i = 0; i < bundle.rows; ++i)
        layout_.gridpoint_slot[model_.block_gridpoints[b] + i] = slot_of(bundle.first_row + i, lane);
      for (int i = 0; i < bundle.zones; ++i)
        layout_.zone_slot[model_.block_zones[b] + i] = slot_of(bundle.first_zone_row + i, lane);
    }
    finish(std::move(bundle), blocks);
  }

  void add_spread(int block) {
    Bundle bundle;
    bundle.kind = BundleKind::spread;
    const int gridpoints = model_.block_gridpoints[block + 1] - model_.block_gridpoints[block];
    bundle.rows = (gridpoints + kLanes - 1) / kLanes;
    bundle.zones = model_.block_zones[block + 1] - model_.block_zones[block];
    start(bundle);
    for (int i = 0; i < gridpoints; ++i)
      layout_.gridpoint_slot[model_.block_gridpoints[block] + i] = slot_of(bundle.first_row, i);
    for (int i = 0; i < bundle.zones; ++i)
      layout_.zone_slot[model_.block_zones[block] + i] = slot_of(bundle.first_zone_row, i);
    finish(std::move(bundle), {block});
  }

  void start(Bundle& bundle) {
    bundle.first_row = layout_.gridpoint_rows;
    bundle.first_zone_row = layout_.zone_rows;
    layout_.gridpoint_rows += bundle.rows;
    layout_.zone_rows += bundle.zone_rows();
    layout_.most_rows = std::max(layout_.most_rows, bundle.rows);
  }

  void finish(Bundle bundle, const std::vector<int>& blocks) {
    bundle.blocks = blocks;
    for (int b : blocks) layout_.bundle_of_block[b] = static_cast<int>(layout_.bundles.size());
    if (bundle.kind == BundleKind::spread) {
      const int first = model_.block_zones[blocks.front()];
      bundle.first_spread_row = static_cast<int>(layout_.spread_zones.size());
      layout_.spread_zones.resize(layout_.spread_zones.size() + bundle.zone_rows());
      // an idle lane repeats the row's first zone, whose forces are then left out
      for (int row = 0; row < bundle.zone_rows(); ++row)
        for (int lane = 0; lane < kLanes; ++lane) {
          const int zone = kLanes * row + lane < bundle.zones ? kLanes * row + lane : kLanes * row;
          for (int n = 0; n <= Dim; ++n)
            layout_.spread_zones[bundle.first_spread_row + row].offset[n][lane] =
                offset_of<Dim>(layout_.gridpoint_slot[model_.zones[first + zone][n]]);
        }
    }
    layout_.bundles.push_back(std::move(bundle));
  }

  void add_faces(const std::vector<int>& faces) {
    const int row_index = static_cast<int>(faces_.size());
    FaceRow<Dim> row{};
    for (int lane = 0; lane < kLanes; ++lane) {
      const bool idle = lane >= static_cast<int>(faces.size());
      const int f = idle ? faces.front() : faces[lane];
      for (int point = 0; point < Dim; ++point) {
        const auto& c = model_.contacts[f * Dim + point];
        row.a[point][lane] = offset_of<Dim>(layout_.gridpoint_slot[c.a]);
        // both sides of an idle one are the same gridpoint, so that it never opens
        row.b[point][lane] = offset_of<Dim>(layout_.gridpoint_slot[idle ? c.a : c.b]);
        row.area[lane] = idle ? 0.0 : c.area;
        for (int i = 0; i < Dim; ++i)
          for (int t = 0; t + 1 < Dim; ++t) row.tangent[t][i][lane] = c.tangents[t][i];
        if (!idle) layout_.contact_slot[f * Dim + point] = slot_of(row_index * Dim + point, lane);
      }
    }
    faces_.push_back(row);
    faces_of_row_.push_back(faces);
  }

  const Model<Dim>& model_;
  const LayoutParameters parameters_;
  Layout<Dim>& layout_;
  std::map<std::pair<int, std::vector<std::array<int, Dim + 1>>>, int> shape_;
  std::vector<FaceRow<Dim>> faces_;
  std::vector<std::vector<int>> faces_of_row_;
  std::vector<ActingContacts> acting_;
};

}  // namespace

template <int Dim>
Layout<Dim>::Layout(const Model<Dim>& model, const LayoutParameters& parameters) {
  LayoutBuilder<Dim> builder(model, parameters, *this);
  builder.place_blocks();
  builder.place_faces();
  builder.gather_contacts();
}

template <int Dim>
std::size_t Layout<Dim>::memory() const {
  std::size_t bytes = bytes_of(bundles) + bytes_of(spread_zones) + bytes_of(faces) + bytes_of(rows_reached) +
                      bytes_of(contacts_of_row) + bytes_of(acting) + bytes_of(gridpoint_slot) +
                      bytes_of(zone_slot) + bytes_of(contact_slot) + bytes_of(bundle_of_block);
  for (const Bundle& bundle : bundles) bytes += bytes_of(bundle.blocks);
  for (const auto& zones : shapes) bytes += bytes_of(zones);
  return bytes;
}

template struct Layout<2>;
template struct Layout<3>;

}  // namespace pyroclast
