#pragma once

#include <cmath>

#include "bodies.hpp"

/// Bodies that are crushed until their pieces part and press each other, for tests of found contacts.
namespace pyroclast::bodies {

/// Contact that breaks early and slides easily.
inline Cohesive::Properties<double> brittle() {
  auto contact = mortar_contact();
  contact.mode_1_energy = 3.0;
  contact.mode_2_energy = 12.0;
  contact.residual_friction_angle = 0.3;
  return contact;
}

template <int Dim>
MechanicsParameters crushing() {
  auto p = quasi_static<Dim>(0.5);
  p.time_step = 1e-6;
  p.found.is_on = true;
  p.zones_for_a_thread = 1;
  if (Dim == 2) {
    p.kinematics = Kinematics::finite;
    p.found.damping = 0.1;
  }
  return p;
}

inline constexpr double kCrushedSize = 0.1;  // m

/// Holds the lower side of a specimen of kCrushedSize and drives the upper one down. The last direction is
/// up.
template <int Dim>
void crush(Mechanics<Dim>& m) {
  constexpr int kUp = Dim - 1;
  const double speed = Dim == 2 ? 0.5 : 0.01 * kCrushedSize / (1000 * m.time_step());
  for (int g = 0; g < m.model().gridpoint_count(); ++g) {
    const double height = m.model().position[g][kUp];
    const bool is_low = std::abs(height) < 1e-9, is_high = std::abs(height - kCrushedSize) < 1e-9;
    for (int i = 0; i < Dim; ++i)
      if (is_low || (is_high && (i == kUp || Dim == 3)))
        m.constraints().prescribe_velocity(g, i, is_high && i == kUp ? -speed : 0.0);
  }
}

}  // namespace pyroclast::bodies
