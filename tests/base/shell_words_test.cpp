#include "pyroclast/base/shell_words.hpp"

#include <array>
#include <cstdio>
#include <memory>

#include <gtest/gtest.h>

namespace pyroclast {
namespace {

/// Returns what a shell makes of a text as the one word of a command.
std::string word_in_shell(const std::string& text) {
  const std::string command = "bash -c " + shell_word("printf %s " + text);
  const std::unique_ptr<FILE, int (*)(FILE*)> pipe(popen(command.c_str(), "r"), &pclose);
  std::string word;
  std::array<char, 256> part{};
  while (const std::size_t count = fread(part.data(), 1, part.size(), pipe.get()))
    word.append(part.data(), count);
  return word;
}

// Promise: a word that is pasted into a shell is the word that was meant, whatever it holds.
TEST(ShellWords, AShellReadsTheWordThatWasMeant) {
  for (const std::string word :
       {"deck.toml", "My concrete.toml", "it's.toml", "\"a\" $HOME `id` \\.toml", "Prüfung 1.toml",
        "a;b&c|d>e.toml", "~/x", "#x", "*?[1].toml", "a\nb\t'c'\\.toml", "", "key=\"1 MPa\""})
    EXPECT_EQ(word_in_shell(shell_word(word)), word);
}

// Promise: an ordinary word stays as it is, and nothing breaks the line.
TEST(ShellWords, APlainWordNeedsNoQuotes) {
  EXPECT_EQ(shell_word("runs/compression-1/deck.toml"), "runs/compression-1/deck.toml");
  EXPECT_EQ(shell_word("My concrete.toml"), "'My concrete.toml'");
  EXPECT_EQ(shell_word("a\nb").find('\n'), std::string::npos);
}

// Promise: a file whose name begins with a dash is no option.
TEST(ShellWords, APathThatBeginsWithADashIsNoOption) {
  EXPECT_EQ(shell_path("-x.toml"), "./-x.toml");
  EXPECT_EQ(shell_path("-my deck.toml"), "'./-my deck.toml'");
  EXPECT_EQ(shell_path("/runs/-x"), "/runs/-x");
}

TEST(ShellWords, ACommandIsItsWords) {
  EXPECT_EQ(shell_command({"pyroclast", "run", "a b.toml", "--seed", "1"}),
            "pyroclast run 'a b.toml' --seed 1");
}

}  // namespace
}  // namespace pyroclast
