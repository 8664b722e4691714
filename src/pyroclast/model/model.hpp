#pragma once

#include <array>
#include <cstdint>
#include <iterator>
#include <map>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "pyroclast/base/chunked_sum.hpp"
#include "pyroclast/base/vec.hpp"

namespace pyroclast {

/// Contact point without its directions: joins gridpoint `a` to gridpoint `b` of another block.
struct Joint {
  int a, b;       ///< gridpoints
  int face;       ///< shared face, see Model::face_contacts
  int interface;  ///< index into Model::interface_names
  double area;    ///< tributary area, m² (2D: half the edge times the thickness)
  /// Size that the blocks there were to have, m, which stiffnesses follow; 0: blocks are alike.
  double block_size = 0.0;
};

template <int Dim>
struct Contact : Joint {
  Vec<Dim> normal;                         ///< unit normal, from a to b
  std::array<Vec<Dim>, Dim - 1> tangents;  ///< unit tangents, right-handed and orthogonal with `normal`
};

/// Plane across an axis behind which the mirror image of a body stands: a side of the specimen lies in it,
/// and gridpoints there do not leave it.
struct PlaneOfSymmetry {
  std::string side;        ///< name of the side
  int component = 0;       ///< component of a position across the plane
  double at = 0.0;         ///< this component in the plane, m
  std::string deck_place;  ///< place in the deck that asks for it, for messages

  /// Returns the name of the set of gridpoints in the plane, those of bearings included.
  std::string set() const { return side + "_symmetry"; }
};

/// Place of a part in the body of which one rank holds it: its own chunks, and of others the blocks that its
/// own ones touch. See part_of.
struct PartOfBody {
  std::shared_ptr<Ranks> ranks;
  std::vector<int> rank_of_chunk;  ///< rank that owns each chunk of the part
  // numbers in the whole of the part's items
  std::vector<int> chunk, block, gridpoint, zone, contact;
  int zones_of_whole = 0;
};

/// Body of deformable blocks, as flat arrays. It holds geometry only: no state, no material parameters.
///
/// Every block owns its gridpoints and zones, which stand together in the arrays. Consecutive blocks make a
/// chunk, the unit of sums, files and ranks. Blocks meet only through contacts. In 2D a zone is a triangle
/// and a face is an edge with two contact points. In 3D a zone is a tetrahedron and a face is a polygon of 3
/// to 15 corners with a contact point at each.
///
/// A model is a ModelOf<2> or a ModelOf<3>. Code that need not know which one shows places and directions in
/// three numbers; in 2D the third is 0.
struct Model {
  virtual ~Model() = default;

  double thickness = 1.0;  ///< thickness out of plane, m (2D only; 1 in 3D)

  std::vector<int> block_gridpoints{0};  ///< gridpoints of block i: [i] to [i + 1]
  std::vector<int> block_zones{0};       ///< zones of block i: [i] to [i + 1]
  std::vector<int> block_material;       ///< index into material_names
  std::vector<int> chunk_blocks{0};      ///< blocks of chunk i: [i] to [i + 1]
  std::vector<int> face_contacts{0};     ///< contacts of shared face i: [i] to [i + 1]

  std::vector<std::string> material_names;
  std::vector<std::string> interface_names;
  int bearing_materials =
      0;  ///< number of materials that belong to bearings, not to the specimen; these are the last ones
  int bearing_interfaces = 0;  ///< number of interfaces between bearings and specimen; they are the last

  std::map<std::string, std::vector<int>, std::less<>> sets;          ///< gridpoints of each set, by name
  std::map<std::string, std::vector<int>, std::less<>> contact_sets;  ///< contacts of each set, by name

  std::vector<PlaneOfSymmetry> symmetry;

  std::shared_ptr<const PartOfBody> part;  ///< null for a whole body

  virtual int dimension() const = 0;  ///< Returns 2 or 3.
  /// Returns the place of a gridpoint in the reference configuration, m.
  virtual Vec<3> place(int gridpoint) const = 0;
  virtual std::span<const int> gridpoints_of_zone(int zone) const = 0;
  virtual const Joint& joint(int contact) const = 0;
  virtual Vec<3> normal(int contact) const = 0;
  /// Returns the volume of each zone, m³. Throws Error as zone_geometry does.
  virtual std::vector<double> zone_volumes() const = 0;
  /// Returns the extent of a contact by which cracks are measured: its length, m, in 2D, its area, m², in 3D.
  double extent(int contact) const { return joint(contact).area / thickness; }

  /// Returns a set by its name. Throws Error naming it when the model has none.
  const std::vector<int>& set(std::string_view name) const;

  bool is_of_bearing(int block) const {
    return block_material[block] >= std::ssize(material_names) - bearing_materials;
  }
  /// Tells whether a contact is between a bearing and the specimen.
  bool is_of_bearing(const Joint& contact) const {
    return contact.interface >= std::ssize(interface_names) - bearing_interfaces;
  }

  // The next functions return the chunks of the lists of blocks, gridpoints and zones.
  ChunkList chunks() const;
  ChunkList gridpoint_chunks() const { return chunks_of(block_gridpoints); }
  ChunkList zone_chunks() const { return chunks_of(block_zones); }

  int block_count() const { return static_cast<int>(block_material.size()); }
  int block_of(int gridpoint) const;
  int gridpoint_count() const { return block_gridpoints.back(); }
  int zone_count() const { return block_zones.back(); }
  /// Returns the zones of the whole body, also of a part of it.
  int whole_zone_count() const { return part ? part->zones_of_whole : zone_count(); }
  /// Returns the ranks that hold the body.
  Ranks& ranks() const { return part ? *part->ranks : one_rank(); }
  int contact_count() const { return face_contacts.back(); }
  int face_count() const { return static_cast<int>(face_contacts.size()) - 1; }

  /// Cuts the body into chunks of another number of blocks.
  void cut_into_chunks(int most_blocks);

 protected:
  explicit Model(int dimension);
  Model(const Model&) = default;
  Model(Model&&) = default;
  Model& operator=(const Model&) = default;
  Model& operator=(Model&&) = default;
  void put_into_chunk(int block);

 private:
  int blocks_of_a_chunk_;  ///< largest number of blocks in a chunk

  ChunkList chunks_of(const std::vector<int>& of_block) const;
};

template <int Dim>
struct ModelOf final : Model {
  ModelOf() : Model(Dim) {}

  std::vector<Vec<Dim>> position;               ///< gridpoints, reference configuration, m
  std::vector<std::array<int, Dim + 1>> zones;  ///< gridpoints of each zone, positively oriented
  std::vector<Contact<Dim>> contacts;

  int dimension() const override { return Dim; }
  Vec<3> place(int gridpoint) const override { return resized<3>(position[gridpoint]); }
  std::span<const int> gridpoints_of_zone(int zone) const override { return zones[zone]; }
  const Joint& joint(int contact) const override { return contacts[contact]; }
  Vec<3> normal(int contact) const override { return resized<3>(contacts[contact].normal); }
  std::vector<double> zone_volumes() const override;

  /// Appends a block and returns its index. The block's zones index its own gridpoints from 0. A chunk takes
  /// up to blocks_of_a_chunk blocks; blocks of bearings stand in chunks of their own.
  int add_block(const std::vector<Vec<Dim>>& gridpoints,
                const std::vector<std::array<int, Dim + 1>>& block_zones, int material);

  /// Joins a face of one block to the coinciding face of another: corner i of `a` to corner i of `b`, both as
  /// gridpoint indices of the model. The corners are ordered so that the normal points out of a's block into
  /// b's (2D: the edge direction turned clockwise, for a block walked counter-clockwise; 3D: right-handed).
  /// In 3D zones meet the face in the triangles of the fan from its first corner. All contact points of a
  /// face have the frame of its mean plane, with the first tangent along its first edge; each has its share
  /// of the area. Throws Error for a face without area, and for one without 2 corners in 2D or 3 to 15 in 3D.
  /// \param block_size  as of the joints
  void join_faces(const std::vector<int>& a, const std::vector<int>& b, int interface,
                  double block_size = 0.0);
};

/// Switch of dimension: calls `f` with a model as what it is, a ModelOf<2> or a ModelOf<3>.
template <class F>
decltype(auto) with_dimension(const Model& model, F f) {
  if (model.dimension() == 2) return f(static_cast<const ModelOf<2>&>(model));
  return f(static_cast<const ModelOf<3>&>(model));
}

/// Returns the largest number of blocks in a chunk of a body that is made from now on. The last digits of
/// sums depend on it. Tests set another number by the environment variable PYROCLAST_CHUNK_BLOCKS. Throws
/// Error where that is no whole number above 0.
int blocks_of_a_chunk(int dimension);

/// Gridpoints over which something is summed, ascending.
struct GridpointSet {
  std::vector<int> gridpoints;
  ChunkList chunks;
  int whole_count = 0;  ///< gridpoints of the set in the whole body
};

/// Makes a set: a collective.
GridpointSet gridpoint_set(const Model& model, std::vector<int> gridpoints);

/// Contacts of a body chunk by chunk: a contact between two chunks belongs to the earlier one.
struct ContactsByChunk {
  std::vector<int> contacts;  ///< numbers of contacts, ascending within a chunk
  ChunkList chunks;           ///< chunks of this list
};

ContactsByChunk contacts_by_chunk(const Model& model);

/// Returns those of the contacts of `all` that stand in `some`, chunk by chunk.
ContactsByChunk contacts_by_chunk(const ContactsByChunk& all, const std::vector<int>& some);

/// Geometry of zones that the solvers read in every step.
template <int Dim>
struct ZoneGeometry {
  std::vector<std::array<Vec<Dim>, Dim>>
      gradient;                ///< first Dim gradients of shape functions, 1/m; the last is minus their sum
  std::vector<double> volume;  ///< m³
};

/// Computes the geometry of zones. Throws Error naming the zone when one has no positive volume.
template <int Dim>
ZoneGeometry<Dim> zone_geometry(const ModelOf<Dim>& model);

/// Returns the block of each zone.
std::vector<int> zone_blocks(const Model& model);
/// Returns the block of each gridpoint.
std::vector<int> gridpoint_blocks(const Model& model);

/// Contact sides at each gridpoint, as compressed lists.
struct GridpointContacts {
  std::vector<int> begin;         ///< contacts of gridpoint i: entries [i] to [i + 1]
  std::vector<int> contact_side;  ///< twice the contact's index, plus one on side b
};

GridpointContacts gridpoint_contacts(const Model& model);

extern template struct ModelOf<2>;
extern template struct ModelOf<3>;

}  // namespace pyroclast
