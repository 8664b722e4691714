#include "pyroclast/simulation/body_on_ranks.hpp"

#include <algorithm>
#include <set>
#include <stdexcept>
#include <utility>

#include "pyroclast/simulation/simulation.hpp"
#include "pyroclast/thermal/thermal_mesh.hpp"

namespace pyroclast {

namespace {

/// One of several ranks that are not there: its part can be made, and nothing can travel.
class Imagined final : public Ranks {
 public:
  Imagined(int me, int count) : me_(me), count_(count) {}
  int me() const override { return me_; }
  int count() const override { return count_; }
  void begin_exchange(std::vector<Message>& /*messages*/, CallPlace /*at*/) override { refuse(); }
  void end_exchange(std::vector<Message>& /*messages*/, CallPlace /*at*/) override { refuse(); }

 protected:
  std::vector<std::byte> gather(std::span<const std::byte> /*own*/, Receivers /*receivers*/,
                                CallPlace /*at*/) override {
    refuse();
  }

 private:
  [[noreturn]] static void refuse() { throw std::logic_error("nothing travels between imagined ranks"); }

  int me_, count_;
};

/// Returns the thermal nodes of a body whose contacts all join; none where no heat flows.
ThermalNodes joined_nodes(const Model& model, const HeatConditions& heat,
                          const std::vector<BlockMaterial>& block_materials) {
  if (heat.uniform) return {};
  std::vector<bool> conducts;
  for (const BlockMaterial& material : block_materials) conducts.push_back(!material.is_of_bearing);
  return with_dimension(model, [&](const auto& of_dimension) {
    return join_through_contacts(of_dimension, blocks_of(model, conducts));
  });
}

/// Returns the bytes of messages of so many items each, by rank.
double message_bytes(const std::map<int, int>& messages, int numbers_of_an_item) {
  std::size_t bytes = 0;
  for (const auto& [rank, items] : messages)
    bytes += sizeof(double) * static_cast<std::size_t>(items * numbers_of_an_item);
  return static_cast<double>(bytes);
}

}  // namespace

ForeignBlocks foreign_blocks(const std::optional<MovingBody>& moving) {
  return moving && moving->mechanics.found.is_on ? ForeignBlocks::all : ForeignBlocks::touching;
}

std::unique_ptr<Model> part_of_rank(std::unique_ptr<Model> whole, const std::shared_ptr<Ranks>& ranks,
                                    const HeatConditions& heat,
                                    const std::vector<BlockMaterial>& block_materials,
                                    ForeignBlocks foreign) {
  if (!ranks || ranks->count() == 1) return whole;
  return part_of(*whole, ranks, joined_nodes(*whole, heat, block_materials).of_gridpoint, foreign);
}

int HeldByRank::neighbours() const {
  std::set<int> ranks;
  for (const auto* sent : {&gridpoints_sent, &nodes_sent})
    for (const auto& [rank, count] : *sent) ranks.insert(rank);
  return static_cast<int>(ranks.size());
}

double HeldByRank::step_bytes(int dimension) const {
  return message_bytes(gridpoints_sent, dimension);
}

double HeldByRank::stage_bytes() const {
  return message_bytes(nodes_sent, 1);
}

std::vector<HeldByRank> held_by_ranks(const Simulation& whole, int ranks) {
  const Model& model = whole.model();
  const auto& block_materials = whole.materials().block_materials;
  const std::vector<int> rank_of_chunk = ranks_of_chunks(model, ranks);
  const ThermalNodes nodes = joined_nodes(model, whole.heat(), block_materials);
  const std::vector<int> chunk_of = model.gridpoint_chunks().of_items();
  const bool finds = whole.moves() && whole.motion().parameters().found.is_on;
  const ForeignBlocks foreign = finds ? ForeignBlocks::all : ForeignBlocks::touching;
  std::vector<HeldByRank> held(static_cast<std::size_t>(ranks));
  for (int me = 0; me < ranks; ++me) {
    const auto made = part_of(model, std::make_shared<Imagined>(me, ranks), nodes.of_gridpoint, foreign);
    HeldByRank& here = held[static_cast<std::size_t>(me)];
    const auto blocks = made->chunks().own(), zones = made->zone_chunks().own();
    here.chunks = static_cast<int>(std::ranges::count(rank_of_chunk, me));
    here.blocks = blocks.last - blocks.first;
    here.zones = zones.last - zones.first;
    here.foreign_blocks = made->block_count() - here.blocks;
    here.foreign_zones = made->zone_count() - here.zones;
    const auto own = made->gridpoint_chunks().own();
    for (int c = 0; c < made->contact_count(); ++c)
      if (own.contain(made->joint(c).a) != own.contain(made->joint(c).b)) ++here.cut_points;
    if (whole.moves())
      for (const auto& [rank, gridpoints] : shared_gridpoints(*made))
        here.gridpoints_sent[rank] = static_cast<int>(gridpoints.own.size());
    // what this rank lacks, the owners send
    for (const int gridpoint : joined_nodes(*made, whole.heat(), block_materials).gridpoint) {
      if (own.contain(gridpoint)) continue;
      const int node = nodes.of_gridpoint[made->part->gridpoint[gridpoint]];
      ++held[static_cast<std::size_t>(rank_of_chunk[chunk_of[nodes.gridpoint[node]]])].nodes_sent[me];
    }
  }
  return held;
}

}  // namespace pyroclast
