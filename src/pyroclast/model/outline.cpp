#include "pyroclast/model/outline.hpp"

#include <algorithm>
#include <utility>

#include <fmt/format.h>

#include "pyroclast/base/error.hpp"

namespace pyroclast {

namespace {

/// Cosine of the angle up to which two faces look the same way, 60 degrees.
constexpr double kLooksAlike = 0.5;

/// Returns the corners of the face that lies opposite to each corner of a zone, seen counter-clockwise from
/// outside.
constexpr std::array<std::array<int, 2>, 3> faces_of(const std::array<int, 3>& zone) {
  return {{{zone[1], zone[2]}, {zone[2], zone[0]}, {zone[0], zone[1]}}};
}
constexpr std::array<std::array<int, 3>, 4> faces_of(const std::array<int, 4>& zone) {
  return {{{zone[1], zone[2], zone[3]},
           {zone[0], zone[3], zone[2]},
           {zone[0], zone[1], zone[3]},
           {zone[0], zone[2], zone[1]}}};
}

template <std::size_t N>
std::array<int, N> sorted(std::array<int, N> corners) {
  std::sort(corners.begin(), corners.end());
  return corners;
}

/// Returns the faces that contacts join to another block of the body, in order and with sorted corners.
template <int Dim>
std::vector<std::array<int, Dim>> joined_faces(const ModelOf<Dim>& model, const std::vector<bool>& belongs) {
  std::vector<std::array<int, Dim>> faces;
  const auto add = [&](std::array<int, Dim> corners) { faces.push_back(sorted(corners)); };
  for (int face = 0; face < model.face_count(); ++face) {
    const int first = model.face_contacts[face], last = model.face_contacts[face + 1];
    if (!belongs[model.contacts[first].a] || !belongs[model.contacts[first].b]) continue;
    // an edge, or the triangles of a polygon's fan
    for (int i = first + 1; i + Dim - 2 < last; ++i) {
      std::array<int, Dim> a{model.contacts[first].a}, b{model.contacts[first].b};
      for (int corner = 1; corner < Dim; ++corner) {
        a[corner] = model.contacts[i + corner - 1].a;
        b[corner] = model.contacts[i + corner - 1].b;
      }
      add(a);
      add(b);
    }
  }
  std::sort(faces.begin(), faces.end());
  return faces;
}

/// Returns the gradient of the shape function of a corner, 1/m. It points from the opposite face towards the
/// corner, and its length is 1 over their distance.
template <int Dim>
Vec<Dim> opposite_gradient(const ZoneGeometry<Dim>& geometry, int zone, int corner) {
  if (corner < Dim) return geometry.gradient[zone][corner];
  Vec<Dim> last{};
  for (const auto& g : geometry.gradient[zone]) last -= g;
  return last;
}

}  // namespace

std::vector<bool> blocks_of(const Model& model, const std::vector<bool>& materials) {
  std::vector<bool> blocks;
  for (const int material : model.block_material) blocks.push_back(materials[material]);
  return blocks;
}

template <int Dim>
std::vector<bool> gridpoints_of(const ModelOf<Dim>& model, const std::vector<bool>& takes_part) {
  if (std::ssize(takes_part) != model.block_count())
    throw Error(fmt::format("{} blocks are said to take part or not, but the model has {}", takes_part.size(),
                            model.block_count()));
  std::vector<bool> result(model.position.size());
  for (int b = 0; b < model.block_count(); ++b)
    for (int g = model.block_gridpoints[b]; g < model.block_gridpoints[b + 1]; ++g) result[g] = takes_part[b];
  return result;
}

template <int Dim>
std::vector<OutlineFace<Dim>> outline(const ModelOf<Dim>& model, const ZoneGeometry<Dim>& geometry,
                                      const std::vector<bool>& takes_part) {
  struct Candidate {
    std::array<int, Dim> corners;  // sorted
    int zone, opposite;
  };
  std::vector<Candidate> candidates;
  for (int b = 0; b < model.block_count(); ++b) {
    if (!takes_part[b]) continue;
    for (int z = model.block_zones[b]; z < model.block_zones[b + 1]; ++z) {
      const auto faces = faces_of(model.zones[z]);
      for (int i = 0; i <= Dim; ++i) candidates.push_back({sorted(faces[i]), z, i});
    }
  }
  std::stable_sort(candidates.begin(), candidates.end(),
                   [](const Candidate& a, const Candidate& b) { return a.corners < b.corners; });
  const auto joined = joined_faces(model, gridpoints_of(model, takes_part));

  std::vector<OutlineFace<Dim>> result;
  for (std::size_t i = 0; i < candidates.size();) {
    const auto& [corners, zone, opposite] = candidates[i];
    std::size_t next = i + 1;
    while (next < candidates.size() && candidates[next].corners == corners) ++next;
    const bool alone = next == i + 1;
    i = next;
    if (!alone || std::binary_search(joined.begin(), joined.end(), corners)) continue;
    const Vec<Dim> gradient = opposite_gradient(geometry, zone, opposite);
    const double steepness = norm(gradient);
    OutlineFace<Dim> face{faces_of(model.zones[zone])[opposite],
                          zone,
                          {},
                          gradient * (-1.0 / steepness),
                          Dim * geometry.volume[zone] * steepness};
    for (int g : face.gridpoints) face.centre += model.position[g] * (1.0 / Dim);
    result.push_back(face);
  }
  std::stable_sort(result.begin(), result.end(),
                   [](const auto& a, const auto& b) { return a.zone < b.zone; });
  return result;
}

template <int Dim>
std::vector<int> earlier_faces(const std::vector<OutlineFace<Dim>>& earlier,
                               const std::vector<OutlineFace<Dim>>& now) {
  // both are in the order of their zones
  const auto same = [](const OutlineFace<Dim>& a, const OutlineFace<Dim>& b) {
    return a.zone == b.zone && a.gridpoints == b.gridpoints;
  };
  const auto find = [&](const std::vector<OutlineFace<Dim>>& faces, const OutlineFace<Dim>& face) {
    auto at = std::ranges::lower_bound(faces, face.zone, {}, &OutlineFace<Dim>::zone);
    while (at != faces.end() && at->zone == face.zone && !same(*at, face)) ++at;
    return at != faces.end() && at->zone == face.zone ? static_cast<int>(at - faces.begin()) : -1;
  };
  std::vector<int> left;
  for (int f = 0; f < std::ssize(earlier); ++f)
    if (find(now, earlier[f]) < 0) left.push_back(f);
  std::vector<int> result;
  for (const OutlineFace<Dim>& face : now) {
    int of = find(earlier, face);
    if (of < 0 && !left.empty()) {
      const auto distance = [&](int f) {
        const bool looks_elsewhere = dot(earlier[f].normal, face.normal) < kLooksAlike;
        return std::pair(looks_elsewhere, norm(earlier[f].centre - face.centre));
      };
      of = *std::ranges::min_element(left, {}, distance);
    }
    result.push_back(of);
  }
  return result;
}

template std::vector<int> earlier_faces(const std::vector<OutlineFace<2>>&,
                                        const std::vector<OutlineFace<2>>&);
template std::vector<int> earlier_faces(const std::vector<OutlineFace<3>>&,
                                        const std::vector<OutlineFace<3>>&);
template std::vector<bool> gridpoints_of(const ModelOf<2>&, const std::vector<bool>&);
template std::vector<bool> gridpoints_of(const ModelOf<3>&, const std::vector<bool>&);
template std::vector<OutlineFace<2>> outline(const ModelOf<2>&, const ZoneGeometry<2>&,
                                             const std::vector<bool>&);
template std::vector<OutlineFace<3>> outline(const ModelOf<3>&, const ZoneGeometry<3>&,
                                             const std::vector<bool>&);

}  // namespace pyroclast
