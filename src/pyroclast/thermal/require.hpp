#pragma once

#include <string_view>

#include <fmt/format.h>

#include "pyroclast/base/error.hpp"

namespace pyroclast {

/// Throws Error where a number is not allowed.
/// \param of      owner of the number, such as "heat conduction"
/// \param wanted  allowed values in words
inline void require(bool allowed, std::string_view of, std::string_view quantity, double value,
                    std::string_view wanted) {
  if (!allowed) throw Error(fmt::format("{}: {} is {}, but it must be {}", of, quantity, value, wanted));
}

}  // namespace pyroclast
