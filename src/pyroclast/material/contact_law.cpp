#include "pyroclast/material/contact_law.hpp"

#include <fmt/format.h>

namespace pyroclast {

namespace {

[[noreturn]] void fail(const std::string& name, const char* quantity, double value,
                       const std::string& allowed) {
  throw Error(fmt::format("{}: {} = {:g}, but it must be {}", name, quantity, value, allowed));
}

void require(bool good, const std::string& name, const char* quantity, double value, const char* allowed) {
  if (!good) fail(name, quantity, value, allowed);
}

}  // namespace

void validate(const ContactProperties& p, const std::string& name) {
  require(p.normal_stiffness > 0.0, name, "K_n (Pa/m)", p.normal_stiffness, "greater than 0");
  require(p.shear_stiffness > 0.0, name, "K_s (Pa/m)", p.shear_stiffness, "greater than 0");
  if (p.behaviour == ContactBehaviour::elastic) return;
  require(p.tensile_strength >= 0.0, name, "f_t (Pa)", p.tensile_strength, "at least 0");
  require(p.mode_1_energy >= 0.0, name, "G_f1 (J/m2)", p.mode_1_energy, "at least 0");
  require(p.mode_2_energy >= 0.0, name, "G_f2 (J/m2)", p.mode_2_energy, "at least 0");
  require(p.compressive_limit > 0.0, name, "f_cm (Pa)", p.compressive_limit, "greater than 0");
  require(p.hardening > 0.0 && p.hardening < 1.0, name, "beta", p.hardening,
          "between 0 and 1, both exclusive");
  require(p.cohesion >= 0.0, name, "c_o (Pa)", p.cohesion, "at least 0");
  require(p.residual_cohesion >= 0.0 && p.residual_cohesion <= p.cohesion, name, "c_res (Pa)",
          p.residual_cohesion, "between 0 and c_o");
  require(p.friction >= 0.0, name, "tan(phi)", p.friction, "at least 0");
  require(p.residual_friction >= 0.0 && p.residual_friction <= p.friction, name, "tan(phi_res)",
          p.residual_friction, "between 0 and tan(phi)");
  const double snap_1 = p.tensile_strength * p.tensile_strength / (2.0 * p.normal_stiffness);
  if (p.tensile_strength != 0.0 && !(p.mode_1_energy > snap_1))
    fail(name, "G_f1 (J/m2)", p.mode_1_energy,
         fmt::format("greater than f_t^2 / (2 K_n) = {:g}, else softening snaps back", snap_1));
  // Where friction does not drop, tau_max - tau_res is largest at c_o - c_res; a drop in friction adds p
  // times it, which the limit f_cm bounds in the elastic range. Beyond it the law falls to the residual line.
  double drop = p.cohesion - p.residual_cohesion;
  if (p.friction > p.residual_friction && std::isfinite(p.compressive_limit))
    drop += p.compressive_limit * (p.friction - p.residual_friction);
  const double snap_2 = drop * drop / (2.0 * p.shear_stiffness);
  if (drop != 0.0 && !(p.mode_2_energy > snap_2))
    fail(name, "G_f2 (J/m2)", p.mode_2_energy,
         fmt::format("greater than (tau_max - tau_res)^2 / (2 K_s) = {:g}, else softening snaps back",
                     snap_2));
}

}  // namespace pyroclast
