#include <algorithm>
#include <cmath>
#include <cstdio>
#include <vector>

#include <gtest/gtest.h>

#include "bodies.hpp"
#include "known.hpp"

/// Blister: a layer over a crack that water pushes open, as before a piece of a heated face leaves.
namespace pyroclast::blister_test {
namespace {

using namespace bodies;

constexpr double young = 24e9, poisson = 0.2;
constexpr double height = 0.01;  // m, of the layer
constexpr double energy = 30.0;  // J/m², of the plane in which it tears off

/// Pressure [Pa] at which a clamped strip over a crack 2 a tears off, plane stress: each tip's
/// G = 2 p² a⁴ / (3 E h³) is the fracture energy.
double clamped(double a) {
  return std::sqrt(1.5 * young * std::pow(height, 3) * energy / std::pow(a, 4));
}

/// The same by beams whose roots turn as those of a double cantilever beam, by M 0.64 h / (E I) (Hashemi,
/// Kinloch and Williams, Proc. R. Soc. A 427, 1990), and shear. G is the slope of the work of pressure.
double with_turning_roots(double a) {
  const double r = 0.64 * height / a, shear = 2.4 * (1.0 + poisson) * 0.75 * std::pow(height / a, 2);
  const double slope = 4.0 / 3.0 - 2.0 / 9.0 * (5.0 + 6.0 * r) / std::pow(1.0 + r, 2);
  return clamped(a) / std::sqrt(slope / (2.0 / 9.0) + shear);
}

/// Half of a layer of square blocks on blocks that are held, free to slide on them, with an open crack from
/// x = 0 to a. Returns the pressure [Pa] at which the first face behind the crack is torn apart.
/// \param steps  of a tenth part of the loading's pace: about half a vibration
double tearing_pressure(int rows, double a, int steps) {
  const double d = height / rows, length = a + 4.0 * height;
  const int nx = static_cast<int>(std::lround(length / d)), ny = rows + 1;
  ModelOf<2> model = lattice(nx, ny, [&](double x, double y) { return Vec<2>{{x * length, y * ny * d}}; });
  model.interface_names = {"layer", "plane", "crack"};
  auto layer = mortar_contact();
  layer.normal_stiffness = young / 20e-6;
  layer.shear_stiffness = layer.normal_stiffness / (2.0 * (1.0 + poisson));
  layer.tensile_strength = layer.cohesion = layer.residual_cohesion = 1e9;
  layer.mode_1_energy = layer.mode_2_energy = 1e6;
  layer.compressive_limit = 1e12;
  auto plane = layer;
  plane.shear_stiffness *= 1e-3;
  plane.tensile_strength = 15e6;  // softens over some 7 mm of the plane, by (E G_f h³ / f_t²)^(1/4)
  plane.mode_1_energy = energy;
  auto crack = plane;
  crack.tensile_strength = 1.0;
  crack.mode_1_energy = 1e-9;
  std::vector<int> open, tip;
  for (int c = 0; c < model.contact_count(); ++c) {
    auto& contact = model.contacts[c];
    const int first = model.face_contacts[contact.face];
    const Vec<2> x =
        0.5 * (model.position[model.contacts[first].a] + model.position[model.contacts[first + 1].a]);
    if (std::abs(x[1] - d) > 1e-9) continue;
    contact.interface = x[0] < a ? 2 : 1;
    if (x[0] < a) open.push_back(c);
    if (x[0] > a && x[0] < a + d) tip.push_back(c);
  }
  auto properties =
      by_interface(model, std::vector<ZoneProperties>(model.zones.size(), zone_properties<2>(young, poisson)),
                   {layer, plane, crack});
  Mechanics<2> m(model, {2400.0}, properties, settling<2>(steps));
  for (int g = 0; g < model.gridpoint_count(); ++g)
    for (int i = 0; i < 2; ++i)
      if (model.block_of(g) < nx || (i == 0 && model.position[g][0] < 1e-9))
        m.constraints().prescribe_velocity(g, i, 0.0);
  double p = 0.6 * clamped(a);
  for (int paces = 10;; paces = 2) {
    properties.pore_pressure.assign(model.contacts.size(), 0.0);
    for (const int c : open) properties.pore_pressure[c] = p;
    m.set_properties(properties);
    m.advance(paces * steps);
    if (std::ranges::all_of(tip,
                            [&](int c) { return m.read().remembered(c, Remembers::tension_damage) >= 1.0; }))
      return p;
    if (p > 2.0 * clamped(a)) return NAN;
    p += 0.01 * clamped(a);
  }
}

TEST(BlisterVerification, ALayerOfFourBlocksTearsOffAsAClampedStripDoes) {
  const double a = 6.0 * height, exact = clamped(a);
  expect_known(
      {"Pressure that tears off a layer of four blocks over a crack of twelve times its height",
       "clamped strip, 2 p^2 a^4 / (3 E h^3) = G_f at each tip; roots that turn make it 17 % less", "Pa"},
      tearing_pressure(4, a, 2500), exact, 0.1 * exact);
}

// With finer blocks it nears that of turning roots. It takes minutes: docs/validation/spalling.md has what it
// prints.
TEST(Blister, DISABLED_NearsThatOfTurningRoots) {
  for (const double ratio : {6.0, 10.0})
    for (const int rows : {4, 8}) {
      const double a = ratio * height;
      const double p = tearing_pressure(rows, a, static_cast<int>(1250 * rows * ratio * ratio / 36.0));
      std::printf(
          "a / h %g, %d blocks: %.2f of the clamped strip's pressure, %.2f of that with turning roots\n",
          ratio, rows, p / clamped(a), p / with_turning_roots(a));
    }
}

}  // namespace
}  // namespace pyroclast::blister_test
