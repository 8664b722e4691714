#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <random>

#include <gtest/gtest.h>

#include "bodies.hpp"
#include "known.hpp"
#include "pyroclast/model/sets.hpp"

/// Bodies of polyhedra against closed forms.
namespace pyroclast {
namespace {

using namespace bodies;

constexpr double kYoung = 29.4e9, kPoisson = 0.2;

/// A body of two materials, 0 and 1, from cells; contacts between the two are of the second interface.
ModelOf<3> of_two_materials(const specimen::Cells<3>& complex, const std::vector<int>& material) {
  ModelOf<3> model;
  model.material_names = {"lower", "upper"};
  model.interface_names = {"within", "between"};
  add_cells(model, complex, material, [&](int a, int b) { return material[a] == material[b] ? 0 : 1; });
  return model;
}

constexpr int kCubes = 4;        // along each side of a layer
constexpr double kCube = 0.005;  // m

/// Two layers of cubes. The plane between them is a chequer of saddles: each of its faces is bent by an angle
/// about its mean plane, which is level.
ModelOf<3> layers_on_saddles(double angle) {
  const double rise = kCube * std::tan(angle) / (2.0 * std::numbers::sqrt2);
  specimen::Cells<3> complex;
  const auto vertex = [](int i, int j, int k) { return (k * (kCubes + 1) + j) * (kCubes + 1) + i; };
  for (int k = 0; k <= 2; ++k)
    for (int j = 0; j <= kCubes; ++j)
      for (int i = 0; i <= kCubes; ++i)
        complex.vertices.push_back({{i * kCube, j * kCube,
                                     k * kCube + (k != 1             ? 0.0
                                                  : (i + j) % 2 == 0 ? rise
                                                                     : -rise)}});
  complex.cells.resize(2 * kCubes * kCubes);
  const auto cell = [](int i, int j, int k) {
    const bool is_inside = i >= 0 && j >= 0 && k >= 0 && i < kCubes && j < kCubes && k < 2;
    return is_inside ? (k * kCubes + j) * kCubes + i : -1;
  };
  // the face between a cell and the next one, or the surface, counter-clockwise seen from the next one
  const auto add = [&](int before, int after, std::vector<int> corners) {
    if (before < 0) std::ranges::reverse(corners);
    add_face(complex, std::move(corners), before < 0 ? after : before, before < 0 ? -1 : after);
  };
  for (int k = 0; k <= 2; ++k)
    for (int j = 0; j <= kCubes; ++j)
      for (int i = 0; i <= kCubes; ++i) {
        if (j < kCubes && k < 2)
          add(cell(i - 1, j, k), cell(i, j, k),
              {vertex(i, j, k), vertex(i, j + 1, k), vertex(i, j + 1, k + 1), vertex(i, j, k + 1)});
        if (i < kCubes && k < 2)
          add(cell(i, j - 1, k), cell(i, j, k),
              {vertex(i, j, k), vertex(i, j, k + 1), vertex(i + 1, j, k + 1), vertex(i + 1, j, k)});
        if (i < kCubes && j < kCubes)
          add(cell(i, j, k - 1), cell(i, j, k),
              {vertex(i, j, k), vertex(i + 1, j, k), vertex(i + 1, j + 1, k), vertex(i, j + 1, k)});
      }
  std::vector<int> material(complex.cells.size());
  for (std::size_t c = 0; c < material.size(); ++c) material[c] = c < material.size() / 2 ? 0 : 1;
  return of_two_materials(complex, material);
}

class BentFacesVerification : public testing::TestWithParam<int> {};
INSTANTIATE_TEST_SUITE_P(Degrees, BentFacesVerification, testing::Values(0, 5, 10, 20));

// Promise: all points of a face have the frame of its mean plane. So a joint of bent faces slides as a plane
// one does; with a frame for each triangle it had teeth, and up to 58 % more friction.
TEST_P(BentFacesVerification, SlideAtTheAngleOfFrictionWithoutDilation) {
  constexpr double kPressure = 5e6, kSide = kCubes * kCube;
  const double friction = std::tan(34.0 * std::numbers::pi / 180.0);
  const ModelOf<3> model = layers_on_saddles(GetParam() * std::numbers::pi / 180.0);
  const auto mortar = mortar_contact();
  Mechanics<3> m(
      model, {2400.0, 2400.0},
      by_interface(
          model, std::vector<ZoneProperties>(model.zones.size(), zone_properties<3>(kYoung, kPoisson)),
          {elastic_contact(),
           Frictional::Properties<double>{mortar.normal_stiffness, mortar.shear_stiffness, friction}}),
      quasi_static<3>());
  std::vector<int> top, bottom;
  for (int g = 0; g < model.gridpoint_count(); ++g) {
    if (model.position[g][2] == 0.0) bottom.push_back(g);
    if (model.position[g][2] == 2 * kCube) top.push_back(g);
  }
  const auto share = tributary_areas(top, faces_in(model, top));
  for (const int g : bottom)
    for (int i = 0; i < 3; ++i) m.constraints().prescribe_velocity(g, i, 0.0);
  for (std::size_t i = 0; i < top.size(); ++i) {
    for (const int across : {0, 1}) m.constraints().prescribe_velocity(top[i], across, 0.0);
    m.constraints().apply_force(top[i], {{0.0, 0.0, -kPressure * share[i]}});
  }
  m.advance(1500);
  const auto height = [&] {
    double sum = 0.0;
    for (const int g : top) sum += m.read().displacement(g)[2];
    return sum / static_cast<double>(top.size());
  };
  const double at_first = height();
  constexpr double kSlip = 21e-6;
  for (const int g : top) m.constraints().prescribe_velocity(g, 0, kSlip / (8000 * m.time_step()));
  m.advance(8000);
  for (const int g : top) m.constraints().prescribe_velocity(g, 0, 0.0);
  m.advance(1000);
  double shear = 0.0;
  for (const int g : bottom) shear += m.read().force(g)[0];
  expect_known({"Shear over pressure of a joint of faces bent by " + std::to_string(GetParam()) + " degrees",
                "tan 34 degrees", "1"},
               std::abs(shear) / (kPressure * kSide * kSide), friction, 0.005 * friction);
  EXPECT_LT(std::abs(height() - at_first), 0.01 * kSlip);
}

/// Gridpoints that stand at the same place.
std::vector<std::vector<int>> by_place(const ModelOf<3>& model) {
  std::map<std::array<double, 3>, std::vector<int>> at;
  for (int g = 0; g < model.gridpoint_count(); ++g) at[model.position[g].c].push_back(g);
  std::vector<std::vector<int>> all;
  for (const auto& [place, gridpoints] : at) all.push_back(gridpoints);
  return all;
}

constexpr double kEdge = 0.05;   // m
constexpr double kShake = 0.05;  // with more, slender faces fold

/// Largest angle between a triangle of a face and the mean plane of the face, in radians.
double largest_bend(const ModelOf<3>& model) {
  double largest = 0.0;
  for (int f = 0; f < model.face_count(); ++f) {
    const auto* const c = &model.contacts[model.face_contacts[f]];
    const int corners = model.face_contacts[f + 1] - model.face_contacts[f];
    const auto at = [&](int i) { return model.position[c[i].a]; };
    for (int i = 1; i + 1 < corners; ++i) {
      const Vec<3> normal = cross(at(i) - at(0), at(i + 1) - at(0));
      largest = std::max(largest, std::acos(std::min(1.0, dot(normal, c->normal) / norm(normal))));
    }
  }
  return largest;
}

// Promise: on bent faces too, a linear field of displacement gives every zone its stress, and the forces of
// the blocks at a vertex cancel.
TEST(BentCellsVerification, ALinearFieldHasTheSameStressEverywhereAndForcesThatCancel) {
  const ModelOf<3> model = laguerre_cells(1000, kEdge, 5, kShake);
  EXPECT_GT(largest_bend(model), 20.0 * std::numbers::pi / 180.0);
  auto m = mechanics(model, elastic_contact(), quasi_static<3>(), kYoung, kPoisson);
  const double h[3][3] = {{1e-4, 3e-5, -2e-5}, {1e-5, -2e-4, 4e-5}, {6e-5, -1e-5, 5e-5}};
  const auto field = [&](const Vec<3>& x) {
    Vec<3> u{};
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j) u[i] += h[i][j] * x[j];
    return u;
  };
  impose(m, field, 4);
  const auto stress = zone_stress<3>(zone_properties<3>(kYoung, kPoisson),
                                     {h[0][0], h[1][1], h[2][2], 0.5 * (h[0][1] + h[1][0]),
                                      0.5 * (h[1][2] + h[2][1]), 0.5 * (h[0][2] + h[2][0])});
  double apart = 0.0, largest_stress = 0.0;
  for (int z = 0; z < model.zone_count(); ++z)
    for (std::size_t i = 0; i < stress.size(); ++i) {
      apart = std::max(apart, std::abs(m.read().stress(z)[i] - stress[i]));
      largest_stress = std::max(largest_stress, std::abs(stress[i]));
    }
  expect_known_field({"Stress of 1,000 cells with bent faces in a linear field", "zone law", "Pa"}, apart,
                     largest_stress, 1e-9 * largest_stress);
  double largest = 0.0, rest = 0.0, virial[3][3] = {};
  for (const auto& gridpoints : by_place(model)) {
    Vec<3> sum{};
    for (const int g : gridpoints) {
      sum += m.read().force(g);
      largest = std::max(largest, norm(m.read().force(g)));
    }
    const Vec<3>& x = model.position[gridpoints.front()];
    if (std::ranges::all_of(x.c, [](double c) { return c > 0.0 && c < kEdge; }))
      rest = std::max(rest, norm(sum));
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j) virial[i][j] += sum[i] * x[j];
  }
  EXPECT_LT(rest, 1e-10 * largest);
  // forces at the surface stand for the stress: their moments sum to minus the stress times the volume
  constexpr int kComponent[3][3] = {{0, 3, 5}, {3, 1, 4}, {5, 4, 2}};
  const double volume = kEdge * kEdge * kEdge;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j)
      EXPECT_NEAR(virial[i][j], -stress[kComponent[i][j]] * volume, 1e-9 * largest_stress * volume);
}

TEST(BentCellsVerification, ATurnByASmallAngleStrainsNothing) {
  const ModelOf<3> model = laguerre_cells(300, kEdge, 5, kShake);
  auto m = mechanics(model, elastic_contact(), quasi_static<3>(), kYoung, kPoisson);
  const Vec<3> turn{{1e-5, -2e-5, 3e-5}};
  impose(
      m, [&](const Vec<3>& x) { return cross(turn, x); }, 4);
  double stress = 0.0, traction = 0.0;
  for (int z = 0; z < model.zone_count(); ++z)
    for (const double s : m.read().stress(z)) stress = std::max(stress, std::abs(s));
  for (int c = 0; c < model.contact_count(); ++c)
    traction = std::max(traction, std::abs(m.read().contact(c).normal_traction));
  EXPECT_LT(stress, 1e-9 * kYoung * norm(turn));
  // a jump of round-off, 1e-16 of the displacements, times the stiffness of the contacts
  EXPECT_LT(traction, 1e-14 * mortar_contact().normal_stiffness * norm(turn) * kEdge);
}

// Promise: forces of contacts on their two sides are opposite and act at one place.
TEST(BentCells, ForcesOfContactsHaveNeitherSumNorMoment) {
  const ModelOf<3> model = laguerre_cells(200, kEdge, 5, kShake);
  std::mt19937_64 random(2);
  std::uniform_real_distribution<double> jump(-5e-6, 5e-6);
  for (const ContactProperties& contact :
       {ContactProperties(elastic_contact()), ContactProperties(mortar_contact())}) {
    auto m = mechanics(model, contact, quasi_static<3>(), 1e-6, 0.0);  // zones bear nothing
    for (int g = 0; g < model.gridpoint_count(); ++g)
      for (int i = 0; i < 3; ++i) m.constraints().prescribe_velocity(g, i, jump(random) / m.time_step());
    m.advance(2);
    Vec<3> sum{}, moment{};
    double forces = 0.0, moments = 0.0;
    for (int g = 0; g < model.gridpoint_count(); ++g) {
      const Vec<3> force = m.read().force(g);
      sum += force;
      moment += cross(model.position[g], force);
      forces += norm(force);
      moments += norm(cross(model.position[g], force));
    }
    EXPECT_GT(forces, 1.0);
    EXPECT_LT(norm(sum), 1e-12 * forces);
    EXPECT_LT(norm(moment), 1e-12 * moments);
  }
}

/// Two prisms of one material over a polygon of so many corners, one on the other.
ModelOf<3> two_prisms(int corners, double radius, double height) {
  specimen::Cells<3> complex;
  for (int level = 0; level < 3; ++level)
    for (int i = 0; i < corners; ++i) {
      // not regular, so that no two shares of the area are alike
      const double angle = 2.0 * std::numbers::pi * (i + 0.2 * std::sin(3.0 * i)) / corners;
      complex.vertices.push_back({{radius * std::cos(angle), radius * std::sin(angle), level * height}});
    }
  complex.cells.resize(2);
  const auto ring = [&](int level) {
    std::vector<int> all;
    for (int i = 0; i < corners; ++i) all.push_back(level * corners + i);
    return all;
  };
  auto bottom = ring(0);
  std::ranges::reverse(bottom);
  add_face(complex, bottom, 0, -1);
  add_face(complex, ring(1), 0, 1);
  add_face(complex, ring(2), 1, -1);
  for (int level = 0; level < 2; ++level)
    for (int i = 0; i < corners; ++i) {
      const int next = (i + 1) % corners, low = level * corners;
      add_face(complex, {low + i, low + next, low + corners + next, low + corners + i}, level, -1);
    }
  return of_two_materials(complex, {0, 0});
}

class PolygonInTensionVerification : public testing::TestWithParam<int> {};
INSTANTIATE_TEST_SUITE_P(Corners, PolygonInTensionVerification, testing::Values(3, 4, 9, 15));

// Promise: a face of any number of corners carries its tensile strength times its area, and breaking it
// takes the fracture energy times the area.
TEST_P(PolygonInTensionVerification, CarriesItsStrengthAndDissipatesItsFractureEnergy) {
  const ModelOf<3> model = two_prisms(GetParam(), 0.005, 0.002);
  const auto mortar = mortar_contact();
  auto m = mechanics(model, mortar, quasi_static<3>(), kYoung, kPoisson);
  double area = 0.0;
  for (const auto& contact : model.contacts) area += contact.area;
  ASSERT_EQ(model.contact_count(), GetParam());
  const double ultimate = 2.0 * mortar.mode_1_energy / mortar.tensile_strength;
  constexpr int kSteps = 20000;
  for (int g = 0; g < model.gridpoint_count(); ++g)
    for (int i = 0; i < 3; ++i)
      m.constraints().prescribe_velocity(
          g, i, i == 2 && g >= model.block_gridpoints[1] ? 1.1 * ultimate / (kSteps * m.time_step()) : 0.0);
  double most = 0.0;
  for (int k = 0; k < kSteps; k += 10) {
    m.advance(10);
    double force = 0.0;
    for (int g = model.block_gridpoints[1]; g < model.gridpoint_count(); ++g) force -= m.read().force(g)[2];
    most = std::max(most, force);
  }
  const std::string face = "a face of " + std::to_string(GetParam()) + " corners";
  expect_known({"Largest force on " + face, "f_t A", "N"}, most, mortar.tensile_strength * area,
               0.005 * mortar.tensile_strength * area);
  expect_known({"Energy that breaks " + face, "G_f1 A", "J"}, m.totals().energy().dissipated.total(),
               mortar.mode_1_energy * area, 1e-3 * mortar.mode_1_energy * area);
}

/// Modulus of a cube of random cells, pulled along y with its sides free, Pa.
double modulus(const ModelOf<3>& model, double stiffness) {
  auto parameters = quasi_static<3>();
  parameters.damping_form = DampingForm::combined;
  const Elastic::Properties<double> contact{stiffness, stiffness / 2.4};
  auto m = mechanics(model, contact, parameters, kYoung, kPoisson);
  const double pulled = 1e-6;  // m
  const auto drive = [&](double velocity) {
    for (int g = 0; g < model.gridpoint_count(); ++g) {
      const Vec<3>& x = model.position[g];
      if (x[1] == kEdge) m.constraints().prescribe_velocity(g, 1, velocity);
      for (int i = 0; i < 3; ++i)
        if (x[i] == 0.0) m.constraints().prescribe_velocity(g, i, 0.0);
    }
  };
  drive(pulled / (1000 * m.time_step()));
  m.advance(1000);
  drive(0.0);
  m.advance(6000);
  EXPECT_LT(m.totals().unbalanced_ratio(), 1e-5);
  double force = 0.0;
  for (int g = 0; g < model.gridpoint_count(); ++g)
    if (model.position[g][1] == kEdge) force += m.read().force(g)[1];
  return std::abs(force) / (kEdge * kEdge) / (pulled / kEdge);
}

// Promise: contacts add their compliance to that of the zones, whatever the cells: it halves when their
// stiffness doubles.
TEST(RandomCellsVerification, TheComplianceOfContactsHalvesWhenTheirStiffnessDoubles) {
  const ModelOf<3> model = laguerre_cells(300, kEdge, 3);
  const double size = kEdge / std::cbrt(300.0), stiffness = 8.0 * kYoung / size;
  const double once = 1.0 / modulus(model, stiffness) - 1.0 / kYoung;
  const double twice = 1.0 / modulus(model, 2.0 * stiffness) - 1.0 / kYoung;
  expect_known({"Compliance of contacts of random cells over that of contacts twice as stiff",
                "zones and contacts "
                "in series",
                "1"},
               once / twice, 2.0, 0.05);
}

}  // namespace
}  // namespace pyroclast
