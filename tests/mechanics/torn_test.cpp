#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "copy_state.hpp"
#include "loose_blocks.hpp"
#include "pyroclast/mechanics/found/found.hpp"
#include "pyroclast/mechanics/mechanics.hpp"
#include "pyroclast/model/part.hpp"
#include "ranks_in_threads.hpp"
#include "small_chunks.hpp"

/// Faces whose sides turn against each other until they are torn.
namespace pyroclast::torn_test {
namespace {

using namespace bodies;

constexpr double kSize = 0.01;   // m
constexpr double kSpin = 600.0;  // 1/s, at the start

/// Two cubes, or squares, joined by a face.
template <int Dim>
ModelOf<Dim> two_blocks() {
  if constexpr (Dim == 2)
    return two_rows(1, kSize);
  else
    return cubes(2, kSize);
}

template <int Dim>
MechanicsParameters free_flight(bool are_found) {
  MechanicsParameters p;
  p.kinematics = Kinematics::finite;
  p.safety = 0.5;
  p.found.is_on = are_found;
  p.zones_for_a_thread = 1;
  return p;
}

/// Strong enough to hold a block that swings about one point, and soft, so that the point holds energy.
Cohesive::Properties<double> strong() {
  auto bond = mortar_contact();
  bond.normal_stiffness *= 0.01;
  bond.shear_stiffness *= 0.01;
  bond.tensile_strength *= 4.0;
  bond.mode_1_energy *= 16.0;
  bond.cohesion *= 4.0;
  bond.mode_2_energy *= 16.0;
  return bond;
}

/// Two blocks whose face hangs by one point, about which the second swings away from the first, which is
/// held.
template <int Dim>
class Hinge {
 public:
  Hinge(const ModelOf<Dim>& model, const ContactProperties& bond, const MechanicsParameters& parameters,
        int threads = 1)
      : m(mechanics<Dim>(model, bond, parameters, 29.4e9, 0.2,
                         std::make_shared<Team>(threads, WhenCrowded::stay))) {
    const int first = model.face_contacts[0], last = model.face_contacts[1];
    Vec<Dim> middle{};
    for (int c = first; c < last; ++c) middle += place(model.contacts[c].a) * (1.0 / (last - first));
    for (int c = first + 1; c < last; ++c) static_cast<void>(m.break_contact(c));
    hold(m, 0);
    const Vec<Dim> pin = place(model.contacts[first].a), normal = model.contacts[first].normal;
    Vec<Dim> across = middle - pin;
    across *= 1.0 / norm(across);
    // the middle of the face moves along the normal, and what lies along the normal moves back over the pin
    std::vector<Vec<Dim>> velocity(model.position.size());
    for (int g = model.block_gridpoints[1]; g < model.block_gridpoints[2]; ++g) {
      const Vec<Dim> arm = place(g) - pin;
      velocity[g] = (normal * dot(arm, across) - across * dot(arm, normal)) * kSpin;
    }
    m.begin_moving(velocity);
    at_start_ = m.totals().energy().kinetic;
  }

  /// Returns the angle by which the edge of the second block at the pin has turned, in (-pi, pi].
  double angle() const {
    const auto& model = m.model();
    const int first = model.face_contacts[0], far = first + (Dim == 2 ? 1 : 2);
    const auto at = [&](int g) { return place(g) + m.read().displacement(g); };
    const Vec<Dim> before = place(model.contacts[far].b) - place(model.contacts[first].b),
                   now = at(model.contacts[far].b) - at(model.contacts[first].b);
    return std::atan2(dot(now, model.contacts[first].normal) * norm(before), dot(now, before));
  }
  bool is_torn() const { return m.body().is_torn(0); }
  double at_start() const { return at_start_; }

  Mechanics<Dim> m;

 private:
  const Vec<Dim>& place(int gridpoint) const { return m.model().position[gridpoint]; }

  double at_start_ = 0.0;
};

template <int Dim>
void expect_equal(const Hinge<Dim>& one, const Hinge<Dim>& expected, const std::string& what) {
  SCOPED_TRACE(what);
  EXPECT_EQ(one.is_torn(), expected.is_torn());
  EXPECT_TRUE(one.m.read().displacements() == expected.m.read().displacements());
  EXPECT_TRUE(one.m.read().velocities() == expected.m.read().velocities());
  EXPECT_EQ(one.m.totals().energy().dissipated.energies, expected.m.totals().energy().dissipated.energies);
}

/// Lets the second block turn by a turn and a half.
template <int Dim>
void expect_to_tear(bool are_found, const ContactProperties& bond) {
  SCOPED_TRACE(std::to_string(Dim) + (are_found ? " dimensions, found" : " dimensions, first"));
  const ModelOf<Dim> model = two_blocks<Dim>();
  Hinge<Dim> hinge(model, bond, free_flight<Dim>(are_found));
  double turned = 0.0, before = 0.0, torn_at = 0.0, worst = 0.0;
  while (turned < 3.0 * std::numbers::pi && hinge.m.time() < 4.0 * std::numbers::pi / kSpin) {
    hinge.m.advance(16);
    const double now = hinge.angle();
    turned += std::remainder(now - before, 2.0 * std::numbers::pi);
    before = now;
    if (hinge.is_torn() && torn_at == 0.0) torn_at = turned;
    worst = std::max(worst, std::abs(hinge.m.totals().energy().error()));
  }
  EXPECT_GE(turned, 3.0 * std::numbers::pi);
  EXPECT_NEAR(torn_at, 0.5 * std::numbers::pi, 0.1);
  const EnergyLedger e = hinge.m.totals().energy();
  EXPECT_LT(e.dissipated.total(), 1e-4 * hinge.at_start());
  EXPECT_LT(worst, 0.03 * e.dissipated.total());
  EXPECT_EQ(e.contacts, 0.0);
  EXPECT_GT(e.dissipated.of("tension"), 0.0);
  for (int c = 0; c < model.contact_count(); ++c) {
    const ContactState state = hinge.m.read().contact(c);
    EXPECT_EQ(state.remembered(Remembers::tension_damage), 1.0);
    EXPECT_GT(state.opening, 0.0);
    EXPECT_EQ(state.normal_traction, 0.0);
  }
}

// Promise: a face that hangs by one point is torn where its sides have turned against each other by 90
// degrees. What it held is lost by the ledger, and the block flies on however it turns.
TEST(TornFaces, AHingeTearsAndTheLedgerCloses) {
  for (const bool are_found : {false, true}) {
    expect_to_tear<2>(are_found, strong());
    expect_to_tear<3>(are_found, strong());
  }
}

/// Goes through a run in several ways, all with the same bits.
template <int Dim>
void expect_bits(bool are_found) {
  SCOPED_TRACE(std::to_string(Dim) + (are_found ? " dimensions, found" : " dimensions, first"));
  const ModelOf<Dim> model = two_blocks<Dim>();
  const auto parameters = free_flight<Dim>(are_found);
  Hinge<Dim> expected(model, strong(), parameters);
  int torn_before = 0;
  while (!expected.is_torn()) {
    expected.m.advance(64);
    torn_before += 64;
  }
  const int steps = 2 * torn_before + 7;
  expected.m.advance(steps - torn_before);
  EXPECT_GT(std::abs(expected.angle()), 0.6 * std::numbers::pi);
  for (const int batch : {1, 50}) {
    Hinge<Dim> other(model, strong(), parameters, batch == 1 ? 1 : 2);
    for (int left = steps; left > 0; left -= batch) other.m.advance(std::min(batch, left));
    expect_equal(other, expected, "batches of " + std::to_string(batch));
  }
  for (const int step : {torn_before - 64, torn_before - 63, torn_before + 30}) {
    Hinge<Dim> half(model, strong(), parameters), other(model, strong(), parameters);
    half.m.advance(step);
    other.m.advance(1);
    copy_state(half.m, other.m);
    EXPECT_EQ(other.is_torn(), half.is_torn());
    other.m.advance(steps - step);
    expect_equal(other, expected, "copied at step " + std::to_string(step));
  }
  Hinge<Dim> again(model, strong(), parameters);  // a state of before goes into a body of after
  again.m.advance(torn_before - 64);
  Hinge<Dim> later(model, strong(), parameters);
  later.m.advance(steps);
  copy_state(again.m, later.m);
  EXPECT_FALSE(later.is_torn());
  later.m.advance(steps - torn_before + 64);
  expect_equal(later, expected, "taken back");
}

// Promise: faces are torn at the same steps of a run, whatever its batches and threads, and where its state
// is copied.
TEST(TornFaces, BitsDependNeitherOnBatchesNorOnCopies) {
  for (const bool are_found : {false, true}) {
    expect_bits<2>(are_found);
    expect_bits<3>(are_found);
  }
}

/// Lets each block be of another rank, and the face tear.
template <int Dim>
void expect_bits_on_ranks(bool are_found) {
  SCOPED_TRACE(std::to_string(Dim) + (are_found ? " dimensions, found" : " dimensions, first"));
  const SmallChunks chunks(1);
  const ModelOf<Dim> model = two_blocks<Dim>();
  Hinge<Dim> expected(model, strong(), free_flight<Dim>(are_found));
  int steps = 0;
  for (; !expected.is_torn(); steps += 64) expected.m.advance(64);
  constexpr int kAfter = 100, kCopied = 200;  // the copy is made before the face is torn
  expected.m.advance(kAfter);
  RanksInThreads::run(2, [&](const std::shared_ptr<Ranks>& ranks) {
    const ModelOf<Dim> part = part_of(model, ranks, {0, 1}, {}, ForeignBlocks::all);
    Hinge<Dim> half(part, strong(), free_flight<Dim>(are_found)),
        hinge(part, strong(), free_flight<Dim>(are_found));
    half.m.advance(steps + kAfter - kCopied);
    hinge.m.advance(1);
    copy_state(half.m, hinge.m);
    hinge.m.advance(kCopied);
    EXPECT_EQ(hinge.is_torn(), expected.is_torn());
    EXPECT_EQ(hinge.m.totals().energy().dissipated.energies,
              expected.m.totals().energy().dissipated.energies);
    for (auto [g, last] = part.gridpoint_chunks().own(); g < last; ++g)
      ASSERT_EQ(hinge.m.read().displacement(g), expected.m.read().displacement(g));
  });
}

// Promise: faces between two ranks are torn at the same steps as on one.
TEST(TornFaces, BitsDoNotDependOnRanks) {
  for (const bool are_found : {false, true}) {
    expect_bits_on_ranks<2>(are_found);
    expect_bits_on_ranks<3>(are_found);
  }
}

// Promise: the pressure of water ends where its face is torn, also in a state that is copied and where
// properties change, and the ledger keeps the work that it has done.
TEST(TornFaces, NoWaterPressesInThem) {
  const ModelOf<2> model = two_blocks<2>();
  constexpr double kPressure = 1e3;  // Pa
  const auto properties = [&] {
    auto wet = by_interface(model, std::vector(model.zones.size(), zone_properties<2>(29.4e9, 0.2)),
                            {ContactProperties(strong())});
    wet.pore_pressure.assign(static_cast<std::size_t>(model.contact_count()), kPressure);
    return wet;
  };
  const auto make = [&] { return Mechanics<2>(model, {2400.0}, properties(), free_flight<2>(false)); };
  auto m = make();
  hold(m, 0);
  const Vec<2> pin = model.position[model.contacts[0].a];
  const double away = dot(model.position[model.contacts[1].a] - pin, {{1.0, 0.0}}) > 0.0 ? 1.0 : -1.0;
  static_cast<void>(m.break_contact(1));
  std::vector<Vec<2>> velocity(model.position.size());
  for (int g = model.block_gridpoints[1]; g < model.block_gridpoints[2]; ++g) {
    const Vec<2> arm = model.position[g] - pin;
    velocity[g] = Vec<2>{{-arm[1], arm[0]}} * (away * kSpin);
  }
  m.begin_moving(velocity);
  while (!m.body().is_torn(0) && m.time() < std::numbers::pi / kSpin) m.advance(64);
  ASSERT_TRUE(m.body().is_torn(0));
  const double pushed = m.totals().energy().pore_pressure;
  EXPECT_GT(pushed, 0.5 * kPressure * 0.5 * kSize * kSize);
  auto copied = make();
  copy_state(m, copied);
  m.set_properties(properties());
  for (Mechanics<2>* body : {&m, &copied}) {
    body->advance(1000);
    const EnergyLedger e = body->totals().energy();
    EXPECT_EQ(e.pore_pressure, pushed);
    // the work of the pressure in the half step that has begun is left out
    EXPECT_LT(std::abs(e.error()), 0.5 * kPressure * kSize * (kSpin * kSize) * m.time_step());
  }
}

// Promise: blocks whose face is torn because they spin on each other press on, where contacts are found.
TEST(TornFaces, BlocksThatSpinOnEachOtherPressOn) {
  constexpr double kStiffness = 1e9, kForce = 0.1;  // Pa/m; N on each gridpoint
  const ModelOf<3> model = cubes(2, kSize);
  auto bond = strong();  // so soft in shear that the spin breaks no point
  bond.normal_stiffness = kStiffness;
  bond.shear_stiffness = 1.0;
  bond.tensile_strength = 1e5;  // stores less than the mode I energy
  auto m = mechanics<3>(model, bond, free_flight<3>(true));
  hold(m, 0);
  std::vector<Vec<3>> velocity(model.position.size());
  for (int g = model.block_gridpoints[1]; g < model.block_gridpoints[2]; ++g) {
    m.constraints().apply_force(g, {{0.0, 0.0, -kForce}});
    const Vec<3> arm = model.position[g] - Vec<3>{{0.5 * kSize, 0.5 * kSize, 0.0}};
    velocity[g] = Vec<3>{{-arm[1], arm[0], 0.0}} * kSpin;
  }
  m.begin_moving(velocity);
  const double pressed = 9.0 * kForce / (kStiffness * kSize * kSize);  // m, at rest
  while (m.time() < 0.8 * std::numbers::pi / kSpin) m.advance(64);
  EXPECT_TRUE(m.body().is_torn(0));
  EXPECT_TRUE(m.body().found->is_handed_over[0]);
  const EnergyLedger e = m.totals().energy();
  EXPECT_GT(e.contacts, 0.0);
  EXPECT_LT(std::abs(e.error()), 1e-3 * std::abs(e.loading - e.kinetic));
  EXPECT_NEAR(m.read().displacement(model.block_gridpoints[2] - 1)[2], -pressed, 1.1 * pressed);
}

/// Drags a block over another, from which it has broken off and which it presses, until it has passed it.
template <int Dim>
void expect_to_part_once_past() {
  SCOPED_TRACE(std::to_string(Dim) + " dimensions");
  constexpr double kSpeed = 4.0, kForce = 0.05;  // m/s; N on each gridpoint
  const ModelOf<Dim> model = two_blocks<Dim>();
  auto bond = strong();
  bond.friction_angle = bond.residual_friction_angle = bond.residual_cohesion = 0.0;
  Mechanics<Dim> m = mechanics<Dim>(model, bond, free_flight<Dim>(false));
  for (int c = 0; c < model.contact_count(); ++c) static_cast<void>(m.break_contact(c));
  hold(m, 0);
  const Vec<Dim> normal = model.contacts[0].normal;
  const int across = std::abs(normal[0]) > 0.5 ? 0 : std::abs(normal[1]) > 0.5 ? 1 : 2;
  const int along = across == 0 ? 1 : 0;
  std::vector<int> dragged;
  std::vector<Vec<Dim>> velocity(model.position.size());
  for (int g = model.block_gridpoints[1]; g < model.block_gridpoints[2]; ++g) {
    dragged.push_back(g);
    m.constraints().apply_force(g, normal * -kForce);
    velocity[g][along] = kSpeed;
  }
  m.constraints().tie(dragged, across);
  for (const int g : dragged) m.constraints().prescribe_velocity(g, along, kSpeed);
  m.begin_moving(velocity);
  const double widest = kSize * (Dim == 2 ? 1.0 : std::numbers::sqrt2);
  while (m.read().slide(0) < 0.98 * widest) m.advance(64);
  EXPECT_FALSE(m.body().is_torn(0));
  EXPECT_LT(m.read().contact(0).normal_traction, 0.0);
  while (m.read().slide(0) < 1.02 * widest) m.advance(64);
  EXPECT_TRUE(m.body().is_torn(0));
  const EnergyLedger e = m.totals().energy();
  EXPECT_EQ(e.contacts, 0.0);
  EXPECT_GT(e.dissipated.of("tension"), 0.0);
  EXPECT_LT(std::abs(e.error()), 1e-4 * e.dissipated.of("tension"));
}

// Promise: a broken face is torn once its sides have slid past each other, and the ledger closes.
TEST(TornFaces, SidesThatHaveSlidPastEachOtherPart) {
  expect_to_part_once_past<2>();
  expect_to_part_once_past<3>();
}

// Promise: a law that loses no energy holds what is broken, however far its sides turn.
TEST(TornFaces, ElasticFacesHold) {
  const ModelOf<2> model = two_rows(1, kSize);
  Hinge<2> hinge(model, Elastic::Properties<double>{1e3, 1e3}, free_flight<2>(false));
  while (hinge.angle() < 0.6 * std::numbers::pi && hinge.m.time() < std::numbers::pi / kSpin)
    hinge.m.advance(64);
  EXPECT_GE(hinge.angle(), 0.6 * std::numbers::pi);
  EXPECT_FALSE(hinge.is_torn());
  EXPECT_GT(hinge.m.totals().energy().contacts, 0.0);
}

}  // namespace
}  // namespace pyroclast::torn_test
