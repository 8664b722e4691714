#pragma once

#include <array>
#include <string_view>
#include <vector>

#include "pyroclast/mechanics/body.hpp"
#include "pyroclast/mechanics/turning_frame.hpp"

namespace pyroclast {

/// State of one contact point at the displacements of the last forces. A point whose face is handed over to
/// found contacts keeps its internal variables and losses, and bears nothing: those contacts do.
struct ContactState {
  const LawTable* law = nullptr;
  int dimension = 0;              ///< dimension of the body, 2 or 3
  std::vector<double> internals;  ///< internal variables in the order of `law->internals(dimension)`
  std::vector<double> losses;     ///< losses since the start, in the order of `law->losses`
  double opening = 0.0;           ///< u_n, m
  Vec<2> tangential_jump{};       ///< u_s along the tangents, m; in 2D the second is 0
  double normal_traction = 0.0;   ///< of the law, Pa, tension positive; pore water pushes beside it
  Vec<2> shear_traction{};        ///< traction along the tangents, Pa
  double stored = 0.0;            ///< J/m²

  // Returns an internal variable; 0 where the law has none of this meaning or name.
  double remembered(Remembers what) const;
  double remembered(std::string_view name) const;
  double lost(std::string_view name) const;  ///< Returns a loss; 0 where the law has none of this name.
};

/// Reader of a body: shows the state of each gridpoint, zone and contact in the order of the model.
template <int Dim>
class Reader {
 public:
  explicit Reader(const Body<Dim>& body) : body_(body) {}

  Vec<Dim> displacement(int gridpoint) const;  ///< m
  Vec<Dim> velocity(int gridpoint) const;      ///< m/s
  /// Returns the sum of all forces at the last step, N; on a prescribed component minus the reaction.
  Vec<Dim> force(int gridpoint) const;
  Vec<Dim> applied_force(int gridpoint) const;  ///< N
  bool is_prescribed(int gridpoint, int component) const;
  double real_mass(int gridpoint) const { return body_.gravity_mass[gridpoint]; }  ///< kg
  double moving_mass(int gridpoint) const { return body_.mass[gridpoint]; }        ///< kg
  /// Returns the displacement to which the last forces belong, m.
  Vec<Dim> displacement_of_force(int gridpoint) const;

  SymmetricTensor<Dim> stress(int zone) const;  ///< Pa, at the displacements of the last forces
  /// Returns the stress in the zone's own frame, Pa.
  /// \param rotation  rotation of the frame, out
  SymmetricTensor<Dim> stress_in_own_frame(int zone, Rotation<Dim>& rotation) const;
  /// Returns the elastic strain of a zone, in the frame of the model; in 2D with the strain across the plane
  /// that leaves the zone free of stress there.
  SymmetricTensor<3> elastic_strain(int zone) const;
  /// Returns the properties of a zone; until creep is committed, they include the compliance that it adds.
  ZoneProperties properties_of_zone(int zone) const;
  /// Returns the creep strain of a zone, in the frame of the model, at the displacements of the last forces;
  /// while the zone creeps, the known part of it.
  SymmetricTensor<Dim> creep_strain(int zone) const;

  ContactState contact(int contact) const;
  /// Returns an internal variable of a contact; 0 where its law has none of this meaning.
  double remembered(int contact, Remembers what) const;
  double damage(int contact) const;      ///< Returns the largest damage of a contact by any mode.
  double crack_step(int contact) const;  ///< Returns the step noted by note_cracks, else kNotCracked.
  /// Returns u_n at the displacements of the last forces, m; of a torn face the distance of its sides there.
  double opening(int contact) const;
  /// Returns the directions of a contact at the displacements of the last forces.
  ContactFrame<Dim> frame_of_forces(int contact) const;
  /// Returns the gradient of a face at the present displacements, see TurningFrame.
  /// \param sign  1: the mean of those of its sides; -1: half of that of side a less that of side b
  typename TurningFrame<Dim>::Columns gradient(int face, double sign) const;
  /// Returns the longest way that a point of a face has slid, at the present displacements, m.
  double slide(int face) const;

  // The next functions return a value of each gridpoint, zone or contact.
  std::vector<Vec<Dim>> displacements() const;
  std::vector<Vec<Dim>> velocities() const;
  std::vector<Vec<Dim>> forces() const;
  std::vector<SymmetricTensor<Dim>> stresses() const;
  std::vector<ContactState> contacts() const;

 private:
  Vec<Dim> jump_of_forces(int contact) const;
  /// Turns a tensor of a zone's own frame into the frame of the model.
  SymmetricTensor<Dim> in_frame_of_model(const Rotation<Dim>& rotation,
                                         const SymmetricTensor<Dim>& tensor) const;
  // Param `moved`: returns the displacement of a gridpoint, m.
  template <class Moved>
  typename TurningFrame<Dim>::Columns gradient(int face, double sign, Moved moved) const;
  /// Returns the directions of a contact.
  template <class Moved>
  ContactFrame<Dim> frame(int contact, Moved moved) const;

  const Body<Dim>& body_;
};

extern template class Reader<2>;
extern template class Reader<3>;

}  // namespace pyroclast
