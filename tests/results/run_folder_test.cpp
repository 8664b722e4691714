#include "pyroclast/results/run_folder.hpp"

#include <algorithm>

#include <nlohmann/json.hpp>

#include "pyroclast/base/error.hpp"
#include "pyroclast/base/physics_version.hpp"
#include "pyroclast/base/sha256.hpp"
#include "pyroclast/results/text_file.hpp"
#include "results/folder.hpp"
#include "results/system_calls.hpp"

namespace pyroclast {
namespace {

const Manifest kManifest{"deck.toml", "title = 1", 1, 1, "portable", "pyroclast", {}};

TEST_F(Results, ARunFolderHoldsTheDeckAndWhatTheRunWasMadeFrom) {
  const RunFolder run(folder_ / "run", false, kManifest);
  EXPECT_EQ(content(folder_ / "run" / "deck.toml"), "title = 1");
  const auto manifest = nlohmann::json::parse(content(folder_ / "run" / "manifest.json"));
  EXPECT_EQ(manifest["deck_sha256"], sha256("title = 1"));
  EXPECT_EQ(manifest["physics_version"], kPhysicsVersion);
}

TEST_F(Results, ARunFolderIsRefusedWhenItExistsAndTakenOnlyIfItHoldsARun) {
  const RunFolder first(folder_ / "run", false, kManifest);
  EXPECT_THROW(RunFolder::check(folder_ / "run", false), Error);
  EXPECT_NO_THROW(RunFolder::check(folder_ / "run", true));
  write_text_file(folder_ / "precious.txt", "mine");
  EXPECT_THROW(RunFolder::check(folder_, true), Error);
  EXPECT_THROW(RunFolder::check(folder_ / "precious.txt", true), Error);
  EXPECT_THROW(RunFolder::check(folder_ / "precious.txt" / "run", false), Error);
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
  const RunFolder first(run, false, kManifest);
  for (const char* folder : {"fields", "figures", "specimen", "paper/figures"})
    fs::create_directories(run / folder);
  for (const char* own : {"history.csv", "fields/blocks_0012.hdf", "fields/contacts_0003.hdf.partial",
                          "figures/cracks.svg", "specimen/specimen.json"})
    write_text_file(run / own, "old");
  const std::vector<fs::path> foreign{"fields/blocks_mine.hdf", "notes.txt", "paper/figures/cracks.svg"};
  for (const auto& file : foreign) write_text_file(run / file, "mine");
  // a link is not followed: what it leads to is another's
  fs::create_directories(folder_ / "elsewhere");
  write_text_file(folder_ / "elsewhere" / "history.csv", "mine");
  fs::create_directory_symlink(folder_ / "elsewhere", run / "more");

  const RunFolder second(run, true, kManifest);
  std::vector<fs::path> kept = foreign;
  kept.emplace_back("more");
  std::ranges::sort(kept);
  EXPECT_EQ(second.foreign(), kept);
  for (const auto& file : foreign) EXPECT_EQ(content(run / file), "mine") << file;
  EXPECT_EQ(content(folder_ / "elsewhere" / "history.csv"), "mine");
  std::vector<std::string> left;
  for (const auto& entry : fs::directory_iterator(run)) left.push_back(entry.path().filename().string());
  std::ranges::sort(left);
  EXPECT_EQ(left,
            (std::vector<std::string>{"deck.toml", "fields", "manifest.json", "more", "notes.txt", "paper"}));
}

TEST_F(Results, CheckingAFolderLeavesNothingBehind) {
  RunFolder::check(folder_ / "runs" / "a" / "b", false);
  EXPECT_TRUE(fs::is_empty(folder_));
}

TEST_F(Results, CheckingAFolderLeavesARunThatBeginsBesideItMeanwhile) {
  SystemCalls calls;
  calls.before_mkdir = [&](const std::string& path) {
    if (!path.ends_with("/mine")) return;
    const RunFolder other(folder_ / "runs" / "other", false, kManifest);
  };
  RunFolder::check(folder_ / "runs" / "mine", false);
  EXPECT_TRUE(fs::exists(folder_ / "runs" / "other" / "manifest.json"));
  EXPECT_FALSE(fs::exists(folder_ / "runs" / "mine"));
}

TEST_F(Results, ARunBeginsThoughACheckBesideItTakesTheirFolderAway) {
  SystemCalls calls;
  bool taken_away = false;
  calls.before_mkdir = [&](const std::string& path) {
    if (path.ends_with("/mine") && !taken_away) taken_away = fs::remove(folder_ / "runs");
  };
  const RunFolder mine(folder_ / "runs" / "mine", false, kManifest);
  EXPECT_TRUE(taken_away);
  EXPECT_TRUE(fs::exists(folder_ / "runs" / "mine" / "manifest.json"));
}

}  // namespace
}  // namespace pyroclast
