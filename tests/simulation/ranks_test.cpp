// Whole runs on several ranks have the bits of one rank. The ranks are threads here.

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <functional>
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
  double mean_unbalanced_force = 0.0;               ///< no column of the history has it
};

/// Deck to be run, with what makes it small.
struct Asked {
  std::string text;
  int blocks = 0;  ///< blocks, 0: those of the deck
  std::size_t most_rows = 1000000;
};

Setup small_setup(const Asked& asked) {
  Setup setup = read(asked.text);
  if (asked.blocks > 0) setup.specimen.blocks.count = asked.blocks;
  return setup;
}

/// Runs a deck on one of several ranks, or alone.
Left run_on(const Asked& asked, const std::shared_ptr<Ranks>& ranks) {
  Setup setup = small_setup(asked);
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
  left.mean_unbalanced_force = simulation->motion().totals().mean_unbalanced_force();
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

/// Describes the first cell in which two histories differ; empty where they are the same, with what else runs
/// left of sums.
std::string difference(const Left& a, const Left& b) {
  if (a.columns != b.columns) return "other columns";
  if (a.mean_unbalanced_force != b.mean_unbalanced_force) return "another mean of forces out of balance";
  for (std::size_t row = 0; row < std::min(a.rows.size(), b.rows.size()); ++row)
    for (std::size_t i = 0; i < a.columns.size(); ++i)
      if (a.rows[row][i] != b.rows[row][i])
        return fmt::format("row {}, {}: {} and {}", row, a.columns[i], a.rows[row][i].value_or(0.0),
                           b.rows[row][i].value_or(0.0));
  return a.rows.size() == b.rows.size() ? "" : "another number of rows";
}

void expect_same_bits(const Asked& asked, const std::vector<int>& counts) {
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

class RunOnRanks : public testing::Test {
  SmallChunks chunks_{kBlocksOfASmallChunk};
};

TEST_F(RunOnRanks, CrushesAPrismToTheBit) {
  expect_same_bits({deck(kUniform + kSettle + kFailure + kControl)}, {2, 3, 7});
}

TEST_F(RunOnRanks, LoadsAndHeatsAPrismToTheBit) {
  expect_same_bits({deck(kUniform + kSettle + load("stress = \"2 MPa\"") + heat("60 degC"))}, {2, 4});
}

TEST_F(RunOnRanks, HeatsAFaceUnderLoadToTheBit) {
  expect_same_bits({deck(kSettle + load("stress = \"2 MPa\"") + kExpose + kHeatedFace)}, {2, 3});
}

// Promise: the same where cracks hinder heat, with gaps between two other ranks.
TEST_F(RunOnRanks, HeatsACrackedPrismToTheBit) {
  expect_same_bits({hot_deck("[heat.cracks]\n")}, {2, 3});
}

class CaseOnRanks : public testing::TestWithParam<std::pair<std::string, int>> {
  SmallChunks chunks_{kBlocksOfASmallChunk};
};
INSTANTIATE_TEST_SUITE_P(Small, CaseOnRanks,
                         testing::Values(std::pair{"compression_3d", 240}, std::pair{"biaxial_3d", 60},
                                         std::pair{"biaxial", 80}, std::pair{"cube_3d", 60},
                                         std::pair{"disc_3d", 80}, std::pair{"brazilian", 170},
                                         std::pair{"drop", 60}, std::pair{"direct_tension", 80},
                                         std::pair{"notched_beam", 200}, std::pair{"cyclic", 80},
                                         std::pair{"anderberg_thelandersson", 80},
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

/// Splits the calls of a rank at a mark.
std::vector<std::string> split(const std::string& events, char mark) {
  std::vector<std::string> parts{""};
  for (const char event : events) event == mark ? (void)parts.emplace_back() : parts.back().push_back(event);
  return parts;
}

/// Returns the calls of a rank in the first rows of a run, batch by batch, without the first and the last
/// batch of each stage, which prepare it and what follows.
std::vector<std::string> calls_of(const Asked& asked,
                                  const std::shared_ptr<RanksInThreads::OfThread>& ranks) {
  Setup setup = small_setup(asked);
  const auto simulation = make_simulation(setup, std::make_shared<Team>(1), ranks);
  Run run(*simulation, std::move(setup.stages));
  run.between_batches([&](Run&, const Wishes&) { ranks->note('|'); });
  while (run.history().row_count() < asked.most_rows && run.next())
    if (run.stage_is_over()) ranks->note('.');
  std::vector<std::string> batches;
  bool is_first = true;
  for (const std::string& batch : split(ranks->events(), '|')) {
    const bool is_last = batch.find('.') != std::string::npos;
    if (!is_first && !is_last) batches.push_back(batch);
    is_first = is_last || (is_first && batch.find('x') == std::string::npos);
  }
  return batches;
}

// Promise: a batch of steps makes no collective between its first and its last step, and few beside them.
// Those of a press are three: one asks whether to stop, one is for the point of the curve and the next
// velocity, one for the row and the verdict. What a control by forces steers by travels with the first, also
// the motion that a stage foresees. Where temperatures change, two are for the hand-over.
TEST_F(RunOnRanks, ABatchTakesThreeCollectives) {
  const Asked press{deck(kUniform + kSettle + kFailure + kControl), 0, 60};
  const Asked heated{deck(kUniform + kSettle + load("stress = \"2 MPa\"") + heat("60 degC"))};
  const Asked drives{shipped_case("notched_beam"), 200, 12}, control{shipped_case("biaxial"), 80, 8};
  const Asked creeps{shipped_case("anderberg_thelandersson"), 80, 60};
  // a body that rests in the first batch at new temperatures
  const Asked quick{with(deck(kUniform + kSettle + load("stress = \"2 MPa\"") + heat("200 degC")),
                         "unbalanced_ratio = 1e-3\nplaten_difference = \"20 kPa\"",
                         "unbalanced_ratio = 0.5\nplaten_difference = \"20 MPa\"")};
  for (const Asked* asked : {&press, &heated, &drives, &control, &creeps, &quick})
    RanksInThreads::run(2, [&](const auto& ranks) {
      const auto batches = calls_of(*asked, ranks);
      EXPECT_GT(batches.size(), 60U);
      for (const std::string& batch : batches) {
        const auto first = batch.find('x'), last = batch.rfind('x');
        EXPECT_LE(std::ranges::count(batch, 'c'), 3) << batch;
        if (first == std::string::npos) continue;  // temperatures change
        EXPECT_EQ(batch.substr(first, last - first).find('c'), std::string::npos) << batch;
      }
    });
}

// Promise: handing temperatures over takes a collective before properties change, and one after; another one
// where creep is under way, which ends first.
TEST_F(RunOnRanks, AHandOverTakesTwoCollectives) {
  const Asked rests{deck(kUniform + kSettle)}, creeps{shipped_case("anderberg_thelandersson"), 80};
  for (const Asked* asked : {&rests, &creeps})
    RanksInThreads::run(2, [&](const std::shared_ptr<RanksInThreads::OfThread>& ranks) {
      const auto simulation = make_simulation(small_setup(*asked), std::make_shared<Team>(1), ranks);
      simulation->motion().advance(10);
      for (const double temperature : {60.0, 100.0}) {
        simulation->field().set_uniform(temperature);
        ranks->note('|');
        simulation->hand_over();
        ranks->note('|');
      }
      const auto calls = split(ranks->events(), '|');
      EXPECT_EQ(calls[1], "cc");
      EXPECT_EQ(calls[3], asked == &creeps ? "ccc" : "cc");
    });
}

/// Prism in a fire on its left, and the course of its temperatures.
const std::string kFire =
    "[heat]\nfield = \"conduction\"\n[[heat.boundaries]]\nfaces = \"left\"\nkind = \"convection\"\n"
    "coefficient = \"500 W/(m2 K)\"\ngas_temperature = { builtin = \"iso834\" }\n"
    "[[heat.boundaries]]\nfaces = \"right\"\nkind = \"temperature\"\ntemperature = \"20 degC\"\n";

struct Heated {
  HeatWork work;
  std::vector<std::array<double, 3>> means;  ///< mean, least and greatest temperature, degC
};

/// \param begins  called before the temperatures begin to change
Heated heat_on(
    int blocks, const std::shared_ptr<Ranks>& ranks, const std::function<void()>& begins = [] {}) {
  std::string text = deck(kSettle + kExpose) + kFire;
  for (int material = 0; material < 2; ++material)
    text = with(text, "conductivity = \"40 W/(m K)\"", "conductivity = \"1 W/(m K)\"");
  Setup setup = read(text);
  setup.specimen.blocks.count = blocks;
  const auto simulation = make_simulation(setup, std::make_shared<Team>(1), ranks);
  TemperatureField& field = simulation->field();
  field.begin_exposure(setup.temperatures);
  begins();
  Heated heated;
  for (int i = 1; i <= 12; ++i) {
    field.advance(1000.0, 10.0 * i);
    heated.means.push_back({field.mean(), field.minimum(), field.maximum()});
  }
  heated.work = field.conduction()->work();
  return heated;
}

// Promise: what limits a heat step are the zones of the whole. A foreign node at the fringe of a part lacks
// zones, so its capacity is too small, and speeds there are too large.
TEST_F(RunOnRanks, LimitsAsManyHeatStepsAsOne) {
  const Heated alone = heat_on(200, nullptr);
  EXPECT_GT(alone.work.limited_steps, 0);
  EXPECT_LT(alone.work.limited_steps, alone.work.steps);
  for (const int count : {2, 3})
    RanksInThreads::run(count, [&](const std::shared_ptr<Ranks>& ranks) {
      const Heated heated = heat_on(200, ranks);
      EXPECT_EQ(heated.work.limited_steps, alone.work.limited_steps);
      EXPECT_EQ(heated.work.stages, alone.work.stages);
      EXPECT_EQ(heated.means, alone.means);
    });
}

// Promise: a stage of a heat step takes one exchange with neighbours, two where flows are limited. A step
// takes a collective for its limits, and each trial one for its verdict.
TEST_F(RunOnRanks, AHeatStepTakesTwoCollectives) {
  RanksInThreads::run(2, [](const auto& ranks) {
    const Heated heated = heat_on(200, ranks, [&] { ranks->note('|'); });
    const std::string events = split(ranks->events(), '|').back();
    const auto exchanges = std::ranges::count(events, 'x'), collectives = std::ranges::count(events, 'c');
    EXPECT_GT(exchanges, heated.work.stages);
    EXPECT_LE(exchanges, 2 * heated.work.stages);
    const auto ends = static_cast<std::int64_t>(heated.means.size());  // of advances; each reads temperatures
    EXPECT_LE(collectives, 2 * heated.work.steps + heated.work.retries + 2 * ends);
  });
}

// Promise: tests see whatever reads a number that its owner has not sent. Owners alone have forces;
// velocities of gridpoints at faces to other ranks have been sent.
TEST_F(RunOnRanks, NumbersThatNobodySentAreNaN) {
  RanksInThreads::run(2, [](const std::shared_ptr<Ranks>& ranks) {
    auto setup = small_setup({deck(kUniform + kSettle)});
    const auto simulation = make_simulation(setup, std::make_shared<Team>(1), ranks);
    simulation->motion().advance(10);
    const Model& model = simulation->model();
    const MotionReader& read = simulation->motion().read();
    int sent = 0;
    for (int g = 0; g < model.gridpoint_count(); ++g) {
      const bool is_own = model.gridpoint_chunks().is_own(g);
      EXPECT_EQ(std::isnan(read.force(g)[0]), !is_own);
      const bool has_come = !std::isnan(read.velocity(g)[0]);
      EXPECT_EQ(has_come, !std::isnan(read.displacement(g)[0]));
      EXPECT_TRUE(has_come || !is_own);
      sent += has_come && !is_own ? 1 : 0;
    }
    EXPECT_GT(sent, 0);
  });
}

TEST_F(RunOnRanks, MoreRanksThanChunksAreRefused) {
  EXPECT_THROW(RanksInThreads::run(20, [](const auto& ranks) { run_on({deck(kUniform + kSettle)}, ranks); }),
               Error);
}

}  // namespace
}  // namespace pyroclast
