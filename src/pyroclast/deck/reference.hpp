#pragma once

#include <string>

#include "pyroclast/deck/survey.hpp"

namespace pyroclast {

/// Writes the tables of a deck and their keys as Markdown. Each table has a heading, below which each key has
/// a row with its written form, unit, allowed values, default and meaning. Tables with the same keys share a
/// heading; a table whose keys depend on one word, such as the kind of a stage, has a part for each word.
/// Lines outside of tables have at most 120 characters.
std::string deck_reference(const DeckSchema& schema);

}  // namespace pyroclast
