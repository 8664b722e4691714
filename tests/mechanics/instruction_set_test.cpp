#include "pyroclast/mechanics/instruction_set.hpp"

#include <tuple>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "bodies.hpp"
#include "model/small_specimen.hpp"
#include "pyroclast/base/error.hpp"
#include "pyroclast/base/state_copy.hpp"
#include "pyroclast/model/concrete_model.hpp"

namespace pyroclast {
namespace {

using namespace bodies;

/// All that a run leaves behind.
template <int Dim>
auto outcome(const Mechanics<Dim>& m) {
  std::vector<double> numbers;
  for (int c = 0; c < m.model().contact_count(); ++c) {
    const auto state = m.read().contact(c);
    numbers.insert(numbers.end(), state.internals.begin(), state.internals.end());
    numbers.insert(numbers.end(), state.losses.begin(), state.losses.end());
  }
  const EnergyLedger e = m.totals().energy();
  for (double part : {e.loading, e.gravity, e.property_change, e.pore_pressure, e.zones, e.contacts,
                      e.kinetic, e.local_damping, e.viscous_damping, e.dissipated.total(),
                      m.totals().unbalanced_ratio(), m.totals().largest_relative_jump()})
    numbers.push_back(part);
  return std::tuple(m.read().displacements(), m.read().velocities(), m.read().forces(), numbers);
}

template <int Dim>
double damaged_share(const Mechanics<Dim>& m) {
  int damaged = 0;
  for (int c = 0; c < m.model().contact_count(); ++c) {
    damaged += m.read().remembered(c, Remembers::tension_damage) > 0.0 ||
               m.read().remembered(c, Remembers::shear_damage) > 0.0 ||
               m.read().remembered(c, Remembers::mixed_damage) > 0.0;
  }
  return static_cast<double>(damaged) / m.model().contact_count();
}

/// Expects the bits of another layout's run. Sums over the body add up in another order: 1e-12 of the largest
/// is round-off of some thousand terms.
template <int Dim>
void expect_same_bits(const Mechanics<Dim>& m, const Mechanics<Dim>& expected, const std::string& layout) {
  SCOPED_TRACE(layout);
  EXPECT_TRUE(m.read().displacements() == expected.read().displacements());
  EXPECT_TRUE(m.read().velocities() == expected.read().velocities());
  EXPECT_TRUE(m.read().forces() == expected.read().forces());
  for (int c = 0; c < expected.model().contact_count(); ++c)
    ASSERT_TRUE(m.read().contact(c).internals == expected.read().contact(c).internals) << "contact " << c;
  const EnergyLedger a = m.totals().energy(), b = expected.totals().energy();
  for (const auto part : {&EnergyLedger::loading, &EnergyLedger::zones, &EnergyLedger::kinetic,
                          &EnergyLedger::local_damping, &EnergyLedger::property_change})
    EXPECT_NEAR(a.*part, b.*part, 1e-12 * turnover(b));
  EXPECT_NEAR(m.totals().unbalanced_ratio(), expected.totals().unbalanced_ratio(),
              1e-12 * expected.totals().unbalanced_ratio());
}

/// A specimen pulled, sheared and pressed until it is cracked all over.
template <int Dim, class Contact = Cohesive::Properties<double>>
Mechanics<Dim> cracked(const ModelOf<Dim>& model, MechanicsParameters parameters, InstructionSet set,
                       bool own_temperatures, int threads = 1, const Contact& contact = mortar_contact()) {
  parameters.instructions = set;
  parameters.gravity = {{0.0, -9.81}};
  parameters.zones_for_a_thread = 1;
  auto m =
      mechanics(model, contact, parameters, 29.4e9, 0.2, std::make_shared<Team>(threads, WhenCrowded::stay));
  if (own_temperatures) {  // every zone and contact has properties of its own, and pore water presses
    BodyProperties p;
    for (int z = 0; z < model.zone_count(); ++z)
      p.zones.push_back(zone_properties<Dim>((20.0 + 0.001 * (z % 1000)) * 1e9, 0.2, 1e-6 * (z % 1000)));
    for (int c = 0; c < model.contact_count(); ++c) {
      auto weaker = contact;
      weaker.tensile_strength *= 1.0 - 1e-4 * (c % 1000);
      weaker.cohesion *= 1.0 - 1e-4 * (c % 1000);
      p.contacts.add(weaker);
      p.of_contact.push_back(c);
      p.pore_pressure.push_back(5e4 * (c % 20));
    }
    m.set_properties(p);
  }
  const auto drive = [&](const Vec<3>& velocity) {
    for (int g = 0; g < model.gridpoint_count(); ++g)
      for (int i = 0; i < Dim; ++i)
        if (const double y = model.position[g][1]; y == 0.0 || y == 0.05)
          m.constraints().prescribe_velocity(g, i, y == 0.0 ? 0.0 : velocity[i]);
    m.advance(400);
  };
  drive({{0.0, 5e-3, 1e-3}});
  drive({{8e-3, 0.0, -2e-3}});
  drive({{-4e-3, -12e-3, 3e-3}});
  return m;
}

struct Variant {
  const char* name;
  Kinematics kinematics;
  double viscous;
  bool own_temperatures;
};

/// Parameters of a body of random cells that cracks.
template <int Dim>
MechanicsParameters cracking() {
  auto parameters = quasi_static<Dim>();
  parameters.damping_form = DampingForm::combined;
  return parameters;
}

class EveryInstructionSet : public testing::TestWithParam<Variant> {};
INSTANTIATE_TEST_SUITE_P(Variants, EveryInstructionSet,
                         testing::Values(Variant{"small", Kinematics::small, 0.0, false},
                                         Variant{"finite", Kinematics::finite, 0.0, false},
                                         Variant{"viscous", Kinematics::small, 50.0, false},
                                         Variant{"own", Kinematics::small, 0.0, true},
                                         Variant{"own_finite", Kinematics::finite, 0.0, true}),
                         [](const auto& variant) { return std::string(variant.param.name); });

// Promise: bit by bit the same, on any number of threads, in a body that is cracked all over.
TEST_P(EveryInstructionSet, GivesTheSameBits) {
  const ModelOf<2> model = tessellated(150, 0.05, 0.05, 3);
  auto parameters = cracking<2>();
  parameters.kinematics = GetParam().kinematics;
  parameters.viscous_damping = GetParam().viscous;
  const auto run = [&](InstructionSet set, int threads) {
    const auto m = cracked(model, parameters, set, GetParam().own_temperatures, threads);
    EXPECT_GT(damaged_share(m), 0.3);
    return outcome(m);
  };
  const auto expected = run(InstructionSet::portable, 1);
  const auto sets = usable_instruction_sets();
  for (InstructionSet set : sets) EXPECT_TRUE(run(set, 2) == expected) << name(set);
  for (int threads : {1, 3}) EXPECT_TRUE(run(sets.back(), threads) == expected) << threads;
}

TEST(MixedModeContacts, HaveTheSameBitsInEveryInstructionSet) {
  const ModelOf<2> model = tessellated(150, 0.05, 0.05, 3);
  for (const bool own_temperatures : {false, true}) {
    for (const auto softening :
         {MixedMode::Softening::bilinear, MixedMode::Softening::exponential, MixedMode::Softening::tailed}) {
      auto contact = mixed_mode_contact();
      contact.softening = softening;
      const auto run = [&](InstructionSet set, int threads) {
        const auto m = cracked(model, quasi_static<2>(), set, own_temperatures, threads, contact);
        EXPECT_GT(damaged_share(m), softening == MixedMode::Softening::tailed ? 0.15 : 0.25);
        return outcome(m);
      };
      const auto expected = run(InstructionSet::portable, 1);
      for (InstructionSet set : usable_instruction_sets()) EXPECT_TRUE(run(set, 2) == expected) << name(set);
    }
  }
}

// Promise: neither how blocks are bundled, some of them in pieces, nor how they are cut into chunks changes a
// force, so no displacement, velocity, damage or slip either.
TEST(AnyLayout, GivesTheSameBits) {
  const ModelOf<2> model = tessellated(150, 0.05, 0.05, 3);
  auto parameters = cracking<2>();
  const auto run = [&](const ModelOf<2>& body, int fewest_blocks, int most_zones, int threads) {
    parameters.layout = {.fewest_blocks = fewest_blocks, .most_zones = most_zones};
    return cracked(body, parameters, usable_instruction_sets().back(), true, threads);
  };
  const auto expected = run(model, LayoutParameters().fewest_blocks, LayoutParameters().most_zones, 1);
  ASSERT_GT(damaged_share(expected), 0.3);
  struct Cut {
    int fewest_blocks, most_zones, chunk_blocks;
  };
  for (const auto [fewest_blocks, most_zones, chunk_blocks] :
       {Cut{1, 64, 1024}, Cut{6, 64, 1024}, Cut{9, 64, 1024},  // with 9 every block is a piece
        Cut{9, 5, 1024}, Cut{4, 64, 20}, Cut{4, 64, 64}, Cut{2, 4, 1}}) {
    ModelOf<2> cut = model;
    cut.cut_into_chunks(chunk_blocks);
    for (const int threads : {1, 2}) {
      expect_same_bits(run(cut, fewest_blocks, most_zones, threads), expected,
                       fmt::format("{} blocks a bundle, {} zones a piece, {} blocks a chunk, {} threads",
                                   fewest_blocks, most_zones, chunk_blocks, threads));
    }
  }
}

/// A specimen between platens, loaded through gridpoints that are tied.
Mechanics<2> tied(const ModelOf<2>& model, MechanicsParameters parameters, int threads) {
  parameters.gravity = {{0.0, -9.81}};
  parameters.zones_for_a_thread = 1;
  BodyProperties p;
  for (int z = 0; z < model.zone_count(); ++z)
    p.zones.push_back(zone_properties<2>((20.0 + 0.001 * z) * 1e9, 0.2, 1e-7 * z));
  p.contacts.add(mortar_contact());
  p.of_contact.assign(model.contacts.size(), 0);
  Mechanics<2> m(model, std::vector<double>(model.material_names.size(), 2400.0), p, parameters,
                 std::make_shared<Team>(threads, WhenCrowded::stay));
  const std::vector<int>& top = model.set("top_platen_support");
  for (const int g : model.set("bottom_platen_support"))
    for (const int i : {0, 1}) m.constraints().prescribe_velocity(g, i, 0.0);
  m.constraints().tie(top, 0);
  m.constraints().tie(top, 1);
  for (const int g : top) m.constraints().apply_force(g, {{g == top[0] ? 1e4 : 0.0, -4e5 / top.size()}});
  m.advance(300);
  return m;
}

/// The same, pressed further without ties.
Mechanics<2> pressed(const ModelOf<2>& model, const MechanicsParameters& parameters, int threads) {
  auto m = tied(model, parameters, threads);
  const std::vector<int>& top = model.set("top_platen_support");
  m.constraints().untie();
  for (const int g : top)
    for (const int i : {0, 1}) m.constraints().prescribe_velocity(g, i, i == 0 ? 1e-3 : -8e-3);
  m.advance(300);
  return m;
}

// Promise: in how many pieces a large block stands changes no bit either, nor do ties that join its pieces.
TEST(LargeBlocks, GiveTheSameBitsInAnyPieces) {
  const ModelOf<2> model = between_platens(small_specimen(150), 0.01, 0.5);
  for (const Kinematics kinematics : {Kinematics::small, Kinematics::finite}) {
    auto parameters = cracking<2>();
    parameters.kinematics = kinematics;
    parameters.layout.most_zones = 1000;
    const auto expected = pressed(model, parameters, 1);
    ASSERT_GT(damaged_share(expected), 0.1);
    struct Cut {
      int most_zones, threads;
    };
    for (const auto [most_zones, threads] : {Cut{8, 1}, Cut{8, 3}, Cut{24, 2}}) {
      parameters.layout.most_zones = most_zones;
      const auto m = pressed(model, parameters, threads);
      ASSERT_GE(m.body().layout.parts.size(), expected.body().layout.parts.size() + 2);
      expect_same_bits(m, expected, fmt::format("{} zones a piece, {} threads", most_zones, threads));
    }
  }
}

// Promise: a body with ties that join pieces goes on from its state as if nothing had come between.
TEST(LargeBlocks, AStateWithTiesThatJoinPiecesGoesOn) {
  const ModelOf<2> model = between_platens(small_specimen(150), 0.01, 0.5);
  auto parameters = quasi_static<2>();
  parameters.layout.most_zones = 8;
  auto whole = tied(model, parameters, 2);
  StateCopy copy;
  copy.take([&](StateVisitor& visitor) { whole.visit_state(visitor); });
  BodyProperties p = whole.body().properties;
  Mechanics<2> resumed(model, std::vector<double>(model.material_names.size(), 2400.0), p,
                       whole.body().parameters);
  copy.put([&](StateVisitor& visitor) { resumed.visit_state(visitor); });
  ASSERT_TRUE(resumed.body().ties_join_parts());
  whole.advance(100);
  resumed.advance(100);
  EXPECT_TRUE(outcome(resumed) == outcome(whole));
}

// Promise: the same of polyhedra, on any number of threads, bundled and cut in any way: each block a ragged
// bundle, or in one piece, or in several; one chunk or many.
TEST(EveryInstructionSet, GivesTheSameBitsInThreeDimensions) {
  const ModelOf<3> model = laguerre_cells(45, 0.05, 3);
  struct InSpace {
    Kinematics kinematics;
    bool own_temperatures;
  };
  for (const auto& [kinematics, own_temperatures] :
       {InSpace{Kinematics::small, false}, {Kinematics::finite, true}}) {
    auto parameters = cracking<3>();
    parameters.kinematics = kinematics;
    const auto run = [&, own = own_temperatures](InstructionSet set, int threads) {
      const auto m = cracked(model, parameters, set, own, threads);
      EXPECT_GT(damaged_share(m), 0.3);
      return outcome(m);
    };
    const auto expected = run(InstructionSet::portable, 1);
    for (InstructionSet set : usable_instruction_sets())
      for (int threads : {1, 2}) EXPECT_TRUE(run(set, threads) == expected) << name(set) << ' ' << threads;
  }
}

TEST(AnyLayout, GivesTheSameBitsInThreeDimensions) {
  const ModelOf<3> model = laguerre_cells(40, 0.05, 3);
  const auto run = [&](const ModelOf<3>& body, const LayoutParameters& layout, int threads) {
    auto parameters = cracking<3>();
    parameters.kinematics = Kinematics::finite;  // whose forces are those of the small ones and more
    parameters.layout = layout;
    return cracked(body, parameters, usable_instruction_sets().back(), true, threads);
  };
  const auto expected = run(model, {}, 1);
  ASSERT_TRUE(std::ranges::all_of(expected.body().layout.bundles,
                                  [](const Bundle& b) { return b.kind == BundleKind::ragged; }));
  ASSERT_GT(damaged_share(expected), 0.3);
  struct Cut {
    int most_gridpoints, most_zones, chunk_blocks, threads;
  };
  for (const auto [most_gridpoints, most_zones, chunk_blocks, threads] :
       {Cut{0, 1000, 1024, 1}, Cut{0, 16, 1024, 2}, Cut{24, 64, 1024, 2}, Cut{255, 64, 7, 2},
        Cut{22, 24, 1, 3}}) {
    ModelOf<3> cut = model;
    cut.cut_into_chunks(chunk_blocks);
    expect_same_bits(run(cut, {.most_zones = most_zones, .most_gridpoints = most_gridpoints}, threads),
                     expected,
                     fmt::format("{} gridpoints, {} zones a piece, {} blocks a chunk, {} threads",
                                 most_gridpoints, most_zones, chunk_blocks, threads));
  }
}

// Promise: a cracked solid goes on from its state as if nothing had come between, in batches of any length.
TEST(Solids, GoOnFromTheirStateBitByBit) {
  const ModelOf<3> model = laguerre_cells(60, 0.05, 3);
  auto parameters = cracking<3>();
  parameters.kinematics = Kinematics::finite;
  auto whole = cracked(model, parameters, usable_instruction_sets().back(), false);
  StateCopy copy;
  copy.take([&](StateVisitor& visitor) { whole.visit_state(visitor); });
  Mechanics<3> resumed(model, {2400.0}, whole.body().properties, whole.body().parameters);
  copy.put([&](StateVisitor& visitor) { resumed.visit_state(visitor); });
  whole.advance(257);
  for (const int steps : {1, 6, 250}) resumed.advance(steps);
  EXPECT_TRUE(outcome(resumed) == outcome(whole));
}

// Promise: the threads of a run may change in number between batches, and where batches end changes no bit.
TEST(Threads, MayChangeInNumberBetweenBatches) {
  const ModelOf<2> model = tessellated(60, 0.05, 0.05, 3);
  auto parameters = quasi_static<2>();
  parameters.zones_for_a_thread = 1;
  const auto run = [&](const std::vector<int>& threads) {
    const auto team = std::make_shared<Team>();
    auto m = mechanics(model, mortar_contact(), parameters, 29.4e9, 0.2, team);
    for (int g = 0; g < model.gridpoint_count(); ++g)
      if (const double y = model.position[g][1]; y == 0.0 || y == 0.05)
        m.constraints().prescribe_velocity(g, 1, y == 0.0 ? 0.0 : 5e-3);
    for (const int number : threads) {
      team->resize(number);
      m.advance(600 / static_cast<int>(threads.size()));
    }
    return outcome(m);
  };
  const auto expected = run({1});
  EXPECT_TRUE(run({1, 2, 3}) == expected);
  EXPECT_TRUE(run({4, 1, 2, 2, 1, 3}) == expected);
}

TEST(InstructionSets, OneThatIsNotThereIsRefusedWithThoseThatAre) {
  try {
    instruction_set("sse9");
    FAIL() << "was taken";
  } catch (const Error& e) {
    EXPECT_NE(std::string(e.what()).find("\"sse9\""), std::string::npos);
    EXPECT_NE(std::string(e.what()).find("portable"), std::string::npos);
  }
  for (InstructionSet set : usable_instruction_sets()) EXPECT_EQ(instruction_set(name(set)), set);
}

}  // namespace
}  // namespace pyroclast
