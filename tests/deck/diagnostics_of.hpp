#pragma once

#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "pyroclast/deck/deck.hpp"

namespace pyroclast {

/// What `finish` reports, in the order of the file.
inline std::vector<Diagnostic> diagnostics_of(const Deck& deck) {
  try {
    deck.finish();
  } catch (const DeckError& error) {
    return error.diagnostics();
  }
  return {};
}

/// The one error of a deck; a failed test if there are none or several.
inline Diagnostic only_diagnostic_of(const Deck& deck) {
  const std::vector<Diagnostic> all = diagnostics_of(deck);
  EXPECT_EQ(all.size(), 1U);
  return all.empty() ? Diagnostic{} : all.front();
}

inline bool mentions(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

}  // namespace pyroclast
