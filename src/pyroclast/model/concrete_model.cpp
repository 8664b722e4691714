#include "pyroclast/model/concrete_model.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <numeric>
#include <unordered_set>
#include <vector>

#include <fmt/format.h>

#include "pyroclast/base/error.hpp"
#include "pyroclast/base/place_in.hpp"
#include "pyroclast/model/model_parts.hpp"

namespace pyroclast {

namespace {

/// Keeps, of each gridpoint in a set, the first entry alone.
void keep_first(std::vector<int>& set) {
  std::unordered_set<int> seen;
  std::erase_if(set, [&](int gridpoint) { return !seen.insert(gridpoint).second; });
}

using specimen::Edge;
using specimen::Region;
using specimen::Specimen;

/// Height of a bearing's zones at its seat over their width, about.
constexpr double kZoneHeightOverWidth = 2.0;

/// Tells whether an edge of the outline lies on a side, or on a patch of it.
bool lies_on(const Region& region, int side, const std::string& name) {
  const auto& [own, is_round, is_cut, part_of] = region.sides()[side];
  return own == name || (part_of >= 0 && region.sides()[part_of].name == name);
}

/// Part of the outline that a bearing covers.
struct Seat {
  std::vector<int> vertices;  ///< vertices from left to right, or upwards
  bool is_reversed = false;   ///< true against the sense of the outline, which has the body on its left
  Vec<2> outward{};           ///< unit vector away from the body
};

/// Finds the part of the outline that a bearing covers. Throws Error where it is not one piece with two ends.
/// \param outline  edges on the outline, with their sides
Seat find_seat(const Specimen& specimen, const std::vector<std::pair<Edge, int>>& outline,
               const std::string& name, const std::string& side) {
  std::vector<int> next(specimen.tessellation.vertices.size(), -1);
  std::vector<int> before(next.size(), -1);
  for (const auto& [edge, on] : outline)
    if (lies_on(specimen.region, on, side)) {
      next[edge.v0] = edge.v1;
      before[edge.v1] = edge.v0;
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
  const auto& at = specimen.tessellation.vertices;
  const Vec<2> along = at[seat.vertices.back()] - at[seat.vertices.front()];
  const double length = norm(along);
  seat.outward = {{along[1] / length, -along[0] / length}};
  seat.is_reversed = along[0] < 0.0 || (along[0] == 0.0 && along[1] < 0.0);
  if (seat.is_reversed) std::ranges::reverse(seat.vertices);
  return seat;
}

struct BearingBlock {
  Seat seat;
  std::vector<int> inner, outer;  ///< gridpoints of its faces, in the order of the seat
  int first = 0, last = 0;        ///< range of all of its gridpoints
  int pivot = 0;
  int interface = 0;
};

/// Adds a structured block over a seat.
BearingBlock add_bearing(ModelOf<2>& model, const Specimen& specimen, const Seat& seat,
                         const Bearing& bearing, int material) {
  std::vector<Vec<2>> inner, outer;
  for (int v : seat.vertices) {
    inner.push_back(specimen.tessellation.vertices[v]);
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
  const int first = model.gridpoint_count();
  model.add_block(gridpoints, zones, material);
  BearingBlock block;
  block.seat = seat;
  block.first = first;
  block.last = model.gridpoint_count();
  block.pivot = first + rows * columns + pivot;
  for (int i = 0; i < columns; ++i) {
    block.inner.push_back(first + i);
    block.outer.push_back(first + rows * columns + i);
  }
  return block;
}

}  // namespace

std::vector<int> all_from(int first, int last) {
  std::vector<int> result(last - first);
  std::iota(result.begin(), result.end(), first);
  return result;
}

void name_blocks(Model& model, int first_block) {
  const int first = model.block_gridpoints[first_block];
  model.sets["specimen"] = all_from(first, model.gridpoint_count());
  for (int block = first_block; block < model.block_count(); ++block) {
    auto& set = model.sets[model.material_names[model.block_material[block]]];
    for (int g = model.block_gridpoints[block]; g < model.block_gridpoints[block + 1]; ++g) set.push_back(g);
  }
}

void name_contacts(Model& model, const std::string& body, int first_contact) {
  for (int contact = first_contact; contact < model.contact_count(); ++contact) {
    const std::string& interface = model.interface_names[model.joint(contact).interface];
    model.contact_sets[body].push_back(contact);
    if (interface != body) model.contact_sets[interface].push_back(contact);
  }
}

std::vector<double> bearing_rows(double thickness, double width) {
  const double rows_of_even_height = thickness / (kZoneHeightOverWidth * width);
  const int rows = std::max(2, static_cast<int>(std::ceil(std::log2(rows_of_even_height + 1.0))));
  std::vector<double> heights;
  for (int row = 0; row <= rows; ++row) heights.push_back((std::exp2(row) - 1.0) / (std::exp2(rows) - 1.0));
  return heights;
}

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

std::vector<Bearing> platens(double thickness) {
  return {{"bottom_platen", "bottom", thickness, "platen", "platen", false},
          {"top_platen", "top", thickness, "platen", "platen", false}};
}

ModelOf<2> make_concrete_model(const Specimen& specimen, double thickness,
                               const std::vector<InterfaceParameters>& interfaces,
                               const std::vector<Bearing>& bearings) {
  const Region& region = specimen.region;
  const auto& tessellation = specimen.tessellation;
  const InterfaceTable table(specimen.phases, interfaces);
  ModelOf<2> model;
  model.thickness = thickness;
  model.material_names = specimen.phases;
  model.interface_names = table.names();
  add_bearing_names(model, bearings);

  const auto edges = specimen::edges(tessellation);
  std::vector<std::pair<Edge, int>> outline;
  for (const Edge& e : edges)
    if (e.right < 0)
      outline.emplace_back(e,
                           region.side_of(tessellation.vertices[e.v0], tessellation.vertices[e.v1]).value());

  std::vector<BearingBlock> blocks(bearings.size());
  // bearings below the specimen stand before it
  const auto add_bearings = [&](bool below) {
    for (std::size_t i = 0; i < bearings.size(); ++i) {
      const Bearing& bearing = bearings[i];
      const Seat seat = find_seat(specimen, outline, bearing.name, bearing.side);
      if ((seat.outward[1] < -0.5) != below) continue;
      blocks[i] =
          add_bearing(model, specimen, seat, bearing, place_in(model.material_names, bearing.material));
      blocks[i].interface = place_in(model.interface_names, bearing.interface);
      model.sets[bearing.name] = all_from(blocks[i].first, blocks[i].last);
      model.sets[bearing.name + "_face"] = blocks[i].inner;
      model.sets[bearing.name + "_support"] = blocks[i].outer;
      model.sets[bearing.name + "_pivot"] = {blocks[i].pivot};
    }
  };
  add_bearings(true);
  const int first_cell = model.block_count();
  for (std::size_t cell = 0; cell < tessellation.cells.size(); ++cell) {
    std::vector<Vec<2>> corners;
    for (int v : tessellation.cells[cell]) corners.push_back(tessellation.vertices[v]);
    const auto zoned = specimen::zone_block(corners);
    model.add_block(zoned.gridpoints, zoned.zones, specimen.phase[cell]);
  }
  name_blocks(model, first_cell);
  add_bearings(false);

  const auto gridpoint = [&](int cell, int vertex) {
    return model.block_gridpoints[first_cell + cell] + place_in(tessellation.cells[cell], vertex);
  };
  const auto size_of = [&](int cell) { return specimen.size.empty() ? 0.0 : specimen.size[cell]; };
  auto& whole_outline = model.sets["outline"];
  for (const specimen::Side& side : region.sides()) model.sets[side.name];
  std::size_t on_outline = 0;
  for (const Edge& e : edges) {
    const std::vector<int> a{gridpoint(e.left, e.v0), gridpoint(e.left, e.v1)};
    if (e.right >= 0) {
      const int first_contact = model.contact_count();
      const int interface = interface_of(table, specimen, e.left, e.right);
      model.join_faces(a, {gridpoint(e.right, e.v0), gridpoint(e.right, e.v1)}, interface,
                       0.5 * (size_of(e.left) + size_of(e.right)));
      if (const auto slit = region.slit_of(tessellation.vertices[e.v0], tessellation.vertices[e.v1])) {
        const specimen::Notch& notch = region.notches()[*slit];
        auto& set = model.contact_sets[notch.name];
        for (int contact = first_contact; contact < model.contact_count(); ++contact) set.push_back(contact);
        // an edge has its left cell on its left
        const Vec<2> along = tessellation.vertices[e.v1] - tessellation.vertices[e.v0];
        const bool is_left = dot(along, notch.tip - notch.mouth) > 0.0;
        for (const int cell : {e.left, e.right}) {
          auto& wall = model.sets[notch.name + ((cell == e.left) == is_left ? "_left" : "_right")];
          for (const int v : {e.v0, e.v1}) wall.push_back(gridpoint(cell, v));
        }
      } else {  // slits are parted from the start: they are no cracks
        name_contacts(model, "specimen", first_contact);
      }
      continue;
    }
    const int side = outline[on_outline++].second;
    for (std::size_t i = 0; i < bearings.size(); ++i) {
      if (!lies_on(region, side, bearings[i].side)) continue;
      const auto opposite = [&](int vertex) {
        return blocks[i].inner[place_in(blocks[i].seat.vertices, vertex)];
      };
      const int first_contact = model.contact_count();
      model.join_faces(a, {opposite(e.v0), opposite(e.v1)}, blocks[i].interface, size_of(e.left));
      name_contacts(model, bearings[i].name, first_contact);
    }
    whole_outline.insert(whole_outline.end(), a.begin(), a.end());
    for (int on = side; on >= 0; on = region.sides()[on].part_of) {
      auto& set = model.sets[region.sides()[on].name];
      set.insert(set.end(), a.begin(), a.end());
    }
  }
  // a corner of a block may belong to two of the outline's edges
  for (auto& [name, set] : model.sets) keep_first(set);
  return model;
}

}  // namespace pyroclast
