#pragma once

#include <string>

#include "pyroclast/deck/survey.hpp"

namespace pyroclast {

/// The tables of a deck and their keys as Markdown: a heading for each table, in which each key has a row
/// with what is written, its unit, what is allowed, its default and its meaning. Tables whose keys are the
/// same share a heading; a table whose keys follow from one word, such as the kind of a stage, has a part for
/// each word. Lines outside of tables have at most 120 characters.
std::string deck_reference(const DeckSchema& schema);

}  // namespace pyroclast
