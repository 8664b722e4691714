#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <string_view>

namespace pyroclast {

/// The least number of insertions, deletions, substitutions and swaps of neighbours that turn `a` into `b`,
/// no place being edited twice (the restricted Damerau-Levenshtein distance), counted in bytes.
std::size_t edit_distance(std::string_view a, std::string_view b);

/// Index of the word that `text` is most likely a misspelling of: the least distance, upper and lower case
/// being equal, if it is at most a third of the longer word's length. The first of equals.
std::optional<std::size_t> nearest(std::string_view text, std::span<const std::string> words);

/// `did you mean "word"?` of the nearest word, behind `before`; empty if none is near.
std::string did_you_mean(std::string_view text, std::span<const std::string> words,
                         std::string_view before = {});

/// The words in quotes, separated by commas.
std::string quoted_list(std::span<const std::string> words);

}  // namespace pyroclast
