#include "pyroclast/deck/toml_characters.hpp"

#include <string>

#include <gtest/gtest.h>

namespace pyroclast {
namespace {

/// Expects a fault in the second line, at the third character.
void expect_fault_at_third(const std::string& line) {
  const auto fault = character_fault("# é\n" + line);
  ASSERT_TRUE(fault) << line;
  EXPECT_EQ(fault->at.line, 2) << line;
  EXPECT_EQ(fault->at.column, 3) << line;
}

// Promise: UTF-8 is what Unicode calls well-formed, to the first and last code point of each range.
TEST(TomlCharacters, AreUtf8) {
  for (const std::string good :
       {"", "\x7F", "\xC2\x80", "\xDF\xBF", "\xE0\xA0\x80", "\xEC\xBF\xBF", "\xED\x9F\xBF", "\xEE\x80\x80",
        "\xEF\xBF\xBF", "\xF0\x90\x80\x80", "\xF3\xBF\xBF\xBF", "\xF4\x8F\xBF\xBF"})
    EXPECT_FALSE(character_fault("a = '" + good + "'")) << good;
  for (const std::string bad :
       {"\x80", "\xC2", "\xC2z", "\xC1\xBF", "\xE0\x9F\xBF", "\xED\xA0\x80", "\xEF\xBF", "\xEF\xBFz",
        "\xF0\x8F\xBF\xBF", "\xF4\x90\x80\x80", "\xF1\x80\x80", "\xF5\x80\x80\x80", "\xFF"})
    expect_fault_at_third("'é" + bad);
}

TEST(TomlCharacters, BeginWithOneByteOrderMarkAtMost) {
  EXPECT_FALSE(character_fault("\xEF\xBB\xBF# a"));
  expect_fault_at_third("'é\xEF\xBB\xBF'");
  EXPECT_TRUE(character_fault("\xEF\xBB\xBF\xEF\xBB\xBF"));
}

// Promise: strings of all four kinds and comments may hold any character.
TEST(TomlCharacters, OutsideOfAsciiStandInStringsAndComments) {
  for (const std::string good :
       {"'é'", "\"é\"", "'''é\né'''", "\"\"\"é\né\"\"\"", "\"\\\"é\"", "\"\\\\\" # é", "'\\' # é",
        "\"\"\"a\"\"é\"\"\"", "\"\"\"a\"\"\"\"\" # é", "'''a''é'''", "\"\\té\"", "\"\"\"\\\n a é\"\"\"",
        "['é', [1, \"é\"], { a.'é' = 'é', 'é'='é' }]", "1\na.'é'.b . \"é\" = 1.5 # é",
        "1\n'é' = 1\n[a.'é']\n[['é']]\nb = { c = [1, 2], d.'é' = 1 }\ne.'é'=1"})
    EXPECT_FALSE(character_fault("# é\na = " + good)) << good;
  for (const std::string bad : {"=1é", "''é", "\"\"é", "a\té", "\"\\é\"", "a\"é"}) expect_fault_at_third(bad);
  EXPECT_TRUE(character_fault("a = \"\"\"\\\n \té\"\"\""));
  EXPECT_TRUE(character_fault("'a\né'"));
  for (const std::string bad : {"a = +'é'", "a = 1.'é'", "a = 'b''é'", "a = [1.'é']", "a = 1979-05-27 'é'",
                                "a = 1['é'", "a = 1='é'", "a = ='é'"})
    EXPECT_TRUE(character_fault(bad)) << bad;
}

TEST(TomlCharacters, KeysAreNoDeeperThanTheParserBears) {
  const auto key = [](int parts) {
    std::string text = "a";
    for (int i = 1; i < parts; ++i) text += ".a";
    return text;
  };
  EXPECT_FALSE(character_fault(key(256) + " = 1\n" + key(256) + ".b = 1\n"));
  std::string many = "x = [";
  for (int i = 0; i < 1000; ++i) many += "1.5, ";
  EXPECT_FALSE(character_fault(many + "]\ny = \"" + key(1000) + "\" # " + key(1000) + "\n"));
  for (const std::string& deep :
       {key(50000) + " = 1", "[" + key(50000) + "]", "[[" + key(300) + "]]", "x = { " + key(300) + " = 1 }",
        "[" + key(200) + "]\n" + key(100) + " = 1", key(200) + " = { " + key(100) + " = 1 }"}) {
    const auto fault = character_fault("# first\n" + deep + "\n");
    ASSERT_TRUE(fault) << deep.substr(0, 20);
    EXPECT_GE(fault->at.line, 2);
    EXPECT_NE(std::string(fault->what).find("256"), std::string::npos);
  }
}

}  // namespace
}  // namespace pyroclast
