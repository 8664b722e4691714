// A project that knows only the installed package: tears one contact apart and asks what that took.
#include <cmath>

#include <pyroclast/material/contact_law.hpp>
#include <pyroclast/units/units.hpp>

int main() {
  pyroclast::ContactProperties p;
  p.normal_stiffness = pyroclast::parse_quantity("18400 GPa/m", pyroclast::unit::stiffness_per_area);
  p.shear_stiffness = 7660e9;
  p.tensile_strength = 2.5e6;
  p.mode_1_energy = 60.0;
  p.compressive_limit = 31e6;
  p.hardening = 0.05;
  pyroclast::validate(p, "contact");
  pyroclast::ContactHistory<2> history;
  const auto response = pyroclast::update_contact<2>(p, 1e-4, {}, history);
  return std::abs(response.dissipated.tension - 60.0) < 1e-9 ? 0 : 1;
}
