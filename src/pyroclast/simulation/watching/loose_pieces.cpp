#include "pyroclast/simulation/watching/loose_pieces.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numeric>
#include <set>
#include <string>

#include <fmt/format.h>

#include "pyroclast/mechanics/cracks.hpp"

namespace pyroclast {

namespace {

/// Share of gravity above which a piece falls as it should.
constexpr double kFalls = 0.99;

Vec<2> in_plane(const Vec<3>& place) {
  return {{place[0], place[1]}};
}

/// Block of a plane body where it lies now.
struct PlacedBlock {
  std::vector<std::array<int, 2>> edges;  // of its outline, counter-clockwise
  Vec<2> low, high;                       // of its box
  double size = 0.0;                      // root of its area, m
};

class PlacedBlocks {
 public:
  explicit PlacedBlocks(const Simulation& simulation) : model_(simulation.model()) {
    for (int g = 0; g < model_.gridpoint_count(); ++g)
      place_.push_back(in_plane(model_.place(g) + simulation.motion().read().displacement(g)));
    const std::vector<int> block_of = zone_blocks(model_);
    std::set<std::array<int, 2>> edges;
    const auto each_edge = [&](int zone, auto f) {
      const auto g = model_.gridpoints_of_zone(zone);
      const bool is_positive = cross(in_plane(model_.place(g[1]) - model_.place(g[0])),
                                     in_plane(model_.place(g[2]) - model_.place(g[0]))) > 0.0;
      for (int i = 0; i < 3; ++i) {
        const int from = g[i], to = g[(i + 1) % 3];
        f(is_positive ? std::array{from, to} : std::array{to, from});
      }
    };
    for (int zone = 0; zone < model_.zone_count(); ++zone)
      each_edge(zone, [&](const std::array<int, 2>& edge) { edges.insert(edge); });
    blocks_.resize(static_cast<std::size_t>(model_.block_count()));
    const std::vector<double> volumes = model_.zone_volumes();
    for (int zone = 0; zone < model_.zone_count(); ++zone) {
      PlacedBlock& block = blocks_[block_of[zone]];
      block.size += volumes[zone] / model_.thickness;
      each_edge(zone, [&](const std::array<int, 2>& edge) {
        if (!edges.contains({edge[1], edge[0]})) block.edges.push_back(edge);
      });
    }
    constexpr double kFar = std::numeric_limits<double>::infinity();
    for (PlacedBlock& block : blocks_) {
      block.size = std::sqrt(block.size);
      block.low = {{kFar, kFar}};
      block.high = {{-kFar, -kFar}};
      for (const auto& edge : block.edges)
        for (int i = 0; i < 2; ++i) {
          block.low[i] = std::min(block.low[i], place_[edge[0]][i]);
          block.high[i] = std::max(block.high[i], place_[edge[0]][i]);
        }
    }
  }

  const PlacedBlock& operator[](int block) const { return blocks_[block]; }
  int count() const { return static_cast<int>(blocks_.size()); }

  /// Returns how deep a gridpoint lies in a block, m; 0 outside.
  double depth(int gridpoint, int in) const {
    const PlacedBlock& block = blocks_[in];
    const Vec<2>& at = place_[gridpoint];
    for (int i = 0; i < 2; ++i)
      if (at[i] < block.low[i] || at[i] > block.high[i]) return 0.0;
    bool is_inside = false;
    double least = std::numeric_limits<double>::infinity();
    for (const auto& edge : block.edges) {
      const Vec<2> from = place_[edge[0]], way = place_[edge[1]] - from, to = at - from;
      if ((from[1] > at[1]) != (from[1] + way[1] > at[1]) && to[0] < way[0] * to[1] / way[1])
        is_inside = !is_inside;
      const double along = std::clamp(dot(to, way) / dot(way, way), 0.0, 1.0);
      least = std::min(least, norm(to - way * along));
    }
    return is_inside ? least : 0.0;
  }

 private:
  const Model& model_;
  std::vector<Vec<2>> place_;
  std::vector<PlacedBlock> blocks_;
};

/// Tells whether a contact holds its blocks together, or bears something.
bool connects(const Motion& motion, int contact) {
  const ContactState state = motion.read().contact(contact);
  if (state.normal_traction != 0.0 || norm(state.shear_traction) != 0.0) return true;
  double most = -1.0;  // without a damage nothing holds a contact that bears nothing
  for (const Remembers mode : kCrackModes)
    if (place_of(*state.law, mode, state.dimension) >= 0) most = std::max(most, state.remembered(mode));
  return most >= 0.0 && most < 1.0;
}

}  // namespace

PassedThrough passed_through(const Simulation& simulation) {
  PassedThrough passed;
  const Model& model = simulation.model();
  if (!simulation.moves() || model.dimension() != 2 || model.part) return passed;
  const PlacedBlocks blocks(simulation);
  std::set<std::array<int, 2>> joined;
  for (int c = 0; c < model.contact_count(); ++c) {
    const int a = model.block_of(model.joint(c).a), b = model.block_of(model.joint(c).b);
    joined.insert({std::min(a, b), std::max(a, b)});
  }
  std::vector<int> order(static_cast<std::size_t>(blocks.count()));
  std::iota(order.begin(), order.end(), 0);
  std::ranges::sort(order, {}, [&](int block) { return blocks[block].low[0]; });
  std::map<int, bool> deep;  // gridpoints that lie in others
  const auto look_into = [&](int block, int other) {
    const double most = PassedThrough::kDeep * std::min(blocks[block].size, blocks[other].size);
    for (const auto& edge : blocks[block].edges) {
      const double depth = blocks.depth(edge[0], other);
      if (depth > passed.depth) {
        passed.depth = depth;
        passed.block = block;
        passed.other = other;
      }
      if (depth > most) deep[edge[0]] = true;
    }
  };
  for (std::size_t i = 0; i < order.size(); ++i)
    for (std::size_t j = i + 1; j < order.size(); ++j) {
      const int a = order[i], b = order[j];
      if (blocks[b].low[0] > blocks[a].high[0]) break;
      if (blocks[b].low[1] > blocks[a].high[1] || blocks[a].low[1] > blocks[b].high[1]) continue;
      if (joined.contains({std::min(a, b), std::max(a, b)})) continue;
      look_into(a, b);
      look_into(b, a);
    }
  std::set<int> of_blocks;
  for (const auto& [gridpoint, is_deep] : deep) of_blocks.insert(model.block_of(gridpoint));
  passed.gridpoints = static_cast<int>(deep.size());
  passed.blocks = static_cast<int>(of_blocks.size());
  return passed;
}

std::vector<FallingPiece> falling_pieces(const Simulation& simulation) {
  std::vector<FallingPiece> pieces;
  const Model& model = simulation.model();
  if (!simulation.moves() || model.part) return pieces;
  const Motion& motion = simulation.motion();
  const MechanicsParameters& parameters = motion.parameters();
  const double gravity = norm(parameters.gravity);
  if (gravity == 0.0) return pieces;

  std::vector<int> piece(static_cast<std::size_t>(model.block_count()));
  std::iota(piece.begin(), piece.end(), 0);
  const auto first_of = [&](int block) {
    while (piece[block] != block) block = piece[block] = piece[piece[block]];
    return block;
  };
  const auto join = [&](int a, int b) { piece[first_of(a)] = first_of(b); };
  for (int c = 0; c < model.contact_count(); ++c)
    if (connects(motion, c)) join(model.block_of(model.joint(c).a), model.block_of(model.joint(c).b));
  for (const FoundPoint& point : motion.found_points()) join(point.blocks[0], point.blocks[1]);

  std::map<int, FallingPiece> of_first;
  std::set<int> held;
  for (int block = 0; block < model.block_count(); ++block) {
    const int first = first_of(block);
    of_first[first].blocks.push_back(block);
    for (int g = model.block_gridpoints[block]; g < model.block_gridpoints[block + 1]; ++g)
      for (int i = 0; i < model.dimension(); ++i)
        if (motion.read().is_prescribed(g, i)) held.insert(first);
  }
  // local damping takes its share of a force that moves a piece on, in the combined form half of it
  const double undamped =
      1.0 - (parameters.damping_form == DampingForm::combined ? 0.5 : 1.0) * parameters.local_damping;
  for (auto& [first, falling] : of_first) {
    if (held.contains(first)) continue;
    std::vector<int> gridpoints;
    for (const int block : falling.blocks)
      for (int g = model.block_gridpoints[block]; g < model.block_gridpoints[block + 1]; ++g)
        gridpoints.push_back(g);
    const GridpointSet set = gridpoint_set(model, std::move(gridpoints));
    falling.share_of_gravity = undamped * norm(motion.totals().total_weight(set)) /
                               (gravity * motion.totals().total_moving_mass(set));
    pieces.push_back(std::move(falling));
  }
  std::ranges::stable_sort(pieces, std::greater{}, [](const FallingPiece& p) { return p.blocks.size(); });
  return pieces;
}

std::vector<std::string> warnings_of_loose_pieces(const Simulation& simulation) {
  std::vector<std::string> warnings;
  if (!simulation.moves()) return warnings;
  if (!simulation.motion().parameters().found.is_on)
    if (const PassedThrough passed = passed_through(simulation); passed.gridpoints > 0)
      warnings.push_back(fmt::format(
          "pieces have passed through others: {} gridpoints of {} blocks lie in blocks that they have no "
          "contact with, deeper than {:.0f} % of a block's size; the deepest, of block {}, lies {:.3g} mm "
          "deep in block {}: mechanics.contacts = \"found\" lets them meet (docs/understand/found.md)",
          passed.gridpoints, passed.blocks, 100.0 * PassedThrough::kDeep, passed.block, 1e3 * passed.depth,
          passed.other));
  const auto pieces = falling_pieces(simulation);
  const auto slow = [](const FallingPiece& p) { return p.share_of_gravity < kFalls; };
  if (const auto count = std::ranges::count_if(pieces, slow); count > 0) {
    const FallingPiece& piece = *std::ranges::find_if(pieces, slow);
    warnings.push_back(fmt::format(
        "{} free, and fall{} too slowly: {} with {:.2g} of gravity's acceleration, because of {}; for "
        "blocks that fly use mechanics.mass = \"real\" and mechanics.local_damping = 0.0",
        count == 1 ? "a piece is" : fmt::format("{} pieces are", count), count == 1 ? "s" : "",
        piece.blocks.size() == 1
            ? fmt::format("block {}", piece.blocks.front())
            : fmt::format("that of block {} and {} more", piece.blocks.front(), piece.blocks.size() - 1),
        piece.share_of_gravity,
        simulation.motion().parameters().mass == MassChoice::scaled ? "scaled mass and local damping"
                                                                    : "local damping"));
  }
  return warnings;
}

}  // namespace pyroclast
