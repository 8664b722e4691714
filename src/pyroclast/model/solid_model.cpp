#include "pyroclast/model/solid_model.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <string>
#include <utility>

#include <fmt/format.h>

#include "pyroclast/base/error.hpp"
#include "pyroclast/base/place_in.hpp"
#include "pyroclast/base/sort_unique.hpp"
#include "pyroclast/model/model_parts.hpp"

namespace pyroclast {

namespace {

/// Bearing as a block of the model.
struct SolidBearing {
  std::vector<int> faces;     ///< faces of the complex on which it lies
  std::map<int, int> column;  ///< column of gridpoints over each vertex of these faces
  int first = 0;              ///< first gridpoint of the block: that of the first column at the specimen
  int columns = 0, rows = 0;
  int interface = 0;

  int inner(int vertex) const { return first + column.at(vertex); }
};

/// Adds three tetrahedra of the prism over a triangle between two rows. Its side faces are cut by the
/// diagonals from the lower column at the inner row to the higher one at the outer row, so that neighbours
/// cut them alike.
void add_prism(const std::array<int, 3>& columns, int inner, int outer, const std::vector<Vec<3>>& gridpoints,
               std::vector<std::array<int, 4>>& zones) {
  auto [a, b, c] = columns;
  if (a > b) std::swap(a, b);
  if (b > c) std::swap(b, c);
  if (a > b) std::swap(a, b);
  for (std::array<int, 4> zone : {std::array{inner + a, inner + b, inner + c, outer + c},
                                  std::array{inner + a, inner + b, outer + b, outer + c},
                                  std::array{inner + a, outer + a, outer + b, outer + c}}) {
    const Vec<3>& x = gridpoints[zone[0]];
    if (dot(cross(gridpoints[zone[1]] - x, gridpoints[zone[2]] - x), gridpoints[zone[3]] - x) < 0.0)
      std::swap(zone[1], zone[2]);
    zones.push_back(zone);
  }
}

/// Least area vector of a side on which a bearing lies, over its area: a seat on a rim is bent by little.
constexpr double kMostBent = 0.9;

/// Adds a bearing over a side of the specimen.
SolidBearing add_bearing(ModelOf<3>& model, const solid::SolidSpecimen& specimen, const Bearing& bearing,
                         int side, int material) {
  const auto& complex = specimen.complex;
  SolidBearing block;
  Vec<3> outward{};
  std::vector<Vec<3>> inner;
  double area = 0.0;
  for (int f = 0; f < static_cast<int>(complex.faces.size()); ++f) {
    const solid::CellFace& face = complex.faces[f];
    if (face.side != side) continue;
    block.faces.push_back(f);
    const Vec<3> vector = solid::area_vector(complex, face);
    outward += vector;
    area += norm(vector);
    for (const int v : face.corners)
      if (block.column.try_emplace(v, static_cast<int>(inner.size())).second)
        inner.push_back(complex.vertices[v]);
  }
  if (block.faces.empty() || !(bearing.thickness > 0.0))
    throw Error(fmt::format("bearing \"{}\": {}", bearing.name,
                            block.faces.empty() ? "no block lies on its side" : "it has no thickness"));
  if (norm(outward) < kMostBent * area)
    throw Error(
        fmt::format("bearing \"{}\": its side \"{}\" goes around the body, and no bearing can lie on it in a "
                    "solid yet",
                    bearing.name, bearing.side));
  outward *= 1.0 / norm(outward);
  block.columns = static_cast<int>(inner.size());
  const auto heights = bearing_rows(bearing.thickness, std::sqrt(area / static_cast<double>(block.columns)));
  block.rows = static_cast<int>(heights.size()) - 1;
  // a flat outer face, whatever the seat
  double highest = 0.0;
  for (const Vec<3>& p : inner) highest = std::max(highest, dot(p - inner.front(), outward));
  std::vector<Vec<3>> gridpoints;
  for (const double height : heights)
    for (const Vec<3>& p : inner) {
      const double way = highest - dot(p - inner.front(), outward) + bearing.thickness;
      gridpoints.push_back(p + outward * (height * way));
    }
  std::vector<std::array<int, 4>> zones;
  for (int row = 0; row < block.rows; ++row)
    for (const int f : block.faces) {
      const auto& corners = complex.faces[f].corners;
      const auto column = [&](std::size_t i) { return block.column.at(corners[i]); };
      for (std::size_t i = 1; i + 1 < corners.size(); ++i)
        add_prism({column(0), column(i), column(i + 1)}, row * block.columns, (row + 1) * block.columns,
                  gridpoints, zones);
    }
  block.first = model.gridpoint_count();
  model.add_block(gridpoints, zones, material);
  const int outer = block.first + block.rows * block.columns;
  model.sets[bearing.name] = all_from(block.first, model.gridpoint_count());
  model.sets[bearing.name + "_face"] = all_from(block.first, block.first + block.columns);
  model.sets[bearing.name + "_support"] = all_from(outer, outer + block.columns);
  Vec<3> middle{};
  for (int g = outer; g < outer + block.columns; ++g) middle += model.position[g] * (1.0 / block.columns);
  model.sets[bearing.name + "_pivot"] = {*std::ranges::min_element(
      model.sets[bearing.name + "_support"], {}, [&](int g) { return norm(model.position[g] - middle); })};
  return block;
}

/// Sine of the angle by which a side at 45 degrees may seem to face another way by rounding.
constexpr double kDiagonal = 1e-9;

/// Returns the name of the quarter of a cylinder's rim to which a face with this normal belongs. All faces of
/// a side of the polygon belong to one.
const char* quarter_of(const Vec<3>& normal) {
  if (std::abs(normal[0]) >= std::abs(normal[2]) - kDiagonal * norm(normal))
    return kQuartersOfRim[normal[0] < 0.0 ? 0 : 1];
  return kQuartersOfRim[normal[2] < 0.0 ? 2 : 3];
}

}  // namespace

std::vector<std::vector<int>> add_cells(ModelOf<3>& model, const solid::Complex& complex,
                                        const std::vector<int>& material,
                                        const std::function<int(int, int)>& interface_between,
                                        const std::vector<double>& size) {
  const int first_block = model.block_count();
  std::vector<std::vector<int>> vertices;
  for (std::size_t cell = 0; cell < complex.cells.size(); ++cell) {
    auto zoned = solid::zone_cell(complex, cell);
    model.add_block(zoned.gridpoints, zoned.zones, material[cell]);
    vertices.push_back(std::move(zoned.vertices));
  }
  const auto gridpoints = [&](int cell, const std::vector<int>& corners) {
    std::vector<int> its;
    for (const int corner : corners)
      its.push_back(model.block_gridpoints[first_block + cell] + place_in(vertices[cell], corner));
    return its;
  };
  for (const auto& [corners, inner, outer, side] : complex.faces)
    if (outer >= 0)
      model.join_faces(gridpoints(inner, corners), gridpoints(outer, corners),
                       interface_between(inner, outer),
                       size.empty() ? 0.0 : 0.5 * (size[inner] + size[outer]));
  return vertices;
}

ModelOf<3> make_solid_model(const solid::SolidSpecimen& specimen,
                            const std::vector<InterfaceParameters>& interfaces,
                            const std::vector<Bearing>& bearings) {
  const auto& complex = specimen.complex;
  const auto& sides = specimen.body.sides();
  const InterfaceTable table(specimen.phases, interfaces);
  ModelOf<3> model;
  model.material_names = specimen.phases;
  model.interface_names = table.names();
  add_bearing_names(model, bearings);
  std::vector<SolidBearing> blocks(bearings.size());
  const auto add_bearings = [&](bool below) {
    for (std::size_t i = 0; i < bearings.size(); ++i) {
      const Bearing& bearing = bearings[i];
      const auto side = std::ranges::find(sides, bearing.side);
      if (side == sides.end())
        throw Error(
            fmt::format("bearing \"{}\": \"{}\" is no side of the solid", bearing.name, bearing.side));
      if ((bearing.side == "bottom") != below) continue;
      blocks[i] = add_bearing(model, specimen, bearing, static_cast<int>(side - sides.begin()),
                              place_in(model.material_names, bearing.material));
      blocks[i].interface = place_in(model.interface_names, bearing.interface);
    }
  };

  add_bearings(true);
  const int first_block = model.block_count();
  const auto vertices = add_cells(
      model, complex, specimen.phase,
      [&](int cell, int other) { return interface_of(table, specimen, cell, other); }, specimen.size);
  name_blocks(model, first_block);
  name_contacts(model, "specimen", 0);
  add_bearings(false);

  // a block may touch a side in an edge or a corner alone
  std::vector<std::vector<int>> gridpoints_at(complex.vertices.size());
  for (std::size_t cell = 0; cell < vertices.size(); ++cell)
    for (std::size_t i = 0; i < vertices[cell].size(); ++i)
      gridpoints_at[vertices[cell][i]].push_back(
          model.block_gridpoints[first_block + static_cast<int>(cell)] + static_cast<int>(i));
  for (const std::string& side : sides) model.sets[side];
  const bool has_quarters = specimen.body.axis() == solid::Prism::Axis::y;
  std::vector<std::string> of_sides;
  for (std::size_t f = 0; f < complex.faces.size(); ++f) {
    const auto& [corners, inner, outer, side] = complex.faces[f];
    if (side < 0) continue;
    std::vector<int> its;
    for (const int v : corners)
      its.push_back(model.block_gridpoints[first_block + inner] + place_in(vertices[inner], v));
    std::vector<std::string> names{"outline", sides[side]};
    if (const int whole = specimen.body.whole_of(side); whole >= 0) names.push_back(sides[whole]);
    if (has_quarters && sides[side] == "rim")
      names.emplace_back(quarter_of(solid::area_vector(complex, complex.faces[f])));
    for (const std::string& name : names) {
      auto& set = model.sets[name];
      for (const int v : corners) set.insert(set.end(), gridpoints_at[v].begin(), gridpoints_at[v].end());
      if (std::ranges::find(of_sides, name) == of_sides.end()) of_sides.push_back(name);
    }
    for (std::size_t i = 0; i < bearings.size(); ++i) {
      if (!std::ranges::binary_search(blocks[i].faces, static_cast<int>(f))) continue;
      std::vector<int> opposite;
      for (const int v : corners) opposite.push_back(blocks[i].inner(v));
      const int first_contact = model.contact_count();
      model.join_faces(its, opposite, blocks[i].interface,
                       specimen.size.empty() ? 0.0 : specimen.size[inner]);
      name_contacts(model, bearings[i].name, first_contact);
    }
  }
  // a corner may belong to several faces
  for (const std::string& name : of_sides) sort_unique(model.sets[name]);
  return model;
}

}  // namespace pyroclast
