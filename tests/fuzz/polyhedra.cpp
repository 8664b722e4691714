#include "pyroclast/solid/polyhedra.hpp"

#include <string>
#include <utility>

#include "targets.hpp"

namespace pyroclast::fuzz {

bool polyhedra(std::string_view text) {
  return takes([&] {
    solid::Polyhedra read = solid::polyhedra_from(std::string(text), "blocks.json");
    const solid::Prism body = read.body;
    const solid::SolidSpecimen made = solid::specimen_from(std::move(read), body);
    require(made.body.volume() > 0.0, "a specimen has a volume");
    const solid::Polyhedra again = solid::polyhedra_from(solid::polyhedra_text(made), "again.json");
    require(again.complex.vertices == made.complex.vertices && again.complex.cells == made.complex.cells,
            "what is written is read again");
  });
}

}  // namespace pyroclast::fuzz
