#include <gtest/gtest.h>

#include "bodies.hpp"
#include "known.hpp"
#include "pyroclast/base/error.hpp"
#include "pyroclast/material/concrete.hpp"
#include "pyroclast/mechanics/mechanics.hpp"
#include "pyroclast/model/sets.hpp"

/// Bodies whose temperature changes: stresses, contacts and the energy ledger.
// of its own, as tests of a module are one unit
namespace pyroclast::thermal_stress_test {
namespace {

using namespace bodies;

constexpr double young = 29.4e9, poisson = 0.2;

/// One material and one interface, at one free thermal strain.
template <int Dim>
BodyProperties uniform(const ModelOf<Dim>& model, const ContactProperties& contact, double thermal_strain,
                       double modulus = young) {
  return by_interface(
      model,
      std::vector<ZoneProperties>(model.zones.size(), zone_properties<Dim>(modulus, poisson, thermal_strain)),
      {contact});
}

/// Elastic, and giving way by `softness` of what a bar of that length and modulus does.
Elastic::Properties<double> stiff_contact(double softness, double length, double modulus = young) {
  auto p = elastic_contact();
  p.normal_stiffness = p.shear_stiffness = modulus / (softness * length);
  return p;
}

/// Lets gridpoints at these values of a coordinate not move along it.
template <int Dim>
void hold(Mechanics<Dim>& m, int component, std::initializer_list<double> at) {
  const auto& x = m.model().position;
  for (int g = 0; g < m.model().gridpoint_count(); ++g)
    for (double value : at)
      if (std::abs(x[g][component] - value) < 1e-12) m.constraints().prescribe_velocity(g, component, 0.0);
}

template <int Dim>
double largest_stress(const Mechanics<Dim>& m) {
  double largest = 0.0;
  for (const auto& stress : m.read().stresses())
    for (double s : stress) largest = std::max(largest, std::abs(s));
  return largest;
}

template <int Dim>
double largest_traction(const Mechanics<Dim>& m) {
  double largest = 0.0;
  for (const auto& c : m.read().contacts())
    largest = std::max({largest, std::abs(c.normal_traction), norm(c.shear_traction)});
  return largest;
}

// ---- Free expansion

template <int Dim>
void expect_no_stress_in_the_expanded_body(const ModelOf<Dim>& model) {
  const double strain = 1e-3;
  auto m = mechanics(model, mortar_contact(), quasi_static<Dim>());
  m.set_properties(uniform(model, mortar_contact(), strain));
  EXPECT_GT(largest_stress(m), young * strain);  // it was held when it got hot
  impose(
      m, [&](const Vec<Dim>& x) { return strain * x; }, 8);
  // Strain is a difference of displacements of strain times size over a zone's length: round-off 1e-16 times
  // size over length, a few hundred here.
  EXPECT_LT(largest_stress(m), 1e-12 * young * strain);
  EXPECT_LT(largest_traction(m), 1e-12 * young * strain);
}

TEST(FreeExpansionVerification, LeavesNoStressWhereGridpointsMoveByThermalStrain) {
  expect_no_stress_in_the_expanded_body(tessellated(150, 0.1, 0.1, 4));
  expect_no_stress_in_the_expanded_body(five_tetrahedra());
}

TEST(FreeExpansionVerification, IsWhatAnIrregularBodySettlesAt) {
  const double strain = 1e-3;
  const ModelOf<2> model = tessellated(40, 0.1, 0.1, 4);
  auto m = mechanics(model, elastic_contact(), settling<2>(40));
  m.set_properties(uniform(model, elastic_contact(), strain));
  m.advance(2000);
  // at rest to round-off: what is left is that of the field above
  expect_known_field(
      {"Stress of a body that expands freely, over E alpha dT", "no restraint, no stress", "1"},
      largest_stress(m) / (young * strain), 1.0, 1e-12);
  EXPECT_LT(largest_traction(m), 1e-12 * young * strain);
}

// ---- Restraint

/// Largest deviation of a zone's stress from a uniform one without shear.
double deviation(const Mechanics<2>& m, double xx, double yy) {
  double worst = 0.0;
  for (const auto& s : m.read().stresses())
    worst = std::max({worst, std::abs(s[0] - xx), std::abs(s[1] - yy), std::abs(s[2])});
  return worst;
}

TEST(RestraintVerification, AColumnBetweenFixedEndsTakesTheStressOfZonesAndContactsInSeries) {
  const int n = 5;
  const double d = 0.01, strain = 1e-4, free = young * strain;
  const ModelOf<2> model = column(n, d);
  const auto error_with = [&](double softness, double steps) {
    const auto contact = stiff_contact(softness, d);
    auto m = mechanics(model, contact, settling<2>(steps));
    m.constraints().prescribe_velocity(0, 0, 0.0);
    hold(m, 1, {0.0, n * d});
    m.set_properties(uniform(model, contact, strain));
    m.advance(25000);
    // n blocks that would lengthen by strain, n - 1 contacts between them
    return deviation(m, 0.0, -free / (1.0 + softness * (n - 1) / n)) / free;
  };
  // 1e-9: settled, which takes the stiff contacts that many steps; they come to E alpha dT within 1e-3
  const Known known{"Stress of a heated column between fixed ends, over E alpha dT",
                    "zones and contacts in series", "1"};
  expect_known_field(known, error_with(0.5, 10), 1.0, 1e-9);
  expect_known_field(known, error_with(1e-3, 200), 1.0, 1e-9);
}

TEST(RestraintVerification, ASquareBetweenSlidingPlatesTakesTheBiaxialStressOfZonesAndContactsInSeries) {
  const int n = 4;
  const double d = 0.01, strain = 1e-4, softness = 1e-2;
  const ModelOf<2> model = lattice(n, n, [&](double s, double t) { return Vec<2>{{n * d * s, n * d * t}}; });
  const auto contact = stiff_contact(softness, d);
  auto m = mechanics(model, contact, settling<2>(30));
  for (int i : {0, 1}) hold(m, i, {0.0, n * d});
  m.set_properties(uniform(model, contact, strain));
  m.advance(1000);
  const double free = young * strain / (1.0 - poisson);
  const double series = free / (1.0 + softness / (1.0 - poisson) * (n - 1) / n);
  expect_known_field({"Biaxial stress of a heated square between sliding plates, over E alpha dT / (1 - nu)",
                      "zones and contacts in series", "1"},
                     deviation(m, -series, -series) / free, 1.0, 1e-9);  // settled
}

// The contacts of an irregular body have no series formula; what they take off is in proportion to 1 / K.
TEST(RestraintVerification, AnIrregularBodyWithAFixedOutlineComesToTheBiaxialStressAsContactsGetStiff) {
  const double size = 0.1, strain = 1e-4;
  const ModelOf<2> model = tessellated(25, size, size, 4);
  const double free = young * strain / (1.0 - poisson);
  const auto error_with = [&](double softness) {
    const auto contact = stiff_contact(softness, size / 5.0);
    auto m = mechanics(model, contact, settling<2>(60));
    for (int g = 0; g < model.gridpoint_count(); ++g)
      for (int i : {0, 1})
        if (const double x = model.position[g][i]; x == 0.0 || x == size)
          for (int j : {0, 1}) m.constraints().prescribe_velocity(g, j, 0.0);
    m.set_properties(uniform(model, contact, strain));
    m.advance(4000);
    return deviation(m, -free, -free) / free;
  };
  const double stiff = error_with(1e-2), stiffer = error_with(1e-3);
  expect_known_field(
      {"Biaxial stress of an irregular body with a fixed outline, contacts of 0.1 % of the compliance",
       "E alpha dT / (1 - nu)", "1"},
      stiffer, 1.0, 5e-3);  // a few times the softness, where small blocks crowd
  EXPECT_NEAR(stiffer, 0.1 * stiff, 0.05 * 0.1 * stiff);  // linear but for the square of 1e-2 times a few
}

template <int Dim>
void expect_heat_stored(const ModelOf<Dim>& model, double volume) {
  const double strain = 1e-4;
  auto m = mechanics(model, mortar_contact(), quasi_static<Dim>());
  for (int i = 0; i < Dim; ++i)
    for (int g = 0; g < model.gridpoint_count(); ++g) m.constraints().prescribe_velocity(g, i, 0.0);
  m.set_properties(uniform(model, mortar_contact(), strain));
  const double stress = young * strain / (1.0 - (Dim - 1) * poisson);
  for (const auto& s : m.read().stresses())
    for (int i = 0; i < Dim; ++i) EXPECT_NEAR(s[i], -stress, 1e-12 * stress);
  expect_known({Dim == 2 ? "Energy that heating puts into a body held everywhere, plane stress"
                         : "Energy that heating puts into a body held everywhere, 3D",
                "stress times strain over two", "J"},
               m.totals().energy().property_change, 0.5 * Dim * stress * strain * volume,
               1e-12 * stress * strain * volume);
  EXPECT_NEAR(m.totals().energy().zones, m.totals().energy().property_change,
              1e-12 * m.totals().energy().property_change);

  const Mechanics<Dim> hot(model, {2400.0}, uniform(model, mortar_contact(), strain), quasi_static<Dim>());
  EXPECT_NEAR(hot.totals().energy().property_change, m.totals().energy().property_change,
              1e-12 * m.totals().energy().property_change);
  EXPECT_NEAR(hot.totals().energy().error(), 0.0, 1e-12 * m.totals().energy().property_change);
}

TEST(RestraintVerification, ABodyHeldEverywhereTakesTheFullStressAndStoresTheHeat) {
  expect_heat_stored(tessellated(40, 0.1, 0.1, 4), 0.1 * 0.1);
  expect_heat_stored(five_tetrahedra(), 1.0);
}

// ---- Cooling

/// A material whose free strain has a slope of its own on cooling.
BlockMaterial contracting_material() {
  BlockMaterial material;
  material.thermal_strain = Curve::table({20.0, 820.0}, {0.0, 8e-3}, temperature_axis());
  material.contraction = 6e-6;
  return material;
}

/// A body that is held everywhere, heated, cooled and heated again.
template <int Dim>
void expect_stress_of_its_own_slope(const ModelOf<Dim>& model, Kinematics kinematics) {
  const BlockMaterial material = contracting_material();
  auto parameters = quasi_static<Dim>();
  parameters.kinematics = kinematics;
  auto m = mechanics(model, elastic_contact(), parameters);
  for (int g = 0; g < model.gridpoint_count(); ++g)
    for (int i = 0; i < Dim; ++i) m.constraints().prescribe_velocity(g, i, 0.0);
  const double over_strain = Dim == 2 ? young / (1.0 - poisson) : young / (1.0 - 2.0 * poisson);
  double hottest = 20.0;
  for (const auto& [T, strain] : {std::pair{420.0, 4e-3}, {20.0, 1.6e-3}, {320.0, 3.4e-3}, {520.0, 5e-3}}) {
    hottest = std::max(hottest, T);
    m.set_properties(uniform(model, elastic_contact(), material.free_strain(T, hottest)));
    m.advance(1);
    for (const auto& stress : m.read().stresses())
      expect_known({std::string("Stress of a held body after heating and on cooling, ") +
                        (Dim == 2 ? "plane stress" : "tetrahedra"),
                    "-E / (1 - (Dim - 1) nu) [strain(T_max) - contraction (T_max - T)]", "Pa"},
                   stress[0], -over_strain * strain, 1e-9 * over_strain * strain);
  }
}

TEST(CoolingVerification, AHeldBodyTakesTheStressOfItsOwnSlope) {
  expect_stress_of_its_own_slope<2>(column(1, 0.01), Kinematics::small);
  expect_stress_of_its_own_slope<2>(column(1, 0.01), Kinematics::finite);
  expect_stress_of_its_own_slope<3>(cubes(1, 0.01), Kinematics::small);
  expect_stress_of_its_own_slope<3>(cubes(1, 0.01), Kinematics::finite);
}

// ---- Thick cylinder

/// Hoop stress at the inner and outer radius of a quarter of a ring, hotter inside, steady, plane stress:
/// means over each pack of blocks at one radius, continued linearly from the two packs next to a surface.
std::array<double, 2> surface_hoop_stress(double a, double b, int packs, int columns, double modulus,
                                          double thermal_strain, double softness) {
  const ModelOf<2> model = lattice(packs, columns, [&](double s, double t) {
    return turned({{a + (b - a) * s, 0.0}}, 0.5 * std::numbers::pi * t);
  });
  const auto contact = stiff_contact(softness, (b - a) / packs, modulus);
  auto m = mechanics(model, contact, settling<2>(800), modulus, poisson);
  for (int i : {0, 1}) hold(m, i, {0.0});  // symmetry
  auto properties = uniform(model, contact, 0.0, modulus);
  for (int z = 0; z < model.zone_count(); ++z)
    for (int g : model.zones[z])
      properties.zones[z].thermal_strain +=
          thermal_strain / 3.0 * std::log(b / norm(model.position[g])) / std::log(b / a);
  m.set_properties(properties);
  m.advance(8000);
  EXPECT_LT(m.totals().unbalanced_ratio(), 1e-6);  // stresses change by 1e-5 from here on

  const auto volume = zone_geometry(model).volume;
  const auto block = zone_blocks(model);
  std::vector<double> hoop(packs), radius(packs), weight(packs);
  for (int z = 0; z < model.zone_count(); ++z) {
    Vec<2> centre{};
    for (int g : model.zones[z]) centre += model.position[g] * (1.0 / 3.0);
    const double r = norm(centre);
    const auto polar = rotated<2>({centre[0] / r, -centre[1] / r}, m.read().stresses()[z]);
    const int pack = block[z] % packs;
    hoop[pack] += volume[z] * polar[1];
    radius[pack] += volume[z] * r;
    weight[pack] += volume[z];
  }
  for (int i = 0; i < packs; ++i) {
    hoop[i] /= weight[i];
    radius[i] /= weight[i];
  }
  const auto continued = [&](double r, int nearest, int next) {
    return hoop[nearest] +
           (hoop[next] - hoop[nearest]) * (r - radius[nearest]) / (radius[next] - radius[nearest]);
  };
  return {continued(a, 0, 1), continued(b, packs - 1, packs - 2)};
}

// Timoshenko and Goodier, Theory of Elasticity, art. 151 (long cylinder) with plane stress for plane strain.
TEST(ThickCylinderVerification, TakesTheHoopStressesOfALogarithmicTemperature) {
  const double a = 0.05, b = 0.1, modulus = 20e9, thermal_strain = 1e-5 * 100.0;
  const double l = std::log(b / a);
  const auto exact = [&](double r) {
    return modulus * thermal_strain / (2.0 * l) *
           (1.0 - std::log(b / r) - a * a / (b * b - a * a) * (1.0 + b * b / (r * r)) * l);
  };
  EXPECT_NEAR(exact(a), -12.24e6, 0.01e6);
  EXPECT_NEAR(exact(b), 7.76e6, 0.01e6);
  const auto [inner, outer] = surface_hoop_stress(a, b, 16, 14, modulus, thermal_strain, 3e-3);
  // 2 %: linear continuation over half of a pack of sixteen (a curved line), contacts that give way by 0.3 %
  const std::string source = "Timoshenko and Goodier, Theory of Elasticity, art. 151";
  expect_known({"Hoop stress inside a ring, hotter inside", source, "Pa"}, inner, exact(a),
               0.02 * std::abs(exact(a)));
  expect_known({"Hoop stress outside a ring, hotter inside", source, "Pa"}, outer, exact(b),
               0.02 * std::abs(exact(b)));
}

// ---- Spheres

/// Radial and hoop stress, Pa.
struct PolarStress {
  double radial = 0.0, hoop = 0.0;
};

/// Means of the stresses over the volume of each shell of a body made by octant().
std::vector<PolarStress> of_shells(const Mechanics<3>& m, int n) {
  const ModelOf<3>& model = m.model();
  const auto volume = zone_geometry(model).volume;
  const auto block = zone_blocks(model);
  std::vector<PolarStress> mean(model.block_count() / (3 * n * n));
  std::vector<double> weight(mean.size());
  for (int z = 0; z < model.zone_count(); ++z) {
    Vec<3> centre{};
    for (int g : model.zones[z]) centre += model.position[g] * 0.25;
    const Vec<3> r = centre * (1.0 / norm(centre));
    const auto s = m.read().stress(z);
    const double radial = s[0] * r[0] * r[0] + s[1] * r[1] * r[1] + s[2] * r[2] * r[2] +
                          2.0 * (s[3] * r[0] * r[1] + s[4] * r[1] * r[2] + s[5] * r[2] * r[0]);
    const int shell = block[z] / (3 * n * n);
    mean[shell].radial += volume[z] * radial;
    mean[shell].hoop += volume[z] * 0.5 * (s[0] + s[1] + s[2] - radial);
    weight[shell] += volume[z];
  }
  for (std::size_t i = 0; i < mean.size(); ++i) {
    mean[i].radial /= weight[i];
    mean[i].hoop /= weight[i];
  }
  return mean;
}

/// Root of the mean square error over both stresses of all shells, over a scale.
double error_of_shells(const std::vector<PolarStress>& found, const std::vector<PolarStress>& exact,
                       double scale) {
  double sum = 0.0;
  for (std::size_t i = 0; i < found.size(); ++i)
    sum += std::pow(found[i].radial - exact[i].radial, 2) + std::pow(found[i].hoop - exact[i].hoop, 2);
  return std::sqrt(sum / (2.0 * static_cast<double>(found.size()))) / scale;
}

/// Steps to rest, and half of the slowest vibration, for each block along an edge of a patch.
constexpr int kStepsOfSpheres = 800, kSettlingOfSpheres = 100;
constexpr double kHollow = 0.05, kOutside = 0.1;  // radii, m

/// The closed form c + d / r + e / r^3 of the radial stress, of which the hoop stress is c + d / (2 r) -
/// e / (2 r^3), as means over the volume of each shell.
std::vector<PolarStress> exact_of_shells(const std::vector<double>& radii, double c, double d, double e) {
  std::vector<PolarStress> exact;
  for (std::size_t i = 0; i + 1 < radii.size(); ++i) {
    const double from = radii[i], to = radii[i + 1], cube = std::pow(to, 3) - std::pow(from, 3);
    const double over_r = 1.5 * (to * to - from * from) / cube, over_cube = 3.0 * std::log(to / from) / cube;
    exact.push_back({c + d * over_r + e * over_cube, c + 0.5 * d * over_r - 0.5 * e * over_cube});
  }
  return exact;
}

/// Means of the stresses of an octant's shells when it has come to rest between its planes of symmetry.
std::vector<PolarStress> shells_at_rest(Mechanics<3>& m, int n) {
  for (int i : {0, 1, 2}) hold(m, i, {0.0});
  m.advance(kStepsOfSpheres * n);
  EXPECT_LT(m.totals().unbalanced_ratio(), 2e-5);
  return of_shells(m, n);
}

/// Errors of the stresses of a thick sphere, over the largest of the closed form: under a pressure inside,
/// and steadily hotter inside.
std::array<double, 2> thick_sphere_errors(int n) {
  const double a = kHollow, b = kOutside, cubes = b * b * b - a * a * a;
  std::vector<double> radii;
  for (int i = 0; i <= 2 * n; ++i) radii.push_back(a * std::pow(b / a, 0.5 * i / n));
  const ModelOf<3> model = octant(radii, n);
  const auto contact = stiff_contact(1e-3, a / n);

  constexpr double pressure = 1e6;
  auto pressed = mechanics(model, contact, settling<3>(kSettlingOfSpheres * n), young, poisson);
  std::vector<Vec<3>> force(model.position.size());
  for (const Face& face : faces_of(model)) {
    if (!std::ranges::all_of(face.gridpoints(),
                             [&](int g) { return std::abs(norm(model.position[g]) - a) < 1e-9; }))
      continue;
    for (const int g : face.gridpoints()) force[g] += face.normal * (-pressure * face.area / 3.0);
  }
  for (int g = 0; g < model.gridpoint_count(); ++g) pressed.constraints().apply_force(g, force[g]);
  const double held = pressure * a * a * a / cubes;
  const double of_pressure = error_of_shells(shells_at_rest(pressed, n),
                                             exact_of_shells(radii, held, 0.0, -held * b * b * b), pressure);

  constexpr double thermal_strain = 1e-3;  // of the hollow's face
  auto heated = mechanics(model, contact, settling<3>(kSettlingOfSpheres * n), young, poisson);
  auto properties = uniform(model, contact, 0.0);
  for (int z = 0; z < model.zone_count(); ++z)
    for (int g : model.zones[z])
      properties.zones[z].thermal_strain +=
          0.25 * thermal_strain * a / (b - a) * (b / norm(model.position[g]) - 1.0);
  heated.set_properties(properties);
  const double scale = young * thermal_strain / (1.0 - poisson), k = scale * a * b / cubes;
  const double of_heat = error_of_shells(
      shells_at_rest(heated, n),
      exact_of_shells(radii, k * (a + b), -k * (b * b + a * b + a * a), k * a * a * b * b), scale);
  return {of_pressure, of_heat};
}

// Timoshenko and Goodier, Theory of Elasticity, art. 136 (Lamé) and 152. Promise: errors at least halve where
// blocks do.
TEST(ThickSphereVerification, TakesTheStressesOfAPressureAndOfASteadyTemperature) {
  const auto coarse = thick_sphere_errors(2), fine = thick_sphere_errors(4);
  const char* const source[] = {"Lame; Timoshenko and Goodier, Theory of Elasticity, art. 136",
                                "Timoshenko and Goodier, Theory of Elasticity, art. 152"};
  const char* const what[] = {"under a pressure inside, over the pressure",
                              "hotter inside, over E alpha dT / (1 - nu)"};
  for (int i : {0, 1}) {
    expect_known_field(
        {std::string("Stresses of a thick sphere ") + what[i] + ", means of shells", source[i], "1"}, fine[i],
        1.0, 0.01);
    EXPECT_GT(std::log2(coarse[i] / fine[i]), 0.9);
  }
}

// Promise: a ball that expands more than the large body around it takes the pressure
// misfit / (1 / (3 K) + 1 / (4 G)), K of the ball and G of the body.
TEST(InclusionVerification, ABallInALargeBodyTakesThePressureOfItsMisfit) {
  constexpr double radius = 0.01, misfit = 1e-3, ball_young = 70e9, ball_poisson = 0.15;
  constexpr int n = 4, ball_shells = 2, shells = 12;
  std::vector<double> radii{0.0, 0.5 * radius};
  for (int i = 0; i <= shells - ball_shells; ++i)  // to five times the ball: 0.5 % less than an endless body
    radii.push_back(radius * std::pow(5.0, static_cast<double>(i) / (shells - ball_shells)));
  const ModelOf<3> model = octant(radii, n, ball_shells);
  const auto contact = stiff_contact(3e-3, 0.5 * radius);
  auto properties = uniform(model, contact, 0.0);
  const auto block = zone_blocks(model);
  for (int z = 0; z < model.zone_count(); ++z)
    if (model.block_material[block[z]] == 0)
      properties.zones[z] = zone_properties<3>(ball_young, ball_poisson, misfit);
  Mechanics<3> m(model, {2400.0, 2400.0}, properties, settling<3>(kSettlingOfSpheres * n));
  const auto found = shells_at_rest(m, n);
  const double bulk = ball_young / (3.0 * (1.0 - 2.0 * ball_poisson));
  const double shear = young / (2.0 * (1.0 + poisson));
  const double pressure = misfit / (1.0 / (3.0 * bulk) + 1.0 / (4.0 * shear));
  for (int shell = 0; shell < ball_shells; ++shell)
    for (const auto& [stress, which] :
         {std::pair{found[shell].radial, "Radial"}, std::pair{found[shell].hoop, "Hoop"}})
      expect_known({std::string(which) + " stress of a ball that expands more than the large body around it",
                    "misfit / (1 / (3 K) + 1 / (4 G))", "Pa"},
                   stress, -pressure, 0.03 * pressure);
}

// ---- Total form

TEST(TotalFormVerification, ALoadedColumnShortensAsItsModulusFallsAndReturnsOnCooling) {
  const int n = 4;
  const double d = 0.01, pressure = 1e6;
  const ModelOf<2> model = column(n, d);
  auto m = mechanics(model, elastic_contact(), settling<2>(20));
  m.constraints().prescribe_velocity(0, 0, 0.0);
  for (int g : {0, 1}) m.constraints().prescribe_velocity(g, 1, 0.0);
  const int top = 4 * n - 2;
  for (int g : {top, top + 1}) m.constraints().apply_force(g, {{0.0, -pressure * d / 2.0}});
  struct Stage {
    double stiffness_left, thermal_strain;
  };
  for (const auto& [left, thermal] : {Stage{1.0, 0.0}, {0.7, 2e-3}, {0.2, 8e-3}, {1.0, 0.0}}) {
    auto contact = elastic_contact();
    contact.normal_stiffness *= left;
    contact.shear_stiffness *= left;
    m.set_properties(uniform(model, contact, thermal, young * left));
    const double expected =
        thermal - pressure / (left * young) - pressure * (n - 1) / (n * d * contact.normal_stiffness);
    m.advance(3000);
    // 1e-9: settled
    for (int g : {top, top + 1})
      expect_known({"Strain of a loaded column that softens, expands and cools",
                    "total form, zones and contacts in series", "1"},
                   m.read().displacements()[g][1] / (n * d), expected, 1e-9 * std::abs(expected));
  }
}

// ---- Contacts at changing temperature

/// The upper of two blocks, moved as a whole.
class ContactAtTemperature : public testing::Test {
 protected:
  void move(const Vec<2>& jump) {
    for (int g = 0; g < 8; ++g)
      for (int i : {0, 1})
        body_.constraints().prescribe_velocity(
            g, i, g < 4 ? 0.0 : (jump[i] - body_.read().displacement(g)[i]) / (10 * body_.time_step()));
    body_.advance(10);
    for (int g = 4; g < 8; ++g)
      for (int i : {0, 1}) body_.constraints().prescribe_velocity(g, i, 0.0);
    body_.advance(1);
  }
  void heat(const ContactProperties& hot) {
    validate(hot, "hot");
    body_.set_properties(uniform(model_, hot, 0.0));
  }
  ContactState state() const { return body_.read().contact(0); }

  const ModelOf<2> model_ = column(2, 0.01);
  const Cohesive::Properties<double> cold_ = mortar_contact();
  Mechanics<2> body_ = mechanics(model_, cold_, quasi_static<2>());
};

TEST_F(ContactAtTemperature, CarriesDamageOnUnchangedThroughHeatingAndCooling) {
  move({{0.0, 20e-6}});
  move({{0.0, 10e-6}});
  const ContactState before = state();
  EXPECT_GT(before.remembered(Remembers::tension_damage), 0.4);
  EXPECT_LT(before.remembered(Remembers::tension_damage), 0.5);

  auto hot = cold_;
  hot.normal_stiffness *= 0.5;
  hot.tensile_strength *= 0.4;
  hot.mode_1_energy *= 0.3;
  heat(hot);
  EXPECT_EQ(state().remembered(Remembers::tension_damage), before.remembered(Remembers::tension_damage));
  const double damage = before.remembered(Remembers::tension_damage);
  const double kappa = hot.elastic_opening() + damage * (hot.ultimate_opening() - hot.elastic_opening());
  ASSERT_LT(10e-6, kappa);  // it unloads in the new law too
  const double expected = (1.0 - damage) * hot.tensile_strength * 10e-6 / kappa;
  EXPECT_NEAR(state().normal_traction, expected, 1e-9 * expected);

  heat(cold_);
  EXPECT_EQ(state().remembered(Remembers::tension_damage), before.remembered(Remembers::tension_damage));
  EXPECT_EQ(state().normal_traction, before.normal_traction);
  EXPECT_EQ(state().lost("tension"), before.lost("tension"));
}

TEST_F(ContactAtTemperature, ComesBackToTheShrunkenTensionEnvelope) {
  const double opening = 0.9 * cold_.elastic_opening();
  move({{0.0, opening}});
  EXPECT_EQ(state().remembered(Remembers::tension_damage), 0.0);
  auto hot = cold_;
  hot.tensile_strength *= 0.5;
  hot.mode_1_energy *= 0.5;
  heat(hot);
  // on the new softening line from (u_e, f_t) to (u_f, 0)
  const double expected = hot.tensile_strength * (hot.ultimate_opening() - opening) /
                          (hot.ultimate_opening() - hot.elastic_opening());
  EXPECT_NEAR(state().normal_traction, expected, 1e-9 * expected);
  const double damage = state().remembered(Remembers::tension_damage);
  EXPECT_GT(damage, 0.0);
  heat(cold_);
  EXPECT_EQ(state().remembered(Remembers::tension_damage), damage);
  EXPECT_LT(state().normal_traction, cold_.normal_stiffness * opening);
}

TEST_F(ContactAtTemperature, ComesBackToTheShrunkenShearEnvelopeWithFriction) {
  const double pressure = 10e6, jump = 8e6 / cold_.shear_stiffness;
  move({{jump, -pressure / cold_.normal_stiffness}});
  EXPECT_EQ(state().lost("slip_path"), 0.0);
  auto hot = cold_;
  hot.cohesion *= 0.2;
  hot.residual_cohesion *= 0.2;
  hot.mode_2_energy *= 0.2;
  heat(hot);
  const double slip = state().lost("slip_path"), damage = state().remembered(Remembers::shear_damage);
  const double cohesion = (1.0 - damage) * hot.cohesion + damage * hot.residual_cohesion;
  const double strength = cohesion + pressure * std::tan(hot.friction_angle);
  const double ultimate_slip = 2.0 * hot.mode_2_energy / (hot.cohesion - hot.residual_cohesion);
  EXPECT_GT(slip, 0.0);
  EXPECT_NEAR(damage, slip / ultimate_slip, 1e-9 * damage);
  EXPECT_NEAR(norm(state().shear_traction), strength, 1e-9 * strength);
  EXPECT_NEAR(norm(state().shear_traction), hot.shear_stiffness * (jump - slip), 1e-9 * strength);
  EXPECT_NEAR(state().normal_traction, -pressure, 1e-9 * pressure);

  heat(cold_);
  EXPECT_EQ(state().lost("slip_path"), slip);
  EXPECT_EQ(state().remembered(Remembers::shear_damage), damage);
}

TEST_F(ContactAtTemperature, ComesBackToTheShrunkenCompressionEnvelope) {
  const double pressure = 25e6, closing = pressure / cold_.normal_stiffness;
  move({{0.0, -closing}});
  EXPECT_EQ(state().remembered(Remembers::closure), 0.0);
  auto hot = cold_;
  hot.compressive_limit = 10e6;
  heat(hot);
  const double expected = -(10e6 + hot.hardening * (pressure - 10e6));
  EXPECT_NEAR(state().normal_traction, expected, 1e-9 * pressure);
  const double closure = state().remembered(Remembers::closure);
  EXPECT_NEAR(closure, closing + expected / hot.normal_stiffness, 1e-9 * closing);
  heat(cold_);
  EXPECT_EQ(state().remembered(Remembers::closure), closure);
  EXPECT_NEAR(state().normal_traction, -cold_.normal_stiffness * (closing - closure), 1e-9 * pressure);
}

// ---- Energy

/// Two kinds of blocks at the same temperature, one of which expands more; everything gets weaker and softer.
template <int Dim>
BodyProperties mixture(const ModelOf<Dim>& model, const ContactProperties& cold, double rise) {
  const double left = 1.0 - rise / 1000.0;
  ContactProperties contact = cold;
  for (std::size_t i = 0; i < contact.numbers.size(); ++i)
    if (contact.law->properties[i].role != Role::plain) contact.numbers[i] *= left;
  std::vector<ZoneProperties> zones;
  for (int block : zone_blocks(model))
    zones.push_back(zone_properties<Dim>((block % 3 == 0 ? 70e9 : young) * left, poisson,
                                         (block % 3 == 0 ? 6e-6 : 14e-6) * rise));
  return by_interface(model, zones, {contact});
}

const std::vector<double> heating_and_cooling{100.0, 200.0, 350.0, 500.0, 300.0, 100.0};

/// Loads a body on a fixed plate by a force on its top, then heats and cools it, a number of steps at each
/// temperature. Expects that a change of temperature is no error of the ledger.
template <int Dim>
Mechanics<Dim> heated_under_load(const ModelOf<Dim>& model, const ContactProperties& contact,
                                 const MechanicsParameters& parameters, double size,
                                 const std::vector<double>& rises, int steps,
                                 std::shared_ptr<Team> team = nullptr) {
  const int up = Dim - 1;
  Mechanics<Dim> m(model, {2400.0}, mixture(model, contact, 0.0), parameters, std::move(team));
  for (int g = 0; g < model.gridpoint_count(); ++g)
    for (int i = 0; i < Dim; ++i)
      if (model.position[g][up] == 0.0) m.constraints().prescribe_velocity(g, i, 0.0);
  int loaded = 0;
  for (const auto& x : model.position) loaded += x[up] == size;
  Vec<Dim> force{};
  force[0] = 0.1e6 * std::pow(size, Dim - 1) / loaded;
  force[up] = -4e6 * std::pow(size, Dim - 1) / loaded;
  for (int g = 0; g < model.gridpoint_count(); ++g)
    if (model.position[g][up] == size) m.constraints().apply_force(g, force);
  m.advance(steps);
  for (double rise : rises) {
    const double before = m.totals().energy().error();
    m.set_properties(mixture(model, contact, rise));
    EXPECT_NEAR(m.totals().energy().error(), before, 1e-12 * turnover(m.totals().energy()))
        << rise;  // round-off
    m.advance(steps);
  }
  return m;
}

template <int Dim>
void expect_exact_ledger(const ModelOf<Dim>& model, double size) {
  for (const double damping : {0.0, 0.5})
    for (const MassChoice mass : {MassChoice::real, MassChoice::scaled})
      for (const int steps : {1, 300}) {
        auto parameters = quasi_static<Dim>(damping);
        parameters.mass = mass;
        parameters.viscous_damping = 100.0 * damping;
        parameters.gravity[Dim - 1] = -9.81;
        const auto e =
            heated_under_load(model, elastic_contact(), parameters, size, heating_and_cooling, steps)
                .totals()
                .energy();
        EXPECT_GT(e.property_change, 0.0);
        EXPECT_EQ(e.mass_scaling == 0.0, mass == MassChoice::real);
        // Central differences conserve energy exactly where forces are linear: sums of some hundred steps, in
        // round-off.
        EXPECT_LT(std::abs(e.error()), 1e-12 * turnover(e)) << damping << " " << steps;
      }
}

TEST(HeatLedger, ClosesToRoundOffWhileContactsAreElastic) {
  expect_exact_ledger(tessellated(40, 0.05, 0.05, 5), 0.05);
  expect_exact_ledger(five_tetrahedra(), 1.0);
}

// A step over a corner of the contact law books the area under the law and works along the chord, so the
// error falls with the step. `refinement` divides the step and leaves masses and heating as they are.
TEST(HeatLedger, ClosesWhileDifferentialExpansionTearsContacts) {
  const ModelOf<2> model = tessellated(40, 0.2, 0.2, 5);
  std::vector<double> rises;
  for (double rise = 20.0; rise <= 300.0; rise += 20.0) rises.push_back(rise);
  for (double rise = 270.0; rise >= 0.0; rise -= 30.0) rises.push_back(rise);
  const auto error = [&](int refinement) {
    auto parameters = quasi_static<2>(0.8);
    parameters.safety /= refinement;
    parameters.time_step /= refinement;
    const auto m = heated_under_load(model, mortar_contact(), parameters, 0.2, rises, 400 * refinement);
    int torn = 0;
    for (const auto& c : m.read().contacts()) torn += c.remembered(Remembers::tension_damage) == 1.0;
    EXPECT_GT(torn, 10);
    const auto e = m.totals().energy();
    EXPECT_GT(e.dissipated.of("shear"), 0.0);
    EXPECT_NE(e.mass_scaling, 0.0);
    return std::abs(e.error()) / turnover(e);
  };
  // A fifth of what the ledger promises at the common step, and a fifth of that at a sixth of the step (first
  // order).
  EXPECT_LT(error(1), 1e-3);
  EXPECT_LT(error(6), 2e-4);
}

TEST(HeatLedger, SettingTheSamePropertiesAnewChangesNothing) {
  const ModelOf<2> model = tessellated(40, 0.05, 0.05, 5);
  const auto parameters = quasi_static<2>(0.5);
  auto m = heated_under_load(model, mortar_contact(), parameters, 0.05, {300.0}, 300);
  auto again = heated_under_load(model, mortar_contact(), parameters, 0.05, {300.0, 300.0}, 300);
  m.advance(300);
  double change = 0.0, largest = 0.0;
  for (std::size_t g = 0; g < m.read().displacements().size(); ++g) {
    change = std::max(change, norm(again.read().displacements()[g] - m.read().displacements()[g]));
    largest = std::max(largest, norm(m.read().displacements()[g]));
  }
  EXPECT_LT(change, 1e-12 * largest);  // round-off
  EXPECT_NEAR(again.totals().energy().property_change, m.totals().energy().property_change,
              1e-12 * m.totals().energy().property_change);
}

TEST(HeatLedger, IsBitwiseTheSameWithOneAndTwoThreads) {
  const ModelOf<2> model = tessellated(60, 0.05, 0.05, 3);
  const auto run = [&](int threads) {
    auto parameters = quasi_static<2>(0.5);
    parameters.zones_for_a_thread = 1;
    auto m = heated_under_load(model, mortar_contact(), parameters, 0.05, heating_and_cooling, 200,
                               std::make_shared<Team>(threads, WhenCrowded::stay));
    const auto e = m.totals().energy();
    return std::tuple(m.read().displacements(), m.read().forces(), e.property_change, e.mass_scaling,
                      e.accounted());
  };
  const auto one = run(1);
  const auto two = run(2);
  EXPECT_TRUE(one == two);
  EXPECT_NE(std::get<3>(one), 0.0);
}

// ---- Time step at another temperature

TEST(TimeStepAtTemperature, StiffensWithinTheSafetyOfRealMassAndNoFurther) {
  const ModelOf<2> model = column(3, 0.01);
  auto parameters = quasi_static<2>(0.5);
  parameters.mass = MassChoice::real;
  parameters.safety = 0.5;
  auto m = mechanics(model, elastic_contact(), parameters);
  hold(m, 1, {0.0});
  m.constraints().prescribe_velocity(0, 0, 0.0);
  m.constraints().apply_force(10, {{1e3, -1e4}});
  const auto stiffer = [&](double times) {
    auto contact = elastic_contact();
    contact.normal_stiffness *= times;
    contact.shear_stiffness *= times;
    return uniform(model, contact, 0.0, young * times);
  };
  // half the stable step at first, so stable up to four times the stiffness
  m.set_properties(stiffer(3.9));
  m.advance(20000);
  EXPECT_LT(m.totals().unbalanced_ratio(), 1e-3);  // it comes to rest, where an unstable body would blow up
  EXPECT_THROW(m.set_properties(stiffer(4.1)), Error);
}

TEST(TimeStepAtTemperature, ScaledMassesStayStableInAStiffenedBody) {
  const ModelOf<2> model = tessellated(40, 0.05, 0.05, 5);
  auto m = mechanics(model, elastic_contact(), quasi_static<2>(0.0), 0.01 * young);
  const double ratio = m.mass_ratio();
  m.set_properties(uniform(model, elastic_contact(), 1e-3));
  EXPECT_GT(m.mass_ratio(), 1.5 * ratio);  // zones are a hundred times stiffer, contacts as they were
  m.advance(5000);
  const auto e = m.totals().energy();
  EXPECT_LT(e.kinetic, e.property_change);  // nothing damps it, and no energy comes from nowhere
  EXPECT_GT(e.property_change, 0.0);
}

// ---- Ties

/// A block with a platen on it that reaches out by three times its width to the right, where the load is.
class TiedPlaten : public testing::Test {
 protected:
  TiedPlaten() {
    model_.material_names = {"mortar"};
    model_.interface_names = {"mortar-mortar"};
    const auto add = [&](const std::vector<Vec<2>>& corners) {
      const auto zoned = specimen::zone_block(corners);
      model_.add_block(zoned.gridpoints, zoned.zones, 0);
    };
    add({{{0.0, 0.0}}, {{d, 0.0}}, {{d, d}}, {{0.0, d}}});
    add({{{0.0, d}}, {{d, d}}, {{4 * d, d}}, {{4 * d, 1.5 * d}}, {{0.0, 1.5 * d}}});
    model_.join_faces({2, 3}, {6, 5}, 0);
  }

  Mechanics<2> loaded(const MechanicsParameters& parameters) const {
    Mechanics<2> m(model_, {2400.0}, uniform(model_, elastic_contact(), 0.0), parameters);
    hold(m, 1, {0.0});
    m.constraints().prescribe_velocity(0, 0, 0.0);
    m.constraints().apply_force(right, {{0.0, -force}});
    return m;
  }
  static double tilt(const Mechanics<2>& m) {
    return std::abs(m.read().displacements()[right][1] - m.read().displacements()[left][1]);
  }

  static constexpr double d = 0.01, force = 1e4;
  static constexpr int right = 8, left = 9;  // ends of the platen's upper face
  ModelOf<2> model_;
};

TEST_F(TiedPlaten, DoesNotTiltUnderAnEccentricReaction) {
  auto m = loaded(settling<2>(100));
  m.constraints().tie({left, right}, 1);
  m.advance(5000);
  const double down = -m.read().displacements()[right][1];
  EXPECT_GT(down, 0.5 * force / d * d / young);  // of the order of what the block shortens by
  EXPECT_LT(tilt(m), 1e-12 * down);              // round-off
  double reaction = 0.0;
  for (int g : {0, 1}) reaction -= m.read().forces()[g][1];
  EXPECT_NEAR(reaction, force, 1e-9 * force);  // settled
  m.constraints().untie();
  m.advance(5000);
  EXPECT_GT(tilt(m), down);
}

TEST_F(TiedPlaten, TakesTheWorkOfForceTimesDisplacementThroughHeating) {
  for (const double damping : {0.0, 0.5}) {
    auto m = loaded(quasi_static<2>(damping));
    m.constraints().tie({left, right}, 1);
    m.advance(50);
    for (const double left_over : {0.7, 0.4, 1.0}) {
      auto contact = elastic_contact();
      contact.normal_stiffness *= left_over;
      contact.shear_stiffness *= left_over;
      m.set_properties(uniform(model_, contact, 1e-3 / left_over, young * left_over));
      m.advance(70);
    }
    const auto e = m.totals().energy();
    EXPECT_GT(e.kinetic, 0.0);
    EXPECT_NE(e.mass_scaling, 0.0);
    EXPECT_LT(tilt(m), 1e-12 * std::abs(m.read().displacements()[right][1]));
    // the ledger stands at the displacement that the last step started from
    const double work =
        -force * (m.read().displacements()[right][1] - m.read().velocities()[right][1] * m.time_step());
    EXPECT_NEAR(e.loading, work, 1e-12 * turnover(e));
    EXPECT_LT(std::abs(e.error()), 1e-12 * turnover(e));
  }
}

}  // namespace
}  // namespace pyroclast::thermal_stress_test
