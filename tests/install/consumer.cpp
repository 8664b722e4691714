// A project that knows only the installed package: tears one contact apart and asks what that took.
#include <cmath>

#include <pyroclast/laws/cohesive.hpp>
#include <pyroclast/laws/contact_properties.hpp>
#include <pyroclast/units/units.hpp>

int main() {
  using pyroclast::Cohesive;
  Cohesive::Properties<double> p;
  p.normal_stiffness = pyroclast::parse_quantity("18400 GPa/m", pyroclast::unit::stiffness_per_area);
  p.shear_stiffness = 7660e9;
  p.tensile_strength = 2.5e6;
  p.mode_1_energy = 60.0;
  p.compressive_limit = 31e6;
  p.hardening = 0.05;
  p.cohesion = 3.8e6;
  p.mode_2_energy = 240.0;
  pyroclast::validate(p, "contact");
  Cohesive::Internals<2, double> internals;
  Cohesive::Losses<double> lost{};
  Cohesive::update<2, double>(Cohesive::derive(p), 1e-4, {}, internals, lost);
  return std::abs(lost.tension - 60.0) < 1e-9 ? 0 : 1;
}
