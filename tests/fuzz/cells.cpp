#include <string>

#include "pyroclast/specimen/cells_file.hpp"
#include "pyroclast/specimen/from_cells.hpp"
#include "targets.hpp"

namespace pyroclast::fuzz {

bool cells(std::string_view text) {
  return takes([&] {
    const auto made = specimen::specimen_from(specimen::cells_from(std::string(text), "cells.json"));
    require(made.region.area() > 0.0, "a specimen has an area");
    require(
        specimen::cells_from(specimen::cells_text({made.tessellation, made.phases, made.phase}), "again.json")
                .tessellation.vertices == made.tessellation.vertices,
        "what is written is read again");
  });
}

}  // namespace pyroclast::fuzz
