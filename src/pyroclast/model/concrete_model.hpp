#pragma once

#include <array>
#include <functional>
#include <string>
#include <vector>

#include "pyroclast/material/concrete.hpp"
#include "pyroclast/model/model.hpp"
#include "pyroclast/specimen/specimen.hpp"

namespace pyroclast {

/// Block beside the specimen by which it is loaded or held: a platen, a roller's bearing, a glued end. Its
/// face follows the outline and is zoned to meet the specimen's gridpoints.
struct Bearing {
  std::string name;
  std::string side;        ///< side or patch of the specimen that the bearing covers
  double thickness = 0.0;  ///< m
  std::string material;    ///< name in [materials]
  std::string interface;   ///< name of the interface, see BearingInterface
  /// True for a gridpoint in the very middle of the outer face, about which the bearing may turn.
  bool has_pivot = true;
};

/// Returns two bearings, `bottom_platen` and `top_platen`, over these sides of a rectangle.
std::vector<Bearing> platens(double thickness);

/// Makes a specimen and its bearings into a model. Throws Error, naming the bearing, when a bearing has no
/// side to lie on. Materials are the phases of the specimen, then those of the bearings; interfaces are those
/// between phases, then those of the bearings. Sets of gridpoints:
///
/// | set | gridpoints |
/// |---|---|
/// | `specimen` | of the whole specimen |
/// | name of a phase | of all blocks of the phase |
/// | name of a side or patch, `left` or `notch_1` | of the specimen: the two gridpoints of each edge |
/// | name of a bearing | of the whole bearing |
/// | `<bearing>_face` | of its face at the specimen, from left to right, or upwards on an upright side |
/// | `<bearing>_support` | of its outer face, in the same order |
/// | `<bearing>_pivot` | nearest to the middle of its outer face |
/// | `<notch>_left`, `<notch>_right` | of the two sides of a notch without width, seen from its mouth |
///
/// Sets of contacts: under the name of a notch without width, the contacts that the notch parts.
///
/// In space a bearing is a prism over the polygons of the blocks on its side, which must be plane; its sets
/// are in the order of their gridpoints. An upright cylinder has four quarters of its rim as sets too, see
/// kQuartersOfRim.
///
/// \param thickness   thickness of a specimen in the plane, m; in space not used
/// \param interfaces  interfaces of the deck, see InterfaceTable
template <int Dim>
ModelOf<Dim> make_model(const specimen::Specimen<Dim>& specimen, double thickness = 1.0,
                        const std::vector<InterfaceParameters>& interfaces = {},
                        const std::vector<Bearing>& bearings = {});

/// Sets of gridpoints of the rim of an upright cylinder: the quarters towards -x and x, -z and z.
inline constexpr std::array<const char*, 4> kQuartersOfRim{"rim_left", "rim_right", "rim_front", "rim_back"};

/// Adds cells in space to a model as blocks, cell by cell, and joins the faces of neighbours.
/// \param material           material of each cell, index into Model::material_names
/// \param interface_between  function from two cells to an index into Model::interface_names
void add_cells(ModelOf<3>& model, const specimen::Cells<3>& cells, const std::vector<int>& material,
               const std::function<int(int, int)>& interface_between);

}  // namespace pyroclast
