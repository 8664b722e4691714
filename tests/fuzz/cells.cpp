#include <string>

#include "pyroclast/specimen/cells_file.hpp"
#include "pyroclast/specimen/from_cells.hpp"
#include "pyroclast/specimen/pieces.hpp"
#include "targets.hpp"

namespace pyroclast::fuzz {

bool cells(std::string_view text) {
  takes([&] {  // joined, whatever they are
    const auto file = specimen::cells_from(std::string(text), "cells.json");
    const auto made = specimen::specimen_from(specimen::joined(file.cells, 1e-3));
    require(made.outline.extent() > 0.0, "a specimen that is joined has an area");
  });
  return takes([&] {
    const auto made = specimen::specimen_from(specimen::cells_from(std::string(text), "cells.json").cells);
    require(made.outline.extent() > 0.0, "a specimen has an area");
    require(specimen::cells_from(specimen::cells_text(made), "again.json").cells.cells.vertices ==
                made.cells.vertices,
            "what is written is read again");
  });
}

}  // namespace pyroclast::fuzz
