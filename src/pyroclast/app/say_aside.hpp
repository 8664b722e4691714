#pragma once

#include <cstdio>
#include <string>

#include "pyroclast/base/shown.hpp"

namespace pyroclast::app {

/// Writes to stderr; what acts on a terminal is written out. Where stderr is full or gone, nobody can be
/// told, and nothing ends for it.
inline void say_aside(const std::string& text) {
  std::fputs(shown(text, true).c_str(), stderr);
}

}  // namespace pyroclast::app
