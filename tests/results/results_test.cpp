#include <algorithm>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "experiment/heated_specimen.hpp"
#include "pyroclast/base/error.hpp"
#include "pyroclast/results/field_files.hpp"
#include "pyroclast/results/hdf5_file.hpp"
#include "pyroclast/results/heat_summary.hpp"
#include "pyroclast/results/history_file.hpp"
#include "pyroclast/results/run_folder.hpp"
#include "pyroclast/results/text_file.hpp"
#include "results/folder.hpp"

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

TEST_F(Results, AFullDeviceIsAnErrorThatNamesTheFile) {
  try {
    LineFile file("/dev/full");
    file.line("one line");
    FAIL() << "a full device took a line";
  } catch (const Error& e) {
    EXPECT_NE(std::string(e.what()).find("/dev/full"), std::string::npos);
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

TEST_F(Results, HistoryHasAValueForEveryColumn) {
  {
    HistoryFile history(folder_ / "history.csv");
    Sample sample;
    sample.strain = sample.stage_strain = sample.specimen_strain = 0.00125;
    sample.stress_top = 30e6;
    sample.stress_bottom = 28e6;
    history.write(sample);
  }
  std::stringstream text(content(folder_ / "history.csv"));
  std::string header, row;
  std::getline(text, header);
  std::getline(text, row);
  EXPECT_EQ(header, HistoryFile::header());
  EXPECT_EQ(std::count(header.begin(), header.end(), ','), std::count(row.begin(), row.end(), ','));
  EXPECT_NE(row.find("0.00125,0.00125,0.00125,29,30,28"),
            std::string::npos);  // strain thrice, then mean, top and bottom stress in MPa
}

TEST_F(Results, HistoryOfHeatHasAColumnForEachProbeAndALedgerThatCloses) {
  const auto body = small_body(100);
  const HeatCase heat = heat_case({on(OutlinePart::left, PrescribedTemperature{Curve::constant(100.0)}),
                                   on(OutlinePart::right, convection(25.0, Curve::constant(20.0)))});
  auto field = conduct(body, heat, 60.0);
  {
    HeatHistoryFile history(folder_ / "history.csv", body.model, {{"hot", {{0.0, 0.05}}}});
    history.write(field);
    field.advance(1e9, 60.0);
    history.write(field);
  }
  std::stringstream text(content(folder_ / "history.csv"));
  std::string header, first, last;
  std::getline(text, header);
  std::getline(text, first);
  std::getline(text, last);
  EXPECT_EQ(header.substr(header.rfind(',') + 1), "probe_hot_degC");
  EXPECT_EQ(std::count(header.begin(), header.end(), ','), std::count(last.begin(), last.end(), ','));
  EXPECT_EQ(last.substr(0, 3), "60,");
  EXPECT_DOUBLE_EQ(std::stod(last.substr(last.rfind(',') + 1)), 100.0);  // held there

  Case c;
  c.conduct = HeatRun{.duration = 60.0, .steady_rate = 1e-9};
  const HeatSummary summary = summarize(c, field, HeatOutcome::completed);
  EXPECT_GT(summary.heat.prescribed, 0.0);
  EXPECT_LT(summary.heat.boundary.convection, 0.0);
  EXPECT_LT(summary.ledger_error(), 1e-12);  // conserved to rounding
  ASSERT_EQ(summary.warnings.size(), 1U);
  EXPECT_NE(summary.warnings[0].find("no steady state"), std::string::npos);
}

TEST_F(Results, FieldOfHeatIsAFrameOfTheBlocksOnly) {
  const auto body = small_body(100);
  const HeatCase heat = heat_case({on(OutlinePart::left, PrescribedTemperature{Curve::constant(100.0)})});
  const auto field = conduct(body, heat, 60.0);
  HeatFieldFiles files(folder_ / "fields", body.model);
  files.write(field);
  std::vector<std::string> names;
  for (const auto& entry : fs::directory_iterator(folder_ / "fields"))
    names.push_back(entry.path().filename().string());
  std::sort(names.begin(), names.end());
  EXPECT_EQ(names,
            (std::vector<std::string>{"blocks.hdf.series", "blocks_0000.hdf", "frames.csv", "mesh.h5"}));
}

}  // namespace
}  // namespace pyroclast
