#include <algorithm>
#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "bodies.hpp"
#include "known.hpp"
#include "pyroclast/base/error.hpp"
#include "pyroclast/mechanics/mechanics.hpp"

/// Zones that creep: free strain as a tensor, integration over an exchange, work.
namespace pyroclast {
namespace {

using namespace bodies;

constexpr double young = 29.4e9, poisson = 0.2, nu_L = 0.3;

template <int Dim>
ModelOf<Dim> block();
template <>
ModelOf<2> block<2>() {
  return column(1, 0.01);
}
template <>
ModelOf<3> block<3>() {
  return cubes(1, 0.01);
}

constexpr int kToRest = 1500;  ///< steps

/// All zones alike.
template <int Dim>
BodyProperties creeping(const ModelOf<Dim>& model, const CreepIncrement& creep, double thermal_strain = 0.0) {
  auto p = by_interface(
      model,
      std::vector<ZoneProperties>(model.zones.size(), zone_properties<Dim>(young, poisson, thermal_strain)),
      {elastic_contact()});
  p.creep.assign(model.zones.size(), creep);
  return p;
}

template <int Dim>
Mechanics<Dim> body(const ModelOf<Dim>& model, const MechanicsParameters& parameters) {
  return Mechanics<Dim>(model, {2400.0}, creeping(model, {.poisson = nu_L}), parameters);
}

/// Loads the whole outside by the tractions of a uniform stress.
template <int Dim>
void load(Mechanics<Dim>& m, const SymmetricTensor<Dim>& stress) {
  const auto& model = m.model();
  const auto geometry = zone_geometry(model);
  std::vector<Vec<Dim>> force(model.position.size());
  for (int z = 0; z < model.zone_count(); ++z)
    for (int n = 0; n < Dim; ++n) {
      const Vec<Dim> f = pyroclast::apply<Dim>(stress, geometry.gradient[z][n]) * geometry.volume[z];
      force[model.zones[z][n]] += f;
      force[model.zones[z][Dim]] -= f;
    }
  for (int g = 0; g < model.gridpoint_count(); ++g) m.constraints().apply_force(g, force[g]);
}

template <int Dim>
void creep(Mechanics<Dim>& m, const CreepIncrement& increment, double thermal_strain = 0.0,
           int steps = kToRest) {
  m.set_properties(creeping(m.model(), increment, thermal_strain));
  m.advance(steps);
  m.commit_creep();
}

template <std::size_t N>
double largest_difference(const std::array<double, N>& a, const std::array<double, N>& b) {
  double largest = 0.0;
  for (std::size_t i = 0; i < N; ++i) largest = std::max(largest, std::abs(a[i] - b[i]));
  return largest;
}

template <std::size_t N>
std::array<double, N> times(double factor, std::array<double, N> t) {
  for (double& component : t) component *= factor;
  return t;
}

// ---- Stress that is held

constexpr double kCompliance = 16.3e-3 / 35e6;  ///< of all increments, 1/Pa: that of concrete at 500 degC

template <int Dim>
void expect_exact_creep(const SymmetricTensor<Dim>& stress, const SymmetricTensor<Dim>& strain,
                        const char* what) {
  const ModelOf<Dim> model = block<Dim>();
  for (const int increments : {1, 7}) {
    auto m = body(model, settling<Dim>());
    load(m, stress);
    m.advance(kToRest);
    for (int i = 0; i < increments; ++i) creep(m, {.compliance = kCompliance / increments, .poisson = nu_L});
    double worst = 0.0;
    for (int z = 0; z < model.zone_count(); ++z)
      worst = std::max(worst, largest_difference(m.read().creep_strain(z), strain));
    const double scale = largest_difference(strain, {});
    expect_known_field({std::string("Creep strain under a held stress, ") + what,
                        "B / f_c [(1 + nu_L) sigma - nu_L tr(sigma) I], Thelandersson 1987", "1"},
                       worst, scale, 1e-9 * scale);
  }
}

TEST(CreepVerification, OfAHeldStressIsExactForAnyIncrement) {
  const double s = -10e6, e = kCompliance * s;
  expect_exact_creep<2>({s, 0.0, 0.0}, {e, -nu_L * e, 0.0}, "one axis, plane stress");
  expect_exact_creep<2>({s, s, 0.0}, {(1.0 - nu_L) * e, (1.0 - nu_L) * e, 0.0}, "two axes, plane stress");
  expect_exact_creep<2>({0.5 * s, 0.5 * s, 0.5 * s},
                        {0.5 * (1.0 - nu_L) * e, 0.5 * (1.0 - nu_L) * e, 0.5 * (1.0 + nu_L) * e},
                        "one axis at 45 degrees");
  expect_exact_creep<3>({0.0, 0.0, s, 0.0, 0.0, 0.0}, {-nu_L * e, -nu_L * e, e, 0.0, 0.0, 0.0},
                        "one axis, tetrahedra");
  expect_exact_creep<3>({s, s, s, 0.1 * s, 0.0, 0.0},
                        {(1.0 - 2.0 * nu_L) * e, (1.0 - 2.0 * nu_L) * e, (1.0 - 2.0 * nu_L) * e,
                         0.1 * (1.0 + nu_L) * e, 0.0, 0.0},
                        "three axes and shear, tetrahedra");
}

TEST(CreepVerification, IsLeftWhenTheStressIsTakenAway) {
  const ModelOf<2> model = block<2>();
  auto m = body(model, settling<2>());
  load<2>(m, {-10e6, 0.0, 0.0});
  m.advance(kToRest);
  creep(m, {.compliance = kCompliance, .poisson = nu_L});
  const auto crept = m.read().creep_strain(0);
  load<2>(m, {});
  creep(m, {.poisson = nu_L});  // another exchange, at which nothing is heated
  EXPECT_EQ(m.read().creep_strain(0), crept);
  const double shorter = (m.read().displacement(1)[0] - m.read().displacement(0)[0]) / 0.01;
  expect_known({"Strain after creep and unloading", "the creep strain alone", "1"}, shorter,
               -kCompliance * 10e6, 1e-9 * kCompliance * 10e6);
}

// Promise: the work of the load is the work of creep, and what the splitting into exchanges puts into the
// ledger goes down with the increment.
TEST(CreepVerification, TakesTheWorkOfAHeldLoad) {
  const ModelOf<2> model = block<2>();
  const auto ledger = [&](int increments) {
    auto m = body(model, settling<2>());
    load<2>(m, {-10e6, 0.0, 0.0});
    m.advance(kToRest);
    const EnergyLedger before = m.totals().energy();
    for (int i = 0; i < increments; ++i) creep(m, {.compliance = kCompliance / increments, .poisson = nu_L});
    const EnergyLedger after = m.totals().energy();
    const double work = after.loading - before.loading, lost = after.dissipated.of("creep");
    EXPECT_NEAR(lost, work, 1e-9 * work);
    EXPECT_NEAR(lost, kCompliance * 10e6 * 10e6 * 0.01 * 0.01, 1e-9 * work);
    EXPECT_NEAR(after.zones, before.zones, 1e-9 * work);
    EXPECT_LT(std::abs(after.error()), 1e-11 * turnover(after));
    return (after.property_change - before.property_change) / work;
  };
  const double coarse = ledger(200), fine = ledger(400);
  EXPECT_GT(coarse, 0.0);
  EXPECT_NEAR(coarse / fine, 2.0, 0.05);
}

// ---- Restraint

/// Stress of a bar that is held and heated in a number of exchanges, Pa.
double restrained(int increments, double expansion, double creep_rate, double rise) {
  const ModelOf<2> model = block<2>();
  auto m = body(model, settling<2>());
  for (int g = 0; g < model.gridpoint_count(); ++g) m.constraints().prescribe_velocity(g, 1, 0.0);
  const double step = rise / increments;
  double theta_scheme = 0.0;
  for (int i = 1; i <= increments; ++i) {
    creep(m, {.compliance = creep_rate * step, .poisson = nu_L}, expansion * step * i);
    theta_scheme = (theta_scheme * (1.0 / young - 0.5 * creep_rate * step) - expansion * step) /
                   (1.0 / young + 0.5 * creep_rate * step);
  }
  for (int z = 0; z < model.zone_count(); ++z) {
    EXPECT_NEAR(m.read().stress(z)[1], theta_scheme, 1e-9 * std::abs(theta_scheme));
    EXPECT_NEAR(m.read().stress(z)[0], 0.0, 1e-9 * std::abs(theta_scheme));
  }
  return m.read().stress(0)[1];
}

TEST(CreepVerification, RelaxesARestrainedBarToSecondOrder) {
  const double expansion = 1e-5, rate = 1.6e-12, rise = 100.0;
  const double exact = -expansion / rate * (1.0 - std::exp(-young * rate * rise));
  const double coarse = restrained(10, expansion, rate, rise), fine = restrained(20, expansion, rate, rise);
  EXPECT_GT(std::abs(coarse - exact), 1e-4 * std::abs(exact));  // else the order says nothing
  EXPECT_NEAR(std::log2((coarse - exact) / (fine - exact)), 2.0, 0.1);
  expect_known({"Stress of a bar restrained while it is heated by 100 K, creeping, 80 exchanges",
                "-alpha / c (1 - exp(-E c dT))", "Pa"},
               restrained(80, expansion, rate, rise), exact, 2e-4 * std::abs(exact));
}

// ---- Choices of the law

TEST(CreepVerification, SplitsTheStressByItsSign) {
  const double turn = 0.7, c = std::cos(turn), s = std::sin(turn);
  const auto turned_by = [&](const SymmetricTensor<2>& t) { return rotated<2>(Rotation<2>{c, s}, t); };
  const SymmetricTensor<2> stress = turned_by({-10e6, 4e6, 0.0});
  const auto at_held_stress = [](const CreepIncrement& increment, const SymmetricTensor<2>& held) {
    const auto split = creep_split<2>(increment, held);
    auto strain = creep_direction<2>(held, increment.poisson);
    for (int i = 0; i < 3; ++i) strain[i] = split.known[i] + split.compliance * strain[i];
    return strain;
  };
  for (const double tension : {0.0, 0.4, 1.0}) {
    const auto expected = turned_by(times(1e-12, creep_direction<2>({-10e6, tension * 4e6, 0.0}, nu_L)));
    const CreepIncrement increment{.compliance = 1e-12, .poisson = nu_L, .tension = tension};
    EXPECT_LT(largest_difference(at_held_stress(increment, stress), expected), 1e-14 * 10e6 * 1e-12 * 100);
    const double alike = (100.0 + tension * 16.0) / 116.0;
    EXPECT_NEAR(creep_split<2>(increment, stress).compliance, 0.5e-12 * alike, 1e-26);
  }
  const CreepIncrement increment{.compliance = 1e-12, .poisson = nu_L, .confinement = 1.5};
  EXPECT_NEAR(at_held_stress(increment, {-1e6, 0.0, 0.0})[0], -1e-6, 1e-18);
  EXPECT_NEAR(at_held_stress(increment, {-1e6, -1e6, 0.0})[0],
              -0.7e-6 * (1.0 + 1.5 * (std::numbers::sqrt2 - 1.0)), 1e-18);
  const CreepIncrement all{.compliance = 1e-12, .poisson = 0.0, .tension = 0.0, .confinement = 1.5};
  const auto three = creep_split<3>(all, {-1e6, -1e6, -1e6, 0.0, 0.0, 0.0});
  EXPECT_NEAR(2.0 * three.compliance, 1e-12 * (1.0 + 1.5 * (std::numbers::sqrt3 - 1.0)), 1e-24);
  // principal stresses -1, -1 and 2 MPa: s has no part of (1, 1, 1), the axis of the tension
  const CreepIncrement compression{.compliance = 1e-12, .poisson = 0.0, .tension = 0.0};
  const SymmetricTensor<3> skew{0.0, 0.0, 0.0, 1e6, 1e6, 1e6};
  const auto split = creep_split<3>(compression, skew);
  SymmetricTensor<3> held;
  for (int i = 0; i < 6; ++i) held[i] = split.known[i] + split.compliance * skew[i];
  EXPECT_LT(largest_difference(held, times(1e-6 / 3.0, SymmetricTensor<3>{-2.0, -2.0, -2.0, 1.0, 1.0, 1.0})),
            1e-18);
}

// ---- What a commit leaves alone

/// A body of many blocks that is pressed, sheared and heated unevenly.
template <int Dim>
Mechanics<Dim> crept(const ModelOf<Dim>& model, MechanicsParameters parameters, int exchanges,
                     double tension = 0.3) {
  Mechanics<Dim> m = body(model, parameters);
  SymmetricTensor<Dim> stress{};
  stress[0] = -3e6;
  stress[1] = -8e6;
  stress[Dim] = 1e6;
  load(m, stress);
  m.advance(300);
  for (int i = 1; i <= exchanges; ++i) {
    BodyProperties p = creeping(model, {}, 0.0);
    for (int z = 0; z < model.zone_count(); ++z) {
      p.zones[z].thermal_strain = 1e-4 * i * (1.0 + 0.01 * (z % 7));
      p.creep[z] = {.compliance = z % 3 == 0 ? 0.0 : 4e-12, .poisson = nu_L, .tension = tension};
    }
    if (i > 1) m.commit_creep();
    m.set_properties(p);
    m.advance(100);
  }
  return m;
}

template <int Dim>
void expect_that_a_commit_keeps_the_stress(const ModelOf<Dim>& model, MechanicsParameters parameters) {
  auto m = crept(model, parameters, 3);
  const auto stress = m.read().stresses();
  const auto forces = m.read().forces();
  const auto displacements = m.read().displacements();
  const EnergyLedger before = m.totals().energy();
  m.commit_creep();
  double worst = 0.0, unlike = 0.0, largest = 0.0;
  for (int z = 0; z < model.zone_count(); ++z) {
    worst = std::max(worst, largest_difference(m.read().stress(z), stress[z]));
    largest = std::max(largest, largest_difference(stress[z], {}));
    unlike = std::max(unlike, largest_difference(stress[z], stress[0]));
  }
  EXPECT_GT(unlike, 0.05 * largest);
  EXPECT_LT(worst, 1e-11 * largest);
  EXPECT_EQ(m.read().displacements(), displacements);
  EXPECT_GT(m.totals().energy().dissipated.of("creep"), before.dissipated.of("creep"));
  EXPECT_NEAR(m.totals().energy().error(), before.error(), 1e-12 * turnover(before));
  // exact where forces are linear in the displacements
  const double allowed = parameters.kinematics == Kinematics::small ? 1e-11 : 1e-6;
  EXPECT_LT(std::abs(before.error()), allowed * turnover(before));
}

TEST(Creep, LeavesStressesAsTheyAreWhenItIsCommitted) {
  expect_that_a_commit_keeps_the_stress<2>(tessellated(60, 0.05, 0.05, 4), quasi_static<2>());
  expect_that_a_commit_keeps_the_stress<3>(cubes(4, 0.01), quasi_static<3>());
  auto finite = quasi_static<2>();
  finite.kinematics = Kinematics::finite;
  expect_that_a_commit_keeps_the_stress<2>(tessellated(60, 0.05, 0.05, 4), finite);
  expect_that_a_commit_keeps_the_stress<3>(cubes(4, 0.01), finite);
}

/// \param turn  turns a vector
/// \param own   the turn of a zone
template <int Dim, class Turn>
void expect_creep_to_turn(Turn turn, const Rotation<Dim>& own) {
  const ModelOf<Dim> model = block<Dim>();
  auto parameters = settling<Dim>();
  parameters.kinematics = Kinematics::finite;
  auto m = body(model, parameters);
  load<Dim>(m, {10e6});  // a free body turns away from a force that presses it
  m.advance(10 * kToRest);
  creep(m, {.compliance = kCompliance, .poisson = nu_L});
  load<Dim>(m, {});
  m.advance(kToRest);
  const auto strain = m.read().creep_strain(0);
  const auto u = m.read().displacements();
  for (int g = 0; g < model.gridpoint_count(); ++g) {
    const Vec<Dim> way = turn(model.position[g] + u[g]) - model.position[g] - u[g];
    for (int i = 0; i < Dim; ++i) m.constraints().prescribe_velocity(g, i, way[i] / m.time_step());
  }
  m.advance(1);
  for (int g = 0; g < model.gridpoint_count(); ++g)
    for (int i = 0; i < Dim; ++i) m.constraints().prescribe_velocity(g, i, 0.0);
  m.advance(1);
  for (double component : m.read().stress(0)) EXPECT_NEAR(component, 0.0, 1e-9 * young * kCompliance * 10e6);
  EXPECT_LT(largest_difference(m.read().creep_strain(0), rotated<Dim>(own, strain)), 1e-12);
}

TEST(Creep, TurnsWithItsZone) {
  const double angle = 0.6, c = std::cos(angle), s = std::sin(angle);
  expect_creep_to_turn<2>([&](const Vec<2>& x) { return turned(x, angle); }, {c, s});
  // about the axis x
  const auto turn = [&](const Vec<3>& x) { return Vec<3>{{x[0], c * x[1] - s * x[2], s * x[1] + c * x[2]}}; };
  expect_creep_to_turn<3>(turn, {{turn({{1, 0, 0}}), turn({{0, 1, 0}}), turn({{0, 0, 1}})}});
}

// Promise: bit by bit the same in any instruction set and on any number of threads, also where it is in the
// middle of an exchange.
TEST(Creep, HasTheSameBitsInEveryInstructionSet) {
  const ModelOf<2> model = tessellated(150, 0.05, 0.05, 3);
  for (const Kinematics kinematics : {Kinematics::small, Kinematics::finite}) {
    auto parameters = quasi_static<2>();
    parameters.kinematics = kinematics;
    parameters.zones_for_a_thread = 1;
    const auto run = [&](InstructionSet set, int threads) {
      parameters.instructions = set;
      auto m = crept(model, parameters, 3);
      m.commit_creep();
      m.advance(20);
      const EnergyLedger e = m.totals().energy();
      return std::tuple(m.read().displacements(), m.read().stresses(), e.dissipated.total(),
                        e.property_change, threads * 0);
    };
    const auto expected = run(InstructionSet::portable, 1);
    for (InstructionSet set : usable_instruction_sets()) EXPECT_TRUE(run(set, 2) == expected) << name(set);
  }
}

TEST(Creep, CannotBeginInABodyThatWasMadeWithoutIt) {
  const ModelOf<2> model = block<2>();
  auto m = mechanics(model, elastic_contact(), quasi_static<2>());
  EXPECT_FALSE(m.body().creeps());
  EXPECT_EQ(m.totals().energy().dissipated.of("creep"), 0.0);
  EXPECT_THROW(m.set_properties(creeping(model, {.compliance = 1e-12, .poisson = nu_L})), Error);
}

}  // namespace
}  // namespace pyroclast
