#pragma once

#include <span>

#include "pyroclast/mechanics/body.hpp"
#include "pyroclast/mechanics/energy_ledger.hpp"
#include "pyroclast/mechanics/reader.hpp"

namespace pyroclast {

/// Sums over a body or a set of its gridpoints, chunk by chunk.
template <int Dim>
class Totals {
 public:
  explicit Totals(const Body<Dim>& body) : body_(body), read_(body) {}

  Vec<Dim> mean_displacement(const GridpointSet& set) const;    ///< m
  Vec<Dim> total_force(const GridpointSet& set) const;          ///< N, sum of Reader::force
  Vec<Dim> total_applied_force(const GridpointSet& set) const;  ///< N
  Vec<Dim> total_weight(const GridpointSet& set) const;         ///< N, weight of the real mass
  double total_moving_mass(const GridpointSet& set) const;      ///< kg
  /// Returns the acceleration of a set's mean by a force of 1 N on the set, 1/kg.
  /// \param weights  share of each gridpoint in the mean and in the force
  double mobility(const GridpointSet& set, std::span<const double> weights) const;
  /// Sums the forces on all free components: weight, loads and reactions together, N. The sum is zero when
  /// the body as a whole is in equilibrium.
  Vec<Dim> net_force() const;

  /// Returns the energies at the displacements from which the last step started. Kinetic energy is
  /// half m v(t - dt/2) v(t + dt/2). With it, central differences conserve the sum of energies exactly in a
  /// linear body, so the ledger's error comes from the contacts.
  EnergyLedger energy() const;
  /// Returns the work of the present pore pressures on the present openings, J.
  double work_of_pore_pressure() const;
  /// Returns the mean unbalanced force over the mean force that zones, contacts and gravity apply to the
  /// gridpoints. An applied force below that of a strain of 1e-10 counts as that force: so a body without
  /// load is at rest too.
  double unbalanced_ratio() const;
  double mean_unbalanced_force() const;  ///< Returns the mean over the gridpoints, N.
  /// Returns the largest jump over the length of its edge, in 3D over the mean size of a block. Contacts with
  /// small displacements are exact while this ratio is small.
  double largest_relative_jump() const;

 private:
  EnergyLedger energies() const;
  Dissipation dissipated() const;

  const Body<Dim>& body_;
  Reader<Dim> read_;
};

extern template class Totals<2>;
extern template class Totals<3>;

}  // namespace pyroclast
