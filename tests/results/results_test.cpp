#include <algorithm>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>
#include <sys/resource.h>

#include "messages.hpp"
#include "pyroclast/base/error.hpp"
#include "pyroclast/base/sha256.hpp"
#include "pyroclast/results/hdf5_file.hpp"
#include "pyroclast/results/history_file.hpp"
#include "pyroclast/results/results_writer.hpp"
#include "pyroclast/results/run_folder.hpp"
#include "pyroclast/results/summary.hpp"
#include "pyroclast/results/text_file.hpp"
#include "pyroclast/setup/hdf5_reader.hpp"
#include "results/folder.hpp"
#include "stages/small_runs.hpp"

namespace pyroclast {
namespace {

// Two of the example values of the standard, FIPS 180.
TEST_F(Results, Sha256IsTheStandardDigest) {
  EXPECT_EQ(sha256("abc"), "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
  EXPECT_EQ(sha256(""), "e3b0c44298fc1c149afbf4c8996fb92427ae41e4649b934ca495991b7852b855");
}

TEST_F(Results, ATextFileAppearsWholeOrNotAtAll) {
  write_text_file(folder_ / "a.txt", "whole");
  EXPECT_EQ(content(folder_ / "a.txt"), "whole");
  EXPECT_THROW(write_text_file(folder_ / "missing" / "a.txt", "whole"), Error);
  EXPECT_THROW(write_text_file("/dev/full/a.txt", "whole"), Error);
  EXPECT_EQ(std::distance(fs::directory_iterator(folder_), {}), 1);
}

/// While it is there, no file of this process grows beyond a length: like a full disk.
class FullDisk {
 public:
  explicit FullDisk(rlim_t bytes) {
    std::signal(SIGXFSZ, SIG_IGN);
    getrlimit(RLIMIT_FSIZE, &before_);
    rlimit limit = before_;
    limit.rlim_cur = bytes;
    setrlimit(RLIMIT_FSIZE, &limit);
  }
  ~FullDisk() {
    setrlimit(RLIMIT_FSIZE, &before_);
    std::signal(SIGXFSZ, SIG_DFL);
  }
  FullDisk(const FullDisk&) = delete;
  FullDisk& operator=(const FullDisk&) = delete;

 private:
  rlimit before_{};
};

TEST_F(Results, AFullDeviceIsAnErrorThatNamesTheFile) {
  LineFile file(folder_ / "a.csv", "one\n");
  const FullDisk full(6);
  try {
    file.line("another line");
    FAIL() << "a full device took a line";
  } catch (const Error& e) {
    EXPECT_NE(std::string(e.what()).find("a.csv"), std::string::npos);
  }
}

TEST_F(Results, AnHdf5FileAppearsOnlyOnceItIsClosed) {
  const fs::path path = folder_ / "a.h5";
  {
    Hdf5File file(path);
    file.group("/g");
    file.dataset("/g/x", std::vector<double>(3000, 1.5), 3);
    EXPECT_FALSE(fs::exists(path));
  }
  EXPECT_TRUE(fs::is_empty(folder_));  // given up without closing: nothing is left
  Hdf5File file(path);
  file.group("/g");
  file.close();
  EXPECT_TRUE(fs::exists(path));
}

TEST_F(Results, RowsOfADatasetMayComeInAnyOrder) {
  const fs::path path = folder_ / "a.h5";
  Hdf5File file(path);
  file.room<double>("/x", 4, 2);
  file.room<std::int64_t>("/none", 0);
  file.rows("/x", 2, std::vector{5.0, 6.0, 7.0, 8.0});
  file.rows("/x", 0, std::vector{1.0, 2.0, 3.0, 4.0});
  file.close();
  const Hdf5Reader reader(path);
  EXPECT_EQ(reader.numbers("/x"), (std::vector{1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0, 8.0}));
  EXPECT_TRUE(Hdf5File::is_whole(path));
}

TEST_F(Results, AFullDiskIsAnErrorOfAnHdf5FileAndLeavesNothing) {
  const fs::path path = folder_ / "a.h5";
  for (const rlim_t room : {0, 100, 20000}) {  // the last one is enough for all but the rows of the dataset
    const std::string said = message([&] {
      const FullDisk full(room);
      Hdf5File file(path);
      file.group("/g");
      if (room == 20000) file.dataset("/g/x", std::vector<double>(3000, 1.5));
      file.attribute("/g", "about", std::string("x"));
      file.close();
    });
    EXPECT_NE(said.find("a.h5: cannot be written (File too large)"), std::string::npos) << said;
    EXPECT_TRUE(fs::is_empty(folder_)) << room;
  }
  Hdf5File file(path);
  file.dataset("/x", std::vector{1.0});
  file.close();
  EXPECT_TRUE(Hdf5File::is_whole(path));
}

std::vector<std::string> lines_of(const std::string& text) {
  std::vector<std::string> lines;
  std::stringstream stream(text);
  for (std::string line; std::getline(stream, line);) lines.push_back(line);
  return lines;
}

TEST_F(Results, HistoryGivesEveryNumberInFull) {
  History history;
  history.add_column({"strain", "1"});
  HistoryFile file(folder_ / "history.csv", history);
  history.add_row();
  history.set("strain", 1.0 / 3.0);
  file.write(history);
  EXPECT_EQ(content(folder_ / "history.csv"), "strain\n0.3333333333333333\n");
}

TEST_F(Results, HistoryHasACellForEveryColumnEmptyWhereThereIsNothing) {
  History history;
  for (const auto* name : {"stage", "strain", "exchange"}) history.add_column({name, "1"});
  HistoryFile file(folder_ / "history.csv", history);
  history.add_row();
  history.set("stage", 0.0);
  history.set("strain", 0.00125);
  file.write(history);
  history.add_row();
  history.set("stage", 1.0);
  history.set("exchange", 3.0);
  file.write(history);
  EXPECT_EQ(lines_of(content(folder_ / "history.csv")),
            (std::vector<std::string>{"stage,strain,exchange", "0,0.00125,", "1,,3"}));
}

/// A wall between two temperatures, heated for a minute.
std::string wall_deck() {
  std::string text = with(shipped_case("thermal_wall"), "count = 2000", "count = 100");
  text = with(text, "duration = \"2 h\"", "duration = \"1 min\"\nsteady_rate = \"1e-9 K/s\"");
  return with(text, "frame_interval = \"15 min\"", "frame_interval = \"40 s\"");
}

/// Records a whole run of a deck.
Summary record(const std::string& text, const fs::path& folder) {
  Setup setup = read_setup(Deck::parse(text, "deck.toml"), ".");
  const auto simulation = make_simulation(setup);
  ResultsWriter writer(folder, setup);
  Run run(*simulation, std::move(setup.stages));
  writer.begin(run);
  while (run.next()) writer.write(run);
  return writer.finish(run);
}

TEST_F(Results, HeatAloneHasProbesALedgerThatClosesAndNoContacts) {
  const Summary summary = record(wall_deck(), folder_);
  const auto rows = lines_of(content(folder_ / "history.csv"));
  const std::string &header = rows.front(), &last = rows.back();
  EXPECT_EQ(header.substr(header.rfind(',') + 1), "probe_x_75mm_degC");
  EXPECT_EQ(header.substr(0, header.find(',', 6)), "stage,heating_time_s");
  EXPECT_EQ(last.substr(0, 5), "0,60,");
  EXPECT_EQ(std::count(header.begin(), header.end(), ','), std::count(last.begin(), last.end(), ','));
  EXPECT_EQ(lines_of(content(folder_ / "fields" / "frames.csv")).front(),
            "frame,stage,temperature_degC,heating_time_s");
  EXPECT_FALSE(summary.soundness.energy_error);
  EXPECT_LT(summary.soundness.heat_error.value(), 1e-12);  // conserved to rounding
  const auto& stage = summary.stages.at(0);
  ASSERT_EQ(stage.report.warnings.size(), 1U);
  EXPECT_NE(stage.report.warnings[0].find("no steady state"), std::string::npos);
  std::vector<std::string> names;
  for (const auto& entry : fs::directory_iterator(folder_ / "fields"))
    names.push_back(entry.path().filename().string());
  std::sort(names.begin(), names.end());
  EXPECT_EQ(names, (std::vector<std::string>{"blocks.hdf.series", "blocks_0000.hdf", "blocks_0001.hdf",
                                             "blocks_0002.hdf", "frames.csv", "mesh.h5"}));
}

TEST_F(Results, TheSummaryHasAReportOfEachStage) {
  record(deck(kUniform + kSettle + load("level = 0.01\nf_c = \"20 MPa\"") + heat("30 degC") + kCompress +
              kCompress),
         folder_);
  const auto json = nlohmann::json::parse(content(folder_ / "summary.json"));
  EXPECT_EQ(json["outcome"], "completed");
  std::vector<std::string> kinds;
  for (const auto& stage : json["stages"]) kinds.push_back(stage["kind"]);
  EXPECT_EQ(kinds, (std::vector<std::string>{"settle", "load", "heat", "compress", "compress"}));
  EXPECT_EQ(json["stages"][1]["results"]["load_level"], 0.01);
  EXPECT_EQ(json["stages"][2]["results"]["exchanges"], 2);
  EXPECT_GT(json["stages"][3]["results"]["E_GPa"], 10.0);
  EXPECT_TRUE(json["stages"][4]["results"]["E_GPa"].is_null());  // it began loaded
  EXPECT_GT(json["energy_J"]["loading"], 0.0);
}

// Promise: with small kinematics a jump of more than an edge is told where results rest on it: up to the peak
// of a compression, up to the end of heating. With finite kinematics it is not.
TEST_F(Results, JumpsOfMoreThanAnEdgeAreToldWhereResultsRestOnThem) {
  const auto told = [](const Finished& r) {
    const auto warnings = summarize(r.run).warnings;
    return std::ranges::any_of(warnings, [](const auto& w) { return w.find("jumps exceed an edge") == 0; });
  };
  const auto compress = [](const std::string& until) {
    return "[[stages]]\nkind = \"compress\"\nvelocity = \"4 mm/s\"\nramp_time = \"20 ms\"\n" + until;
  };
  const std::string far = compress("stop_strain = 0.012\nstop_fraction_of_peak = 0.05\n");
  const Finished crushed(deck(kUniform + kSettle + far));
  ASSERT_GT(crushed.last("largest_jump"), 1.0);
  EXPECT_FALSE(told(crushed));
  const std::string again = deck(kUniform + kSettle + far + compress("stop_strain = 0.001\n"));
  EXPECT_TRUE(told(Finished(again)));
  std::string turning = again;
  turning.replace(turning.find("[mechanics]"), 11, "[mechanics]\nkinematics = \"finite\"");
  const Finished finite(turning);
  ASSERT_GT(finite.last("largest_jump"), 1.0);
  EXPECT_FALSE(told(finite));
}

}  // namespace
}  // namespace pyroclast
