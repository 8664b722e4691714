#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "bodies.hpp"
#include "known.hpp"
#include "pyroclast/base/random.hpp"
#include "pyroclast/mechanics/turning_frame.hpp"

/// Finite kinematics: zones and faces that turn.
namespace pyroclast::turning_test {
namespace {

using namespace bodies;

/// Draws a rotation: the columns of a unit quaternion's matrix.
Matrix3<> random_turn(Random& random) {
  std::array<double, 4> q{};
  double square = 0.0;
  for (double& c : q) {
    c = random.uniform(-1.0, 1.0);
    square += c * c;
  }
  for (double& c : q) c /= std::sqrt(square);
  const auto [w, x, y, z] = q;
  return {{{{1 - 2 * (y * y + z * z), 2 * (x * y + w * z), 2 * (x * z - w * y)}},
           {{2 * (x * y - w * z), 1 - 2 * (x * x + z * z), 2 * (y * z + w * x)}},
           {{2 * (x * z + w * y), 2 * (y * z - w * x), 1 - 2 * (x * x + y * y)}}}};
}

/// Turn by 90 degrees about the axis z.
constexpr Matrix3<> kQuarter{{{{0.0, 1.0, 0.0}}, {{-1.0, 0.0, 0.0}}, {{0.0, 0.0, 1.0}}}};

Vec<3> times(const Matrix3<>& m, const Vec<3>& v) {
  return m[0] * v[0] + m[1] * v[1] + m[2] * v[2];
}

/// Strain of a zone whose edges are unit vectors, from its deformation gradient.
SymmetricTensor<3> strain_of(Matrix3<> gradient, Rotation<3>& rotation) {
  const Matrix3<> unit = Rotation<3>().axis;
  for (int i = 0; i < 3; ++i) gradient[i] -= unit[i];
  return mechanical_strain<3>(unit, 1.0, gradient, 0.0, Kinematics::finite, rotation);
}

// Promise: the strain of a zone is U - I of F = R U, whatever its turn: to round-off up to strains of 0.1.
TEST(ZoneThatTurns, StrainsByItsStretchAlone) {
  Random random(1);
  for (const double size : {1e-4, 0.01, 0.1})
    for (int n = 0; n < 2000; ++n) {
      SymmetricTensor<3> expected;
      for (double& component : expected) component = size * random.uniform(-1.0, 1.0);
      for (int i = 3; i < 6; ++i) expected[i] *= 0.5;
      const auto& [xx, yy, zz, xy, yz, zx] = expected;
      const Matrix3<> turn = random_turn(random);
      const Matrix3<> stretch{{{{1 + xx, xy, zx}}, {{xy, 1 + yy, yz}}, {{zx, yz, 1 + zz}}}};
      Rotation<3> rotation;
      const auto strain =
          strain_of({times(turn, stretch[0]), times(turn, stretch[1]), times(turn, stretch[2])}, rotation);
      for (int i = 0; i < 6; ++i) ASSERT_NEAR(strain[i], expected[i], 4e-15) << size;
      for (int i = 0; i < 3; ++i) ASSERT_LT(norm(rotation.axis[i] - turn[i]), 4e-15);
    }
  Rotation<3> rotation;
  for (const double component : strain_of(kQuarter, rotation)) EXPECT_EQ(component, 0.0);
}

TEST(ZoneThatTurns, TurnsATensorAsItTurnsVectors) {
  Random random(2);
  const Rotation<3> r{random_turn(random)};
  const SymmetricTensor<3> s{3.0, -1.0, 2.0, 0.5, -0.7, 1.1};
  const Vec<3> n{{0.2, -0.5, 0.9}};
  const Vec<3> turned = apply<3>(rotated<3>(r, s), rotated<3>(r, n));
  EXPECT_LT(norm(turned - rotated<3>(r, apply<3>(s, n))), 1e-14);
}

/// A face of five corners on each side, bent and open, with the energy of springs in its frame.
struct Face {
  static constexpr int kCorners = 5;
  using Real = long double;
  using Places = std::array<Vec<3, Real>, 2 * kCorners>;

  std::array<std::array<Real, 2>, kCorners> weight;  // of either side
  Places start;

  explicit Face(double bent) {
    Random random(3);
    std::array<Vec<2, Real>, kCorners> p;
    Vec<2, Real> middle{};
    for (int i = 0; i < kCorners; ++i) {
      p[i] = {{std::cos(1.3L * i) * random.uniform(0.8, 1.2), std::sin(1.3L * i) * random.uniform(0.8, 1.2)}};
      middle += p[i] * (1.0L / kCorners);
    }
    Real xx = 0, xy = 0, yy = 0;
    for (auto& q : p) {
      q -= middle;
      xx += q[0] * q[0];
      xy += q[0] * q[1];
      yy += q[1] * q[1];
    }
    const Matrix3<> turn = random_turn(random);
    for (int i = 0; i < kCorners; ++i) {
      weight[i] = {(yy * p[i][0] - xy * p[i][1]) / (xx * yy - xy * xy) / 2,
                   (xx * p[i][1] - xy * p[i][0]) / (xx * yy - xy * xy) / 2};
      for (int side = 0; side < 2; ++side)
        for (int k = 0; k < 3; ++k)
          start[side * kCorners + i][k] =
              turn[0][k] * p[i][0] + turn[1][k] * p[i][1] + bent * random.uniform(-1.0, 1.0);
    }
  }

  /// \param forces  minus the derivatives of the energy by the places, out
  Real energy(const Places& x, Places& forces) const {
    std::array<Vec<3, Real>, 2> gradient{};
    for (int i = 0; i < kCorners; ++i)
      for (int t : {0, 1}) gradient[t] += (x[i] + x[kCorners + i]) * weight[i][t];
    const TurningFrame<3, Real> frame(gradient);
    WorkOfTurn<3, Real> work;
    Real energy = 0;
    forces = {};
    for (int i = 0; i < kCorners; ++i) {
      const Vec<3, Real> jump = x[kCorners + i] - x[i];
      const Real opening = dot(jump, frame.normal);
      const Tangential<3, Real> along{{dot(jump, frame.tangents[0]), dot(jump, frame.tangents[1])}};
      const Real normal = 3 * opening;
      const Tangential<3, Real> shear = along * 1.3L;
      energy += 0.5L * (normal * opening + dot(shear, along));
      work.add(normal, shear, opening, along);
      forces[i] = frame.normal * normal + frame.tangents[0] * shear[0] + frame.tangents[1] * shear[1];
      forces[kCorners + i] = -forces[i];
    }
    const auto by_gradient = frame.minus_derivative(work);
    for (int i = 0; i < 2 * kCorners; ++i)
      for (int t : {0, 1}) forces[i] += by_gradient[t] * weight[i % kCorners][t];
    return energy;
  }
};

// Promise: forces of a face, those of its turn with them, are minus the gradient of its energy, and leave
// neither a force nor a moment on the body, with jumps of a tenth of the face.
TEST(FaceThatTurns, HasForcesThatAreTheGradientOfItsEnergyAndInBalance) {
  for (const double bent : {0.02, 0.1}) {
    const Face face(bent);
    Face::Places forces, unused;
    face.energy(face.start, forces);
    long double size = 0, worst = 0;
    Vec<3, long double> sum{}, moment{};
    for (std::size_t i = 0; i < forces.size(); ++i) {
      sum += forces[i];
      moment += cross(face.start[i], forces[i]);
      size = std::max(size, norm(forces[i]));
      for (int k = 0; k < 3; ++k) {
        const auto moved = [&](long double by) {
          auto x = face.start;
          x[i][k] += by;
          return face.energy(x, unused);
        };
        const long double h = 1e-4L;  // to the fourth order
        const long double slope = (8 * (moved(h) - moved(-h)) - (moved(2 * h) - moved(-2 * h))) / (12 * h);
        worst = std::max(worst, std::abs(forces[i][k] + slope));
      }
    }
    EXPECT_LT(worst, 1e-11L * size);
    EXPECT_LT(norm(sum), 1e-17L * size);
    EXPECT_LT(norm(moment), 1e-17L * size);
  }
}

template <int Dim>
MechanicsParameters finite() {
  auto parameters = quasi_static<Dim>(0.0);
  parameters.kinematics = Kinematics::finite;
  return parameters;
}

/// Moves gridpoints to displacements in one step, and takes the forces there in a second.
template <int Dim>
void put(Mechanics<Dim>& m, const std::vector<Vec<Dim>>& displacement) {
  for (std::size_t g = 0; g < displacement.size(); ++g)
    for (int i = 0; i < Dim; ++i)
      m.constraints().prescribe_velocity(static_cast<int>(g), i, displacement[g][i] / m.time_step());
  m.advance(1);
  for (std::size_t g = 0; g < displacement.size(); ++g)
    for (int i = 0; i < Dim; ++i) m.constraints().prescribe_velocity(static_cast<int>(g), i, 0.0);
  m.advance(1);
}

Vec<2> turned_about(const Vec<2>& x, double angle) {
  return turned(x, angle);
}
/// Turns about the axis (1, 2, 2) / 3.
Vec<3> turned_about(const Vec<3>& x, double angle) {
  const Vec<3> axis{{1.0 / 3.0, 2.0 / 3.0, 2.0 / 3.0}};
  return x * std::cos(angle) + cross(axis, x) * std::sin(angle) +
         axis * (dot(axis, x) * (1 - std::cos(angle)));
}

/// Expects zones and faces of a body to bear nothing after a turn.
template <int Dim, class Turn>
void expect_nothing_after(const ModelOf<Dim>& model, Turn turn, double strain) {
  auto m = mechanics(model, mortar_contact(), finite<Dim>());
  std::vector<Vec<Dim>> way;
  for (const auto& x : model.position) way.push_back(turn(x) - x);
  put(m, way);
  for (const auto& s : m.read().stresses())
    for (const double component : s) EXPECT_LE(std::abs(component), 29.4e9 * strain);
  for (int c = 0; c < model.contact_count(); ++c) {
    EXPECT_LT(std::abs(m.read().contact(c).normal_traction), 18400e9 * 1e-16);  // jump to round-off
    const auto frame = m.read().frame_of_forces(c);
    EXPECT_LT(norm(frame.normal - turn(model.contacts[c].normal)), 1e-12);
    EXPECT_LT(norm(frame.tangents[0] - turn(model.contacts[c].tangents[0])), 1e-12);
  }
}

// Promise: a body may turn by any angle without straining or loading its contacts. By 90 degrees about an
// axis of coordinates it strains nothing at all.
TEST(FiniteKinematics, ARigidTurnLeavesNoStressAndNoTraction) {
  const auto turn = [](const auto& x) { return turned_about(x, 0.5); };
  expect_nothing_after<2>(tessellated(40, 0.1, 0.1, 2), turn, 1e-12);
  expect_nothing_after<3>(laguerre_cells(20, 0.1, 2), turn, 1e-12);
  const auto quarter = [](const Vec<3>& x) { return times(kQuarter, x); };
  expect_nothing_after<3>(cubes(3, 0x1p-6), quarter, 1e-15);
}

TEST(FiniteKinematics, StressesAreToldInTheFrameOfTheModel) {
  const ModelOf<3> model = cubes(2, 0.01);
  const SymmetricTensor<3> strain{1e-3, -2e-3, 5e-4, 7e-4, -3e-4, 4e-4};
  const auto turn = [](const Vec<3>& x) { return turned_about(x, 0.5); };
  auto m = mechanics(model, elastic_contact(), finite<3>());
  std::vector<Vec<3>> way;
  for (const auto& x : model.position) way.push_back(turn(x + apply<3>(strain, x)) - x);
  put(m, way);
  const Rotation<3> rotation{{turn({{1, 0, 0}}), turn({{0, 1, 0}}), turn({{0, 0, 1}})}};
  const auto expected = rotated<3>(rotation, zone_stress<3>(zone_properties<3>(29.4e9, 0.2), strain));
  for (const auto& stress : m.read().stresses())
    for (int i = 0; i < 6; ++i) EXPECT_NEAR(stress[i], expected[i], 29.4e9 * 1e-13);
}

/// A body of bent cells that are pulled apart, deformed and turned by a right angle.
template <int Dim>
std::vector<Vec<Dim>> torn(const ModelOf<Dim>& model, double by) {
  Random random(5);
  std::vector<Vec<Dim>> way;
  for (int block = 0; block < model.block_count(); ++block) {
    Vec<Dim> of_block;
    for (double& c : of_block.c) c = by * random.uniform(-1.0, 1.0);
    for (int g = model.block_gridpoints[block]; g < model.block_gridpoints[block + 1]; ++g) {
      way.push_back(turned_about(model.position[g], 1.5) - model.position[g] + of_block);
      for (double& c : way.back().c) c += 0.02 * by * random.uniform(-1.0, 1.0);
    }
  }
  return way;
}

/// Expects the forces of a torn body to be minus the gradient of its energy, and to be in balance.
template <int Dim>
void expect_gradient(const ModelOf<Dim>& model, double by, int each) {
  const auto way = torn(model, by);
  const auto at = [&](const std::vector<Vec<Dim>>& displacement) {
    auto m = mechanics(model, elastic_contact(), finite<Dim>());
    put(m, displacement);
    return m;
  };
  const auto m = at(way);
  double size = 0.0;
  Vec<3> sum{}, moment{};
  for (int g = 0; g < model.gridpoint_count(); ++g) {
    const Vec<3> force = resized<3>(m.read().force(g));
    size = std::max(size, norm(force));
    sum += force;
    moment += cross(resized<3>(model.position[g] + m.read().displacement(g)), force);
  }
  EXPECT_LT(norm(sum), 1e-13 * size);
  EXPECT_LT(norm(moment), 1e-13 * size * 0.05);
  for (int g = 0; g < model.gridpoint_count(); g += each)
    for (int i = 0; i < Dim; ++i) {
      const auto energy = [&](double more) {
        auto moved = way;
        moved[g][i] += more;
        return at(moved).totals().energy().elastic();
      };
      const double h = 2e-3 * by;
      const double slope = (8 * (energy(h) - energy(-h)) - (energy(2 * h) - energy(-2 * h))) / (12 * h);
      EXPECT_NEAR(m.read().force(g)[i], -slope, 1e-9 * size) << g;
    }
}

TEST(FiniteKinematics, ForcesAreTheGradientOfTheEnergyAndInBalance) {
  expect_gradient<2>(tessellated(8, 0.05, 0.05, 2), 5e-4, 5);
  expect_gradient<3>(laguerre_cells(8, 0.05, 2, 0.1), 5e-4, 11);
}

/// Deflection and shortening of a cantilever over its length.
struct Deflection {
  double across, along;
};

/// A column of cubes, its foot held, its head pushed across by a force that keeps its direction.
Deflection of_cantilever(int cubes_along, double force, const Vec<3>& direction) {
  const double d = 0.01, young = 1e9;
  const ModelOf<3> model = cubes(cubes_along, d);
  auto parameters = settling<3>(12.0 * cubes_along * cubes_along);
  parameters.kinematics = Kinematics::finite;
  auto m = mechanics(model, elastic_contact(), parameters, young, 0.0);
  const int head = 9 * (cubes_along - 1) + 4;
  for (int g = 0; g < 4; ++g)
    for (int i = 0; i < 3; ++i) m.constraints().prescribe_velocity(g, i, 0.0);
  for (int g = head; g < head + 4; ++g) m.constraints().apply_force(g, direction * (0.25 * force));
  m.advance(120 * cubes_along * cubes_along);
  EXPECT_LT(m.totals().unbalanced_ratio(), 1e-6);
  Vec<3> mean{};
  for (int g = head; g < head + 4; ++g) mean += m.read().displacement(g) * 0.25;
  const double length = cubes_along * d;
  return {dot(mean, direction) / length, -mean[2] / length};
}

/// Presses one block on another, slides it by five of its edges without friction, and returns the error of
/// the energy ledger over what it turned over.
template <int Dim>
double error_of_a_slide(const ModelOf<Dim>& model, double size) {
  auto parameters = finite<Dim>();
  parameters.local_damping = 0.8;
  parameters.safety = 0.8;
  auto m = mechanics(model, Frictional::Properties<double>{18400e9, 7400e9, 0.0}, parameters);
  const auto& first = model.contacts[0];
  const auto drive = [&](const Vec<Dim>& way, int steps) {
    for (int g = 0; g < model.gridpoint_count(); ++g) {
      const bool is_second = g >= model.block_gridpoints[1];
      const double depth = dot(model.position[g] - model.position[first.a], first.normal);
      if (std::abs(depth) < 0.1 * size) continue;
      const Vec<Dim> velocity = way * (is_second ? 1.0 / (steps * m.time_step()) : 0.0);
      for (int i = 0; i < Dim; ++i) m.constraints().prescribe_velocity(g, i, velocity[i]);
    }
    m.advance(steps);
  };
  drive(first.normal * (-1e-3 * size), 2000);
  drive(first.tangents[0] * (5.0 * size), 20000);
  const EnergyLedger energy = m.totals().energy();
  return std::abs(energy.error()) / turnover(energy);
}

// Promise: sides that slide far on each other without breaking keep the step stable. Their face stiffens as
// they slide. With masses that do not follow, the error is all of the energy in the plane, and 0.17 in space.
TEST(FiniteKinematics, SidesThatSlideFarStayStable) {
  EXPECT_LT(error_of_a_slide<2>(column(2, 0.01), 0.01), 1e-4);
  EXPECT_LT(error_of_a_slide<3>(cubes(2, 0.01), 0.01), 1e-4);
}

// Promise: a slender bar bends far as the elastica does, by zones and faces that turn. Its stiffness is that
// of the same cubes and contacts under a small force: one row of them shows whether they turn, not how soft
// they are.
TEST(ElasticaVerification, ACantileverOfJoinedCubesBendsFar) {
  constexpr int kCubes = 16;
  const Vec<3> across{{0.6, 0.8, 0.0}};
  const double small_force = 1e-3;
  const double modulus = small_force / 3.0 / of_cantilever(kCubes, small_force, across).across;  // E I / L^2
  struct Known {
    double force, across, along;
  };
  for (const auto& [force, v, u] :
       {Known{2.0, 0.49346, 0.16064}, {5.0, 0.71379, 0.38763}, {10.0, 0.81061, 0.55500}}) {
    const Deflection found = of_cantilever(kCubes, force * modulus, across);
    const std::string of = ", P L^2 / EI = " + std::to_string(static_cast<int>(force));
    expect_known({"Deflection of a cantilever of cubes over its length" + of, "Mattiasson 1981", "1"},
                 found.across, v, 0.05 * v);
    expect_known({"Shortening of a cantilever of cubes over its length" + of, "Mattiasson 1981", "1"},
                 found.along, u, 0.05 * u);
  }
}

}  // namespace
}  // namespace pyroclast::turning_test
