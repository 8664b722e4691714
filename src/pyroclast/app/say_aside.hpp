#pragma once

#include <cstdio>
#include <string>

#include "pyroclast/base/shown.hpp"

namespace pyroclast::app {

/// Writes to stderr, with characters that act on a terminal written out. Where stderr is full or gone, nobody
/// can be told, and the program goes on.
inline void say_aside(const std::string& text) {
  std::fputs(shown(text, true).c_str(), stderr);
}

/// Writes to stdout a text with words of others, such as paths, in the same form.
inline void say(const std::string& text) {
  std::fputs(shown(text, true).c_str(), stdout);
}

}  // namespace pyroclast::app
