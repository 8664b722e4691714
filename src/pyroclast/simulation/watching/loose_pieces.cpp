#include "pyroclast/simulation/watching/loose_pieces.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <map>
#include <numeric>
#include <set>
#include <string>

#include <fmt/format.h>

#include "pyroclast/base/disjoint_sets.hpp"
#include "pyroclast/simulation/contact_gaps.hpp"
#include "pyroclast/simulation/watching/items.hpp"

namespace pyroclast {

namespace {

/// Share of gravity above which a piece falls as it should.
constexpr double kFalls = 0.99;

using PairOfBlocks = std::array<int, 2>;

/// Tells whether a contact holds its blocks together, or bears something.
bool connects(const Motion& motion, int contact) {
  const ContactState state = motion.read().contact(contact);
  if (state.normal_traction != 0.0 || norm(state.shear_traction) != 0.0) return true;
  const double damage = largest_damage(motion, contact);
  return damage >= 0.0 && damage < 1.0;  // without a damage nothing holds a contact that bears nothing
}

/// Calls `take(a, b, connects)` for the blocks of each contact of the whole body, on the first rank: a
/// collective.
template <class Take>
void each_contact(const Simulation& simulation, bool asks_connects, Take take) {
  const Model& model = simulation.model();
  const auto block_of = [&](int gridpoint) {
    const int block = model.block_of(gridpoint);
    return static_cast<double>(model.part ? model.part->block[block] : block);
  };
  constexpr int kWidth = 3;
  in_slices(
      Item::contact, model, kWidth,
      [&](int contact, double* row) {
        row[0] = block_of(model.joint(contact).a);
        row[1] = block_of(model.joint(contact).b);
        row[2] = asks_connects && connects(simulation.motion(), contact) ? 1.0 : 0.0;
      },
      [&](std::int64_t, const std::vector<double>& rows) {
        for (auto row = rows.begin(); row != rows.end(); row += kWidth)
          take(static_cast<int>(row[0]), static_cast<int>(row[1]), row[2] != 0.0);
      });
}

/// Calls `take(block, row)` for each gridpoint of the whole body, on the first rank: a collective.
/// \param read  writes a row of so many numbers
template <class Read, class Take>
void each_gridpoint(const Simulation& simulation, int width, Read read, Take take) {
  const Model& model = simulation.model();
  in_slices(
      Item::gridpoint, model, width + 1,
      [&](int g, double* row) {
        const int block = model.block_of(g);
        row[0] = model.part ? model.part->block[block] : block;
        read(g, row + 1);
      },
      [&](std::int64_t, const std::vector<double>& rows) {
        for (auto row = rows.begin(); row != rows.end(); row += width + 1)
          take(static_cast<int>(row[0]), &row[1]);
      });
}

/// Block of a plane body where it lies now.
struct PlacedBlock {
  std::vector<std::array<int, 2>> edges;  // gridpoints, counter-clockwise round the block
  Vec<2> low, high;                       // of its box
  double size = 0.0;                      // root of its area, m
};

/// Blocks of a plane body where they lie now: all of them on the first rank, none on others.
class PlacedBlocks {
 public:
  explicit PlacedBlocks(const Simulation& simulation) {
    const Model& model = simulation.model();
    std::vector<Vec<2>> start;
    std::vector<int> block_of;
    each_gridpoint(
        simulation, 4,
        [&](int g, double* row) {
          const Vec<3> x = model.place(g), u = simulation.motion().read().displacement(g);
          for (int i = 0; i < 2; ++i) row[i] = x[i], row[2 + i] = x[i] + u[i];
        },
        [&](int block, const double* row) {
          block_of.push_back(block);
          start.push_back({{row[0], row[1]}});
          place_.push_back({{row[2], row[3]}});
        });
    std::vector<std::array<int, 3>> zones;
    in_slices(
        Item::zone, model, 3,
        [&](int zone, double* row) {
          for (const int g : model.gridpoints_of_zone(zone))
            *row++ = model.part ? model.part->gridpoint[g] : g;
        },
        [&](std::int64_t, const std::vector<double>& rows) {
          for (auto row = rows.begin(); row != rows.end(); row += 3)
            zones.push_back({static_cast<int>(row[0]), static_cast<int>(row[1]), static_cast<int>(row[2])});
        });
    if (block_of.empty()) return;
    blocks_.resize(static_cast<std::size_t>(std::ranges::max(block_of)) + 1);
    std::set<std::array<int, 2>> edges;
    for (auto& zone : zones) {
      const double twice = cross(start[zone[1]] - start[zone[0]], start[zone[2]] - start[zone[0]]);
      if (twice < 0.0) std::swap(zone[1], zone[2]);
      blocks_[block_of[zone[0]]].size += 0.5 * std::abs(twice);
      for (std::size_t i = 0; i < 3; ++i) edges.insert({zone[i], zone[(i + 1) % 3]});
    }
    for (const auto& edge : edges)
      if (!edges.contains({edge[1], edge[0]})) blocks_[block_of[edge[0]]].edges.push_back(edge);
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
  std::vector<Vec<2>> place_;
  std::vector<PlacedBlock> blocks_;
};

/// Sums over a block.
struct BlockSums {
  bool is_held = false;
  double real_mass = 0.0, moving_mass = 0.0;  // kg
};

}  // namespace

PassedThrough passed_through(const Simulation& simulation) {
  PassedThrough passed;
  if (!simulation.moves() || simulation.model().dimension() != 2) return passed;
  const PlacedBlocks blocks(simulation);
  std::set<PairOfBlocks> joined;
  each_contact(simulation, false, [&](int a, int b, bool) {
    joined.insert({std::min(a, b), std::max(a, b)});
  });
  std::vector<int> order(static_cast<std::size_t>(blocks.count()));
  std::iota(order.begin(), order.end(), 0);
  std::erase_if(order, [&](int block) { return simulation.is_gone(block); });
  std::ranges::sort(order, {}, [&](int block) { return blocks[block].low[0]; });
  std::map<int, int> deep;  // gridpoints that lie in others, and their blocks
  const auto look_into = [&](int block, int other) {
    const double most = PassedThrough::kDeep * std::min(blocks[block].size, blocks[other].size);
    for (const auto& edge : blocks[block].edges) {
      const double depth = blocks.depth(edge[0], other);
      if (depth > passed.depth) {
        passed.depth = depth;
        passed.block = block;
        passed.other = other;
      }
      if (depth > most) deep[edge[0]] = block;
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
  for (const auto& [gridpoint, block] : deep) of_blocks.insert(block);
  passed.gridpoints = static_cast<int>(deep.size());
  passed.blocks = static_cast<int>(of_blocks.size());
  return passed;
}

std::vector<FallingPiece> falling_pieces(const Simulation& simulation) {
  std::vector<FallingPiece> pieces;
  if (!simulation.moves()) return pieces;
  const Motion& motion = simulation.motion();
  const MechanicsParameters& parameters = motion.parameters();
  if (norm(parameters.gravity) == 0.0) return pieces;

  std::vector<BlockSums> sums;
  each_gridpoint(
      simulation, 3,
      [&](int g, double* row) {
        for (int i = 0; i < simulation.model().dimension(); ++i)
          if (motion.read().is_prescribed(g, i)) row[0] = 1.0;
        if (motion.is_gone(simulation.model().block_of(g))) row[0] = 1.0;
        row[1] = motion.read().real_mass(g);
        row[2] = motion.read().moving_mass(g);
      },
      [&](int block, const double* row) {
        if (block >= std::ssize(sums)) sums.resize(static_cast<std::size_t>(block) + 1);
        BlockSums& of_block = sums[block];
        of_block.is_held = of_block.is_held || row[0] != 0.0;
        of_block.real_mass += row[1];
        of_block.moving_mass += row[2];
      });
  DisjointSets piece(static_cast<int>(sums.size()));
  each_contact(simulation, true, [&](int a, int b, bool connects) {
    if (connects) piece.join(a, b);
  });
  for (const FoundPoint& point : motion.found_points()) piece.join(point.blocks[0], point.blocks[1]);

  struct Sum : BlockSums {
    std::vector<int> blocks;
  };
  std::map<int, Sum> of_piece;  // by their first blocks
  for (int block = 0; block < std::ssize(sums); ++block) {
    Sum& sum = of_piece[piece.first_of(block)];
    sum.is_held = sum.is_held || sums[block].is_held;
    sum.real_mass += sums[block].real_mass;
    sum.moving_mass += sums[block].moving_mass;
    sum.blocks.push_back(block);
  }
  // local damping takes its share of a force that moves a piece on, in the combined form half of it
  const double undamped =
      1.0 - (parameters.damping_form == DampingForm::combined ? 0.5 : 1.0) * parameters.local_damping;
  for (auto& [first, sum] : of_piece)
    if (!sum.is_held) pieces.push_back({std::move(sum.blocks), undamped * sum.real_mass / sum.moving_mass});
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
