#include "pyroclast/base/shown.hpp"

#include <gtest/gtest.h>

#include "pyroclast/base/read_file.hpp"

namespace pyroclast {
namespace {

// Promise: a path that an escape in double quotes has spoilt is told with the way out.
TEST(Shown, APathWithControlCharactersHasARemedy) {
  EXPECT_EQ(remedy_of_path("sub/furnace.csv"), "");
  EXPECT_NE(remedy_of_path("sub\furnace.csv").find("write \"/\" in paths"), std::string::npos);
}

TEST(Shown, WhatActsOnATerminalIsWrittenOut) {
  EXPECT_EQ(shown("wall 20 °C, σ"), "wall 20 °C, σ");
  EXPECT_EQ(shown("\x1b[31mred\x1b[0m"), "\\x1b[31mred\\x1b[0m");
  EXPECT_EQ(shown("a\nb\tc\rd"), "a\\nb\\tc\\rd");
  EXPECT_EQ(shown("a\nb\tc\rd", true), "a\nb\tc\\rd");
  EXPECT_EQ(shown("\xc2\x9b"
                  "2J"),
            "\\x9b2J");  // a control character of Unicode
  EXPECT_EQ(shown("\xe2\x80\xae"
                  "gpj"),
            "\\u202egpj");                                  // turns the direction of writing
  EXPECT_EQ(shown("a\xff\xc0\x80z"), "a\\xff\\xc0\\x80z");  // no UTF-8
  EXPECT_EQ(shown("\xed\xa0\x80"), "\\xed\\xa0\\x80");      // half a surrogate pair
  EXPECT_EQ(shown("\xe2\x82"), "\\xe2\\x82");
}

TEST(Shown, LongTextsAreCutBetweenCharacters) {
  EXPECT_EQ(shown_in_short("σσσ", 3), "σσσ");
  EXPECT_EQ(shown_in_short("σσσσ", 3), "σσσ... (4 characters)");
  EXPECT_EQ(shown_in_short("", 3), "");
}

}  // namespace
}  // namespace pyroclast
