#pragma once

#include <array>
#include <functional>
#include <vector>

#include "pyroclast/model/concrete_model.hpp"
#include "pyroclast/solid/specimen.hpp"

namespace pyroclast {

/// Sets of gridpoints of the rim of an upright cylinder: the quarters towards -x and x, -z and z.
inline constexpr std::array<const char*, 4> kQuartersOfRim{"rim_left", "rim_right", "rim_front", "rim_back"};

/// Adds the cells of a complex to a model as blocks, cell by cell, and joins the faces of neighbours.
/// \param material           material of each cell, index into Model::material_names
/// \param interface_between  function from two cells to an index into Model::interface_names
/// \param size               size that each cell was to have, m, which contacts follow; empty: all alike
/// \return for each cell, the vertices of the complex at which its gridpoints stand, in their order
std::vector<std::vector<int>> add_cells(ModelOf<3>& model, const solid::Complex& complex,
                                        const std::vector<int>& material,
                                        const std::function<int(int, int)>& interface_between,
                                        const std::vector<double>& size = {});

/// Makes a solid specimen and its bearings into a model, as make_concrete_model does in the plane, with the
/// same sets. A bearing is a prism over the polygons of the blocks on its side; its sets are in the order of
/// their gridpoints. An upright cylinder has four quarters of its rim as sets too, see kQuartersOfRim. Throws
/// Error, naming the bearing, when it has no plane side to lie on, or no thickness.
ModelOf<3> make_solid_model(const solid::SolidSpecimen& specimen,
                            const std::vector<InterfaceParameters>& interfaces = {},
                            const std::vector<Bearing>& bearings = {});

}  // namespace pyroclast
