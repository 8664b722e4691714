#include "pyroclast/model/concrete_model.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace pyroclast {

namespace {

using specimen::Specimen;

/// Zones of a platen stand about this many times as high as they are wide: contact forces vary along the face
/// much faster than into the depth.
constexpr double kZoneHeightOverWidth = 2.0;

struct Platen {
  std::vector<int> inner, outer;  ///< gridpoints of its faces, left to right
};

/// A structured block over the columns `x` (ascending), from `inner_y` to `outer_y`.
Platen add_platen(Model<2>& model, const std::vector<double>& x, double inner_y, double outer_y) {
  const int columns = static_cast<int>(x.size());
  const double width = (x.back() - x.front()) / (columns - 1);
  const int rows = std::max(
      2, static_cast<int>(std::lround(std::abs(outer_y - inner_y) / (kZoneHeightOverWidth * width))));
  std::vector<Vec<2>> gridpoints;
  for (int r = 0; r <= rows; ++r)
    for (double column : x) gridpoints.push_back({{column, inner_y + (outer_y - inner_y) * r / rows}});
  std::vector<std::array<int, 3>> zones;
  const bool upward = outer_y > inner_y;
  for (int r = 0; r < rows; ++r)
    for (int i = 0; i + 1 < columns; ++i) {
      const int p = r * columns + i, q = p + 1, s = p + columns, t = s + 1;
      // diagonals alternate, so that the platen has no preferred direction
      std::array<std::array<int, 3>, 2> pair;
      if ((r + i) % 2 == 0)
        pair = {{{p, q, t}, {p, t, s}}};
      else
        pair = {{{p, q, s}, {q, t, s}}};
      for (auto zone : pair) {
        if (!upward) std::swap(zone[1], zone[2]);
        zones.push_back(zone);
      }
    }
  const int first = model.gridpoint_count();
  model.add_block(gridpoints, zones, platen_material(model));
  Platen platen;
  for (int i = 0; i < columns; ++i) {
    platen.inner.push_back(first + i);
    platen.outer.push_back(first + rows * columns + i);
  }
  return platen;
}

/// Vertices on a horizontal wall, left to right.
std::vector<int> wall_vertices(const Specimen& specimen, double y) {
  std::vector<int> wall;
  const auto& vertices = specimen.tessellation.vertices;
  for (int v = 0; v < static_cast<int>(vertices.size()); ++v)
    if (vertices[v][1] == y) wall.push_back(v);
  std::sort(wall.begin(), wall.end(), [&](int a, int b) { return vertices[a][0] < vertices[b][0]; });
  return wall;
}

std::size_t place_on_wall(const Specimen& specimen, const std::vector<int>& wall, int vertex) {
  const auto& vertices = specimen.tessellation.vertices;
  const auto found = std::lower_bound(wall.begin(), wall.end(), vertex,
                                      [&](int a, int b) { return vertices[a][0] < vertices[b][0]; });
  return static_cast<std::size_t>(found - wall.begin());
}

}  // namespace

Model<2> make_concrete_model(const Specimen& specimen, std::optional<double> platen_thickness,
                             double thickness, const std::vector<InterfaceParameters>& stated) {
  const InterfaceTable interfaces(specimen.phases, stated);
  Model<2> model;
  model.thickness = thickness;
  model.material_names = specimen.phases;
  model.material_names.emplace_back("platen");
  model.interface_names = interfaces.names();
  const auto& tessellation = specimen.tessellation;

  const auto bottom_wall = wall_vertices(specimen, 0.0);
  const auto top_wall = wall_vertices(specimen, specimen.height);
  const auto columns = [&](const std::vector<int>& wall) {
    std::vector<double> x;
    x.reserve(wall.size());
    for (int v : wall) x.push_back(tessellation.vertices[v][0]);
    return x;
  };

  Platen bottom, top;
  if (platen_thickness) bottom = add_platen(model, columns(bottom_wall), 0.0, -*platen_thickness);
  const int first_cell = model.block_count(), first_gridpoint = model.gridpoint_count();
  for (std::size_t cell = 0; cell < tessellation.cells.size(); ++cell) {
    std::vector<Vec<2>> corners;
    for (int v : tessellation.cells[cell]) corners.push_back(tessellation.vertices[v]);
    const auto zoned = specimen::zone_block(corners);
    model.add_block(zoned.gridpoints, zoned.zones, specimen.phase[cell]);
  }
  const int first_platen_above = model.gridpoint_count();
  if (platen_thickness)
    top = add_platen(model, columns(top_wall), specimen.height, specimen.height + *platen_thickness);

  const auto gridpoint = [&](int cell, int vertex) {
    const auto& corners = tessellation.cells[cell];
    const auto at = std::find(corners.begin(), corners.end(), vertex) - corners.begin();
    return model.block_gridpoints[first_cell + cell] + static_cast<int>(at);
  };
  const auto add_to = [&](const char* name, const std::vector<int>& gridpoints) {
    auto& set = model.sets[name];
    set.insert(set.end(), gridpoints.begin(), gridpoints.end());
  };
  const auto join_platen = [&](const std::vector<int>& face, const specimen::Edge& e,
                               const std::vector<int>& wall, const Platen& platen) {
    if (!platen_thickness) return;
    const auto opposite = [&](int vertex) { return platen.inner[place_on_wall(specimen, wall, vertex)]; };
    model.join_faces(face, {opposite(e.v0), opposite(e.v1)}, interfaces.platen());
  };

  for (const auto& e : specimen::edges(tessellation)) {
    const std::vector<int> a{gridpoint(e.left, e.v0), gridpoint(e.left, e.v1)};
    if (e.right >= 0) {
      model.join_faces(a, {gridpoint(e.right, e.v0), gridpoint(e.right, e.v1)},
                       interfaces.between(specimen.phase[e.left], specimen.phase[e.right]));
      continue;
    }
    const Vec<2>& x0 = tessellation.vertices[e.v0];
    const Vec<2>& x1 = tessellation.vertices[e.v1];
    if (x0[1] == 0.0 && x1[1] == 0.0) {
      join_platen(a, e, bottom_wall, bottom);
      add_to("bottom", a);
    } else if (x0[1] == specimen.height && x1[1] == specimen.height) {
      join_platen(a, e, top_wall, top);
      add_to("top", a);
    } else {
      add_to(x0[0] == 0.0 ? "left" : "right", a);
    }
  }

  auto& specimen_set = model.sets["specimen"];
  specimen_set.resize(first_platen_above - first_gridpoint);
  std::iota(specimen_set.begin(), specimen_set.end(), first_gridpoint);
  auto& bottom_platen = model.sets["bottom_platen"];
  bottom_platen.resize(first_gridpoint);
  std::iota(bottom_platen.begin(), bottom_platen.end(), 0);
  auto& top_platen = model.sets["top_platen"];
  top_platen.resize(model.gridpoint_count() - first_platen_above);
  std::iota(top_platen.begin(), top_platen.end(), first_platen_above);
  model.sets["bottom_support"] = bottom.outer;
  model.sets["bottom_face"] = bottom.inner;
  model.sets["top_support"] = top.outer;
  model.sets["top_face"] = top.inner;
  return model;
}

}  // namespace pyroclast
