#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "targets.hpp"

namespace pyroclast::fuzz {
namespace {

namespace fs = std::filesystem;

std::vector<fs::path> files_of(const fs::path& folder) {
  std::vector<fs::path> files;
  for (const auto& entry : fs::directory_iterator(folder)) files.push_back(entry.path());
  std::sort(files.begin(), files.end());
  return files;
}

class Seeds : public testing::TestWithParam<Target> {};

// Promise: every text that is known to be good is taken; every other is refused with an Error, among them all
// that once did worse.
TEST_P(Seeds, AreTakenOrRefused) {
  for (const bool good : {true, false}) {
    const fs::path folder = fs::path(SEEDS) / GetParam().name / (good ? "taken" : "refused");
    const auto files = files_of(folder);
    EXPECT_FALSE(files.empty()) << folder;
    for (const fs::path& file : files) {
      std::ifstream stream(file, std::ios::binary);
      const std::string text{std::istreambuf_iterator<char>(stream), {}};
      EXPECT_EQ(GetParam().reads(text), good) << file;
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Fuzz, Seeds, testing::ValuesIn(kTargets),
                         [](const auto& instance) { return std::string(instance.param.name); });

}  // namespace
}  // namespace pyroclast::fuzz
