#include "pyroclast/model/concrete_model.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <map>
#include <numeric>
#include <unordered_set>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "pyroclast/base/error.hpp"
#include "pyroclast/base/place_in.hpp"
#include "pyroclast/base/sort_unique.hpp"
#include "pyroclast/model/solid_zones.hpp"
#include "pyroclast/specimen/polyhedron.hpp"

namespace pyroclast {

namespace {

using specimen::Cells;
using specimen::Facet;
using specimen::Region;
using specimen::Side;
using specimen::Specimen;

/// Keeps, of each gridpoint in a set, the first entry alone.
void keep_first(std::vector<int>& set) {
  std::unordered_set<int> seen;
  std::erase_if(set, [&](int gridpoint) { return !seen.insert(gridpoint).second; });
}

/// Height of a bearing's zones at its seat over their width, about.
constexpr double kZoneHeightOverWidth = 2.0;

/// Returns the numbers from `first` up to `last`, excluded.
std::vector<int> all_from(int first, int last) {
  std::vector<int> result(last - first);
  std::iota(result.begin(), result.end(), first);
  return result;
}

/// Names the blocks from a number on: adds their gridpoints to the set `specimen`, and to those of their
/// materials.
void name_blocks(Model& model, int first_block) {
  const int first = model.block_gridpoints[first_block];
  model.sets["specimen"] = all_from(first, model.gridpoint_count());
  for (int block = first_block; block < model.block_count(); ++block) {
    auto& set = model.sets[model.material_names[model.block_material[block]]];
    for (int g = model.block_gridpoints[block]; g < model.block_gridpoints[block + 1]; ++g) set.push_back(g);
  }
}

/// Names the contacts from a number on: adds them to the set of contacts of a body, and to those of their
/// interfaces.
void name_contacts(Model& model, const std::string& body, int first_contact) {
  for (int contact = first_contact; contact < model.contact_count(); ++contact) {
    const std::string& interface = model.interface_names[model.joint(contact).interface];
    model.contact_sets[body].push_back(contact);
    if (interface != body) model.contact_sets[interface].push_back(contact);
  }
}

/// Returns the heights between the rows of a bearing's zones over its thickness, from 0 to 1. Contact forces
/// vary along the face much faster than into the depth, and even out away from the seat: zones at the seat
/// are about twice as high as wide, and each row is twice as high as the one before.
/// \param thickness  of the bearing, m
/// \param width      mean width of the zones at the seat, m
std::vector<double> bearing_rows(double thickness, double width) {
  const double rows_of_even_height = thickness / (kZoneHeightOverWidth * width);
  const int rows = std::max(2, static_cast<int>(std::ceil(std::log2(rows_of_even_height + 1.0))));
  std::vector<double> heights;
  for (int row = 0; row <= rows; ++row) heights.push_back((std::exp2(row) - 1.0) / (std::exp2(rows) - 1.0));
  return heights;
}

/// Adds the materials and interfaces of bearings, each once, behind those of the specimen.
void add_bearing_names(Model& model, const std::vector<Bearing>& bearings) {
  const auto add_name = [](std::vector<std::string>& names, const std::string& name, int& count) {
    if (std::ranges::find(names, name) != names.end()) return;
    names.push_back(name);
    ++count;
  };
  for (const Bearing& bearing : bearings) {
    add_name(model.material_names, bearing.material, model.bearing_materials);
    add_name(model.interface_names, bearing.interface, model.bearing_interfaces);
  }
}

/// Returns the interface that joins two cells of a specimen.
template <int Dim>
int interface_of(const InterfaceTable& table, const Specimen<Dim>& specimen, int cell, int other) {
  const int phase = specimen.phase[cell];
  const auto stone = [&](int c) { return specimen.stone.empty() ? -1 : specimen.stone[c]; };
  const bool are_stones = stone(cell) >= 0 && stone(other) >= 0;
  const bool of_two_stones = phase == specimen.phase[other] && are_stones && stone(cell) != stone(other);
  return of_two_stones ? table.between_stones(phase) : table.between(phase, specimen.phase[other]);
}

/// Tells whether a facet on a side lies on a side of this name, or on a patch of it.
bool lies_on(const std::vector<Side>& sides, int side, const std::string& name) {
  return side >= 0 &&
         (sides[side].name == name || (sides[side].part_of >= 0 && sides[sides[side].part_of].name == name));
}

/// Bearing as a block of the model: columns of gridpoints over the vertices of its seat.
template <int Dim>
struct BearingBlock {
  std::map<int, int> column;         ///< column over each vertex of the seat
  std::vector<Vec<Dim>> gridpoints;  ///< row by row from the seat outwards, m
  std::vector<std::array<int, Dim + 1>> zones;
  Vec<Dim> outward{};  ///< unit vector away from the body
  int columns = 0, rows = 0;
  int pivot = 0;  ///< column of the gridpoint in the middle of the outer face
  int first = 0;  ///< first gridpoint of the block in the model
  int interface = 0;

  int inner(int vertex) const { return first + column.at(vertex); }
};

/// Part of the outline in the plane that a bearing covers.
struct Seat {
  std::vector<int> vertices;  ///< vertices from left to right, or upwards
  bool is_reversed = false;   ///< true against the sense of the outline, which has the body on its left
  Vec<2> outward{};           ///< unit vector away from the body
};

/// Finds the part of the outline that a bearing covers. Throws Error where it is not one piece with two ends.
Seat find_seat(const Specimen<2>& specimen, const std::vector<Facet<2>>& facets, const std::string& name,
               const std::string& side) {
  std::vector<int> next(specimen.cells.vertices.size(), -1);
  std::vector<int> before(next.size(), -1);
  for (const Facet<2>& edge : facets)
    if (lies_on(specimen.outline.sides(), edge.side, side)) {
      next[edge.corners[0]] = edge.corners[1];
      before[edge.corners[1]] = edge.corners[0];
    }
  Seat seat;
  for (std::size_t v = 0; v < next.size(); ++v)
    if (next[v] >= 0 && before[v] < 0) {
      if (!seat.vertices.empty())
        throw Error(fmt::format("bearing \"{}\": \"{}\" is in several pieces", name, side));
      for (int at = static_cast<int>(v); at >= 0; at = next[at]) seat.vertices.push_back(at);
    }
  if (seat.vertices.empty())
    throw Error(fmt::format("bearing \"{}\": \"{}\" is no side with two ends", name, side));
  const auto& at = specimen.cells.vertices;
  const Vec<2> along = at[seat.vertices.back()] - at[seat.vertices.front()];
  const double length = norm(along);
  seat.outward = {{along[1] / length, -along[0] / length}};
  seat.is_reversed = along[0] < 0.0 || (along[0] == 0.0 && along[1] < 0.0);
  if (seat.is_reversed) std::ranges::reverse(seat.vertices);
  return seat;
}

/// Returns a structured block over a seat in the plane. Throws Error where the bearing has none.
BearingBlock<2> block_over(const Specimen<2>& specimen, const std::vector<Facet<2>>& facets,
                           const Bearing& bearing) {
  const Seat seat = find_seat(specimen, facets, bearing.name, bearing.side);
  std::vector<Vec<2>> inner, outer;
  for (int v : seat.vertices) {
    inner.push_back(specimen.cells.vertices[v]);
    outer.push_back(inner.back() + bearing.thickness * seat.outward);
  }
  const Vec<2> along = outer.back() - outer.front();
  const Vec<2> end = outer.front();
  const auto off_line = [&](const Vec<2>& p) { return dot(p - end, seat.outward); };
  double highest = 0.0;
  for (const Vec<2>& p : outer) highest = std::max(highest, off_line(p));
  for (Vec<2>& p : outer) p += (highest - off_line(p)) * seat.outward;  // a flat face, whatever the seat
  const int columns = static_cast<int>(inner.size());
  const Vec<2> middle = 0.5 * (outer.front() + outer.back());
  const auto nearest = std::ranges::min_element(outer, {}, [&](const Vec<2>& p) { return norm(p - middle); });
  const auto pivot = static_cast<int>(nearest - outer.begin());
  if (bearing.has_pivot) {
    if (pivot == 0 || pivot + 1 == columns)
      throw Error(
          fmt::format("bearing \"{}\": it is as narrow as a block; it needs two or more", bearing.name));
    *nearest = middle;
  }
  const std::vector<double> heights = bearing_rows(bearing.thickness, norm(along) / (columns - 1));
  const int rows = static_cast<int>(heights.size()) - 1;
  std::vector<Vec<2>> gridpoints;
  for (const double height : heights)
    for (int i = 0; i < columns; ++i) gridpoints.push_back(inner[i] + height * (outer[i] - inner[i]));
  std::vector<std::array<int, 3>> zones;
  for (int r = 0; r < rows; ++r)
    for (int i = 0; i + 1 < columns; ++i) {
      const int p = r * columns + i, q = p + 1, s = p + columns, t = s + 1;
      // diagonals alternate, so that the block has no preferred direction
      std::array<std::array<int, 3>, 2> pair;
      if ((r + i) % 2 == 0)
        pair = {{{p, q, t}, {p, t, s}}};
      else
        pair = {{{p, q, s}, {q, t, s}}};
      for (auto zone : pair) {
        if (!seat.is_reversed) std::swap(zone[1], zone[2]);
        zones.push_back(zone);
      }
    }
  BearingBlock<2> block;
  for (int i = 0; i < columns; ++i) block.column.emplace(seat.vertices[i], i);
  block.gridpoints = std::move(gridpoints);
  block.zones = std::move(zones);
  block.outward = seat.outward;
  block.columns = columns;
  block.rows = rows;
  block.pivot = pivot;
  return block;
}

/// Least area vector of a side on which a bearing lies, over its area: a seat on a rim is bent by little.
constexpr double kMostBent = 0.9;

/// Returns a block over a side of a solid. Throws Error where the bearing has no plane side to lie on.
BearingBlock<3> block_over(const Specimen<3>& specimen, const std::vector<Facet<3>>& /*facets*/,
                           const Bearing& bearing) {
  const Cells<3>& cells = specimen.cells;
  const int side = specimen::find_side(specimen.outline.sides(), bearing.side);
  if (side < 0)
    throw Error(fmt::format("bearing \"{}\": \"{}\" is no side of the solid", bearing.name, bearing.side));
  BearingBlock<3> block;
  std::vector<int> faces;
  Vec<3> outward{};
  std::vector<Vec<3>> inner;
  double area = 0.0;
  for (int f = 0; f < static_cast<int>(cells.faces.size()); ++f) {
    const Facet<3>& face = cells.faces[f];
    if (face.side != side) continue;
    faces.push_back(f);
    const Vec<3> vector = specimen::area_vector(cells, face);
    outward += vector;
    area += norm(vector);
    for (const int v : face.corners)
      if (block.column.try_emplace(v, static_cast<int>(inner.size())).second)
        inner.push_back(cells.vertices[v]);
  }
  if (faces.empty() || !(bearing.thickness > 0.0))
    throw Error(fmt::format("bearing \"{}\": {}", bearing.name,
                            faces.empty() ? "no block lies on its side" : "it has no thickness"));
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
  for (const double height : heights)
    for (const Vec<3>& p : inner) {
      const double way = highest - dot(p - inner.front(), outward) + bearing.thickness;
      block.gridpoints.push_back(p + outward * (height * way));
    }
  for (int row = 0; row < block.rows; ++row)
    for (const int f : faces) {
      const auto& corners = cells.faces[f].corners;
      const auto column = [&](std::size_t i) { return block.column.at(corners[i]); };
      for (std::size_t i = 1; i + 1 < corners.size(); ++i)
        add_prism({column(0), column(i), column(i + 1)}, row * block.columns, (row + 1) * block.columns,
                  block.gridpoints, block.zones);
    }
  block.outward = outward;
  const auto outer = block.gridpoints.end() - block.columns;
  Vec<3> middle{};
  for (auto p = outer; p != block.gridpoints.end(); ++p) middle += *p * (1.0 / block.columns);
  block.pivot = static_cast<int>(std::ranges::min_element(outer, block.gridpoints.end(), {},
                                                          [&](const Vec<3>& p) { return norm(p - middle); }) -
                                 outer);
  return block;
}

/// Tells whether a bearing stands before the specimen in the model, as it lies below.
bool is_below(const BearingBlock<2>& block, const Bearing& /*bearing*/) {
  return block.outward[1] < -0.5;
}
bool is_below(const BearingBlock<3>& /*block*/, const Bearing& bearing) {
  return bearing.side == "bottom";
}

/// Adds the block of a bearing, and its sets.
template <int Dim>
void add_bearing(ModelOf<Dim>& model, BearingBlock<Dim>& block, const Bearing& bearing) {
  block.first = model.gridpoint_count();
  model.add_block(block.gridpoints, block.zones, place_in(model.material_names, bearing.material));
  block.interface = place_in(model.interface_names, bearing.interface);
  const int outer = block.first + block.rows * block.columns;
  model.sets[bearing.name] = all_from(block.first, model.gridpoint_count());
  model.sets[bearing.name + "_face"] = all_from(block.first, block.first + block.columns);
  model.sets[bearing.name + "_support"] = all_from(outer, outer + block.columns);
  model.sets[bearing.name + "_pivot"] = {outer + block.pivot};
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

/// Adds the cells of a specimen as blocks. Returns for each cell the vertices at which its gridpoints stand.
template <int Dim>
std::vector<std::vector<int>> add_blocks(ModelOf<Dim>& model, const Cells<Dim>& cells,
                                         const std::vector<int>& material) {
  std::vector<std::vector<int>> vertices;
  for (std::size_t cell = 0; cell < cells.cells.size(); ++cell) {
    auto zoned = specimen::zone_cell(cells, cell);
    model.add_block(zoned.gridpoints, zoned.zones, material[cell]);
    vertices.push_back(std::move(zoned.vertices));
  }
  return vertices;
}

/// Makes a model of a specimen and its bearings.
template <int Dim>
class ModelMaker {
 public:
  ModelMaker(const Specimen<Dim>& specimen, double thickness,
             const std::vector<InterfaceParameters>& interfaces, const std::vector<Bearing>& bearings)
      : specimen_(specimen),
        bearings_(bearings),
        sides_(specimen.outline.sides()),
        table_(specimen.phases, interfaces),
        facets_(specimen::facets(specimen.cells)) {
    model_.material_names = specimen.phases;
    model_.interface_names = table_.names();
    add_bearing_names(model_, bearings);
    if constexpr (Dim == 2) {
      model_.thickness = thickness;
      for (Facet<2>& e : facets_)
        if (e.outer < 0) e.side = specimen.outline.side_of(at(e.corners[0]), at(e.corners[1])).value();
    }
  }

  ModelOf<Dim> make() {
    for (const Bearing& bearing : bearings_) blocks_.push_back(block_over(specimen_, facets_, bearing));
    add_bearings(true);
    first_block_ = model_.block_count();
    vertices_ = add_blocks(model_, specimen_.cells, specimen_.phase);
    name_blocks(model_, first_block_);
    add_bearings(false);
    for (const Side& side : sides_) model_.sets[side.name];
    if constexpr (Dim == 2) {
      for (const Facet<2>& facet : facets_) facet.outer >= 0 ? join(facet) : end(facet);
      // a corner of a block may belong to two of the outline's edges
      for (auto& [name, set] : model_.sets) keep_first(set);
    } else {
      for (const Facet<3>& facet : facets_)
        if (facet.outer >= 0) join(facet);
      list_gridpoints();
      for (const Facet<3>& facet : facets_)
        if (facet.outer < 0) end(facet);
      // a corner may belong to several faces
      for (const std::string& name : of_sides_) sort_unique(model_.sets[name]);
    }
    return std::move(model_);
  }

 private:
  /// Adds the bearings that lie below the specimen, or the others.
  void add_bearings(bool below) {
    for (std::size_t i = 0; i < bearings_.size(); ++i)
      if (is_below(blocks_[i], bearings_[i]) == below) add_bearing(model_, blocks_[i], bearings_[i]);
  }

  /// Joins the two blocks at a facet. Slits are parted from the start: they are no cracks.
  void join(const Facet<Dim>& facet) {
    const int first_contact = model_.contact_count();
    model_.join_faces(gridpoints(facet.inner, facet), gridpoints(facet.outer, facet),
                      interface_of(table_, specimen_, facet.inner, facet.outer),
                      0.5 * (size_of(facet.inner) + size_of(facet.outer)));
    if constexpr (Dim == 2)
      if (const auto slit = specimen_.outline.slit_of(at(facet.corners[0]), at(facet.corners[1]))) {
        add_walls(facet, specimen_.outline.notches()[*slit], first_contact);
        return;
      }
    name_contacts(model_, "specimen", first_contact);
  }

  /// Adds the contacts at an edge to the set of a slit, and its gridpoints to those of the slit's walls.
  void add_walls(const Facet<2>& edge, const specimen::Notch& notch, int first_contact) {
    auto& set = model_.contact_sets[notch.name];
    for (int contact = first_contact; contact < model_.contact_count(); ++contact) set.push_back(contact);
    // an edge has its inner cell on its left
    const bool is_left = dot(at(edge.corners[1]) - at(edge.corners[0]), notch.tip - notch.mouth) > 0.0;
    for (const int cell : {edge.inner, edge.outer})
      for (const int g : gridpoints(cell, edge))
        model_.sets[notch.name + ((cell == edge.inner) == is_left ? "_left" : "_right")].push_back(g);
  }

  /// Joins the block at a facet of the outline to bearings on it, and adds its gridpoints to sets of sides.
  void end(const Facet<Dim>& facet) {
    for (std::size_t i = 0; i < bearings_.size(); ++i) {
      if (!lies_on(sides_, facet.side, bearings_[i].side)) continue;
      std::vector<int> opposite;
      for (const int v : facet.corners) opposite.push_back(blocks_[i].inner(v));
      const int first_contact = model_.contact_count();
      model_.join_faces(gridpoints(facet.inner, facet), opposite, blocks_[i].interface, size_of(facet.inner));
      name_contacts(model_, bearings_[i].name, first_contact);
    }
    std::vector<std::string> names{"outline"};
    for (int side = facet.side; side >= 0; side = sides_[side].part_of) names.push_back(sides_[side].name);
    if constexpr (Dim == 3)
      if (specimen_.outline.axis() == specimen::Prism::Axis::y && sides_[facet.side].name == "rim")
        names.emplace_back(quarter_of(specimen::area_vector(specimen_.cells, facet)));
    for (const std::string& name : names) {
      auto& set = model_.sets[name];
      if constexpr (Dim == 2) {
        for (const int g : gridpoints(facet.inner, facet)) set.push_back(g);
      } else {
        for (const int v : facet.corners)
          set.insert(set.end(), gridpoints_at_[v].begin(), gridpoints_at_[v].end());
        if (std::ranges::find(of_sides_, name) == of_sides_.end()) of_sides_.push_back(name);
      }
    }
  }

  /// Lists the gridpoints at each vertex: in space a block may touch a side in an edge or a corner alone.
  void list_gridpoints() {
    gridpoints_at_.resize(specimen_.cells.vertices.size());
    for (std::size_t cell = 0; cell < vertices_.size(); ++cell)
      for (std::size_t i = 0; i < vertices_[cell].size(); ++i)
        gridpoints_at_[vertices_[cell][i]].push_back(first_gridpoint(static_cast<int>(cell)) +
                                                     static_cast<int>(i));
  }

  const Vec<Dim>& at(int vertex) const { return specimen_.cells.vertices[vertex]; }
  int first_gridpoint(int cell) const { return model_.block_gridpoints[first_block_ + cell]; }
  double size_of(int cell) const { return specimen_.size.empty() ? 0.0 : specimen_.size[cell]; }

  /// Returns the gridpoints of a cell at a facet.
  std::vector<int> gridpoints(int cell, const Facet<Dim>& facet) const {
    std::vector<int> its;
    for (const int v : facet.corners) its.push_back(first_gridpoint(cell) + place_in(vertices_[cell], v));
    return its;
  }

  const Specimen<Dim>& specimen_;
  const std::vector<Bearing>& bearings_;
  const std::vector<Side>& sides_;
  InterfaceTable table_;
  std::vector<Facet<Dim>> facets_;
  ModelOf<Dim> model_;
  std::vector<BearingBlock<Dim>> blocks_;   ///< of each bearing
  int first_block_ = 0;                     ///< block of the first cell
  std::vector<std::vector<int>> vertices_;  ///< vertices at the gridpoints of each cell
  std::vector<std::vector<int>> gridpoints_at_;
  std::vector<std::string> of_sides_;  ///< names of sets of sides in space
};

}  // namespace

std::vector<Bearing> platens(double thickness) {
  return {{"bottom_platen", "bottom", thickness, "platen", "platen", false},
          {"top_platen", "top", thickness, "platen", "platen", false}};
}

void add_cells(ModelOf<3>& model, const Cells<3>& cells, const std::vector<int>& material,
               const std::function<int(int, int)>& interface_between) {
  const int first_block = model.block_count();
  const auto vertices = add_blocks(model, cells, material);
  const auto gridpoints = [&](int cell, const std::vector<int>& corners) {
    std::vector<int> its;
    for (const int corner : corners)
      its.push_back(model.block_gridpoints[first_block + cell] + place_in(vertices[cell], corner));
    return its;
  };
  for (const auto& [corners, inner, outer, side] : cells.faces)
    if (outer >= 0)
      model.join_faces(gridpoints(inner, corners), gridpoints(outer, corners),
                       interface_between(inner, outer));
}

template <int Dim>
ModelOf<Dim> make_model(const Specimen<Dim>& specimen, double thickness,
                        const std::vector<InterfaceParameters>& interfaces,
                        const std::vector<Bearing>& bearings) {
  return ModelMaker<Dim>(specimen, thickness, interfaces, bearings).make();
}

template ModelOf<2> make_model<2>(const Specimen<2>&, double, const std::vector<InterfaceParameters>&,
                                  const std::vector<Bearing>&);
template ModelOf<3> make_model<3>(const Specimen<3>&, double, const std::vector<InterfaceParameters>&,
                                  const std::vector<Bearing>&);

}  // namespace pyroclast
