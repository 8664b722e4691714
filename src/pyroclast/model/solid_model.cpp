#include "pyroclast/model/solid_model.hpp"

#include <algorithm>
#include <utility>

namespace pyroclast {

void add_cells(ModelOf<3>& model, const solid::Complex& complex, const std::vector<int>& material,
               const std::function<int(int, int)>& interface_between) {
  const int first_block = model.block_count();
  std::vector<std::vector<int>> vertices;  // of each cell, in the order of its gridpoints
  for (std::size_t cell = 0; cell < complex.cells.size(); ++cell) {
    auto zoned = solid::zone_cell(complex, cell);
    model.add_block(zoned.gridpoints, zoned.zones, material[cell]);
    vertices.push_back(std::move(zoned.vertices));
  }
  const auto gridpoints = [&](int cell, const std::vector<int>& corners) {
    std::vector<int> its;
    for (const int corner : corners)
      its.push_back(model.block_gridpoints[first_block + cell] +
                    static_cast<int>(std::ranges::find(vertices[cell], corner) - vertices[cell].begin()));
    return its;
  };
  for (const auto& [corners, inner, outer, side] : complex.faces)
    if (outer >= 0)
      model.join_faces(gridpoints(inner, corners), gridpoints(outer, corners),
                       interface_between(material[inner], material[outer]));
}

}  // namespace pyroclast
