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
#include "pyroclast/specimen/cells.hpp"

namespace pyroclast {

namespace {

/// Share of gravity above which a piece falls as it should.
constexpr double kFalls = 0.99;

/// Depth over the size of a block that rounding may give to a corner on its surface.
constexpr double kOnSurface = 1e-9;

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

/// Block where it lies now.
template <int Dim>
struct PlacedBlock {
  std::vector<std::array<int, Dim>> facets;  // gridpoints of its surface, seen from outside counter-clockwise
  std::vector<std::array<int, Dim + 1>> zones;  // gridpoints, positively oriented
  std::vector<int> gridpoints;                  // of its surface
  Vec<Dim> low, high;                           // of its box
  double size = 0.0;                            // root of its area, cube root of its volume, m
};

/// Blocks where they lie now: all of them on the first rank, none on others.
template <int Dim>
class PlacedBlocks {
 public:
  explicit PlacedBlocks(const Simulation& simulation) {
    const Model& model = simulation.model();
    std::vector<Vec<Dim>> start;
    std::vector<int> block_of;
    each_gridpoint(
        simulation, 2 * Dim,
        [&](int g, double* row) {
          const Vec<3> x = model.place(g), u = simulation.motion().read().displacement(g);
          for (int i = 0; i < Dim; ++i) row[i] = x[i], row[Dim + i] = x[i] + u[i];
        },
        [&](int block, const double* row) {
          block_of.push_back(block);
          std::copy_n(row, Dim, start.emplace_back().c.begin());
          std::copy_n(row + Dim, Dim, place_.emplace_back().c.begin());
        });
    std::vector<std::array<int, Dim + 1>> zones;
    in_slices(
        Item::zone, model, Dim + 1,
        [&](int zone, double* row) {
          for (const int g : model.gridpoints_of_zone(zone))
            *row++ = model.part ? model.part->gridpoint[g] : g;
        },
        [&](std::int64_t, const std::vector<double>& rows) {
          for (auto row = rows.begin(); row != rows.end(); row += Dim + 1)
            std::copy_n(row, Dim + 1, zones.emplace_back().begin());
        });
    if (block_of.empty()) return;
    blocks_.resize(static_cast<std::size_t>(std::ranges::max(block_of)) + 1);
    for (auto& zone : zones) {
      const double size = size_of(zone, start);
      if (size < 0.0) std::swap(zone[0], zone[1]);
      PlacedBlock<Dim>& block = blocks_[block_of[zone[0]]];
      block.size += std::abs(size);
      block.zones.push_back(zone);
    }
    for (PlacedBlock<Dim>& block : blocks_) {
      block.size = specimen::side_of<Dim>(block.size);
      find_surface(block);
    }
  }

  const PlacedBlock<Dim>& operator[](int block) const { return blocks_[block]; }
  int count() const { return static_cast<int>(blocks_.size()); }

  /// Returns how deep a gridpoint lies in a block, m, by the nearest line or plane of its facets; 0 outside.
  double depth(int gridpoint, int in) const {
    const PlacedBlock<Dim>& block = blocks_[in];
    const Vec<Dim>& at = place_[gridpoint];
    for (int i = 0; i < Dim; ++i)
      if (at[i] < block.low[i] || at[i] > block.high[i]) return 0.0;
    if (std::ranges::none_of(block.zones, [&](const auto& zone) { return holds(zone, at); })) return 0.0;
    double least = std::numeric_limits<double>::infinity();
    for (const auto& facet : block.facets) {
      const Vec<Dim> normal = normal_of(facet);
      least = std::min(least, std::abs(dot(at - place_[facet[0]], normal)) / norm(normal));
    }
    return least > kOnSurface * block.size ? least : 0.0;
  }

 private:
  /// Returns the area or volume of a zone, with its sign.
  static double size_of(const std::array<int, Dim + 1>& zone, const std::vector<Vec<Dim>>& place) {
    const Vec<Dim>& at = place[zone[0]];
    if constexpr (Dim == 2)
      return 0.5 * cross(place[zone[1]] - at, place[zone[2]] - at);
    else
      return dot(place[zone[1]] - at, cross(place[zone[2]] - at, place[zone[3]] - at)) / 6.0;
  }

  Vec<Dim> normal_of(const std::array<int, Dim>& facet) const {
    const Vec<Dim> way = place_[facet[1]] - place_[facet[0]];
    if constexpr (Dim == 2)
      return {{way[1], -way[0]}};
    else
      return cross(way, place_[facet[2]] - place_[facet[0]]);
  }

  /// Tells whether a point lies in a zone.
  bool holds(const std::array<int, Dim + 1>& zone, const Vec<Dim>& at) const {
    for (int left_out = 0; left_out <= Dim; ++left_out) {
      const auto facet = facet_of(zone, left_out);
      if (dot(at - place_[facet[0]], normal_of(facet)) > 0.0) return false;
    }
    return true;
  }

  /// Returns the facet of a zone opposite to one of its gridpoints, seen from outside counter-clockwise.
  static std::array<int, Dim> facet_of(const std::array<int, Dim + 1>& zone, int left_out) {
    std::array<int, Dim> facet{};
    for (int i = 0, to = 0; i <= Dim; ++i)
      if (i != left_out) facet[to++] = zone[i];
    if (left_out % 2 == 1) std::swap(facet[0], facet[1]);
    return facet;
  }

  void find_surface(PlacedBlock<Dim>& block) const {
    std::map<std::array<int, Dim>, std::pair<std::array<int, Dim>, int>> seen;  // facets by their gridpoints
    for (const auto& zone : block.zones)
      for (int left_out = 0; left_out <= Dim; ++left_out) {
        const auto facet = facet_of(zone, left_out);
        auto key = facet;
        std::ranges::sort(key);
        auto& [first, times] = seen[key];
        first = facet;
        ++times;
      }
    block.low.c.fill(std::numeric_limits<double>::infinity());
    block.high.c.fill(-std::numeric_limits<double>::infinity());
    std::set<int> gridpoints;
    for (const auto& [key, facet] : seen) {
      if (facet.second > 1) continue;
      block.facets.push_back(facet.first);
      gridpoints.insert(key.begin(), key.end());
      for (const int g : key)
        for (int i = 0; i < Dim; ++i) {
          block.low[i] = std::min(block.low[i], place_[g][i]);
          block.high[i] = std::max(block.high[i], place_[g][i]);
        }
    }
    block.gridpoints.assign(gridpoints.begin(), gridpoints.end());
  }

  std::vector<Vec<Dim>> place_;
  std::vector<PlacedBlock<Dim>> blocks_;
};

template <int Dim>
PassedThrough find_passed_through(const Simulation& simulation) {
  PassedThrough passed;
  const PlacedBlocks<Dim> blocks(simulation);
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
    for (const int g : blocks[block].gridpoints) {
      const double depth = blocks.depth(g, other);
      if (depth > passed.depth) {
        passed.depth = depth;
        passed.block = block;
        passed.other = other;
      }
      if (depth > most) deep[g] = block;
    }
  };
  for (std::size_t i = 0; i < order.size(); ++i)
    for (std::size_t j = i + 1; j < order.size(); ++j) {
      const int a = order[i], b = order[j];
      if (blocks[b].low[0] > blocks[a].high[0]) break;
      bool meet = true;
      for (int k = 1; k < Dim; ++k)
        meet = meet && blocks[b].low[k] <= blocks[a].high[k] && blocks[a].low[k] <= blocks[b].high[k];
      if (!meet) continue;
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

/// Sums over a block.
struct BlockSums {
  bool is_held = false;
  double real_mass = 0.0, moving_mass = 0.0;  // kg
};

}  // namespace

PassedThrough passed_through(const Simulation& simulation) {
  if (!simulation.moves()) return {};
  return simulation.model().dimension() == 2 ? find_passed_through<2>(simulation)
                                             : find_passed_through<3>(simulation);
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
