// Checkpoints have the same bytes for any number of ranks, which are threads here.

#include <functional>
#include <memory>
#include <string>
#include <utility>

#include <gtest/gtest.h>

#include "pyroclast/results/checkpoint_file.hpp"
#include "ranks_in_threads.hpp"
#include "results/folder.hpp"
#include "small_chunks.hpp"
#include "stages/small_runs.hpp"

namespace pyroclast {
namespace {

/// Deck, with its number of blocks where that is not its own, and the batches after which it stops.
struct Asked {
  std::string text;
  int blocks = 0;
  int batches = 100;
};

class CheckpointOnRanks : public Results {
 protected:
  /// Runs a deck for so many batches, from a checkpoint where one is named, and writes a checkpoint.
  void go(const Asked& asked, int batches, const std::string& from, const std::string& to, int count) {
    const auto act = [&](const std::shared_ptr<Ranks>& ranks) {
      pyroclast::Setup setup = read(asked.text);
      if (asked.blocks > 0) setup.specimen.blocks.count = asked.blocks;
      const auto simulation = make_simulation(setup, std::make_shared<Team>(1), ranks);
      pyroclast::Run run(*simulation, std::move(setup.stages));
      const auto visit = [&](StateVisitor& visitor) { run.visit_state(visitor); };
      if (!from.empty()) CheckpointFile(folder_ / from).restore(visit);
      run.go_on();
      int taken = 0;
      run.stop_when([&] { return taken++ == batches; });
      run.run();
      write_checkpoint(folder_ / to, {}, visit, simulation->ranks());
    };
    if (count == 1)
      act(nullptr);
    else
      RanksInThreads::run(count, act);
  }

  void expect_same_bytes(const Asked& asked) {
    go(asked, asked.batches, "", "half", 1);
    go(asked, asked.batches, "", "half_of_3", 3);
    EXPECT_TRUE(content(folder_ / "half_of_3") == content(folder_ / "half"));
    go(asked, 2 * asked.batches, "", "end", 1);
    const std::string end = content(folder_ / "end");
    ASSERT_TRUE(end != content(folder_ / "half"));
    for (const int count : {1, 2, 4}) {
      go(asked, asked.batches, "half_of_3", "end_on_ranks", count);
      EXPECT_TRUE(content(folder_ / "end_on_ranks") == end) << "written by 3 ranks, read by " << count;
    }
  }

 private:
  SmallChunks chunks_{8};
};

TEST_F(CheckpointOnRanks, OfAPressIsThatOfOne) {
  expect_same_bytes({deck(kUniform + kSettle + kFailure + kControl)});
}

TEST_F(CheckpointOnRanks, OfALoadedBodyInAnOvenIsThatOfOne) {
  expect_same_bytes({deck(kUniform + kSettle + load("stress = \"2 MPa\"") + heat("60 degC"))});
}

TEST_F(CheckpointOnRanks, OfAHeatedFaceIsThatOfOne) {
  expect_same_bytes({deck(kSettle + load("stress = \"2 MPa\"") + kExpose + kHeatedFace)});
}

TEST_F(CheckpointOnRanks, OfCracksThatHinderHeatIsThatOfOne) {
  expect_same_bytes({hot_deck("[heat.cracks]\n")});
}

// Promise: the same for shipped cases: drives with records, creep in a solid, heat alone.
TEST_F(CheckpointOnRanks, OfCasesIsThatOfOne) {
  for (const auto& [name, blocks] :
       {std::pair{"notched_beam", 200}, std::pair{"cyclic", 80}, std::pair{"transient_heating", 80},
        std::pair{"fire_one_side_3d", 60}, std::pair{"delamination_heat", 200}}) {
    SCOPED_TRACE(name);
    expect_same_bytes({shipped_case(name), blocks, 40});
  }
}

}  // namespace
}  // namespace pyroclast
