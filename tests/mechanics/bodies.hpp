#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numbers>
#include <utility>
#include <vector>

#include "pyroclast/laws/built_in.hpp"
#include "pyroclast/mechanics/mechanics.hpp"
#include "pyroclast/model/concrete_model.hpp"
#include "pyroclast/specimen/laguerre.hpp"
#include "pyroclast/specimen/spaced_seeds.hpp"
#include "pyroclast/specimen/specimen.hpp"
#include "table_2.hpp"

/// Small bodies that the mechanics tests share.
namespace pyroclast::bodies {

inline Elastic::Properties<double> elastic_contact() {
  const auto mortar = mortar_contact();
  return {mortar.normal_stiffness, mortar.shear_stiffness};
}

inline Vec<2> turned(const Vec<2>& x, double angle) {
  return {{std::cos(angle) * x[0] - std::sin(angle) * x[1], std::sin(angle) * x[0] + std::cos(angle) * x[1]}};
}

/// The blocks of a random tessellation without platens, one material, one interface, turned by `angle`.
/// \param width  width of the outline, m
inline ModelOf<2> tessellated(int blocks, const specimen::Region& outline, double width, std::uint64_t seed,
                              double angle = 0.0) {
  specimen::SpecimenParameters p;
  p.outline = outline;
  p.seed = seed;
  p.aggregates = {.fraction = 0.0,
                  .d_min = 0.1 * width,
                  .d_max = 0.2 * width,
                  .fuller_exponent = 0.45,
                  .sieves = {0.1 * width, 0.2 * width},
                  .minimum_gap = 0.0,
                  .attempts = 1};
  p.blocks.count = blocks;
  p.blocks.shortest_edge = 0.2;
  const auto specimen = specimen::make_specimen(p);
  const auto& cells = specimen.cells.cells;
  ModelOf<2> model;
  model.material_names = {"mortar"};
  model.interface_names = {"mortar-mortar"};
  for (const auto& cell : cells) {
    std::vector<Vec<2>> corners;
    for (int v : cell) corners.push_back(turned(specimen.cells.vertices[v], angle));
    const auto zoned = specimen::zone_block(corners);
    model.add_block(zoned.gridpoints, zoned.zones, 0);
  }
  const auto gridpoint = [&](int cell, int vertex) {
    for (std::size_t i = 0; i < cells[cell].size(); ++i)
      if (cells[cell][i] == vertex) return model.block_gridpoints[cell] + static_cast<int>(i);
    return -1;
  };
  for (const auto& e : specimen::facets(specimen.cells))
    if (e.outer >= 0)
      model.join_faces({gridpoint(e.inner, e.corners[0]), gridpoint(e.inner, e.corners[1])},
                       {gridpoint(e.outer, e.corners[0]), gridpoint(e.outer, e.corners[1])}, 0);
  return model;
}

inline ModelOf<2> tessellated(int blocks, double width, double height, std::uint64_t seed,
                              double angle = 0.0) {
  return tessellated(blocks, specimen::Region::rectangle(width, height), width, seed, angle);
}

/// A column of `count` square blocks of size d, joined face to face, its axis turned by `angle` from the y
/// axis. Block i holds gridpoints 4 i (lower left) to 4 i + 3, counter-clockwise.
inline ModelOf<2> column(int count, double d, double angle = 0.0) {
  ModelOf<2> model;
  model.material_names = {"mortar"};
  model.interface_names = {"mortar-mortar"};
  for (int i = 0; i < count; ++i) {
    std::vector<Vec<2>> corners{{{0.0, i * d}}, {{d, i * d}}, {{d, (i + 1) * d}}, {{0.0, (i + 1) * d}}};
    for (auto& x : corners) x = turned(x, angle);
    model.add_block(corners, {{0, 1, 2}, {0, 2, 3}}, 0);
  }
  for (int i = 0; i + 1 < count; ++i)
    model.join_faces({4 * i + 2, 4 * i + 3}, {4 * (i + 1) + 1, 4 * (i + 1)}, 0);
  return model;
}

/// Quadrilateral blocks between the images of the points (i / nx, j / ny), each cut into four zones around
/// its centroid, joined face to face. Block j nx + i holds gridpoints 5 (j nx + i) and up: its corners, from
/// (i, j) counter-clockwise, and its centroid. \param position  maps the unit square to the body and keeps
/// its orientation
template <class Map>
ModelOf<2> lattice(int nx, int ny, Map position) {
  ModelOf<2> model;
  model.material_names = {"mortar"};
  model.interface_names = {"mortar-mortar"};
  const auto point = [&](int i, int j) {
    return position(static_cast<double>(i) / nx, static_cast<double>(j) / ny);
  };
  for (int j = 0; j < ny; ++j)
    for (int i = 0; i < nx; ++i) {
      const auto zoned =
          specimen::zone_block({point(i, j), point(i + 1, j), point(i + 1, j + 1), point(i, j + 1)});
      model.add_block(zoned.gridpoints, zoned.zones, 0);
    }
  for (int j = 0; j < ny; ++j)
    for (int i = 0; i < nx; ++i) {
      const int here = 5 * (j * nx + i), right = here + 5, above = here + 5 * nx;
      if (i + 1 < nx) model.join_faces({here + 1, here + 2}, {right, right + 3}, 0);
      if (j + 1 < ny) model.join_faces({here + 2, here + 3}, {above + 1, above}, 0);
    }
  return model;
}

/// The unit cube cut into five tetrahedra, each a block of its own, joined through their inner faces.
inline ModelOf<3> five_tetrahedra() {
  const std::vector<Vec<3>> x{{{0, 0, 0}}, {{1, 0, 0}}, {{1, 1, 0}}, {{0, 1, 0}},
                              {{0, 0, 1}}, {{1, 0, 1}}, {{1, 1, 1}}, {{0, 1, 1}}};
  const std::vector<std::array<int, 4>> cut{
      {0, 1, 2, 5}, {0, 2, 3, 7}, {0, 5, 7, 4}, {2, 7, 5, 6}, {0, 2, 7, 5}};
  ModelOf<3> model;
  model.material_names = {"mortar"};
  model.interface_names = {"mortar-mortar"};
  for (const auto& t : cut) model.add_block({x[t[0]], x[t[1]], x[t[2]], x[t[3]]}, {{0, 1, 2, 3}}, 0);
  const auto corner = [&](int block, int vertex) {
    for (int i = 0; i < 4; ++i)
      if (cut[block][i] == vertex) return 4 * block + i;
    return -1;
  };
  for (int outer = 0; outer < 4; ++outer) {
    // the three vertices shared with the tetrahedron in the middle, and the one that is not
    std::vector<int> shared;
    Vec<3> apex{};
    for (int v : cut[outer]) {
      if (corner(4, v) >= 0)
        shared.push_back(v);
      else
        apex = x[v];
    }
    const Vec<3> normal = cross(x[shared[1]] - x[shared[0]], x[shared[2]] - x[shared[0]]);
    if (dot(normal, apex - x[shared[0]]) > 0.0) std::swap(shared[1], shared[2]);  // out of the outer block
    model.join_faces({corner(outer, shared[0]), corner(outer, shared[1]), corner(outer, shared[2])},
                     {corner(4, shared[0]), corner(4, shared[1]), corner(4, shared[2])}, 0);
  }
  return model;
}

/// A column of `count` cubes of size d along z, joined through their square faces, each cut into tetrahedra
/// around its middle. Block i holds gridpoints 9 i to 9 i + 7, the lower four first, counter-clockwise seen
/// from above, and 9 i + 8, its middle.
inline ModelOf<3> cubes(int count, double d) {
  // faces outwards, each cut by the diagonal from its first corner
  constexpr int faces[6][4] = {{0, 3, 2, 1}, {4, 5, 6, 7}, {0, 1, 5, 4},
                               {1, 2, 6, 5}, {2, 3, 7, 6}, {3, 0, 4, 7}};
  std::vector<std::array<int, 4>> zones;
  for (const auto& f : faces) {
    zones.push_back({f[0], f[2], f[1], 8});
    zones.push_back({f[0], f[3], f[2], 8});
  }
  ModelOf<3> model;
  model.material_names = {"mortar"};
  model.interface_names = {"mortar-mortar"};
  for (int i = 0; i < count; ++i) {
    std::vector<Vec<3>> x;
    for (int level : {0, 1})
      for (const auto& [a, b] : {std::pair{0, 0}, {1, 0}, {1, 1}, {0, 1}})
        x.push_back({{a * d, b * d, (i + level) * d}});
    x.push_back({{0.5 * d, 0.5 * d, (i + 0.5) * d}});
    model.add_block(x, zones, 0);
  }
  for (int i = 0; i + 1 < count; ++i) {
    const int low = 9 * i, high = 9 * (i + 1);
    model.join_faces({low + 4, low + 5, low + 6, low + 7}, {high, high + 1, high + 2, high + 3}, 0);
  }
  return model;
}

/// Adds a face between two cells, or on the surface where `outer` is -1.
inline void add_face(specimen::Cells<3>& complex, std::vector<int> corners, int inner, int outer) {
  const int face = static_cast<int>(complex.faces.size());
  complex.faces.push_back({std::move(corners), inner, outer, outer < 0 ? 0 : -1});
  for (const int cell : {inner, outer})
    if (cell >= 0) complex.cells[cell].push_back(face);
}

/// Octant of a sphere around the origin, where x, y and z are positive: shells between radii, each of three
/// patches of n x n blocks, in which a cube's faces would be seen from its middle. Blocks of a shell that
/// begins at the radius 0 are pyramids. Block b stands in shell b / (3 n^2). Materials are `inner` and
/// `outer`. \param inner_shells  number of shells of the inner material
inline ModelOf<3> octant(const std::vector<double>& radii, int n, int inner_shells = 0) {
  specimen::Cells<3> complex;
  std::map<std::array<int, 4>, int> vertices;     // by level and place on the cube
  std::map<std::vector<int>, std::size_t> faces;  // by their corners, ascending
  std::vector<int> material;
  const auto vertex = [&](int level, int patch, int i, int j) {
    std::array<int, 4> key{};  // all vertices at the radius 0 are one
    Vec<3> at{};
    if (radii[level] > 0.0) {
      key[3] = level;
      key[patch] = n;
      key[(patch + 1) % 3] = i;
      key[(patch + 2) % 3] = j;
      for (int axis = 0; axis < 3; ++axis) at[axis] = std::tan(0.25 * std::numbers::pi * key[axis] / n);
      at *= radii[level] / norm(at);
    }
    const auto [found, is_new] = vertices.emplace(key, static_cast<int>(complex.vertices.size()));
    if (is_new) complex.vertices.push_back(at);
    return found->second;
  };
  for (int shell = 0; shell + 1 < std::ssize(radii); ++shell)
    for (int patch = 0; patch < 3; ++patch)
      for (int i = 0; i < n; ++i)
        for (int j = 0; j < n; ++j) {
          const auto corners = [&](int level) {
            return std::array{vertex(level, patch, i, j), vertex(level, patch, i + 1, j),
                              vertex(level, patch, i + 1, j + 1), vertex(level, patch, i, j + 1)};
          };
          const auto low = corners(shell), high = corners(shell + 1);
          std::vector<std::vector<int>> outward{{low[3], low[2], low[1], low[0]},
                                                {high[0], high[1], high[2], high[3]}};
          for (int side = 0; side < 4; ++side) {
            const int next = (side + 1) % 4;
            outward.push_back({low[side], low[next], high[next], high[side]});
          }
          const int cell = static_cast<int>(complex.cells.size());
          complex.cells.emplace_back();
          material.push_back(shell < inner_shells ? 0 : 1);
          for (auto& face : outward) {
            face.erase(std::unique(face.begin(), face.end()), face.end());
            if (face.size() < 3) continue;  // at the radius 0
            auto sorted = face;
            std::ranges::sort(sorted);
            if (const auto before = faces.find(sorted); before != faces.end()) {
              complex.faces[before->second].outer = cell;
              complex.cells[cell].push_back(static_cast<int>(before->second));
              continue;
            }
            faces.emplace(sorted, complex.faces.size());
            add_face(complex, face, cell, -1);
          }
        }
  ModelOf<3> model;
  model.material_names = {"inner", "outer"};
  model.interface_names = {"joint"};
  add_cells(model, complex, material, [](int, int) { return 0; });
  return model;
}

/// Raw Laguerre cells of a cube, one material, one interface. Their corners within are moved at random by up
/// to a share of their shortest edge along each axis, which bends faces.
inline ModelOf<3> laguerre_cells(int blocks, double edge, std::uint64_t seed, double shake = 0.0) {
  const specimen::Prism body(specimen::Region::rectangle(edge, edge), specimen::Prism::Axis::z, edge);
  Random random(seed);
  specimen::Cells<3> complex =
      specimen::laguerre_cells(specimen::spaced_seeds(body, blocks, 0.3, random), body).cells;
  std::vector<double> shortest(complex.vertices.size(), edge);
  for (const auto& face : complex.faces)
    for (std::size_t i = 0; i < face.corners.size(); ++i) {
      const int a = face.corners[i], b = face.corners[(i + 1) % face.corners.size()];
      const double length = face.outer < 0 ? 0.0 : norm(complex.vertices[b] - complex.vertices[a]);
      for (const int v : {a, b}) shortest[v] = std::min(shortest[v], length);
    }
  for (std::size_t v = 0; v < shortest.size(); ++v)
    for (double& x : complex.vertices[v].c) x += shake * shortest[v] * random.uniform(-1.0, 1.0);
  ModelOf<3> model;
  model.material_names = {"mortar"};
  model.interface_names = {"mortar-mortar"};
  add_cells(model, complex, std::vector<int>(complex.cells.size(), 0), [](int, int) { return 0; });
  return model;
}

template <int Dim>
MechanicsParameters quasi_static(double damping = 0.8) {
  MechanicsParameters p;
  p.local_damping = damping;
  p.mass = MassChoice::scaled;
  p.time_step = 1e-5;
  p.safety = 0.9;
  return p;
}

/// Damped by velocity alone, which leaves no force at rest; near critical for a body whose slowest vibration
/// takes about twice that many steps.
template <int Dim>
MechanicsParameters settling(double steps = 40) {
  auto p = quasi_static<Dim>(0.0);
  p.viscous_damping = 3.0 / (steps * p.time_step);
  return p;
}

template <int Dim>
Mechanics<Dim> mechanics(const ModelOf<Dim>& model, const ContactProperties& contact,
                         const MechanicsParameters& parameters, double young = 29.4e9, double poisson = 0.2,
                         std::shared_ptr<Team> team = nullptr) {
  return Mechanics<Dim>(
      model, {2400.0},
      by_interface(model,
                   std::vector<ZoneProperties>(model.zones.size(), zone_properties<Dim>(young, poisson)),
                   {contact}),
      parameters, std::move(team));
}

/// Sum of the sizes of a ledger's entries, to measure its error by.
inline double turnover(const EnergyLedger& e) {
  double sum = e.dissipated.total();
  for (const auto& entry : kEnergies)
    if (entry.side != LedgerSide::error) sum += std::abs(entry.value(e));
  return sum;
}

/// Moves every gridpoint at a steady velocity to a displacement given by its position, in a number of steps,
/// and takes one more step so that forces belong to it.
template <int Dim, class Field>
void impose(Mechanics<Dim>& m, Field displacement, int steps) {
  const auto& x = m.model().position;
  const double duration = steps * m.time_step();
  for (int g = 0; g < m.model().gridpoint_count(); ++g)
    for (int i = 0; i < Dim; ++i) m.constraints().prescribe_velocity(g, i, displacement(x[g])[i] / duration);
  m.advance(steps);
  for (int g = 0; g < m.model().gridpoint_count(); ++g)
    for (int i = 0; i < Dim; ++i) m.constraints().prescribe_velocity(g, i, 0.0);
  m.advance(1);
}

}  // namespace pyroclast::bodies
