#include "pyroclast/deck/source_text.hpp"

#include <gtest/gtest.h>

namespace pyroclast {
namespace {

TEST(SourceText, GivesLinesWithoutTheirEnds) {
  const SourceText source("first\r\nsecond\n\nlast");
  EXPECT_EQ(source.line(1), "first");
  EXPECT_EQ(source.line(2), "second");
  EXPECT_EQ(source.line(3), "");
  EXPECT_EQ(source.line(4), "last");
  EXPECT_EQ(source.line(0), "");
  EXPECT_EQ(source.line(5), "");
}

TEST(SourceText, CountsColumnsInCharactersNotBytes) {
  const SourceText source("\"größe\" = \"5 µm\" # ok");
  EXPECT_EQ(source.excerpt({1, 11}, {1, 17}), "\"5 µm\"");
}

TEST(SourceText, ShortensWhatSpansSeveralLines) {
  const SourceText source("sieves = [1,\n  2]");
  EXPECT_EQ(source.excerpt({1, 10}, {2, 5}), "[1, ...");
}

}  // namespace
}  // namespace pyroclast
