#pragma once

#include <array>
#include <cstdio>
#include <cstdlib>
#include <ostream>
#include <string_view>

#include <fmt/format.h>

#include "pyroclast/base/error.hpp"

/// What reads text of a user's, one function for each kind of text. Each returns whether the text was taken;
/// one that refuses it does so with an Error, which the function expects. Whatever else comes of a text is a
/// fault: another exception, a value that is not finite, a crash, undefined behaviour, a leak, a hang.
namespace pyroclast::fuzz {

/// A deck, with everything that a run asks of it.
bool deck(std::string_view text);
/// Changes of a deck as --set has them, one on each line.
bool changes(std::string_view text);
/// A formula in T.
bool formula(std::string_view text);
/// A CSV file with a curve over the temperature.
bool table(std::string_view text);
/// A Neper tessellation of a domain of 2 x 1.
bool tessellation(std::string_view text);
/// A file with blocks that are made elsewhere, in the plane or in space.
bool cells(std::string_view text);
/// A number with its unit.
bool quantity(std::string_view text);
/// A CSV file with a path of jumps.
bool jump_path(std::string_view text);
/// Edits of the state of one of three small runs, or the table of a checkpoint.
bool checkpoint(std::string_view text);
/// The manifest of a run's folder, and what may stand in the place of a frame.
bool run_folder(std::string_view text);
/// A table of temperatures over the time.
bool record(std::string_view text);

struct Target {
  std::string_view name;
  bool (*reads)(std::string_view text);
};
inline void PrintTo(const Target& target, std::ostream* stream) {
  *stream << target.name;
}
inline constexpr std::array<Target, 11> kTargets{{{"deck", deck},
                                                  {"changes", changes},
                                                  {"formula", formula},
                                                  {"table", table},
                                                  {"tessellation", tessellation},
                                                  {"cells", cells},
                                                  {"quantity", quantity},
                                                  {"jump_path", jump_path},
                                                  {"checkpoint", checkpoint},
                                                  {"run_folder", run_folder},
                                                  {"record", record}}};

/// Ends the process where a promise about what was read does not hold.
inline void require(bool holds, std::string_view promise) {
  if (holds) return;
  fmt::print(stderr, "does not hold: {}\n", promise);
  std::abort();
}

/// Whether a reader takes what it is given.
template <class Read>
bool takes(const Read& read) {
  try {
    read();
    return true;
  } catch (const Error& error) {
    require(error.what()[0] != '\0', "an Error says what is wrong");
    return false;
  }
}

}  // namespace pyroclast::fuzz
