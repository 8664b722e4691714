#pragma once

#include <string>

#include "pyroclast/base/vec.hpp"

namespace pyroclast {

/// Returns a place for messages, with as many numbers as the body has dimensions: "(0.1, 0.25)".
/// \param format  format of a number, as of fmt: "{:.4g}"
std::string place_text(const Vec<3>& place, int dimension, const char* format);

}  // namespace pyroclast
