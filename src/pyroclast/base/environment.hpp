#pragma once

#include <cstdlib>
#include <string>

namespace pyroclast {

/// Returns a variable of the environment; empty where the variable is not set.
inline std::string environment(const char* name) {
  const char* const value = std::getenv(name);
  return value ? value : "";
}

}  // namespace pyroclast
