#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <string_view>

namespace pyroclast {

/// Returns the least number of insertions, deletions, substitutions and swaps of neighbours that turn `a`
/// into `b`, where no place is edited twice (the restricted Damerau-Levenshtein distance), counted in bytes.
std::size_t edit_distance(std::string_view a, std::string_view b);

/// Returns the index of the word that `text` most likely misspells: the word at the least distance, ignoring
/// case, if the distance is at most a third of the longer word's length. Among equals the first counts.
std::optional<std::size_t> nearest(std::string_view text, std::span<const std::string> words);

/// Returns `did you mean "word"?` for the nearest word, with `before` in front; empty if no word is near.
std::string did_you_mean(std::string_view text, std::span<const std::string> words,
                         std::string_view before = {});

/// Returns the words in quotes, separated by commas.
std::string quoted_list(std::span<const std::string> words);

}  // namespace pyroclast
