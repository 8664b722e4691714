#include <string>

#include "pyroclast/specimen/cells_file.hpp"
#include "pyroclast/specimen/from_cells.hpp"
#include "targets.hpp"

namespace pyroclast::fuzz {
namespace {

using namespace specimen;

/// Makes a specimen of the cells of a text.
template <int Dim>
Specimen<Dim> made_of(const GivenCells<Dim>& read) {
  Specimen<Dim> made = specimen_from(read);
  require(made.outline.extent() > 0.0, "a specimen has an extent");
  return made;
}

}  // namespace

bool cells(std::string_view text) {
  takes([&] {  // joined, whatever they are
    std::visit([](const auto& read) { made_of(read); },
               cells_from(std::string(text), "cells.json", {}, 1e-3));
  });
  return takes([&] {
    std::visit(
        []<int Dim>(const GivenCells<Dim>& read) {
          const Specimen<Dim> made = made_of(read);
          const auto again = std::get<GivenCells<Dim>>(cells_from(cells_text(made), "again.json"));
          require(again.cells.vertices == made.cells.vertices && again.cells.cells == made.cells.cells,
                  "what is written is read again");
        },
        cells_from(std::string(text), "cells.json"));
  });
}

}  // namespace pyroclast::fuzz
