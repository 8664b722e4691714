#include <string>
#include <utility>

#include "pyroclast/specimen/cells_file.hpp"
#include "pyroclast/specimen/from_cells.hpp"
#include "pyroclast/specimen/polyhedra_file.hpp"
#include "targets.hpp"

namespace pyroclast::fuzz {

bool polyhedra(std::string_view text) {
  return takes([&] {
    specimen::GivenCells<3> read = specimen::polyhedra_from(std::string(text), "blocks.json");
    const specimen::Prism body = read.outline;
    const specimen::Specimen<3> made = specimen::specimen_from(std::move(read), body);
    require(made.outline.extent() > 0.0, "a specimen has a volume");
    const specimen::GivenCells<3> again = specimen::polyhedra_from(specimen::cells_text(made), "again.json");
    require(again.cells.vertices == made.cells.vertices && again.cells.cells == made.cells.cells,
            "what is written is read again");
  });
}

}  // namespace pyroclast::fuzz
