#include "pyroclast/model/model.hpp"

#include <algorithm>

#include <fmt/format.h>

#include "pyroclast/base/error.hpp"
#include "pyroclast/model/zone_shape.hpp"

namespace pyroclast {

namespace {

struct FaceFrame2 {
  double area;
  Vec<2> normal;
  std::array<Vec<2>, 1> tangents;
};

FaceFrame2 face_frame(const std::array<Vec<2>, 2>& corner, double thickness) {
  const Vec<2> along = corner[1] - corner[0];
  const double length = norm(along);
  const Vec<2> t = along * (1.0 / length);
  return {length * thickness, {{t[1], -t[0]}}, {t}};
}

struct FaceFrame3 {
  double area;
  Vec<3> normal;
  std::array<Vec<3>, 2> tangents;
};

FaceFrame3 face_frame(const std::array<Vec<3>, 3>& corner, double) {
  const Vec<3> along = corner[1] - corner[0];
  const Vec<3> doubled = cross(along, corner[2] - corner[0]);
  const double twice_area = norm(doubled);
  const Vec<3> n = doubled * (1.0 / twice_area);
  const Vec<3> t = along * (1.0 / norm(along));
  return {0.5 * twice_area, n, {t, cross(n, t)}};
}

}  // namespace

template <int Dim>
int Model<Dim>::add_block(const std::vector<Vec<Dim>>& gridpoints,
                          const std::vector<std::array<int, Dim + 1>>& new_zones, int material) {
  const int offset = gridpoint_count();
  position.insert(position.end(), gridpoints.begin(), gridpoints.end());
  for (auto zone : new_zones) {
    for (int& g : zone) g += offset;
    zones.push_back(zone);
  }
  block_gridpoints.push_back(gridpoint_count());
  block_zones.push_back(zone_count());
  block_material.push_back(material);
  return block_count() - 1;
}

template <int Dim>
void Model<Dim>::join_faces(const std::array<int, Dim>& a, const std::array<int, Dim>& b, int interface) {
  std::array<Vec<Dim>, Dim> corner;
  for (int i = 0; i < Dim; ++i) corner[i] = position[a[i]];
  const auto frame = face_frame(corner, thickness);
  if (!(frame.area > 0.0))
    throw Error(fmt::format("face at gridpoint {} has no area, so no contact can stand on it", a[0]));
  const int face = contacts.empty() ? 0 : contacts.back().face + 1;
  for (int i = 0; i < Dim; ++i)
    contacts.push_back({a[i], b[i], face, interface, frame.area / Dim, frame.normal, frame.tangents});
}

template <int Dim>
const std::vector<int>& Model<Dim>::set(std::string_view name) const {
  if (const auto found = sets.find(name); found != sets.end()) return found->second;
  throw Error(fmt::format("the model has no set of gridpoints \"{}\"", name));
}

template <int Dim>
int Model<Dim>::block_of(int gridpoint) const {
  const auto after = std::upper_bound(block_gridpoints.begin(), block_gridpoints.end(), gridpoint);
  return static_cast<int>(after - block_gridpoints.begin()) - 1;
}

template <int Dim>
ZoneGeometry<Dim> zone_geometry(const Model<Dim>& model) {
  ZoneGeometry<Dim> geometry;
  geometry.gradient.resize(model.zones.size());
  geometry.volume.resize(model.zones.size());
  for (std::size_t z = 0; z < model.zones.size(); ++z) {
    std::array<Vec<Dim>, Dim + 1> x;
    for (int i = 0; i <= Dim; ++i) x[i] = model.position[model.zones[z][i]];
    geometry.volume[z] = shape_gradients<Dim>(x, geometry.gradient[z]) * model.thickness;
    if (!(geometry.volume[z] > 0.0))
      throw Error(
          fmt::format("zone {} has volume {:g} m3, but it must be greater than 0", z, geometry.volume[z]));
  }
  return geometry;
}

template <int Dim>
std::vector<int> zone_blocks(const Model<Dim>& model) {
  std::vector<int> block(model.zones.size());
  for (int b = 0; b < model.block_count(); ++b)
    for (int z = model.block_zones[b]; z < model.block_zones[b + 1]; ++z) block[z] = b;
  return block;
}

template <int Dim>
GridpointContacts gridpoint_contacts(const Model<Dim>& model) {
  GridpointContacts list;
  list.begin.assign(model.position.size() + 1, 0);
  for (const auto& c : model.contacts) {
    ++list.begin[c.a + 1];
    ++list.begin[c.b + 1];
  }
  for (std::size_t i = 1; i < list.begin.size(); ++i) list.begin[i] += list.begin[i - 1];
  list.contact_side.resize(list.begin.back());
  auto next = list.begin;
  for (int c = 0; c < model.contact_count(); ++c) {
    list.contact_side[next[model.contacts[c].a]++] = 2 * c;
    list.contact_side[next[model.contacts[c].b]++] = 2 * c + 1;
  }
  return list;
}

template struct Model<2>;
template struct Model<3>;
template ZoneGeometry<2> zone_geometry(const Model<2>&);
template ZoneGeometry<3> zone_geometry(const Model<3>&);
template std::vector<int> zone_blocks(const Model<2>&);
template std::vector<int> zone_blocks(const Model<3>&);
template GridpointContacts gridpoint_contacts(const Model<2>&);
template GridpointContacts gridpoint_contacts(const Model<3>&);

}  // namespace pyroclast
