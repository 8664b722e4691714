#pragma once

#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>

#include <gtest/gtest.h>

#include "own_folder.hpp"

namespace pyroclast {

namespace fs = std::filesystem;

/// A test with a folder of its own.
class Results : public testing::Test {
 protected:
  void SetUp() override {
    folder_ = own_folder() / testing::UnitTest::GetInstance()->current_test_info()->name();
    fs::remove_all(folder_);
    fs::create_directories(folder_);
  }
  void TearDown() override { fs::remove_all(folder_); }

  static std::string content(const fs::path& file) {
    std::ifstream stream(file);
    std::stringstream text;
    text << stream.rdbuf();
    return text.str();
  }

  fs::path folder_;
};

}  // namespace pyroclast
