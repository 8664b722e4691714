#include "pyroclast/base/place_text.hpp"

#include <fmt/format.h>

namespace pyroclast {

std::string place_text(const Vec<3>& place, int dimension, const char* format) {
  std::string text = "(";
  for (int i = 0; i < dimension; ++i)
    text += (i > 0 ? ", " : "") + fmt::format(fmt::runtime(format), place[i]);
  return text + ")";
}

}  // namespace pyroclast
