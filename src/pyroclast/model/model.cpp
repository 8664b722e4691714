#include "pyroclast/model/model.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "pyroclast/base/environment.hpp"
#include "pyroclast/base/error.hpp"
#include "pyroclast/model/zone_shape.hpp"

namespace pyroclast {

namespace {

template <int Dim>
struct FaceFrame {
  Vec<Dim> normal;
  std::array<Vec<Dim>, Dim - 1> tangents;
  std::vector<double> area;  ///< area of each corner, m²
};

FaceFrame<2> face_frame(const std::vector<Vec<2>>& corner, double thickness) {
  const Vec<2> along = corner[1] - corner[0];
  const double length = norm(along);
  const Vec<2> t = along * (1.0 / length);
  return {{{t[1], -t[0]}}, {t}, {length * thickness / 2, length * thickness / 2}};
}

/// Returns the frame of a face. Each corner has a third of the triangles at it, as seen along the mean
/// normal: zones on those triangles give it the same shares.
FaceFrame<3> face_frame(const std::vector<Vec<3>>& corner, double) {
  std::vector<Vec<3>> doubled;  // twice the area vectors of the triangles (0, i, i + 1)
  Vec<3> all{};
  for (std::size_t i = 1; i + 1 < corner.size(); ++i) {
    doubled.push_back(cross(corner[i] - corner[0], corner[i + 1] - corner[0]));
    all += doubled.back();
  }
  const Vec<3> n = all * (1.0 / norm(all));
  const Vec<3> edge = corner[1] - corner[0];
  const Vec<3> along = edge - n * dot(edge, n);
  const Vec<3> t = along * (1.0 / norm(along));
  FaceFrame<3> frame{n, {t, cross(n, t)}, std::vector<double>(corner.size())};
  for (std::size_t i = 1; i + 1 < corner.size(); ++i)
    for (std::size_t at : {std::size_t{0}, i, i + 1}) frame.area[at] += dot(doubled[i - 1], n) / 6.0;
  return frame;
}

}  // namespace

template <int Dim>
int ModelOf<Dim>::add_block(const std::vector<Vec<Dim>>& gridpoints,
                            const std::vector<std::array<int, Dim + 1>>& new_zones, int material) {
  const int offset = gridpoint_count();
  position.insert(position.end(), gridpoints.begin(), gridpoints.end());
  for (auto zone : new_zones) {
    for (int& g : zone) g += offset;
    zones.push_back(zone);
  }
  block_gridpoints.push_back(static_cast<int>(position.size()));
  block_zones.push_back(static_cast<int>(zones.size()));
  block_material.push_back(material);
  put_into_chunk(block_count() - 1);
  return block_count() - 1;
}

int blocks_of_a_chunk(int dimension) {
  constexpr int kInPlane = 1024, kInSpace = 512;  // a block in space has some six times as many zones
  constexpr const char* kVariable = "PYROCLAST_CHUNK_BLOCKS";
  const std::string stated = environment(kVariable);
  if (stated.empty()) return dimension == 2 ? kInPlane : kInSpace;
  const auto blocks = number_in_environment(kVariable);
  if (!blocks || *blocks < 1)
    throw Error(
        fmt::format("{}={}: the blocks of a chunk are a whole number above 0; leave the variable out, it is "
                    "for tests",
                    kVariable, stated));
  return *blocks;
}

Model::Model(int dimension) : blocks_of_a_chunk_(blocks_of_a_chunk(dimension)) {}

void Model::put_into_chunk(int block) {
  const bool begins = block == 0 || block - chunk_blocks[chunk_blocks.size() - 2] >= blocks_of_a_chunk_ ||
                      is_of_bearing(block) != is_of_bearing(block - 1);
  if (begins)
    chunk_blocks.push_back(block + 1);
  else
    chunk_blocks.back() = block + 1;
}

void Model::cut_into_chunks(int most_blocks) {
  blocks_of_a_chunk_ = most_blocks;
  chunk_blocks = {0};
  for (int block = 0; block < block_count(); ++block) put_into_chunk(block);
}

ChunkList Model::chunks() const {
  if (!part) return ChunkList(chunk_blocks);
  std::vector<bool> is_foreign;
  for (const int rank : part->rank_of_chunk) is_foreign.push_back(rank != part->ranks->me());
  return ChunkList(chunk_blocks, std::move(is_foreign), *part->ranks);
}

ChunkList Model::chunks_of(const std::vector<int>& of_block) const {
  std::vector<int> begins;
  for (const int block : chunk_blocks) begins.push_back(of_block[block]);
  return chunks().of(std::move(begins));
}

namespace {

/// Returns the number of blocks of a solid whose faces surely have fewer corners than contacts can join.
/// Along a rim the corners of a face are as many as sides of the rim that it meets, and go with the size of a
/// block. \param corners  most corners of a face with `blocks` blocks
int blocks_for(std::size_t corners, int blocks) {
  constexpr double kUsual = 11.0;  // most corners of faces within a body
  return static_cast<int>(std::ceil(blocks * std::pow(static_cast<double>(corners) / kUsual, 3)));
}

}  // namespace

template <int Dim>
void ModelOf<Dim>::join_faces(const std::vector<int>& a, const std::vector<int>& b, int interface,
                              double block_size) {
  const std::size_t fewest = Dim, most = Dim == 2 ? 2 : 15;
  if (Dim == 3 && a.size() == b.size() && a.size() > most) {
    int blocks = 0;
    for (int block = 0; block < block_count(); ++block) blocks += is_of_bearing(block) ? 0 : 1;
    throw Error(fmt::format(
        "a face of a block has {} corners, but contacts can join {} at most: {} blocks are too few for "
        "the outline, take {} or more",
        a.size(), most, blocks, blocks_for(a.size(), blocks)));
  }
  if (a.size() != b.size() || a.size() < fewest || a.size() > most)
    throw Error(fmt::format("faces with {} and {} corners cannot be joined: both must have {}", a.size(),
                            b.size(), Dim == 2 ? "2" : "the same number, from 3 to 15"));
  std::vector<Vec<Dim>> corner;
  for (int g : a) corner.push_back(position[g]);
  const auto frame = face_frame(corner, thickness);
  const int face = face_count();
  for (std::size_t i = 0; i < a.size(); ++i) {
    if (!(frame.area[i] > 0.0))
      throw Error(fmt::format("face at gridpoint {} has no area, so no contact can stand on it", a[0]));
    contacts.push_back(
        {{a[i], b[i], face, interface, frame.area[i], block_size}, frame.normal, frame.tangents});
  }
  face_contacts.push_back(static_cast<int>(contacts.size()));
}

const std::vector<int>& Model::set(std::string_view name) const {
  if (const auto found = sets.find(name); found != sets.end()) return found->second;
  throw Error(fmt::format("the model has no set of gridpoints \"{}\"", name));
}

int Model::block_of(int gridpoint) const {
  const auto after = std::upper_bound(block_gridpoints.begin(), block_gridpoints.end(), gridpoint);
  return static_cast<int>(after - block_gridpoints.begin()) - 1;
}

/// Computes the gradients of a zone and returns its volume, m³. Throws Error where it has none.
template <int Dim>
double geometry_of(const ModelOf<Dim>& model, int zone, std::array<Vec<Dim>, Dim>& gradient) {
  std::array<Vec<Dim>, Dim + 1> x;
  for (int i = 0; i <= Dim; ++i) x[i] = model.position[model.zones[zone][i]];
  const double volume = shape_gradients<Dim>(x, gradient) * model.thickness;
  if (!(volume > 0.0))
    throw Error(fmt::format("zone {} has volume {:g} m3, but it must be greater than 0", zone, volume));
  return volume;
}

template <int Dim>
std::vector<double> ModelOf<Dim>::zone_volumes() const {
  std::vector<double> volumes(zones.size());
  std::array<Vec<Dim>, Dim> unused;
  for (std::size_t z = 0; z < zones.size(); ++z)
    volumes[z] = geometry_of<Dim>(*this, static_cast<int>(z), unused);
  return volumes;
}

template <int Dim>
ZoneGeometry<Dim> zone_geometry(const ModelOf<Dim>& model) {
  ZoneGeometry<Dim> geometry;
  geometry.gradient.resize(model.zones.size());
  geometry.volume.resize(model.zones.size());
  for (std::size_t z = 0; z < model.zones.size(); ++z)
    geometry.volume[z] = geometry_of<Dim>(model, static_cast<int>(z), geometry.gradient[z]);
  return geometry;
}

std::vector<int> zone_blocks(const Model& model) {
  return ChunkList(model.block_zones).of_items();
}

std::vector<int> gridpoint_blocks(const Model& model) {
  return ChunkList(model.block_gridpoints).of_items();
}

GridpointContacts gridpoint_contacts(const Model& model) {
  GridpointContacts list;
  list.begin.assign(model.gridpoint_count() + 1, 0);
  for (int c = 0; c < model.contact_count(); ++c) {
    ++list.begin[model.joint(c).a + 1];
    ++list.begin[model.joint(c).b + 1];
  }
  for (std::size_t i = 1; i < list.begin.size(); ++i) list.begin[i] += list.begin[i - 1];
  list.contact_side.resize(list.begin.back());
  auto next = list.begin;
  for (int c = 0; c < model.contact_count(); ++c) {
    list.contact_side[next[model.joint(c).a]++] = 2 * c;
    list.contact_side[next[model.joint(c).b]++] = 2 * c + 1;
  }
  return list;
}

GridpointSet gridpoint_set(const Model& model, std::vector<int> gridpoints) {
  std::sort(gridpoints.begin(), gridpoints.end());
  ChunkList chunks = model.gridpoint_chunks().of_some(gridpoints);
  const int count = chunks.whole_count();
  return {std::move(gridpoints), std::move(chunks), count};
}

ContactsByChunk contacts_by_chunk(const Model& model) {
  const ChunkList gridpoints = model.gridpoint_chunks();
  const auto chunk_of = [&](int gridpoint) {
    const auto& begins = gridpoints.begins();
    return static_cast<int>(std::upper_bound(begins.begin(), begins.end(), gridpoint) - begins.begin()) - 1;
  };
  std::vector<std::vector<int>> of_chunk(static_cast<std::size_t>(gridpoints.count()));
  for (int c = 0; c < model.contact_count(); ++c)
    of_chunk[std::min(chunk_of(model.joint(c).a), chunk_of(model.joint(c).b))].push_back(c);
  ContactsByChunk all;
  std::vector<int> begins{0};
  for (const auto& contacts : of_chunk) {
    all.contacts.insert(all.contacts.end(), contacts.begin(), contacts.end());
    begins.push_back(static_cast<int>(all.contacts.size()));
  }
  all.chunks = gridpoints.of(std::move(begins));
  return all;
}

ContactsByChunk contacts_by_chunk(const ContactsByChunk& all, const std::vector<int>& some) {
  std::vector<bool> is_in(all.contacts.size());
  for (const int c : some) is_in[c] = true;
  std::vector<int> places;
  for (std::size_t i = 0; i < all.contacts.size(); ++i)
    if (is_in[all.contacts[i]]) places.push_back(static_cast<int>(i));
  ContactsByChunk part{{}, all.chunks.of_some(places)};
  for (const int place : places) part.contacts.push_back(all.contacts[place]);
  return part;
}

template struct ModelOf<2>;
template struct ModelOf<3>;
template ZoneGeometry<2> zone_geometry(const ModelOf<2>&);
template ZoneGeometry<3> zone_geometry(const ModelOf<3>&);

}  // namespace pyroclast
