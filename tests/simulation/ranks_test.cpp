// Whole runs on several ranks have the bits of one rank. The ranks are threads here.

#include <map>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "pyroclast/model/part.hpp"
#include "ranks_in_threads.hpp"
#include "small_chunks.hpp"
#include "stages/small_runs.hpp"

namespace pyroclast {
namespace {

constexpr int kBlocksOfASmallChunk = 8;

/// What a run leaves: its history, and the state of each gridpoint and contact of the whole.
struct Left {
  std::vector<std::string> columns;
  std::vector<std::vector<std::optional<double>>> rows;
  std::map<int, std::array<Vec<3>, 3>> gridpoints;  ///< displacement, velocity and force
  std::map<int, std::vector<double>> contacts;      ///< internal variables and losses
};

/// Deck to be run, with what makes it small.
struct Asked {
  std::string text;
  int blocks = 0;  ///< blocks, 0: those of the deck
  std::size_t most_rows = 1000000;
};

/// Runs a deck on one of several ranks, or alone.
Left run_on(const Asked& asked, const std::shared_ptr<Ranks>& ranks) {
  Setup setup = read(asked.text);
  if (asked.blocks > 0) setup.specimen.blocks.count = asked.blocks;
  const auto simulation = make_simulation(setup, std::make_shared<Team>(1), ranks);
  Run run(*simulation, std::move(setup.stages));
  while (run.history().row_count() < asked.most_rows && run.next()) {
  }
  Left left;
  for (const Column& column : run.history().columns()) left.columns.push_back(column.name);
  for (std::size_t r = 0; r < run.history().row_count(); ++r) {
    const auto row = run.history().row(r);
    left.rows.emplace_back(row.begin(), row.end());
  }
  if (!simulation->moves()) return left;
  const Model& model = simulation->model();
  const MotionReader& read = simulation->motion().read();
  for (auto [g, last] = model.gridpoint_chunks().own(); g < last; ++g)
    left.gridpoints[model.part ? model.part->gridpoint[g] : g] = {read.displacement(g), read.velocity(g),
                                                                  read.force(g)};
  const ChunkList chunks = model.gridpoint_chunks();
  for (int c = 0; c < model.contact_count(); ++c) {
    // contacts between foreign blocks serve heat alone
    if (!chunks.is_own(model.joint(c).a) && !chunks.is_own(model.joint(c).b)) continue;
    const ContactState state = read.contact(c);
    std::vector<double>& numbers = left.contacts[model.part ? model.part->contact[c] : c];
    numbers.assign(state.internals.begin(), state.internals.end());
    numbers.insert(numbers.end(), state.losses.begin(), state.losses.end());
  }
  return left;
}

/// Describes the first cell in which two histories differ; empty where they are the same.
std::string difference(const Left& a, const Left& b) {
  if (a.columns != b.columns) return "other columns";
  for (std::size_t row = 0; row < std::min(a.rows.size(), b.rows.size()); ++row)
    for (std::size_t i = 0; i < a.columns.size(); ++i)
      if (a.rows[row][i] != b.rows[row][i])
        return fmt::format("row {}, {}: {} and {}", row, a.columns[i], a.rows[row][i].value_or(0.0),
                           b.rows[row][i].value_or(0.0));
  return a.rows.size() == b.rows.size() ? "" : "another number of rows";
}

void expect_same_bits(const Asked& asked, const std::vector<int>& counts) {
  const SmallChunks chunks(kBlocksOfASmallChunk);
  const Left alone = run_on(asked, nullptr);
  ASSERT_GT(alone.rows.size(), 3U);
  for (const int count : counts) {
    SCOPED_TRACE(testing::Message() << count << " ranks");
    Left together;
    std::mutex mutex;
    RanksInThreads::run(count, [&](const std::shared_ptr<Ranks>& ranks) {
      Left left = run_on(asked, ranks);
      const std::lock_guard lock(mutex);
      EXPECT_EQ(difference(left, alone), "") << "rank " << ranks->me();
      together.gridpoints.merge(left.gridpoints);
      for (const auto& [contact, numbers] : left.contacts) {
        const auto [found, is_new] = together.contacts.emplace(contact, numbers);
        EXPECT_TRUE(is_new || found->second == numbers) << "contact " << contact << " differs between ranks";
      }
    });
    EXPECT_TRUE(together.gridpoints == alone.gridpoints);
    EXPECT_TRUE(together.contacts == alone.contacts);
  }
}

TEST(RunOnRanks, CrushesAPrismToTheBit) {
  expect_same_bits({deck(kUniform + kSettle + kFailure + kControl)}, {2, 3, 7});
}

TEST(RunOnRanks, LoadsAndHeatsAPrismToTheBit) {
  expect_same_bits({deck(kUniform + kSettle + load("stress = \"2 MPa\"") + heat("60 degC"))}, {2, 4});
}

TEST(RunOnRanks, HeatsAFaceUnderLoadToTheBit) {
  expect_same_bits({deck(kSettle + load("stress = \"2 MPa\"") + kExpose + kHeatedFace)}, {2, 3});
}

// Promise: the same where cracks hinder heat, with gaps between two other ranks.
TEST(RunOnRanks, HeatsACrackedPrismToTheBit) {
  expect_same_bits({hot_deck("[heat.cracks]\n")}, {2, 3});
}

class CaseOnRanks : public testing::TestWithParam<std::pair<std::string, int>> {};
INSTANTIATE_TEST_SUITE_P(Small, CaseOnRanks,
                         testing::Values(std::pair{"compression_3d", 240}, std::pair{"biaxial_3d", 60},
                                         std::pair{"biaxial", 80}, std::pair{"cube_3d", 60},
                                         std::pair{"disc_3d", 80}, std::pair{"brazilian", 170},
                                         std::pair{"direct_tension", 80}, std::pair{"notched_beam", 200},
                                         std::pair{"cyclic", 80}, std::pair{"anderberg_thelandersson", 80},
                                         std::pair{"delamination_heat", 200}, std::pair{"thermal_wall", 100},
                                         std::pair{"fire_one_side", 100}, std::pair{"hot_strength", 80},
                                         std::pair{"residual_capacity", 80},
                                         std::pair{"restrained_heating", 80}, std::pair{"ring_cooling", 240},
                                         std::pair{"starter_3d", 60}, std::pair{"transient_heating", 80},
                                         std::pair{"wall_bent", 100}, std::pair{"limestone", 80}),
                         [](const auto& info) { return info.param.first; });

TEST_P(CaseOnRanks, HasTheBitsOfOne) {
  const auto& [name, blocks] = GetParam();
  expect_same_bits({shipped_case(name), blocks, 8}, {2, 3});
}

TEST(RunOnRanks, MoreRanksThanChunksAreRefused) {
  const SmallChunks chunks(kBlocksOfASmallChunk);
  EXPECT_THROW(RanksInThreads::run(20, [](const auto& ranks) { run_on({deck(kUniform + kSettle)}, ranks); }),
               Error);
}

}  // namespace
}  // namespace pyroclast
