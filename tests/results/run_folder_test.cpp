#include "pyroclast/results/run_folder.hpp"

#include <algorithm>

#include <nlohmann/json.hpp>

#include "decks.hpp"
#include "pyroclast/base/error.hpp"
#include "pyroclast/base/physics_version.hpp"
#include "pyroclast/base/sha256.hpp"
#include "pyroclast/results/folder_lock.hpp"
#include "pyroclast/results/text_file.hpp"
#include "results/folder.hpp"
#include "results/system_calls.hpp"

namespace pyroclast {
namespace {

const Manifest kManifest{"deck.toml", {"title = 1", {}}, 1, 1, "portable", "pyroclast", {}, std::nullopt};

/// A run folder that is made where there is none, as long as it is locked.
RunFolder made(const fs::path& path, bool overwrite = false) {
  const FolderLock lock(path);
  return {path, overwrite, kManifest};
}

TEST_F(Results, ARunFolderHoldsTheDeckAndWhatTheRunWasMadeFrom) {
  const RunFolder run = made(folder_ / "run");
  EXPECT_EQ(content(folder_ / "run" / "deck.toml"), "title = 1");
  const auto manifest = nlohmann::json::parse(content(folder_ / "run" / "manifest.json"));
  EXPECT_EQ(manifest["deck_sha256"], sha256("title = 1"));
  EXPECT_EQ(manifest["physics_version"], kPhysicsVersion);
}

TEST_F(Results, ARunFolderIsRefusedWhenItExistsAndTakenOnlyIfItHoldsARun) {
  const RunFolder first = made(folder_ / "run");
  EXPECT_THROW(RunFolder::check(folder_ / "run", false), Error);
  EXPECT_NO_THROW(RunFolder::check(folder_ / "run", true));
  write_text_file(folder_ / "precious.txt", "mine");
  EXPECT_THROW(RunFolder::check(folder_, true), Error);
  EXPECT_THROW(FolderLock(folder_ / "precious.txt"), Error);
  EXPECT_THROW(FolderLock(folder_ / "precious.txt" / "run"), Error);
  EXPECT_THROW(RunFolder::require(folder_), Error);
  EXPECT_NO_THROW(RunFolder::require(folder_ / "run"));
}

TEST_F(Results, AnotherProgramsManifestIsNotARuns) {
  for (const char* text : {R"({"name": "My page", "start_url": "/"})", R"({"program": "webpack"})",
                           R"(["pyroclast"])", R"({"program": ["pyroclast"]})", "pyroclast", ""}) {
    write_text_file(folder_ / "manifest.json", text);
    EXPECT_THROW(RunFolder::check(folder_, true), Error) << text;
    EXPECT_THROW(RunFolder(folder_, true, kManifest), Error) << text;
    EXPECT_EQ(content(folder_ / "manifest.json"), text);
  }
}

TEST_F(Results, OverwritingRemovesWhatARunWritesAndNamesWhatItKeeps) {
  const fs::path run = folder_ / "run";
  const RunFolder first = made(run);
  for (const char* folder : {"fields", "figures", "specimen", "checkpoints", "inputs", "paper/figures"})
    fs::create_directories(run / folder);
  for (const char* own :
       {"history.csv", "fields/blocks_0012.hdf", "fields/contacts_0003.hdf.partial", "figures/cracks.svg",
        "figures/cracks.png.0123abcd.partial", "report.html.deadbeef.partial", "specimen/specimen.json",
        "run.log", "checkpoints/000012.state", "checkpoints/stage_1.state", "inputs/table.csv"})
    write_text_file(run / own, "old");
  const std::vector<fs::path> foreign{"fields/blocks_mine.hdf", "figures/cracks.png.0123abc.partial",
                                      "notes.txt", "paper/figures/cracks.svg"};
  for (const auto& file : foreign) write_text_file(run / file, "mine");
  // a link is not followed: what it leads to is another's
  fs::create_directories(folder_ / "elsewhere");
  write_text_file(folder_ / "elsewhere" / "history.csv", "mine");
  fs::create_directory_symlink(folder_ / "elsewhere", run / "more");

  const RunFolder second = made(run, true);
  std::vector<fs::path> kept = foreign;
  kept.emplace_back("more");
  std::ranges::sort(kept);
  EXPECT_EQ(second.foreign(), kept);
  for (const auto& file : foreign) EXPECT_EQ(content(run / file), "mine") << file;
  EXPECT_EQ(content(folder_ / "elsewhere" / "history.csv"), "mine");
  std::vector<std::string> left;
  for (const auto& entry : fs::directory_iterator(run)) left.push_back(entry.path().filename().string());
  std::ranges::sort(left);
  EXPECT_EQ(left, (std::vector<std::string>{"deck.toml", "fields", "figures", "manifest.json", "more",
                                            "notes.txt", "paper"}));
}

TEST_F(Results, WhatIsWrittenInPlaceHasOneName) {
  const fs::path run = folder_ / "run";
  const RunFolder first = made(run);
  write_text_file(folder_ / "mine.txt", "mine");
  for (const char* file : {"lock", "history.csv", "run.log", "fields/frames.csv"}) {
    fs::create_directories((run / file).parent_path());
    fs::create_hard_link(folder_ / "mine.txt", run / file);
    try {
      const FolderLock lock(run);
      FAIL() << file;
    } catch (const Error& e) {
      EXPECT_NE(std::string(e.what()).find("rsync --link-dest"), std::string::npos) << e.what();
    }
    EXPECT_EQ(content(folder_ / "mine.txt"), "mine") << file;
    fs::remove(run / file);
  }
  EXPECT_NO_THROW(FolderLock{run});
}

TEST_F(Results, WhatShowsHowFarARunHasComeGoesAndNothingElse) {
  const fs::path run = folder_ / "run";
  const RunFolder first = made(run);
  fs::create_directories(run / "figures" / "more");
  const std::vector<fs::path> kept{"deck.toml",        "manifest.json",          "history.csv",
                                   "figures/mine.png", "figures/morphology.png", "figures/more/cracks.png"};
  for (const auto& file : kept)
    if (!fs::exists(run / file)) write_text_file(run / file, "kept");
  for (const char* drawn : {"figures/cracks.png", "figures/cracks.pdf.0123abcd.partial",
                            "figures/fracture.csv", "report.html", "summary.json.partial"})
    write_text_file(run / drawn, "drawn");
  RunFolder::remove_drawn(run);
  std::vector<fs::path> left;
  for (const auto& entry : fs::recursive_directory_iterator(run))
    if (entry.is_regular_file()) left.push_back(entry.path().lexically_relative(run));
  EXPECT_TRUE(std::ranges::is_permutation(left, kept));
}

TEST_F(Results, AFolderIsHeldByOneAtATimeAndLeftAsItWas) {
  {
    const FolderLock lock(folder_ / "runs" / "a");
    EXPECT_NO_THROW(RunFolder::check(folder_ / "runs" / "a", false));
    try {
      const FolderLock second(folder_ / "runs" / "a");
      FAIL() << "two hold the folder";
    } catch (const Error& e) {
      EXPECT_NE(std::string(e.what()).find("another run of this process"), std::string::npos);
    }
    EXPECT_NO_THROW(FolderLock(folder_ / "runs" / "b"));
  }
  EXPECT_TRUE(fs::is_empty(folder_));
  EXPECT_NO_THROW(FolderLock(folder_ / "runs" / "a"));
}

TEST_F(Results, AFolderIsMadeThoughACheckBesideItTakesTheOneAboveAway) {
  SystemCalls calls;
  bool taken_away = false;
  calls.before_mkdir = [&](const std::string& path) {
    if (path.ends_with("/mine") && !taken_away) taken_away = fs::remove(folder_ / "runs");
  };
  const RunFolder mine = made(folder_ / "runs" / "mine");
  EXPECT_TRUE(taken_away);
  EXPECT_TRUE(fs::exists(folder_ / "runs" / "mine" / "manifest.json"));
}

TEST_F(Results, AFolderKeepsWhatGivesTheSameRunAgain) {
  fs::create_directories(folder_ / "tables");
  write_text_file(folder_ / "tables" / "E.csv", "T [degC],E [GPa]\n20,30\n1000,10\n");
  const std::string text =
      with(shipped_case("starter"), "E = \"29.4 GPa\"", "E = { csv = \"tables/E.csv\" }");
  const Deck deck = Deck::parse(text, "deck.toml");
  pyroclast::Setup setup = read_setup(deck, folder_);
  setup.specimen.seed = 77;
  const Inputs inputs = inputs_of(deck, setup);
  ASSERT_EQ(inputs.files.size(), 1U);
  EXPECT_EQ(inputs.files[0].name, "inputs/E.csv");
  Manifest manifest = kManifest;
  manifest.inputs = inputs;
  {
    const FolderLock lock(folder_ / "run");
    const RunFolder run(folder_ / "run", false, manifest);
  }
  fs::remove_all(folder_ / "tables");
  const Deck kept = Deck::open(folder_ / "run" / "deck.toml");
  const pyroclast::Setup again = read_setup(kept, folder_ / "run");
  EXPECT_EQ(again.specimen.seed, 77U);
  EXPECT_EQ(inputs_of(kept, again).hash(), inputs.hash());
}

}  // namespace
}  // namespace pyroclast
