#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstdint>
#include <fstream>
#include <functional>
#include <numeric>
#include <random>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "messages.hpp"
#include "pyroclast/base/error.hpp"
#include "pyroclast/results/checkpoints.hpp"
#include "pyroclast/results/results_writer.hpp"
#include "results/folder.hpp"
#include "results/system_calls.hpp"
#include "stages/small_runs.hpp"

namespace pyroclast {
namespace {

/// Something with a state of every form.
struct Thing {
  double number = std::nan("");
  std::int64_t count = -1;
  bool flag = false;
  std::vector<double> list;
  FlatArray<int> array;
  std::string text;

  void visit_state(StateVisitor& visitor) {
    visitor.visit("number", number);
    visitor.visit("count", count, state::within(-1, 1000));
    const StateVisitor::Scope scope(visitor, "more");
    visitor.visit("flag", flag);
    visitor.visit("list", list);
    visitor.visit("array", array, state::count());
    visitor.visit("text", text);
  }
};

Thing made_thing(int size = 1000) {
  Thing thing{0.1, 7, true, std::vector<double>(static_cast<std::size_t>(size)), FlatArray<int>(3), "a\nb"};
  std::iota(thing.list.begin(), thing.list.end(), 0.5);
  thing.array[1] = 5;
  return thing;
}

void write(const fs::path& path, Thing thing, std::int64_t number = 1) {
  CheckpointInfo info;
  info.number = number;
  info.step = 100 * number;
  info.version = "0.1";
  info.commit = "of old";
  write_checkpoint(path, info, [&](StateVisitor& visitor) { thing.visit_state(visitor); });
}

TEST_F(Results, ACheckpointGivesBackWhatItWasGiven) {
  const Thing thing = made_thing();
  write(folder_ / "a.state", thing, 3);
  const CheckpointFile file(folder_ / "a.state");
  EXPECT_EQ(file.info().number, 3);
  EXPECT_EQ(file.info().step, 300);
  EXPECT_NO_THROW(file.verify());
  Thing other;
  file.restore([&](StateVisitor& visitor) { other.visit_state(visitor); });
  EXPECT_EQ(other.number, thing.number);
  EXPECT_EQ(other.count, thing.count);
  EXPECT_EQ(other.flag, thing.flag);
  EXPECT_EQ(other.list, thing.list);
  EXPECT_EQ(other.text, thing.text);
  ASSERT_EQ(other.array.size(), 3U);
  EXPECT_TRUE(std::equal(other.array.begin(), other.array.end(), thing.array.begin()));
}

TEST_F(Results, ACheckpointOfSomethingElseIsRefusedByName) {
  write(folder_ / "a.state", made_thing());
  const CheckpointFile file(folder_ / "a.state");
  double number = 0.0;
  const auto restore = [&](const char* name) {
    return message([&] { file.restore([&](StateVisitor& visitor) { visitor.visit(name, number); }); });
  };
  EXPECT_NE(restore("other").find("does not hold \"other\"; it was written by pyroclast 0.1 (of old)"),
            std::string::npos);
  EXPECT_NE(restore("more.flag").find("holds 1 x 1 bytes of \"more.flag\""), std::string::npos);
  EXPECT_NE(restore("number").find("which this run does not have"), std::string::npos);
}

TEST_F(Results, ACheckpointIsOnDiskWholeOrNotAtAll) {
  SystemCalls calls;
  write(folder_ / "a.state", made_thing(), 1);
  EXPECT_EQ(calls.log, (std::vector<std::string>{"fsync a.state.partial", "rename a.state.partial a.state",
                                                 "fsync " + folder_.filename().string()}));
  calls.fsync_error = EIO;
  EXPECT_THROW(write(folder_ / "a.state", made_thing(), 2), Error);
  EXPECT_EQ(CheckpointFile(folder_ / "a.state").info().number, 1);
  EXPECT_FALSE(fs::exists(folder_ / "a.state.partial"));
}

// Promise: a checkpoint of an older form is refused by that reason, not as a damaged one.
TEST_F(Results, ACheckpointOfAnOlderFormIsRefused) {
  write(folder_ / "a.state", made_thing());
  std::string bytes = content(folder_ / "a.state");
  bytes.back() = '1';
  { std::ofstream(folder_ / "a.state", std::ios::binary) << bytes; }
  const std::string said = message([&] { CheckpointFile(folder_ / "a.state"); });
  EXPECT_NE(said.find("is in an older form"), std::string::npos) << said;
}

// Promise: of an array that stands chunk by chunk the chunk that is damaged is named.
TEST_F(Results, ADamagedChunkIsNamed) {
  const ChunkList chunks({0, 40, 60, 100});
  std::vector<double> numbers(100, 1.5);
  const auto visit = [&](StateVisitor& visitor) { visitor.visit_by_chunk("numbers", numbers, chunks); };
  write_checkpoint(folder_ / "a.state", {}, visit);
  std::string bytes = content(folder_ / "a.state");
  bytes[8 + 8 * 50] ^= 1;
  { std::ofstream(folder_ / "a.state", std::ios::binary) << bytes; }
  for (const auto& read : {std::function([&] { CheckpointFile(folder_ / "a.state").verify(); }),
                           std::function([&] { CheckpointFile(folder_ / "a.state").restore(visit); })})
    EXPECT_NE(message(read).find("\"numbers\" of chunk 1 differs"), std::string::npos) << message(read);
}

/// Cuts, flips and swaps bytes.
std::string damaged(std::string bytes, std::mt19937_64& random) {
  const auto place = [&] { return static_cast<std::size_t>(random() % bytes.size()); };
  const std::string before = bytes;
  switch (random() % 3) {
    case 0:
      bytes.resize(place());
      break;
    case 1:
      bytes[place()] ^= static_cast<char>(1U << (random() % 8));
      break;
    default: {
      const std::size_t length = 1 + random() % (bytes.size() / 4);
      const std::size_t a = random() % (bytes.size() - length), b = random() % (bytes.size() - length);
      for (std::size_t i = 0; i < length; ++i) std::swap(bytes[a + i], bytes[b + i]);
    }
  }
  return bytes == before ? damaged(before, random) : bytes;
}

// Promise: a file that is there but empty, as a full disk may leave it, is no unreadable one.
TEST_F(Results, AnEmptyFileIsNoCheckpoint) {
  { std::ofstream(folder_ / "a.state"); }
  const std::string said = message([&] { CheckpointFile(folder_ / "a.state"); });
  EXPECT_NE(said.find("is no checkpoint of pyroclast"), std::string::npos) << said;
}

TEST_F(Results, AThousandDamagedCheckpointsAreAThousandErrors) {
  write(folder_ / "a.state", made_thing(200));
  const std::string whole = content(folder_ / "a.state");
  std::mt19937_64 random(1);
  for (int i = 0; i < 1000; ++i) {
    { std::ofstream(folder_ / "b.state", std::ios::binary) << damaged(whole, random); }
    const std::string said = message([&] { CheckpointFile(folder_ / "b.state").verify(); });
    ASSERT_NE(said.find("b.state"), std::string::npos) << i << ": " << said;
  }
}

TEST_F(Results, TheNewestCheckpointIsTakenAndAnOlderOneOfferedWhereItIsDamaged) {
  const fs::path run = folder_ / "run";
  fs::create_directories(checkpoint_folder(run));
  EXPECT_NE(message([&] { newest_checkpoint(run); }).find("holds no checkpoint"), std::string::npos);
  const auto file = [&](const char* name) { return checkpoint_folder(run) / name; };
  write(file("000004.state"), made_thing(), 4);
  write(stage_checkpoint(run, 0), made_thing(), 5);
  write(file("000006.state"), made_thing(), 6);
  EXPECT_EQ(newest_checkpoint(run).info().number, 6);
  write_text_file(file("000004.state"), "damaged, but not the newest");
  EXPECT_EQ(newest_checkpoint(run).info().number, 6);
  write_text_file(file("000006.state"), content(file("000006.state")).substr(0, 100));
  const std::string said = message([&] { newest_checkpoint(run); });
  EXPECT_NE(said.find("000006.state: is cut short"), std::string::npos) << said;
  EXPECT_NE(said.find("of step 500, say --checkpoint-file " + stage_checkpoint(run, 0).string()),
            std::string::npos)
      << said;
}

// The two latest of the clock, and one for each stage that is done.
TEST_F(Results, ARunKeepsItsLatestCheckpointsAndThoseOfItsStages) {
  pyroclast::Setup setup = read_setup(Deck::parse(deck(kUniform + kSettle + kCompress), "deck.toml"), ".");
  const auto simulation = make_simulation(setup);
  pyroclast::Run run(*simulation, std::move(setup.stages));
  for (const bool keeps : {true, false}) {
    const fs::path folder = folder_ / (keeps ? "all" : "few");
    Checkpoints checkpoints(folder, {0.0, keeps},
                            {"inputs", body_hash(*simulation), [&](StateVisitor& v) { run.visit_state(v); },
                             [] { return 0.0; }, [] { return std::uint64_t{0}; }},
                            0);
    for (int i = 0; i < 4; ++i) checkpoints.write(run);
    checkpoints.end_stage(run);
    std::vector<std::string> names;
    for (const auto& entry : fs::directory_iterator(checkpoint_folder(folder)))
      names.push_back(entry.path().filename().string());
    std::ranges::sort(names);
    EXPECT_EQ(names, keeps ? (std::vector<std::string>{"000003.state", "000004.state", "stage_0.state"})
                           : (std::vector<std::string>{"000004.state", "000005.state"}));
  }
}

}  // namespace
}  // namespace pyroclast
