#pragma once

#include <array>
#include <cstdint>
#include <iterator>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "pyroclast/base/vec.hpp"

namespace pyroclast {

/// Contact point: joins gridpoint `a` to gridpoint `b` of another block.
template <int Dim>
struct Contact {
  int a, b;                                ///< gridpoints
  int face;                                ///< shared face, see Model::face_contacts
  int interface;                           ///< index into Model::interface_names
  double area;                             ///< tributary area, m² (2D: half the edge times the thickness)
  Vec<Dim> normal;                         ///< unit, from a to b
  std::array<Vec<Dim>, Dim - 1> tangents;  ///< unit, with `normal` right-handed and orthogonal
};

/// A body of deformable blocks, as flat arrays. Geometry only: no state, no material parameters.
///
/// Every block owns its gridpoints and zones, which stand together in the arrays. Blocks meet only through
/// contacts. In 2D a zone is a triangle and a face an edge with two contact points; in 3D a tetrahedron and a
/// polygon of 3 to 8 corners with a contact point at each.
template <int Dim>
struct Model {
  double thickness = 1.0;  ///< out of plane, m (2D only; 1 in 3D)

  std::vector<Vec<Dim>> position;               ///< gridpoints, reference configuration, m
  std::vector<int> block_gridpoints{0};         ///< gridpoints of block i: [i] to [i + 1]
  std::vector<int> block_zones{0};              ///< zones of block i: [i] to [i + 1]
  std::vector<int> block_material;              ///< index into material_names
  std::vector<std::array<int, Dim + 1>> zones;  ///< gridpoints of each zone, positively oriented
  std::vector<Contact<Dim>> contacts;
  std::vector<int> face_contacts{0};  ///< contacts of shared face i: [i] to [i + 1]

  std::vector<std::string> material_names;
  std::vector<std::string> interface_names;
  int bearing_materials =
      0;  ///< so many of the materials, the last ones, are of bearings, not of the specimen
  int bearing_interfaces = 0;  ///< likewise of the interfaces: between bearings and specimen

  std::map<std::string, std::vector<int>, std::less<>> sets;          ///< of gridpoints, by name
  std::map<std::string, std::vector<int>, std::less<>> contact_sets;  ///< likewise

  /// A set by its name. Throws Error naming it when the model has none.
  const std::vector<int>& set(std::string_view name) const;

  bool is_of_bearing(int block) const {
    return block_material[block] >= std::ssize(material_names) - bearing_materials;
  }
  /// Whether a contact is between a bearing and the specimen.
  bool is_of_bearing(const Contact<Dim>& contact) const {
    return contact.interface >= std::ssize(interface_names) - bearing_interfaces;
  }

  int block_count() const { return static_cast<int>(block_material.size()); }
  int block_of(int gridpoint) const;
  int gridpoint_count() const { return static_cast<int>(position.size()); }
  int zone_count() const { return static_cast<int>(zones.size()); }
  int contact_count() const { return static_cast<int>(contacts.size()); }
  int face_count() const { return static_cast<int>(face_contacts.size()) - 1; }

  /// Appends a block; its zones index its own gridpoints from 0. Returns the block's index.
  int add_block(const std::vector<Vec<Dim>>& gridpoints,
                const std::vector<std::array<int, Dim + 1>>& block_zones, int material);

  /// Joins a face of one block to the coinciding face of another: corner i of `a` to corner i of `b`, both
  /// gridpoint indices of the model, ordered so that the normal (2D: the edge direction turned clockwise, for
  /// a block walked counter-clockwise; 3D: right-handed) points out of a's block into b's. In 3D zones meet
  /// the face in the triangles of the fan from its first corner. All contact points of a face have the frame
  /// of its mean plane, the first tangent along its first edge, and each its share of the area. Throws Error
  /// for a face without area, and for one without 2 corners in 2D or 3 to 8 in 3D.
  void join_faces(const std::vector<int>& a, const std::vector<int>& b, int interface);
};

/// What follows from the geometry alone and the solvers read in every step.
template <int Dim>
struct ZoneGeometry {
  std::vector<std::array<Vec<Dim>, Dim>>
      gradient;                ///< of the first Dim shape functions, 1/m; the last is minus their sum
  std::vector<double> volume;  ///< m³
};

/// Throws Error naming the zone when one has no positive volume.
template <int Dim>
ZoneGeometry<Dim> zone_geometry(const Model<Dim>& model);

/// Block of each zone.
template <int Dim>
std::vector<int> zone_blocks(const Model<Dim>& model);

/// Compressed lists of the contact sides at each gridpoint.
struct GridpointContacts {
  std::vector<int> begin;         ///< contacts of gridpoint i: entries [i] to [i + 1]
  std::vector<int> contact_side;  ///< twice the contact's index, plus one on side b
};

template <int Dim>
GridpointContacts gridpoint_contacts(const Model<Dim>& model);

extern template struct Model<2>;
extern template struct Model<3>;

}  // namespace pyroclast
