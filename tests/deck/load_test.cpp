#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>

#include <gtest/gtest.h>

#include "decks.hpp"
#include "diagnostics_of.hpp"

namespace pyroclast {
namespace {

namespace fs = std::filesystem;

/// A directory of this test that goes with it.
class DeckFile : public testing::Test {
 protected:
  DeckFile() {
    std::string name = (fs::temp_directory_path() / "pyroclast_deck_XXXXXX").string();
    directory_ = mkdtemp(name.data());
  }
  ~DeckFile() override { fs::remove_all(directory_); }

  fs::path write(const std::string& text) const {
    const fs::path file = directory_ / "case.toml";
    std::ofstream(file, std::ios::binary) << text;
    return file;
  }

  fs::path directory_;
};

/// The one error with which loading or parsing fails.
template <class Read>
Diagnostic failure_of(Read read) {
  try {
    read();
  } catch (const DeckError& error) {
    EXPECT_EQ(error.diagnostics().size(), 1U);
    return error.diagnostics().front();
  }
  ADD_FAILURE() << "no DeckError";
  return {};
}

Diagnostic syntax_error_of(const std::string& text) {
  return failure_of([&] { Deck::parse(text, "case.toml"); });
}

TEST_F(DeckFile, IsKeptAsReadForTheManifest) {
  const std::string text = "# a comment\r\ntitle = \"x\"  \n";
  const fs::path file = write(text);
  const Deck deck = Deck::open(file);
  EXPECT_EQ(deck.text(), text);
  EXPECT_EQ(deck.name(), file.string());
  EXPECT_EQ(deck.root().text("title", ""), "x");
  EXPECT_NO_THROW(deck.finish());
}

TEST_F(DeckFile, ThatDoesNotExistIsNamed) {
  const fs::path file = directory_ / "absent.toml";
  const Diagnostic diagnostic = failure_of([&] { Deck::open(file); });
  EXPECT_EQ(diagnostic.file, file.string());
  EXPECT_TRUE(mentions(diagnostic.message, "no such file"));
  EXPECT_EQ(to_string(diagnostic), file.string() + ": no such file");
}

TEST_F(DeckFile, ThatIsADirectoryIsRefused) {
  const Diagnostic diagnostic = failure_of([&] { Deck::open(directory_); });
  EXPECT_EQ(diagnostic.file, directory_.string());
  EXPECT_TRUE(mentions(diagnostic.message, "directory"));
}

TEST_F(DeckFile, ThatIsEmptyIsRefused) {
  const Diagnostic diagnostic = failure_of([&] { Deck::open(write("")); });
  EXPECT_TRUE(mentions(diagnostic.message, "empty"));
}

TEST(DeckText, OfCommentsOnlyIsEmpty) {
  EXPECT_TRUE(mentions(syntax_error_of("# nothing\n\n").message, "empty"));
}

TEST(DeckText, WithASyntaxErrorIsLocated) {
  const Diagnostic diagnostic = syntax_error_of("a = 1\nb = [1, 2\n");
  EXPECT_EQ(diagnostic.file, "case.toml");
  EXPECT_GE(diagnostic.line, 2);
  EXPECT_TRUE(mentions(diagnostic.message, "not valid TOML"));
  EXPECT_EQ(diagnostic.hint, "");
}

TEST(DeckText, WithAKeyTwiceIsASyntaxErrorAtTheSecond) {
  const Diagnostic diagnostic = syntax_error_of("width = \"1 m\"\n\nwidth = \"2 m\"\n");
  EXPECT_EQ(diagnostic.line, 3);
  EXPECT_TRUE(mentions(diagnostic.message, "width"));
}

TEST(DeckText, WithAPathOfWindowsIsExplained) {
  const Diagnostic diagnostic = syntax_error_of("file = \"C:\\data\"\n");
  EXPECT_TRUE(mentions(diagnostic.hint, "write \"/\" in paths")) << diagnostic.message;
}

TEST(DeckText, WithAQuantityOutsideQuotesIsExplained) {
  for (const std::string line : {"width = 150 mm", "angle = 34deg", "rate = -5 K/min # ramp", "part = 31 %",
                                 "temperature = 20°C", "sieves = [4.75 mm, 8 mm]"}) {
    const Diagnostic diagnostic = syntax_error_of("first = 1\n" + line + "\n");
    EXPECT_EQ(diagnostic.line, 2) << line;
    EXPECT_TRUE(mentions(diagnostic.hint, "quotes")) << line << ": " << diagnostic.message;
  }
}

TEST(DeckText, ThatIsNotUtf8IsLocated) {
  const Diagnostic diagnostic = syntax_error_of("a = 1\nb = \"\xff\"\n");
  EXPECT_EQ(diagnostic.line, 2);
  EXPECT_EQ(diagnostic.column, 6);
  EXPECT_TRUE(mentions(diagnostic.message, "UTF-8"));
}

TEST(DeckText, WithAByteOrderMarkInItsMiddleIsLocated) {
  const Diagnostic diagnostic = syntax_error_of("a = 1\nb = \"é\xef\xbb\xbf\"\n");
  EXPECT_EQ(diagnostic.line, 2);
  EXPECT_EQ(diagnostic.column, 7);
  EXPECT_TRUE(mentions(diagnostic.message, "byte-order mark"));
}

TEST(DeckText, MayBeginWithAByteOrderMark) {
  const Deck deck = Deck::parse("\xef\xbb\xbfseed = 1\n", "case.toml");
  EXPECT_EQ(deck.root().integer("seed", Range::any(), ""), 1);
  EXPECT_NO_THROW(deck.finish());
}

// Promise: a change on the command line is the deck's own text from then on: values, strings without quotes,
// inline tables and entries of arrays of tables.
TEST_F(DeckFile, ChangesReplaceValuesInTheText) {
  const auto file = write(
      "[a]\nlength = \"3 mm\"  # note\nE = { value = \"1 GPa\" }\n[[stages]]\nto = 1\n[[stages]]\nto = 2\n");
  const Deck deck = Deck::open(file, {"a.length=5 mm", "stages[1].to = 7", "a.E=\"2 GPa\""});
  EXPECT_EQ(deck.text(),
            "[a]\nlength = \"5 mm\"  # note\nE = \"2 GPa\"\n[[stages]]\nto = 1\n[[stages]]\nto = 7\n");
  EXPECT_DOUBLE_EQ(deck.root().section("a").quantity("length", unit::length, Range::positive(), ""), 5e-3);
}

// Promise: a key that the deck does not have is added in its table, and a table that it does not have, too.
TEST_F(DeckFile, ChangesAddKeysThatAreMissing) {
  const std::string text =
      "title = \"a\"\n[a]  # of a\nlength = \"3 mm\"\n[[stages]]\nto = 1\n[[stages]]\nto = 2\n";
  const auto changed = [&](const std::vector<std::string>& changes) {
    return Deck::open(write(text), changes).text();
  };
  EXPECT_EQ(changed({"a.width=5 mm"}), with(text, "# of a\n", "# of a\nwidth = \"5 mm\"\n"));
  EXPECT_EQ(changed({"stages[1].rate=2"}), with(text, "to = 2", "rate = 2\nto = 2"));
  EXPECT_EQ(changed({"stages[0].b.c=2", "stages[0].b.d=3"}),
            with(text, "to = 1", "b.d = 3\nb.c = 2\nto = 1"));
  EXPECT_EQ(changed({"seed=2"}), "seed = 2\n" + text);
  const Deck deck = Deck::open(write(text), {"new.table.key=true", "new.table.other=1"});
  EXPECT_TRUE(deck.root().section("new").section("table").flag("key", ""));
  EXPECT_EQ(deck.root().section("new").section("table").integer("other", Range::any(), ""), 1);
}

// Promise: a change that cannot be made says why.
// Promise: a place is that in the file which the user wrote, also where a change before it adds lines.
TEST(DeckText, OfTwoFilesNamesTheOneThatIsWrong) {
  const auto wrong = [](const std::string& own, const std::string& more,
                        const std::vector<std::string>& changes) {
    return failure_of([&] {
      const Deck deck = Deck::parse(own, "deck.toml", changes, {more, "more.toml"});
      deck.root().text("title", "of the run");
      for (const Section& stage : deck.root().sections("stages")) stage.text("kind", "kind of the stage");
      deck.root().section_or_none("output").text("folder", "", "where");
      deck.finish();
    });
  };
  const std::string own = "title = \"x\"\n[[stages]]\nkind = \"settle\"\n", more = "# more\n[[stages]]\n";
  for (const std::vector<std::string>& changes :
       {std::vector<std::string>(), std::vector<std::string>{"output.folder=\"f\""}}) {
    const Diagnostic later = wrong(own, more + "kind = 3\n", changes);
    EXPECT_EQ(later.file, "more.toml");
    EXPECT_EQ(later.line, 3);
    EXPECT_EQ(later.key, "stages[1].kind");
  }
  const Diagnostic earlier = wrong("title = \"x\"\n[[stages]]\nkind = 3\n", more + "kind = \"heat\"", {});
  EXPECT_EQ(earlier.file, "deck.toml");
  EXPECT_EQ(earlier.line, 3);
  const Diagnostic syntax = wrong(own, more + "kind = \n", {});
  EXPECT_EQ(syntax.file, "more.toml");
  EXPECT_EQ(syntax.line, 3);
}

TEST_F(DeckFile, ChangesThatHaveNoPlaceAreRefused) {
  const auto file = write("[a]\nlength = \"3 mm\"\n[[stages]]\nto = 1\n");
  for (const char* change : {"a=1", "stages[1].to=1", "a.length.unit=1", "length", "a..b=1", "=1"}) {
    try {
      Deck::open(file, {change});
      ADD_FAILURE() << change;
    } catch (const Error& e) {
      EXPECT_NE(std::string(e.what()).find(change), std::string::npos) << e.what();
    }
  }
}

}  // namespace
}  // namespace pyroclast
