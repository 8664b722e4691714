#include "pyroclast/mechanics/mechanics.hpp"

#include <gtest/gtest.h>
#include <sched.h>

#include "bodies.hpp"
#include "known.hpp"
#include "pyroclast/base/error.hpp"

namespace pyroclast {
namespace {

using namespace bodies;

/// Largest difference between a zone's stress and the expected one, over the largest expected component.
template <int Dim>
double stress_error(const Mechanics<Dim>& m, const SymmetricTensor<Dim>& expected) {
  double scale = 0.0, error = 0.0;
  for (double s : expected) scale = std::max(scale, std::abs(s));
  for (const auto& stress : m.read().stresses())
    for (std::size_t i = 0; i < expected.size(); ++i)
      error = std::max(error, std::abs(stress[i] - expected[i]));
  return error / scale;
}

class PatchTestVerification : public testing::TestWithParam<Kinematics> {};
INSTANTIATE_TEST_SUITE_P(Kinematics, PatchTestVerification,
                         testing::Values(Kinematics::small, Kinematics::finite));

// Promise: a linear displacement field gives the same stress in every zone of a random tessellation, to
// round-off; where it is uniform, forces inside are balanced.
TEST_P(PatchTestVerification, LinearFieldOnARandomTessellationGivesUniformStress) {
  const ModelOf<2> model = tessellated(150, 0.1, 0.1, 4);
  auto parameters = quasi_static<2>();
  parameters.kinematics = GetParam();
  auto m = mechanics(model, mortar_contact(), parameters);
  // A symmetric gradient, so that nothing turns and both kinematics expect the same.
  impose(
      m,
      [](const Vec<2>& x) {
        return Vec<2>{{1e-5 * x[0] + 2e-5 * x[1], 2e-5 * x[0] - 3e-5 * x[1]}};
      },
      10);
  const auto p = zone_properties<2>(29.4e9, 0.2);
  const auto expected = zone_stress<2>(p, {1e-5, -3e-5, 2e-5});
  // 1e-10: displacements of 1e-6 m over zones of 1e-3 m, with round-off 1e-16 of positions of 0.1 m
  expect_known_field(
      {"Patch test of a random tessellation: stresses over the largest", "linear displacements", "1"},
      stress_error(m, expected), 1.0, 1e-10);
  double unbalanced = 0.0, applied = 0.0;
  for (int b = 0; b < model.block_count(); ++b) {
    const int centre = model.block_gridpoints[b + 1] - 1;  // surrounded by the zones of its block
    unbalanced = std::max(unbalanced, norm(m.read().forces()[centre]));
    for (int g = model.block_gridpoints[b]; g < centre; ++g)
      applied = std::max(applied, norm(m.read().forces()[g]));
  }
  EXPECT_LT(unbalanced, 1e-10 * applied);
}

TEST(PatchTest3Verification, LinearFieldOnTetrahedraGivesUniformStress) {
  const ModelOf<3> model = five_tetrahedra();
  EXPECT_EQ(model.contact_count(), 12);
  auto m = mechanics(model, mortar_contact(), quasi_static<3>());
  impose(
      m,
      [](const Vec<3>& x) {
        return Vec<3>{{1e-5 * x[0] + 2e-5 * x[1], 3e-5 * x[2] - 1e-5 * x[1], 4e-5 * x[0] - 2e-5 * x[2]}};
      },
      10);
  const auto expected =
      zone_stress<3>(zone_properties<3>(29.4e9, 0.2), {1e-5, -1e-5, -2e-5, 1e-5, 1.5e-5, 2e-5});
  // as in 2D
  expect_known_field({"Patch test of tetrahedra: stresses over the largest", "linear displacements", "1"},
                     stress_error(m, expected), 1.0, 1e-10);
}

// Pulls a cube of five tetrahedral blocks: force through the contacts equals force through the zones.
TEST(PatchTest3Verification, TetrahedraInSeriesWithContactsComeToEquilibrium) {
  const ModelOf<3> model = five_tetrahedra();
  auto m = mechanics(model, elastic_contact(), quasi_static<3>());
  for (int g = 0; g < model.gridpoint_count(); ++g) {
    const bool bottom = model.position[g][2] == 0.0, top = model.position[g][2] == 1.0;
    if (bottom || top) m.constraints().prescribe_velocity(g, 2, top ? 1e-6 / (1000 * m.time_step()) : 0.0);
  }
  m.advance(1000);
  for (int g = 0; g < model.gridpoint_count(); ++g)
    if (model.position[g][2] == 1.0) m.constraints().prescribe_velocity(g, 2, 0.0);
  m.advance(8000);
  double pulled = 0.0, held = 0.0;
  for (int g = 0; g < model.gridpoint_count(); ++g)
    (model.position[g][2] == 1.0 ? pulled : held) +=
        model.position[g][2] == 1.0 || model.position[g][2] == 0.0 ? m.read().forces()[g][2] : 0.0;
  EXPECT_LT(m.totals().unbalanced_ratio(), 1e-10);
  EXPECT_GT(std::abs(pulled), 29.4e9 * 1e-6 * 0.5);
  EXPECT_NEAR(pulled, -held, 1e-6 * std::abs(pulled));
}

// Faces of four corners have a contact point at each, with the share of the area that zones give it: so the
// pull on a column of cubes is uniform and its elongation that of zones and contacts in series, to the rest
// that damping leaves. The lower face of each cube has the other diagonal than the upper face below it, so
// that this holds with the mean of both only: 1e-3.
TEST(PatchTest3Verification, CubesJoinedThroughSquareFacesHaveTheModulusOfZonesAndContactsInSeries) {
  const int count = 3;
  const double d = 0.01, young = 29.4e9, stress = 1e6;
  const ModelOf<3> model = cubes(count, d);
  ASSERT_EQ(model.face_count(), count - 1);
  ASSERT_EQ(model.contact_count(), 4 * (count - 1));
  auto parameters = quasi_static<3>(0.0);
  parameters.viscous_damping = 3.0 / (count * 4 * parameters.time_step);
  auto m = mechanics(model, elastic_contact(), parameters, young, 0.0);
  for (int g = 0; g < 4; ++g) m.constraints().prescribe_velocity(g, 2, 0.0);
  for (int i : {0, 1}) m.constraints().prescribe_velocity(0, i, 0.0);
  m.constraints().prescribe_velocity(1, 1, 0.0);
  const int top = 9 * (count - 1) + 4;
  const double shares[] = {1.0 / 3, 1.0 / 6, 1.0 / 3, 1.0 / 6};
  for (int i = 0; i < 4; ++i) m.constraints().apply_force(top + i, {{0.0, 0.0, stress * d * d * shares[i]}});
  m.advance(4000);
  double up = 0.0;
  for (int i = 0; i < 4; ++i) up += 0.25 * m.read().displacement(top + i)[2];
  const double expected = stress * (count * d / young + (count - 1) / elastic_contact().normal_stiffness);
  expect_known({"Elongation of a pulled column of cubes", "zones and contacts in series", "m"}, up, expected,
               1e-6 * expected);
  EXPECT_LT(m.totals().unbalanced_ratio(), 1e-9);
}

// Promise: a chain of n blocks and contacts has exactly 1/E_eff = 1/E + 1/(K_n d).
// The chain has n blocks of length d and n - 1 contacts; per length n d the compliance is exact with (n -
// 1)/n contacts.
double chain_modulus(int n, double angle, Kinematics kinematics) {
  const double d = 0.01;
  const ModelOf<2> model = column(n, d, angle);
  auto parameters = quasi_static<2>(0.0);
  parameters.kinematics = kinematics;
  // near critical for the lowest mode of the chain: comes to rest soonest
  parameters.viscous_damping = 3.0 / (n * parameters.time_step);
  auto m = mechanics(model, elastic_contact(), parameters, 29.4e9, 0.0);
  const double force = 1e6 * d / 2.0;  // 1 MPa on the end face, half on each of its gridpoints
  const Vec<2> pull = turned({{0.0, force}}, angle);
  for (int g : {0, 1})
    for (int i : {0, 1}) m.constraints().prescribe_velocity(g, i, 0.0);
  const int top = 4 * (n - 1);
  for (int g : {top + 2, top + 3}) m.constraints().apply_force(g, pull);
  m.advance(60000);
  // at rest to round-off: displacements of 1e-6 m carry 1e-22 m, times a stiffness of 1e11 N/m, over forces
  // of 1e4 N
  EXPECT_LT(m.totals().unbalanced_ratio(), 1e-11);
  const Vec<2> axis = turned({{0.0, 1.0}}, angle);
  const double stretch =
      0.5 * (dot(m.read().displacements()[top + 2], axis) + dot(m.read().displacements()[top + 3], axis));
  return 1e6 / (stretch / (n * d));
}

TEST(ChainVerification, HasTheModulusOfZonesAndContactsInSeries) {
  for (int n : {2, 5, 9}) {
    const double d = 0.01;
    const double expected = 1.0 / (1.0 / 29.4e9 + (n - 1.0) / n / (18400e9 * d));
    expect_known({"Modulus of a chain of blocks, small kinematics", "zones and contacts in series", "Pa"},
                 chain_modulus(n, 0.0, Kinematics::small), expected, 1e-9 * expected);
    // finite: the stress is per first area and the stretch is linear in it, so the same holds
    expect_known({"Modulus of a chain of blocks, finite kinematics", "zones and contacts in series", "Pa"},
                 chain_modulus(n, 0.0, Kinematics::finite), expected, 1e-9 * expected);
  }
}

TEST(ChainVerification, GivesTheSameNumbersAfterTurningTheModelByThirtyDegrees) {
  const double upright = chain_modulus(5, 0.0, Kinematics::small);
  EXPECT_NEAR(chain_modulus(5, std::numbers::pi / 6.0, Kinematics::small), upright, 1e-9 * upright);
  EXPECT_NEAR(chain_modulus(5, std::numbers::pi / 6.0, Kinematics::finite), upright, 1e-9 * upright);
}

TEST(PatchTest, GivesTheSameStressAfterTurningTheModelByThirtyDegrees) {
  const double angle = std::numbers::pi / 6.0;
  const ModelOf<2> model = tessellated(60, 0.1, 0.1, 9);
  const ModelOf<2> turned_model = tessellated(60, 0.1, 0.1, 9, angle);
  auto a = mechanics(model, mortar_contact(), quasi_static<2>());
  auto b = mechanics(turned_model, mortar_contact(), quasi_static<2>());
  const auto field = [](const Vec<2>& x) { return Vec<2>{{1e-4 * x[0] * x[1], -2e-4 * x[1] * x[1]}}; };
  impose(a, field, 10);
  impose(
      b, [&](const Vec<2>& x) { return turned(field(turned(x, -angle)), angle); }, 10);
  double scale = 0.0, worst = 0.0;
  for (std::size_t z = 0; z < a.read().stresses().size(); ++z) {
    const auto s = rotated<2>({std::cos(angle), std::sin(angle)}, a.read().stresses()[z]);
    for (std::size_t i = 0; i < 3; ++i) {
      scale = std::max(scale, std::abs(s[i]));
      worst = std::max(worst, std::abs(s[i] - b.read().stresses()[z][i]));
    }
  }
  EXPECT_LT(worst, 1e-9 * scale);
}

// Promise: the result is bitwise the same with 1 and 2 threads.
TEST(Determinism, IsBitwiseTheSameWithOneAndTwoThreads) {
  const ModelOf<2> model = tessellated(120, 0.05, 0.05, 3);
  const auto run = [&](int threads) {
    auto parameters = quasi_static<2>();
    parameters.zones_for_a_thread = 1;
    parameters.kinematics = Kinematics::finite;
    parameters.damping_form = DampingForm::combined;
    parameters.gravity = {{0.0, -9.81}};
    auto m = mechanics(model, mortar_contact(), parameters, 29.4e9, 0.2,
                       std::make_shared<Team>(threads, WhenCrowded::stay));
    for (int g = 0; g < model.gridpoint_count(); ++g) {
      const double y = model.position[g][1];
      if (y == 0.0 || y == 0.05) m.constraints().prescribe_velocity(g, 1, y == 0.0 ? 0.0 : 2e-3);
    }
    m.advance(2000);
    return std::tuple(m.read().displacements(), m.read().forces(), m.totals().energy().loading,
                      m.totals().energy().accounted());
  };
  const auto one = run(1);
  const auto two = run(2);
  EXPECT_TRUE(one == two);
  EXPECT_GT(std::get<2>(one), 0.0);
}

// Promise: so it is where the threads have one core for the two of them, so that they give way amid the
// steps.
TEST(Determinism, IsBitwiseTheSameWhereThreadsGiveWayAmidTheSteps) {
  const ModelOf<2> model = tessellated(120, 0.05, 0.05, 3);
  const auto run = [&](const std::shared_ptr<Team>& team) {
    auto parameters = quasi_static<2>();
    parameters.zones_for_a_thread = 1;
    auto m = mechanics(model, mortar_contact(), parameters, 29.4e9, 0.2, team);
    for (int g = 0; g < model.gridpoint_count(); ++g) {
      const double y = model.position[g][1];
      if (y == 0.0 || y == 0.05) m.constraints().prescribe_velocity(g, 1, y == 0.0 ? 0.0 : 2e-3);
    }
    m.advance(300);
    return std::tuple(m.steps(), m.read().displacements(), m.read().forces(), m.totals().energy().loading,
                      m.totals().energy().accounted());
  };
  const auto straight = run(std::make_shared<Team>(1));
  cpu_set_t before, one;
  ASSERT_EQ(sched_getaffinity(0, sizeof before, &before), 0);
  int first = 0;
  while (!CPU_ISSET(first, &before)) ++first;
  CPU_ZERO(&one);
  CPU_SET(first, &one);
  ASSERT_EQ(sched_setaffinity(0, sizeof one, &one), 0);
  const auto team = std::make_shared<Team>(2);
  const auto gave_way = run(team);
  ASSERT_EQ(sched_setaffinity(0, sizeof before, &before), 0);
  EXPECT_TRUE(gave_way == straight);
  EXPECT_EQ(team->offered(), 1);
}

// Promise: a rigid block slides down a 40 degree incline with phi = 20 degrees at g (sin 40 - cos 40 tan 20).
TEST(InclineVerification, ABlockSlidesAtTheAccelerationOfCoulombFriction) {
  const double slope = 40.0 * std::numbers::pi / 180.0;
  const double phi = 20.0 * std::numbers::pi / 180.0;
  const ModelOf<2> model = column(2, 0.1, -slope);
  const Frictional::Properties<double> contact{1e9, 1e9, std::tan(phi)};
  MechanicsParameters p;
  p.gravity = {{0.0, -9.81}};
  p.mass = MassChoice::real;
  p.safety = 0.5;
  auto m = mechanics(model, contact, p, 1e9);  // rigid enough: weight compresses it by 1e-6 of its size
  for (int g = 0; g < 4; ++g)
    for (int i : {0, 1}) m.constraints().prescribe_velocity(g, i, 0.0);
  const Vec<2> downhill{{std::cos(slope), -std::sin(slope)}};
  const auto speed = [&] {
    double v = 0.0;
    for (int g = 4; g < 8; ++g) v += 0.25 * dot(m.read().velocities()[g], downhill);
    return v;
  };
  const double expected = 9.81 * (std::sin(slope) - std::cos(slope) * std::tan(phi));
  // Nothing damps the bounce of the block on its contacts, so the mean over many bounces is taken.
  m.advance(2000);
  const double v0 = speed(), t0 = m.time();
  m.advance(200000);
  const double acceleration = (speed() - v0) / (m.time() - t0);
  expect_known(
      {"Acceleration of a block that slides down 40 degrees", "Coulomb friction of 20 degrees", "m/s2"},
      acceleration, expected, 1e-3 * expected);
}

// Promise: a prism of blocks torn apart dissipates G_f1 times its area, at any damping.
class TornPrismVerification : public testing::TestWithParam<std::tuple<double, DampingForm>> {};
INSTANTIATE_TEST_SUITE_P(Damping, TornPrismVerification,
                         testing::Combine(testing::Values(0.0, 0.2, 0.8),
                                          testing::Values(DampingForm::local, DampingForm::combined)));

TEST_P(TornPrismVerification, DissipatesTheModeOneEnergyOfOneSection) {
  const double d = 0.003;
  const ModelOf<2> model = column(4, d);
  auto parameters = quasi_static<2>(std::get<0>(GetParam()));
  parameters.damping_form = std::get<1>(GetParam());
  // Where nothing damps, the halves ring at the highest frequency; a step far below its limit follows the
  // law's corners.
  parameters.safety = 0.3;
  auto m = mechanics(model, mortar_contact(), parameters);
  for (int g : {0, 1, 14, 15})
    for (int i : {0, 1}) m.constraints().prescribe_velocity(g, i, 0.0);
  for (int g : {14, 15}) m.constraints().prescribe_velocity(g, 1, 1e-3);
  m.advance(10000);  // to an opening of 100 um; u_f is 48 um
  const auto e = m.totals().energy();
  int torn = 0;
  double partly = 0.0;
  for (std::size_t c = 0; c < m.read().contacts().size(); ++c) {
    const double damage = m.read().contacts()[c].remembered(Remembers::tension_damage);
    if (damage == 1.0)
      ++torn;
    else
      partly +=
          damage * 60.0 * model.contacts[c].area;  // sections that softened a little before one of them broke
  }
  EXPECT_EQ(torn, 2);
  expect_known(
      {"Energy that tearing a prism dissipates, whatever the damping", "G_f1 times the section", "J/m"},
      e.dissipated.of("tension") - partly, 60.0 * d, 1e-3 * 60.0 * d);
  // 0.5 %: the ledger's promise; the work done includes what damping took
  EXPECT_LT(std::abs(e.error()), 5e-3 * e.work_in());
}

/// \param faster  factor of the velocities, by which the steps are fewer
template <int Dim>
void expect_ledger_to_close(const ModelOf<Dim>& model, Kinematics kinematics, double faster) {
  auto parameters = quasi_static<Dim>(0.5);
  parameters.kinematics = kinematics;
  parameters.viscous_damping = 50.0;
  auto m = mechanics(model, mortar_contact(), parameters);
  for (int g = 0; g < model.gridpoint_count(); ++g) {
    const double y = model.position[g][1];
    if (y != 0.0 && y != 0.05) continue;
    m.constraints().prescribe_velocity(g, 0, y == 0.0 ? 0.0 : 2e-3 * faster);
    m.constraints().prescribe_velocity(g, 1, y == 0.0 ? 0.0 : -1e-3 * faster);
  }
  m.advance(static_cast<int>(20000 / faster));
  const auto e = m.totals().energy();
  EXPECT_GT(e.dissipated.of("shear"), 0.0);
  EXPECT_GT(e.dissipated.of("friction"), 0.0);
  EXPECT_GT(e.viscous_damping, 0.0);
  EXPECT_LT(std::abs(e.error()), 5e-3 * e.work_in());  // the promise of the ledger
}

TEST(Energy, LedgerOfAShearedAndCrushedBodyCloses) {
  for (const Kinematics kinematics : {Kinematics::small, Kinematics::finite})
    expect_ledger_to_close<2>(tessellated(60, 0.05, 0.05, 5), kinematics, 1.0);
  expect_ledger_to_close<3>(laguerre_cells(30, 0.05, 3), Kinematics::finite, 5.0);
}

// Promise: the stable step is safe; just above twice it, motion blows up, so it is not idle either.
TEST(TimeStep, TheStatedStepIsStableAndNotIdle) {
  const ModelOf<2> model = tessellated(40, 0.05, 0.05, 6);
  const auto kinetic_after = [&](double safety) {
    MechanicsParameters p;
    p.mass = MassChoice::real;
    p.safety = safety;
    p.local_damping = 0.3;
    auto m = mechanics(model, elastic_contact(), p);
    m.constraints().apply_force(5, {{1.0, 0.5}});
    m.advance(3000);
    return m.totals().energy().kinetic;
  };
  EXPECT_LT(kinetic_after(1.0), 1e-6);
  EXPECT_FALSE(kinetic_after(2.5) < 1e-3);
}

TEST(Damping, ABodyPulledSteadilyIsDraggedByLocalDampingAndNotByCombinedDamping) {
  const ModelOf<2> model = tessellated(100, 0.02, 0.1, 8);
  const auto difference_of_ends = [&](DampingForm form) {
    auto parameters = quasi_static<2>(0.8);
    parameters.damping_form = form;
    auto m = mechanics(model, elastic_contact(), parameters);
    std::vector<int> bottom, top;
    for (int g = 0; g < model.gridpoint_count(); ++g) {
      if (model.position[g][1] == 0.0) bottom.push_back(g);
      if (model.position[g][1] == 0.1) top.push_back(g);
    }
    for (int g : bottom) m.constraints().prescribe_velocity(g, 1, 0.0);
    for (int g : top) m.constraints().prescribe_velocity(g, 1, 1e-3);
    double difference = 0.0;
    m.advance(10000);
    for (int i = 0; i < 200; ++i) {  // mean over vibrations
      m.advance(17);
      for (int g : bottom) difference += m.read().forces()[g][1];
      for (int g : top) difference += m.read().forces()[g][1];
    }
    return std::abs(difference) / 200.0;
  };
  EXPECT_LT(difference_of_ends(DampingForm::combined), 0.1 * difference_of_ends(DampingForm::local));
}

}  // namespace
}  // namespace pyroclast
