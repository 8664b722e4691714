#include "pyroclast/material/jump_path.hpp"

#include <cmath>

#include "targets.hpp"

namespace pyroclast::fuzz {

bool jump_path(std::string_view text) {
  return takes([&] {
    for (const auto& point : pyroclast::jump_path(MeasuredTable::parse(text, "path.csv", 1)))
      require(std::isfinite(point.opening) && std::isfinite(point.slip) && std::isfinite(point.temperature),
              "a path is finite");
  });
}

}  // namespace pyroclast::fuzz
