#include "pyroclast/moisture/moisture_mesh.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "pyroclast/model/sets.hpp"
#include "pyroclast/thermal/thermal_mesh.hpp"

namespace pyroclast {

namespace {

/// Share of the line of centroids that each cell keeps where a bent face would take all of it.
constexpr double kLeastShare = 0.02;

/// Returns the area vector of a face, m2: of a bent one shorter than its area.
template <int Dim>
Vec<Dim> area_vector(const ModelOf<Dim>& model, int face) {
  const int first = model.face_contacts[face], last = model.face_contacts[face + 1];
  Vec<Dim> vector;
  if constexpr (Dim == 2) {
    for (int c = first; c < last; ++c) vector += model.contacts[c].normal * model.contacts[c].area;
  } else {
    const auto corner = [&](int c) {
      return model.position[model.contacts[c].a] - model.position[model.contacts[first].a];
    };
    for (int c = first + 1; c + 1 < last; ++c) vector += cross(corner(c), corner(c + 1)) * 0.5;
  }
  return vector;
}

/// Returns a face between two cells: a bent face counts as a plane.
template <int Dim>
CellFace cell_face(const ModelOf<Dim>& model, int face, std::array<int, 2> cells, const Vec<Dim>& from,
                   const Vec<Dim>& to) {
  Vec<Dim> centre;
  double area = 0.0;
  for (int c = model.face_contacts[face]; c < model.face_contacts[face + 1]; ++c) {
    centre += model.position[model.contacts[c].a] * model.contacts[c].area;
    area += model.contacts[c].area;
  }
  centre *= 1.0 / area;
  const Vec<Dim> vector = area_vector(model, face), line = to - from;
  const double length = norm(line);
  const double share =
      std::clamp(dot(vector, centre - from) / dot(vector, line), kLeastShare, 1.0 - kLeastShare);
  const double area_across = std::abs(dot(vector, line)) / length;
  return {cells, 0.5 * (norm(vector) + area_across), {share * length, (1.0 - share) * length}};
}

/// Numbers the ends of faces, which faces of several blocks share: corners in the plane, edges in space.
template <int Dim>
class EndNumbers {
 public:
  EndNumbers(const ModelOf<Dim>& model, const std::vector<bool>& takes_part)
      : corner_(join_through_contacts(model, takes_part, {}).of_gridpoint) {}

  /// Returns the number of the edge between two gridpoints; in the plane that of the first one's corner.
  int of(int g, int other) {
    if constexpr (Dim == 2) return corner_[g];
    const auto next = static_cast<int>(number_.size());
    return number_.try_emplace(std::minmax({corner_[g], corner_[other]}), next).first->second;
  }

 private:
  std::vector<int> corner_;
  std::map<std::pair<int, int>, int> number_;
};

/// Adds the ends of a face to a mesh.
template <int Dim>
void add_ends(const ModelOf<Dim>& model, int face, EndNumbers<Dim>& numbers, MoistureMesh& mesh) {
  const int first = model.face_contacts[face], count = model.face_contacts[face + 1] - first;
  const auto corner = [&](int i) { return model.position[model.contacts[first + i % count].a]; };
  Vec<Dim> middle;
  for (int i = 0; i < count; ++i) middle += corner(i) * (1.0 / count);
  CellFace& of = mesh.faces.back();
  of.first_end = static_cast<int>(mesh.ends.size());
  of.end_count = count;
  for (int i = 0; i < count; ++i) {
    const int here = first + i, next = Dim == 2 ? here : first + (i + 1) % count;
    FaceEnd end{numbers.of(model.contacts[here].a, model.contacts[next].a),
                model.thickness,
                norm(corner(i) - middle),
                {here, next}};
    if constexpr (Dim == 3) {
      const Vec<3> edge = corner(i + 1) - corner(i);
      end.breadth = norm(edge);
      end.distance = norm((corner(i) + corner(i + 1)) * 0.5 - middle);
    }
    mesh.ends.push_back(end);
  }
}

}  // namespace

template <int Dim>
MoistureMesh moisture_mesh(const ModelOf<Dim>& model, const ZoneGeometry<Dim>& geometry,
                           const std::vector<bool>& takes_part, const std::vector<OutlineFace<Dim>>& outer) {
  MoistureMesh mesh;
  mesh.cell_of_block.assign(model.block_count(), -1);
  for (int b = 0; b < model.block_count(); ++b) {
    if (!takes_part[b]) continue;
    mesh.cell_of_block[b] = mesh.cell_count();
    double volume = 0.0;
    for (int z = model.block_zones[b]; z < model.block_zones[b + 1]; ++z) volume += geometry.volume[z];
    mesh.volume.push_back(volume);
    mesh.block.push_back(b);
    mesh.material.push_back(model.block_material[b]);
  }
  std::vector<Vec<Dim>> centroid;
  for (const Vec<3>& at : block_centroids(model)) centroid.push_back(resized<Dim>(at));
  const std::vector<int> block_of = gridpoint_blocks(model);
  EndNumbers<Dim> numbers(model, takes_part);
  mesh.cell_face.assign(model.face_count(), -1);
  for (int face = 0; face < model.face_count(); ++face) {
    const Contact<Dim>& first = model.contacts[model.face_contacts[face]];
    const int a = block_of[first.a], b = block_of[first.b];
    const std::array<int, 2> cells{mesh.cell_of_block[a], mesh.cell_of_block[b]};
    if (cells[0] < 0 || cells[1] < 0) continue;
    mesh.cell_face[face] = static_cast<int>(mesh.faces.size());
    mesh.faces.push_back(cell_face(model, face, cells, centroid[a], centroid[b]));
    add_ends(model, face, numbers, mesh);
  }
  for (const OutlineFace<Dim>& face : outer) {
    const int block = block_of[face.gridpoints[0]], cell = mesh.cell_of_block[block];
    if (cell < 0) continue;
    for (int i = 0; i < Dim; ++i)
      mesh.outer_edges.push_back({numbers.of(face.gridpoints[i], face.gridpoints[(i + 1) % Dim]),
                                  static_cast<int>(mesh.outer_faces.size())});
    mesh.outer_faces.push_back({cell, face.area, std::abs(dot(face.normal, face.centre - centroid[block]))});
  }
  return mesh;
}

template MoistureMesh moisture_mesh(const ModelOf<2>&, const ZoneGeometry<2>&, const std::vector<bool>&,
                                    const std::vector<OutlineFace<2>>&);
template MoistureMesh moisture_mesh(const ModelOf<3>&, const ZoneGeometry<3>&, const std::vector<bool>&,
                                    const std::vector<OutlineFace<3>>&);

}  // namespace pyroclast
