#pragma once

#include <cstdio>
#include <string>

namespace pyroclast::app {

/// Writes to stderr. Where that is full or gone, nobody can be told, and nothing ends for it.
inline void say_aside(const std::string& text) {
  std::fputs(text.c_str(), stderr);
}

}  // namespace pyroclast::app
