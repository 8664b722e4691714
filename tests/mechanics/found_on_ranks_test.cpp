#include <algorithm>
#include <atomic>
#include <memory>
#include <vector>

#include <gtest/gtest.h>

#include "copy_state.hpp"
#include "crushing.hpp"
#include "pyroclast/mechanics/found/found.hpp"
#include "pyroclast/mechanics/found/found_points.hpp"
#include "pyroclast/mechanics/mechanics.hpp"
#include "pyroclast/model/part.hpp"
#include "ranks_in_threads.hpp"
#include "small_chunks.hpp"

/// Found contacts of a body that is cut into parts of several ranks, which are threads here.
namespace pyroclast::found_on_ranks {
namespace {

using namespace bodies;

template <int Dim>
ModelOf<Dim> body_of_chunks() {
  const SmallChunks chunks(Dim == 2 ? 7 : 3);
  if constexpr (Dim == 2)
    return tessellated(40, kCrushedSize, kCrushedSize, 3);
  else
    return laguerre_cells(12, kCrushedSize, 3);
}

/// Steps until the properties change, after each such change, and of the copy between two of them.
constexpr int kBefore = 750, kSoftened = 50, kCopied = 50;

/// Properties of a body that has become softer: each contact has its own.
template <int Dim>
BodyProperties softened(const ModelOf<Dim>& model) {
  BodyProperties p;
  for (int z = 0; z < model.zone_count(); ++z) {
    const int in_whole = model.part ? model.part->zone[z] : z;
    p.zones.push_back(zone_properties<Dim>(20e9, 0.2, 1e-6 * (in_whole % 100)));
  }
  auto contact = brittle();
  contact.normal_stiffness *= 0.6;
  contact.shear_stiffness *= 0.6;
  for (int c = 0; c < model.contact_count(); ++c) {
    contact.friction_angle = contact.residual_friction_angle =
        0.3 - 1e-4 * ((model.part ? model.part->contact[c] : c) % 100);
    p.contacts.add(contact);
    p.of_contact.push_back(c);
  }
  p.contacts.add(contact);
  p.of_interface = {model.contact_count()};
  return p;
}

template <int Dim>
Mechanics<Dim> made(const ModelOf<Dim>& model, int threads) {
  auto m = mechanics<Dim>(model, brittle(), crushing<Dim>(), 29.4e9, 0.2,
                          std::make_shared<Team>(threads, WhenCrowded::stay));
  crush(m);
  return m;
}

/// Crushes and softens a body, copies its state into another one of several threads, and softens this.
template <int Dim>
Mechanics<Dim> crushed(const ModelOf<Dim>& model, int threads) {
  auto first = made(model, 1), m = made(model, threads);
  for (int left = kBefore; left > 0; left -= 150) first.advance(std::min(150, left));
  first.set_properties(softened(model));
  first.advance(kSoftened);
  m.advance(1);
  copy_state(first, m);
  m.advance(kCopied);
  m.set_properties(softened(model));
  m.advance(kSoftened);
  return m;
}

/// Sums and points that press.
struct Told {
  EnergyLedger energy;
  double unbalanced_ratio = 0.0;
  std::vector<FoundPoint> points;

  template <int Dim>
  explicit Told(const Mechanics<Dim>& m)
      : energy(m.totals().energy()),
        unbalanced_ratio(m.totals().unbalanced_ratio()),
        points(found_points(m.body())) {}
};

void expect_equal(const Told& a, const Told& b) {
  EXPECT_EQ(a.energy.contacts, b.energy.contacts);
  EXPECT_EQ(a.energy.kinetic, b.energy.kinetic);
  EXPECT_EQ(a.energy.property_change, b.energy.property_change);
  EXPECT_EQ(a.energy.dissipated.energies, b.energy.dissipated.energies);
  EXPECT_EQ(a.unbalanced_ratio, b.unbalanced_ratio);
}

template <int Dim>
void expect_bits() {
  const ModelOf<Dim> whole = body_of_chunks<Dim>();
  const int chunks = whole.chunks().count();
  ASSERT_GT(chunks, 3);
  const auto alone = crushed(whole, 1);
  const Told told(alone);
  const auto chunk_of = whole.chunks().of_items();
  const auto between_chunks = std::ranges::count_if(told.points, [&](const FoundPoint& point) {
    return chunk_of[point.blocks[0]] != chunk_of[point.blocks[1]];
  });
  EXPECT_GT(between_chunks, 5);
  EXPECT_LT(between_chunks, std::ssize(told.points));
  for (const int count : {2, 3}) {
    SCOPED_TRACE(testing::Message() << count << " ranks");
    RanksInThreads::run(count, [&](const std::shared_ptr<Ranks>& ranks) {
      const ModelOf<Dim> part = part_of(whole, ranks, ranks_of_chunks(whole, count), {}, ForeignBlocks::all);
      const auto m = crushed(part, count == 2 ? 2 : 1);
      const Told here(m);
      expect_equal(here, told);
      EXPECT_EQ(here.points.size(), ranks->is_first() ? told.points.size() : 0);
      for (std::size_t i = 0; i < here.points.size(); ++i) {
        ASSERT_EQ(here.points[i].blocks, told.points[i].blocks);
        ASSERT_EQ(here.points[i].force, told.points[i].force);
      }
      for (auto [g, last] = part.gridpoint_chunks().own(); g < last; ++g) {
        ASSERT_EQ(m.read().displacement(g), alone.read().displacement(g)) << g;
        ASSERT_EQ(m.read().velocity(g), alone.read().velocity(g)) << g;
        ASSERT_EQ(m.read().force(g), alone.read().force(g)) << g;
      }
    });
  }
}

// Promise: the parts of a body whose pieces meet do what the whole does, to the bit, also where its state is
// copied and its properties change.
TEST(FoundContactsOnRanks, PartsOfAPlaneDoWhatTheWholeDoes) {
  expect_bits<2>();
}
TEST(FoundContactsOnRanks, PartsOfASolidDoWhatTheWholeDoes) {
  expect_bits<3>();
}

}  // namespace
}  // namespace pyroclast::found_on_ranks
