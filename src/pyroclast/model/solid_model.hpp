#pragma once

#include <functional>
#include <vector>

#include "pyroclast/model/model.hpp"
#include "pyroclast/solid/complex.hpp"

namespace pyroclast {

/// Adds the cells of a complex to a model as blocks, cell by cell, and joins the faces of neighbours.
/// \param material           material of each cell, index into Model::material_names
/// \param interface_between  function from two materials to an index into Model::interface_names
void add_cells(ModelOf<3>& model, const solid::Complex& complex, const std::vector<int>& material,
               const std::function<int(int, int)>& interface_between);

}  // namespace pyroclast
