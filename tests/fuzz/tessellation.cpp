#include <sstream>
#include <string>

#include "pyroclast/specimen/neper_tess.hpp"
#include "targets.hpp"

namespace pyroclast::fuzz {

bool tessellation(std::string_view text) {
  takes([&] {
    std::istringstream stream{std::string(text)};
    specimen::read_neper_tess(stream, "cells.tess", specimen::TessSize{.width = 0.2});  // of any outline
  });
  return takes([&] {
    std::istringstream stream{std::string(text)};
    const auto tessellation = specimen::read_neper_tess(stream, "cells.tess", 0.2, 0.1).cells;
    for (const auto& vertex : tessellation.vertices)
      require(-1e-9 < vertex[0] && vertex[0] < 0.2 + 1e-9 && -1e-9 < vertex[1] && vertex[1] < 0.1 + 1e-9,
              "vertices lie in the specimen");
  });
}

}  // namespace pyroclast::fuzz
