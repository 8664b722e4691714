#include <algorithm>
#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "bodies.hpp"
#include "known.hpp"
#include "pyroclast/base/random.hpp"

/// Pressure of pore water: it widens zones, and parts the sides of contacts.
namespace pyroclast::pore_pressure_test {
namespace {

using namespace bodies;

constexpr double young = 29.4e9, poisson = 0.2;

/// One material and one interface under a pressure, of which zones and contacts bear shares.
template <int Dim>
BodyProperties pressed(const ModelOf<Dim>& model, const ContactProperties& contact, double in_zones,
                       double at_contacts) {
  const double strain = in_zones * (1.0 - 2.0 * poisson) / young;
  BodyProperties p = by_interface(
      model, std::vector<ZoneProperties>(model.zones.size(), zone_properties<Dim>(young, poisson, strain)),
      {contact});
  p.pore_pressure.assign(model.contacts.size(), at_contacts);
  return p;
}

/// Body without pressure, which can have some.
template <int Dim>
Mechanics<Dim> dry(const ModelOf<Dim>& model, const ContactProperties& contact,
                   const MechanicsParameters& parameters) {
  return {model, {2400.0}, pressed(model, contact, 0.0, 0.0), parameters};
}

template <int Dim>
void expect_free_swelling(const ModelOf<Dim>& model, int axis, double length, double height,
                          Kinematics kinematics) {
  const double biot = 0.5, pressure = 3e6;
  auto parameters = settling<Dim>(40);
  parameters.kinematics = kinematics;
  auto m = dry(model, elastic_contact(), parameters);
  m.set_properties(pressed(model, elastic_contact(), biot * pressure, biot * pressure));
  m.advance(6000);
  double low = 0.0, high = 0.0, stress = 0.0;
  for (int g = 0; g < model.gridpoint_count(); ++g) {
    const double u = m.read().displacement(g)[axis];
    if (model.position[g][axis] < 1e-9) low = u;
    if (model.position[g][axis] > length - 1e-9) high = u;
  }
  for (const auto& s : m.read().stresses())
    for (const double component : s) stress = std::max(stress, std::abs(component));
  const int faces = static_cast<int>(std::lround(length / height)) - 1;
  const double opening = faces * biot * pressure / elastic_contact().normal_stiffness;
  const double exact = biot * pressure * (1.0 - 2.0 * poisson) / young * length + opening;
  // 1e-6: strains beside 1, which small kinematics leaves out
  const double within = kinematics == Kinematics::small ? 1e-9 : 1e-4;
  expect_known({std::string("Lengthening of a free column under pore pressure, ") +
                    (Dim == 2 ? "plane stress" : "in space"),
                "b p (1 - 2 nu) / E of blocks, b p / K_n of contacts", "m"},
               high - low, exact, within * exact);
  EXPECT_LT(stress, 1e-9 * pressure);  // Terzaghi: no total stress
  for (const auto& c : m.read().contacts())
    EXPECT_NEAR(c.normal_traction, biot * pressure, 1e-9 * pressure);  // the law holds what parts it
}

TEST(PorePressureVerification, AFreeBodySwellsWithoutStress) {
  expect_free_swelling(column(4, 0.01), 1, 0.04, 0.01, Kinematics::small);
  expect_free_swelling(column(4, 0.01), 1, 0.04, 0.01, Kinematics::finite);
  expect_free_swelling(cubes(3, 0.01), 2, 0.03, 0.01, Kinematics::small);
  expect_free_swelling(cubes(3, 0.01), 2, 0.03, 0.01, Kinematics::finite);
}

TEST(PorePressureVerification, ASealedBodyBetweenFixedPlatesBearsThePressureAsTotalStress) {
  const ModelOf<3> model = cubes(3, 0.01);
  const double pressure = 3e6;
  auto contact = elastic_contact();
  contact.normal_stiffness *= 1e3;
  auto m = dry(model, contact, settling<3>(400));
  for (int g = 0; g < model.gridpoint_count(); ++g)
    for (int i = 0; i < 3; ++i)
      if (const double x = model.position[g][i]; x == 0.0 || x == (i == 2 ? 0.03 : 0.01))
        m.constraints().prescribe_velocity(g, i, 0.0);
  m.set_properties(pressed(model, contact, pressure, pressure));
  m.advance(4000);
  for (const auto& s : m.read().stresses())
    for (int i = 0; i < 3; ++i) EXPECT_NEAR(s[i], -pressure, 1e-6 * pressure);
}

TEST(PorePressureVerification, TwoBlocksPartWhereTheirShareOfThePressureComesToTheTensileStrength) {
  const ModelOf<2> model = column(2, 0.01);
  auto contact = mortar_contact();
  contact.tensile_strength = 2.5e6;
  for (const double share : {1.0, 0.5}) {
    auto m = dry(model, contact, settling<2>(40));
    double broke_at = 0.0;
    for (double pressure = 0.05e6; broke_at == 0.0 && pressure < 6e6; pressure += 0.05e6) {
      m.set_properties(pressed(model, contact, share * pressure, share * pressure));
      m.advance(600);
      if (m.read().remembered(0, Remembers::tension_damage) > 0.0) broke_at = pressure;
    }
    expect_known(
        {"Pore pressure that parts two blocks of 2.5 MPa, its share " + std::to_string(share).substr(0, 3),
         "f_t over the share, within one increment", "Pa"},
        broke_at, 2.5e6 / share, 0.0501e6);
  }
}

template <int Dim>
MechanicsParameters swaying(Kinematics kinematics) {
  auto parameters = quasi_static<Dim>(0.0);
  parameters.kinematics = kinematics;
  parameters.safety = 0.2;
  return parameters;
}

/// Lets a dry body sway, and returns properties with a pressure of its own at each contact.
template <int Dim>
BodyProperties shaken(Mechanics<Dim>& m, const ModelOf<Dim>& model) {
  Random random(4);
  std::vector<Vec<Dim>> velocities(model.position.size());
  for (auto& v : velocities)
    for (double& component : v.c) component = random.uniform(-0.02, 0.02);
  m.begin_moving(velocities);
  m.advance(200);
  auto properties = pressed(model, elastic_contact(), 0.0, 0.0);
  for (double& p : properties.pore_pressure) p = random.uniform(0.0, 5e6);
  return properties;
}

// Promise: pressure moves neither the body's centre nor turns it, however its blocks lie, and its work is the
// ledger's.
template <int Dim>
void expect_balance_under_pressure(const ModelOf<Dim>& model, Kinematics kinematics) {
  auto m = dry(model, elastic_contact(), swaying<Dim>(kinematics));
  const BodyProperties properties = shaken(m, model);
  m.set_properties(properties);
  m.advance(1);
  Vec<3> force{}, moment{};
  double size = 0.0;
  for (int g = 0; g < model.gridpoint_count(); ++g) {
    const Vec<3> f = resized<3>(m.read().force(g));
    force += f;
    moment += cross(resized<3>(model.position[g] + m.read().displacement_of_force(g)), f);
    size += norm(f);
  }
  EXPECT_LT(norm(force), 1e-12 * size);
  // contacts with small displacements do not keep moments
  EXPECT_LT(norm(moment), (kinematics == Kinematics::finite ? 1e-12 : 1e-3) * 0.05 * size);
  m.advance(400);
  const EnergyLedger e = m.totals().energy();
  EXPECT_GT(e.pore_pressure, 1e-3 * turnover(e));
  EXPECT_LT(std::abs(e.error()), (kinematics == Kinematics::small ? 1e-9 : 1e-4) * turnover(e));
  m.set_properties(pressed(model, elastic_contact(), 0.0, 0.0));
  m.advance(1);
  const EnergyLedger after = m.totals().energy();
  EXPECT_LT(std::abs(after.error()), (kinematics == Kinematics::small ? 1e-9 : 1e-4) * turnover(after));
}

TEST(PorePressure, LeavesMomentumAndEnergyInBalance) {
  for (const auto kinematics : {Kinematics::small, Kinematics::finite})
    expect_balance_under_pressure(tessellated(40, 0.05, 0.05, 3), kinematics);
  expect_balance_under_pressure(laguerre_cells(20, 0.05, 3), Kinematics::finite);
}

/// Pressed body whose pressure falls as contacts open by more than they are open now.
template <int Dim>
BodyProperties with_reserve(const Mechanics<Dim>& m, BodyProperties properties, double reserve) {
  properties.pore_reserve = reserve;
  for (int c = 0; c < static_cast<int>(properties.pore_pressure.size()); ++c)
    properties.pore_opening.push_back(m.read().opening(c));
  return properties;
}

// Promise: as a contact opens, the pressure falls to w / (w + further opening) of its value.
TEST(PorePressureVerification, AReserveFallsAsTheContactOpens) {
  const ModelOf<2> model = column(2, 0.01);
  auto m = dry(model, elastic_contact(), settling<2>(40));
  const double pressure = 3e6, reserve = 20e-6, stiffness = elastic_contact().normal_stiffness;
  m.set_properties(with_reserve(m, pressed(model, elastic_contact(), 0.0, pressure), reserve));
  m.advance(3000);
  const double k = stiffness * reserve;  // u K = p w / (w + u)
  const double exact = 0.5 * reserve * (std::sqrt(1.0 + 4.0 * pressure / k) - 1.0);
  expect_known({"Opening of a contact under a pressure of 3 MPa with a reserve of 20 um",
                "root of K u = p w / (w + u)", "m"},
               m.read().opening(0), exact, 1e-9 * exact);
  const double broken = 50e-6;  // a broken contact, drawn open
  for (const double opening : {-1e-6, 0.0, broken})
    EXPECT_NEAR(m.body().properties.work_of_pore_pressure(0, opening),
                pressure * (opening > 0.0 ? reserve * std::log(1.0 + opening / reserve) : opening),
                1e-9 * pressure * broken);
}

TEST(PorePressure, ThatFallsKeepsMomentumAndTheLedger) {
  const ModelOf<2> model = tessellated(40, 0.05, 0.05, 3);
  for (const auto kinematics : {Kinematics::small, Kinematics::finite}) {
    auto m = dry(model, elastic_contact(), swaying<2>(kinematics));
    const BodyProperties properties = shaken(m, model);
    m.set_properties(with_reserve(m, properties, 5e-6));
    m.advance(400);
    Vec<2> force{};
    double size = 0.0;
    for (int g = 0; g < model.gridpoint_count(); ++g) {
      force += m.read().force(g);
      size += norm(m.read().force(g));
    }
    EXPECT_LT(norm(force), 1e-12 * size);
    const EnergyLedger e = m.totals().energy();
    EXPECT_GT(e.pore_pressure, 1e-2 * turnover(e));
    EXPECT_LT(std::abs(e.error()), 1e-5 * turnover(e));  // a force that falls is no spring: 1.6e-6
  }
}

}  // namespace
}  // namespace pyroclast::pore_pressure_test
