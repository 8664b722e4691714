#include "pyroclast/material/jump_path.hpp"

#include <cmath>
#include <sstream>
#include <string>

#include "targets.hpp"

namespace pyroclast::fuzz {

bool jump_path(std::string_view text) {
  return takes([&] {
    std::istringstream stream{std::string(text)};
    for (const auto& point : read_jump_path(stream, "path.csv"))
      require(std::isfinite(point.opening) && std::isfinite(point.slip) && std::isfinite(point.temperature),
              "a path is finite");
  });
}

}  // namespace pyroclast::fuzz
