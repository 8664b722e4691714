#pragma once

#include <fstream>
#include <sstream>
#include <string>

#include <gtest/gtest.h>

/// Texts of decks, for tests.
namespace pyroclast {

/// A deck of cases/, by its name without ending.
inline std::string shipped_case(const std::string& name) {
  std::ifstream file(PYROCLAST_CASES "/" + name + ".toml");
  std::stringstream text;
  text << file.rdbuf();
  return text.str();
}

/// The deck with its first `from` changed, which it must have.
inline std::string with(std::string deck, const std::string& from, const std::string& to) {
  const auto at = deck.find(from);
  if (at == std::string::npos) {
    ADD_FAILURE() << "not in the deck: " << from;
    return deck;
  }
  return deck.replace(at, from.size(), to);
}

}  // namespace pyroclast
