// Promise: what is foretold of ranks is what they hold, and what they send to each other.

#include "pyroclast/simulation/body_on_ranks.hpp"

#include <algorithm>
#include <mutex>
#include <string>

#include <gtest/gtest.h>

#include "counted_ranks.hpp"
#include "pyroclast/simulation/watching/items.hpp"
#include "ranks_in_threads.hpp"
#include "small_chunks.hpp"
#include "stages/small_runs.hpp"

namespace pyroclast {
namespace {

class RanksOfCases : public testing::TestWithParam<std::pair<std::string, int>> {};
INSTANTIATE_TEST_SUITE_P(Small, RanksOfCases,
                         testing::Values(std::pair{"starter", 100}, std::pair{"fire_one_side", 100},
                                         std::pair{"thermal_wall", 100}, std::pair{"disc_3d", 80},
                                         std::pair{"column_fire_3d", 80}),
                         [](const auto& info) { return info.param.first; });

TEST_P(RanksOfCases, AreAsForetold) {
  const SmallChunks chunks(8);
  const auto& [name, blocks] = GetParam();
  auto setup = read(shipped_case(name));
  setup.specimen.blocks.count = blocks;
  if (name == "column_fire_3d") setup.specimen.aggregates.fraction = 0.0;  // so few blocks hold no stone
  const auto whole = make_simulation(setup);
  for (const int count : {2, 5}) {
    SCOPED_TRACE(testing::Message() << count << " ranks");
    const auto held = held_by_ranks(*whole, count);
    ASSERT_EQ(held.size(), static_cast<std::size_t>(count));
    std::mutex mutex;
    RanksInThreads::run(count, [&](const std::shared_ptr<Ranks>& ranks) {
      const auto counted = std::make_shared<CountedRanks>(ranks);
      const auto simulation = make_simulation(setup, *whole->specimen(), nullptr, counted);
      const Model& model = simulation->model();
      counted->forget();
      std::map<int, CountedRanks::Sent> by_motion, by_heat;
      if (simulation->moves()) {
        simulation->motion().advance(7);
        by_motion = counted->sent;
        EXPECT_EQ(counted->collectives, 0);
        counted->forget();
      }
      if (!simulation->field().is_uniform()) {
        simulation->field().begin_exposure(setup.temperatures);
        simulation->field().advance(5.0, 60.0);
        by_heat = counted->sent;
      }
      const std::lock_guard lock(mutex);
      const HeldByRank& here = held[static_cast<std::size_t>(ranks->me())];
      const auto own_blocks = model.chunks().own(), own_zones = model.zone_chunks().own();
      EXPECT_EQ(here.blocks, own_blocks.last - own_blocks.first);
      EXPECT_EQ(here.foreign_blocks, model.block_count() - here.blocks);
      EXPECT_EQ(here.zones, own_zones.last - own_zones.first);
      EXPECT_EQ(here.foreign_zones, model.zone_count() - here.zones);
      ASSERT_EQ(by_motion.size(), here.gridpoints_sent.size());
      for (const auto& [to, sent] : by_motion) {
        EXPECT_EQ(sent.messages, 8) << "seven of displacements and one of velocities";
        EXPECT_EQ(sent.numbers, 8U * model.dimension() * here.gridpoints_sent.at(to));
      }
      for (const auto& [to, nodes] : here.nodes_sent) {
        ASSERT_TRUE(by_heat.contains(to));
        EXPECT_EQ(by_heat.at(to).fewest, static_cast<std::size_t>(nodes));
      }
      if (simulation->moves()) {
        EXPECT_FALSE(here.gridpoints_sent.empty());
      }
      EXPECT_EQ(simulation->field().is_uniform(), here.nodes_sent.empty());
      EXPECT_GT(here.cut_points, 0);
    });
  }
}

TEST(HeldByRanks, AreRefusedWhereChunksAreTooFew) {
  const SmallChunks chunks(30);
  const auto whole = make_simulation(read(deck(kUniform + kSettle)));  // 60 blocks and two platens
  EXPECT_EQ(held_by_ranks(*whole, 4).size(), 4U);
  try {
    held_by_ranks(*whole, 5);
    FAIL() << "five ranks share four chunks";
  } catch (const Error& error) {
    EXPECT_STREQ(error.what(),
                 "5 ranks cannot share a body of 4 chunks: take 4 ranks at most, or more blocks");
  }
}

constexpr int kColumns = 20000;  // so that a slice has few items

/// Returns the function that writes the row of an item: its number in the whole, in the first and last
/// column.
auto row_of_number(Item item, const Model& model) {
  return [item, &model](int i, double* row) {
    const int ends = item == Item::contact_end ? ends_of_contact(model.dimension()) : 1;
    int number = i / ends;
    if (model.part)
      number = item == Item::gridpoint ? model.part->gridpoint[number]
               : item == Item::zone    ? model.part->zone[number]
                                       : model.part->contact[number];
    row[0] = number * ends + i % ends;
    row[kColumns - 1] = -row[0];
  };
}

/// Returns the numbers of items in the order in which slices have them.
std::vector<double> in_order_of_slices(Item item, const Model& model) {
  std::vector<double> all;
  in_slices(item, model, kColumns, row_of_number(item, model),
            [&](std::int64_t first, const std::vector<double>& rows) {
              EXPECT_EQ(first, std::ssize(all));
              for (std::size_t row = 0; row < rows.size(); row += kColumns) {
                all.push_back(rows[row]);
                EXPECT_EQ(rows[row + kColumns - 1], -all.back());
              }
            });
  return all;
}

/// Returns the numbers of the items of which a rank tells, as slices have them.
std::vector<double> of_own_slices(Item item, const Model& model) {
  std::vector<double> all;
  in_own_slices<double>(item, model, kColumns, row_of_number(item, model),
                        [&](std::int64_t first, const std::vector<double>& rows) {
                          EXPECT_LE(rows.size(), std::max<std::size_t>(1 << 16, 4 * kColumns));
                          for (std::size_t row = 0; row < rows.size(); row += kColumns) {
                            all.push_back(static_cast<double>(first++));
                            EXPECT_EQ(rows[row], all.back());
                            EXPECT_EQ(rows[row + kColumns - 1], -all.back());
                          }
                        });
  return all;
}

TEST(Slices, HaveTheOrderOfTheWholeOnAnyRanks) {
  const SmallChunks chunks(8);
  auto setup = read(shipped_case("starter"));
  setup.specimen.blocks.count = 100;
  const auto whole = make_simulation(setup);
  for (const Item item : {Item::gridpoint, Item::zone, Item::contact, Item::contact_end}) {
    SCOPED_TRACE(name_of(item));
    std::vector<double> ascending;
    for (int i = 0; i < count_of(item, whole->model()); ++i) ascending.push_back(i);
    EXPECT_GT(ascending.size(), 100U);
    EXPECT_EQ(in_order_of_slices(item, whole->model()), ascending);
    EXPECT_EQ(of_own_slices(item, whole->model()), ascending);
    RanksInThreads::run(3, [&](const std::shared_ptr<Ranks>& ranks) {
      const auto simulation = make_simulation(setup, *whole->specimen(), nullptr, ranks);
      EXPECT_EQ(in_order_of_slices(item, simulation->model()),
                ranks->is_first() ? ascending : std::vector<double>());
      const std::vector<double> own = of_own_slices(item, simulation->model());
      EXPECT_LT(own.size(), ascending.size());
      auto all = ranks->collect(own);
      std::ranges::sort(all);
      EXPECT_EQ(all, ascending);
    });
  }
}

}  // namespace
}  // namespace pyroclast
