#include "textbook.hpp"

#include <algorithm>
#include <array>
#include <limits>
#include <ostream>
#include <random>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "bodies.hpp"
#include "known.hpp"
#include "model/small_specimen.hpp"
#include "pyroclast/model/concrete_model.hpp"

/// Mechanics<2> beside the textbook step: the same equations, written twice and run side by side.
namespace pyroclast {
namespace {

using namespace bodies;

/// The same body in both codes, loaded and moved alike.
class Pair {
 public:
  Pair(const ModelOf<2>& model, const std::vector<double>& densities, const BodyProperties& properties,
       const MechanicsParameters& parameters)
      : mechanics_(model, densities, properties, parameters),
        textbook_(model, densities, properties, parameters) {}

  void prescribe_velocity(int gridpoint, int component, double velocity) {
    mechanics_.constraints().prescribe_velocity(gridpoint, component, velocity);
    textbook_.prescribe_velocity(gridpoint, component, velocity);
  }
  void advance(int steps) {
    mechanics_.advance(steps);
    textbook_.advance(steps);
  }

  const Mechanics<2>& mechanics() const { return mechanics_; }
  const textbook::Body& textbook() const { return textbook_; }
  double time_step() const { return textbook_.time_step(); }

 private:
  Mechanics<2> mechanics_;
  textbook::Body textbook_;
};

/// Largest difference over the largest value.
struct Difference {
  double largest = 0.0, value = 0.0;

  void add(double a, double b) {
    largest = std::max(largest, std::abs(a - b));
    value = std::max(value, std::abs(b));
  }
  double relative() const { return largest / value; }
};

Difference of_displacements(const Pair& pair) {
  Difference d;
  for (int g = 0; g < pair.mechanics().model().gridpoint_count(); ++g)
    for (int i : {0, 1})
      d.add(pair.mechanics().read().displacement(g)[i], pair.textbook().gridpoints()[g].displacement[i]);
  return d;
}

Difference of_velocities(const Pair& pair) {
  Difference d;
  for (int g = 0; g < pair.mechanics().model().gridpoint_count(); ++g)
    for (int i : {0, 1})
      d.add(pair.mechanics().read().velocity(g)[i], pair.textbook().gridpoints()[g].velocity[i]);
  return d;
}

Difference of_stresses(const Pair& pair) {
  Difference d;
  for (int z = 0; z < pair.mechanics().model().zone_count(); ++z)
    for (int i : {0, 1, 2}) d.add(pair.mechanics().read().stress(z)[i], pair.textbook().zones()[z].stress[i]);
  return d;
}

Difference of_tractions(const Pair& pair) {
  Difference d;
  for (int c = 0; c < pair.mechanics().model().contact_count(); ++c) {
    const auto ours = pair.mechanics().read().contact(c);
    const auto& theirs = pair.textbook().contacts()[c];
    d.add(ours.normal_traction, theirs.normal_traction);
    d.add(ours.shear_traction[0], theirs.shear_traction);
  }
  return d;
}

/// Largest difference of a damage; damages lie between 0 and 1.
double of_damages(const Pair& pair) {
  double largest = 0.0;
  for (int c = 0; c < pair.mechanics().model().contact_count(); ++c) {
    const auto& theirs = pair.textbook().contacts()[c];
    largest = std::max(
        {largest,
         std::abs(pair.mechanics().read().remembered(c, Remembers::tension_damage) - theirs.tension_damage),
         std::abs(pair.mechanics().read().remembered(c, Remembers::shear_damage) - theirs.shear_damage)});
  }
  return largest;
}

/// Sum of all damages of a body, tension and shear.
double total_damage(const Mechanics<2>& m) {
  double sum = 0.0;
  for (int c = 0; c < m.model().contact_count(); ++c)
    sum +=
        m.read().remembered(c, Remembers::tension_damage) + m.read().remembered(c, Remembers::shear_damage);
  return sum;
}

double total_damage(const textbook::Body& body) {
  double sum = 0.0;
  for (const auto& c : body.contacts()) sum += c.tension_damage + c.shear_damage;
  return sum;
}

struct NamedContact {
  const char* name;
  ContactProperties contact;
};

void PrintTo(const NamedContact& c, std::ostream* stream) {
  *stream << c.name;
}

std::vector<NamedContact> contacts() {
  std::vector<NamedContact> all{{"Mortar", mortar_contact()}, {"Elastic", elastic_contact()}};
  auto p = mortar_contact();
  p.compression = Cohesive::Compression::reversible;
  all.push_back({"Reversible", p});
  p = mortar_contact();
  p.coupled = true;
  all.push_back({"Coupled", p});
  p = mortar_contact();
  p.residual_friction_angle = std::atan(0.5 * std::tan(p.friction_angle));
  all.push_back({"FrictionThatDrops", p});
  return all;
}

class LawBesideTextbook : public testing::TestWithParam<NamedContact> {};
INSTANTIATE_TEST_SUITE_P(Contacts, LawBesideTextbook, testing::ValuesIn(contacts()),
                         testing::PrintToStringParamName());

// Promise: on any way of the jump, through tearing, crushing and sliding both ways, the law of the library
// and that of the textbook give the same tractions and damages.
TEST_P(LawBesideTextbook, SameTractionsAndDamagesOnARandomWay) {
  const ModelOf<2> model = column(2, 0.01);
  std::mt19937_64 random(7);
  std::uniform_real_distribution<double> of_unit(-1.0, 1.0);
  double most_damage = 0.0;
  for (int way = 0; way < 20; ++way) {
    Pair pair(model, {2400.0},
              by_interface(model, std::vector<ZoneProperties>(4, zone_properties<2>(29.4e9, 0.2)),
                           {GetParam().contact}),
              quasi_static<2>());
    Difference tractions;
    for (int leg = 0; leg < 40; ++leg) {
      // a leg of 50 steps changes the jump by up to 20 micrometres: u_e is 0.14, u_f 48, the end of the first
      // slope in compression 1.7
      const double shear = 20e-6 * of_unit(random), open = 20e-6 * of_unit(random) - 1e-6;
      for (int g = 0; g < 8; ++g) {
        pair.prescribe_velocity(g, 0, g < 4 ? 0.0 : shear / (50 * pair.time_step()));
        pair.prescribe_velocity(g, 1, g < 4 ? 0.0 : open / (50 * pair.time_step()));
      }
      for (int step = 0; step < 50; ++step) {
        pair.advance(1);
        tractions.add(of_tractions(pair).largest, 0.0);
        for (const auto& c : pair.textbook().contacts())
          tractions.value =
              std::max({tractions.value, std::abs(c.normal_traction), std::abs(c.shear_traction)});
      }
    }
    // Round-off of one step is 1e-16 of the traction; the textbook's incremental shear adds up that of 2000.
    EXPECT_LT(tractions.relative(), 2000 * 1e-16);
    EXPECT_LT(of_damages(pair), 2000 * 1e-16);
    most_damage = std::max(most_damage, total_damage(pair.textbook()));
  }
  if (GetParam().contact.law == &table_of<Cohesive>()) {
    EXPECT_GT(most_damage, 3.0);  // of 4: two contact points, tension and shear
  }
}

enum class Drive { tension, shear, compression };

void PrintTo(Drive drive, std::ostream* stream) {
  *stream << std::array{"Tension", "Shear", "Compression"}[static_cast<std::size_t>(drive)];
}

/// A square of random blocks, its lower edge held, its upper edge driven.
struct Square {
  ModelOf<2> model = tessellated(120, 0.05, 0.05, 3);

  Pair pair(const MechanicsParameters& parameters, Drive drive, double velocity_factor = 1.0) const {
    Pair p(model, {2400.0},
           by_interface(
               model, std::vector<ZoneProperties>(model.zones.size(), zone_properties<2>(29.4e9, 0.2, 1e-5)),
               {mortar_contact()}),
           parameters);
    // fast enough that most contacts are damaged after 4000 steps of 10 us
    const double across = drive == Drive::shear ? 4e-3 : 0.0;
    const double along = drive == Drive::tension ? 2e-3 : drive == Drive::compression ? -8e-3 : 0.0;
    for (int g = 0; g < model.gridpoint_count(); ++g) {
      const double y = model.position[g][1];
      if (y != 0.0 && y != 0.05) continue;
      p.prescribe_velocity(g, 0, y == 0.0 ? 0.0 : across * velocity_factor);
      p.prescribe_velocity(g, 1, y == 0.0 ? 0.0 : along * velocity_factor);
    }
    return p;
  }
};

MechanicsParameters with_gravity(MechanicsParameters p) {
  p.gravity = {{1.0, -9.81}};
  return p;
}

// Promise: before cracking, displacements, velocities, stresses and tractions are the textbook's to
// round-off, with scaled and with real mass.
TEST(TextbookVerification, TheSameToRoundOffBeforeCracking) {
  const Square square;
  for (MassChoice mass : {MassChoice::scaled, MassChoice::real}) {
    auto parameters = with_gravity(quasi_static<2>(0.0));
    parameters.mass = mass;
    Pair pair = square.pair(parameters, Drive::compression, 0.02);
    EXPECT_DOUBLE_EQ(pair.mechanics().time_step(), pair.textbook().time_step());
    pair.advance(1000);
    ASSERT_EQ(total_damage(pair.textbook()), 0.0);
    // Nothing is damped, so what round-off puts in stays: at most 1e-16 a step, a thousand times. Stresses
    // are differences of displacements across a zone, velocities those of forces that nearly cancel.
    expect_known_field({"1,000 steps of random blocks before cracking: displacements over the largest",
                        "own second code", "1"},
                       of_displacements(pair).relative(), 1.0, 1e-13);
    EXPECT_LT(of_velocities(pair).relative(), 1e-11);
    EXPECT_LT(of_stresses(pair).relative(), 1e-11);
    EXPECT_LT(of_tractions(pair).relative(), 1e-11);
  }
}

class DriveBesideTextbook : public testing::TestWithParam<Drive> {};
INSTANTIATE_TEST_SUITE_P(Drives, DriveBesideTextbook,
                         testing::Values(Drive::tension, Drive::shear, Drive::compression),
                         testing::PrintToStringParamName());

// Promise: with smooth damping the two stay together all through cracking.
TEST_P(DriveBesideTextbook, TheSameThroughCrackingWithoutLocalDamping) {
  const Square square;
  for (double viscous : {0.0, 200.0}) {
    auto parameters = with_gravity(quasi_static<2>(0.0));
    parameters.viscous_damping = viscous;
    Pair pair = square.pair(parameters, GetParam());
    pair.advance(4000);
    const auto& contacts = pair.textbook().contacts();
    const auto damaged = std::count_if(contacts.begin(), contacts.end(), [](const auto& c) {
      return c.tension_damage > 0.0 || c.shear_damage > 0.0;
    });
    EXPECT_GT(damaged, 0.5 * static_cast<double>(contacts.size()));
    // Every contact that tears lets neighbouring motions part a little faster. Over these drives round-off
    // grows to 1e-11 of the displacement and 1e-8 of the velocity; an error in the equations shows at 1e-3.
    EXPECT_LT(of_displacements(pair).relative(), 1e-9);
    EXPECT_LT(of_velocities(pair).relative(), 1e-6);
    EXPECT_LT(of_stresses(pair).relative(), 1e-7);
    EXPECT_LT(of_tractions(pair).relative(), 1e-7);
    EXPECT_LT(of_damages(pair), 1e-8);
  }
}

/// How far the textbook's velocities of a body are from those of its twins, at most.
double sensitivity(const Pair& pair, const std::vector<Pair>& twins) {
  double largest = 0.0;
  for (const Pair& twin : twins) {
    Difference d;
    for (std::size_t g = 0; g < pair.textbook().gridpoints().size(); ++g)
      for (int i : {0, 1})
        d.add(twin.textbook().gridpoints()[g].velocity[i], pair.textbook().gridpoints()[g].velocity[i]);
    largest = std::max(largest, d.relative());
  }
  return largest;
}

// Promise: local damping takes the sign of a velocity, and where that is near zero round-off decides. So the
// motion is chaotic; until it is, Mechanics is no further from the textbook than the textbook from itself
// when its drive is changed in the last digits, and afterwards the course of damage is the same.
TEST_P(DriveBesideTextbook, AsNearAsChaosAllowsWithLocalDamping) {
  const Square square;
  for (auto [form, ordered_steps] : {std::pair{DampingForm::local, 150}, {DampingForm::combined, 400}}) {
    auto parameters = with_gravity(quasi_static<2>(0.8));
    parameters.damping_form = form;
    Pair pair = square.pair(parameters, GetParam());
    std::vector<Pair> twins;
    for (int digits : {-2, -1, 1, 2})
      twins.push_back(
          square.pair(parameters, GetParam(), 1.0 + digits * std::numeric_limits<double>::epsilon()));
    for (int step = 50; step <= ordered_steps; step += 50) {
      pair.advance(50);
      for (Pair& twin : twins) twin.advance(50);
      // 30: last digits changed at the drive alone, against round-off in every force of every step
      EXPECT_LT(of_velocities(pair).relative(), 30.0 * sensitivity(pair, twins)) << "after " << step;
    }
    pair.advance(4000 - ordered_steps);
    const double expected = total_damage(pair.textbook());
    EXPECT_GT(expected, 30.0);
    // 3 %: single contacts crack in another order, the body as a whole does not
    EXPECT_NEAR(total_damage(pair.mechanics()), expected, 0.03 * expected);
  }
}

/// Concrete between platens, of Tables 1 and 2, and the forces that hold its lower platen.
struct Compression {
  ModelOf<2> model = between_platens(small_specimen(), 0.01, 1.0);

  Pair pair() const {
    const std::array<ZoneProperties, 3> solids{zone_properties<2>(70e9, 0.2), zone_properties<2>(29.4e9, 0.2),
                                               zone_properties<2>(200e9, 0.3)};
    std::vector<ZoneProperties> zones;
    for (int block : zone_blocks(model)) zones.push_back(solids[model.block_material[block]]);
    auto weaker = mortar_contact();
    for (double* of : {&weaker.normal_stiffness, &weaker.shear_stiffness, &weaker.tensile_strength,
                       &weaker.cohesion, &weaker.residual_cohesion, &weaker.compressive_limit})
      *of *= 0.8;
    const Frictional::Properties<double> platen{mortar_contact().normal_stiffness,
                                                mortar_contact().shear_stiffness, 0.0};
    auto parameters = quasi_static<2>();
    parameters.damping_form = DampingForm::combined;
    parameters.gravity = {{0.0, -9.81}};
    Pair p(model, {2650.0, 2200.0, 7850.0},
           by_interface(model, zones, {elastic_contact(), weaker, mortar_contact(), platen}), parameters);
    for (int g : model.set("bottom_platen_support"))
      for (int i : {0, 1}) p.prescribe_velocity(g, i, 0.0);
    for (int g : model.set("top_platen_support")) {
      p.prescribe_velocity(g, 0, 0.0);
      p.prescribe_velocity(g, 1, -2e-3);
    }
    return p;
  }

  double held_by_mechanics(const Pair& p) const {
    double sum = 0.0;
    for (int g : model.set("bottom_platen_support")) sum -= p.mechanics().read().force(g)[1];
    return sum;
  }
  double held_by_textbook(const Pair& p) const {
    double sum = 0.0;
    for (int g : model.set("bottom_platen_support")) sum -= p.textbook().gridpoints()[g].force[1];
    return sum;
  }
};

// Promise: a concrete specimen crushed between platens has the textbook's course of force and damage, past
// its peak.
TEST(TextbookVerification, TheSameCourseOfACompressionBetweenPlatens) {
  const Compression compression;
  Pair pair = compression.pair();
  double peak = 0.0, apart = 0.0, now = 0.0;
  for (int look = 0; look < 250; ++look) {
    pair.advance(100);
    now = compression.held_by_textbook(pair);
    apart = std::max(apart, std::abs(compression.held_by_mechanics(pair) - now));
    peak = std::max(peak, now);
  }
  EXPECT_LT(now, peak);
  // Local damping makes the motion chaotic, see above; a few contacts of 1,500 crack in another order.
  expect_known_field(
      {"Force on the platen through a compression test past its peak, over the peak", "own second code", "1"},
      apart / peak, 1.0, 0.01);
  const double damage = total_damage(pair.textbook());
  EXPECT_GT(damage, 100.0);
  EXPECT_NEAR(total_damage(pair.mechanics()), damage, 0.01 * damage);
}

}  // namespace
}  // namespace pyroclast
