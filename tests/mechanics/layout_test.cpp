#include "pyroclast/mechanics/layout.hpp"

#include <algorithm>
#include <set>
#include <string>

#include <gtest/gtest.h>

#include "bodies.hpp"
#include "model/small_specimen.hpp"
#include "pyroclast/mechanics/sweep.hpp"
#include "pyroclast/model/concrete_model.hpp"

namespace pyroclast {
namespace {

ModelOf<2> small_concrete() {
  return between_platens(small_specimen(800), 0.01, 0.5);
}

/// That `each` tells of every array of a list, once: they fill it.
template <class List>
void expect_each_tells_of_all() {
  List list;
  std::size_t bytes = 0;
  std::set<std::string> names;
  std::set<const void*> arrays;
  for_each_array(
      [&](const ArrayInfo& info, auto& array) {
        bytes += sizeof(array);
        EXPECT_TRUE(names.insert(info.name).second) << info.name;
        EXPECT_TRUE(arrays.insert(&array).second) << info.name;
      },
      list);
  EXPECT_EQ(bytes, sizeof(List));
}

TEST(Arrays, EachIsInTheListThatMemoryCheckpointsAndViewsFollow) {
  expect_each_tells_of_all<LayoutArrays<2, FlatArray>>();
  expect_each_tells_of_all<LayoutArrays<3, FlatArray>>();
  expect_each_tells_of_all<StateArrays<2, FlatArray>>();
  expect_each_tells_of_all<StateArrays<3, FlatArray>>();
}

/// That each array has an entry of each of what it counts per, or none at all.
template <int Dim>
void expect_counts(const Mechanics<Dim>& body) {
  const auto expect_count = [&](const ArrayInfo& info, const auto& array) {
    const auto count = body.body().layout.count_of(info.per);
    if (info.per == Per::zone_pack_or_bundle) {
      EXPECT_TRUE(array.size() == body.body().layout.bundles.size() ||
                  static_cast<int>(array.size()) == body.body().layout.zone_packs)
          << info.name;
    } else if (count && !array.empty()) {
      EXPECT_EQ(array.size(), *count) << info.name;
    }
  };
  for_each_array(expect_count, static_cast<const LayoutArrays<Dim, FlatArray>&>(body.body().layout));
  for_each_array(expect_count, body.body().arrays);
}

/// The same of a body that moves, and turns, and is held.
template <int Dim>
void expect_counts(const ModelOf<Dim>& model, Kinematics kinematics) {
  auto parameters = bodies::quasi_static<Dim>();
  parameters.kinematics = kinematics;
  parameters.gravity[Dim - 1] = -9.81;
  auto body = bodies::mechanics(model, mortar_contact(), parameters);
  body.constraints().prescribe_velocity(0, 0, 0.0);
  body.advance(1);
  expect_counts(body);
}

TEST(Arrays, HaveAnEntryOfEachOfWhatTheyCountPer) {
  for (const Kinematics kinematics : {Kinematics::small, Kinematics::finite}) {
    expect_counts(bodies::tessellated(200, 0.1, 0.1, 1), kinematics);
    expect_counts(bodies::cubes(5, 0.1), kinematics);
  }
}

// Every gridpoint, zone and contact has one place, and no two share one.
TEST(Layout, GivesEverythingAPlaceOfItsOwn) {
  const ModelOf<2> model = small_concrete();
  const Layout<2> layout(model);
  const auto distinct = [](const FlatArray<int>& slots, int packs) {
    const std::set<int> set(slots.begin(), slots.end());
    EXPECT_EQ(set.size(), slots.size());
    EXPECT_GE(*set.begin(), 0);
    EXPECT_LT(*set.rbegin(), kLanes * packs);
  };
  ASSERT_EQ(layout.gridpoint_slot.size(), model.position.size());
  ASSERT_EQ(layout.zone_slot.size(), model.zones.size());
  ASSERT_EQ(layout.contact_slot.size(), model.contacts.size());
  distinct(layout.gridpoint_slot, layout.gridpoint_packs);
  distinct(layout.zone_slot, layout.zone_packs);
  distinct(layout.contact_slot, layout.point_packs - 1);
}

// The promise of lanes: few of them idle. A 5 % loss is what blocks of rare shapes may cost.
TEST(Layout, LeavesFewLanesIdle) {
  const ModelOf<2> model = small_concrete();
  const Layout<2> layout(model);
  EXPECT_LT(kLanes * layout.zone_packs, 1.05 * model.zone_count() + 8 * kLanes);
  EXPECT_LT(kLanes * 2 * layout.face_packs(), 1.05 * model.contact_count() + 8 * kLanes);
}

// The same of polyhedra, whose faces have 3 to some 12 corners: 5 % is what faces of rare numbers may cost.
// Faces between two chunks share lanes with no others: at 5,000 blocks they cost 4 %.
TEST(Layout, LeavesFewLanesOfContactPointsIdleInThreeDimensions) {
  for (const int blocks : {1000, 5000}) {
    const ModelOf<3> model = bodies::laguerre_cells(blocks, 0.1, 1);
    const auto m = bodies::mechanics(model, mortar_contact(), bodies::quasi_static<3>());
    const Layout<3>& layout = m.body().layout;
    EXPECT_GT(model.contact_count(), 0.93 * kLanes * (layout.point_packs - 1)) << blocks;
    ModelOf<3> one_chunk = model;
    one_chunk.cut_into_chunks(blocks);
    EXPECT_GT(model.contact_count(), 0.95 * kLanes * (Layout<3>(one_chunk).point_packs - 1)) << blocks;
    EXPECT_LT(static_cast<double>(m.body().memory()), 280.0 * model.zone_count()) << blocks;
    EXPECT_EQ(layout.chunks.blocks.count(), (blocks + blocks_of_a_chunk(3) - 1) / blocks_of_a_chunk(3));
    int most = 0;
    for (int f = 0; f < model.face_count(); ++f)
      most = std::max(most, model.face_contacts[f + 1] - model.face_contacts[f]);
    EXPECT_GT(most, 8) << blocks;
  }
}

// What lanes of a bundle share must be the same in the model.
TEST(Layout, BlocksThatShareLanesHaveTheSameZones) {
  const ModelOf<2> model = small_concrete();
  const Layout<2> layout(model);
  int alike = 0;
  for (int i = 0; i < static_cast<int>(layout.bundles.size()); ++i) {
    const Bundle& bundle = layout.bundles[i];
    if (bundle.kind != BundleKind::alike) continue;
    for (int lane = 0; lane < kLanes; ++lane) {
      const int b = layout.block_in(i, lane);
      if (b < 0) continue;
      const int first = model.block_zones[b];
      ASSERT_EQ(model.block_zones[b + 1] - first, bundle.zones);
      for (int z = 0; z < bundle.zones; ++z)
        for (int n = 0; n < 3; ++n) {
          const int pack = bundle.first_pack + layout.shape_zones[bundle.first_corners + z][n];
          EXPECT_EQ(layout.gridpoint_slot[model.zones[first + z][n]], slot_of(pack, lane));
        }
      ++alike;
    }
  }
  EXPECT_GT(alike, model.block_count() / 2);
}

/// Plays a step of the shares and tells whether it is allowed: no bundle moves before all its faces were
/// taken, none is taken after one of its bundles moved, and all of them once. Bundles that lead all move
/// before the others.
void play(const Layout<2>& layout, int threads, const std::vector<int>& leading = {}) {
  const auto shares = share_out(layout, threads, leading);
  std::vector<int> bundle_of_pack(layout.gridpoint_packs);
  for (std::size_t b = 0; b < layout.bundles.size(); ++b)
    for (int i = 0; i < layout.bundles[b].packs; ++i)
      bundle_of_pack[layout.bundles[b].first_pack + i] = static_cast<int>(b);
  const auto touched = [&](int pack) {
    std::set<int> bundles;
    for (int point : {2 * pack, 2 * pack + 1})
      for (int lane = 0; lane < kLanes; ++lane)
        for (int offset : {layout.points[point].a[lane], layout.points[point].b[lane]})
          bundles.insert(bundle_of_pack[offset / offset_of<2>(kLanes)]);
    return bundles;
  };
  std::vector<int> taken(layout.faces.size()), moved(layout.bundles.size());
  const auto take = [&](const IndexRange& packs) {
    for (int pack = packs.first; pack < packs.last; ++pack) {
      ++taken[pack];
      for (int b : touched(pack)) EXPECT_EQ(moved[b], 0) << "face pack " << pack << " after bundle " << b;
    }
  };
  for (const Share& share : shares)
    for (const auto& packs : share.crossing) take(packs);
  // A thread may be ahead of the others by any amount: the worst is one after the other, either way round.
  const auto sweep = [&](std::vector<Share::Stride> Share::*strides) {
    for (auto share = shares.rbegin(); share != shares.rend(); ++share)
      for (const auto& stride : (*share).*strides) {
        take(stride.faces);
        for (int b = stride.bundles.first; b < stride.bundles.last; ++b) {
          ++moved[b];
          for (std::size_t pack = 0; pack < layout.faces.size(); ++pack)
            if (touched(static_cast<int>(pack)).count(b) != 0) {
              EXPECT_EQ(taken[pack], 1) << "bundle " << b << " before face pack " << pack;
            }
        }
      }
  };
  sweep(&Share::leading);
  for (std::size_t b = 0; b < moved.size(); ++b) {
    const int at = static_cast<int>(b);
    const bool leads = std::ranges::count(leading, at) + std::ranges::count(layout.parts, at) > 0;
    EXPECT_EQ(moved[b], leads ? 1 : 0) << "bundle " << b;
  }
  sweep(&Share::strides);
  EXPECT_EQ(std::count(taken.begin(), taken.end(), 1), static_cast<std::ptrdiff_t>(taken.size()));
  EXPECT_EQ(std::count(moved.begin(), moved.end(), 1), static_cast<std::ptrdiff_t>(moved.size()));

  std::vector<int> computed(layout.parts.size());
  for (const Share& share : shares) {
    for (int i = share.corner_parts.first; i < share.corner_parts.last; ++i) ++computed[i];
    for (int i = 0; i < static_cast<int>(layout.parts.size()); ++i) {
      const bool moves = std::ranges::any_of(share.leading, [&](const auto& stride) {
        return stride.bundles.first <= layout.parts[i] && layout.parts[i] < stride.bundles.last;
      });
      EXPECT_EQ(share.moved_parts.first <= i && i < share.moved_parts.last, moves) << "part " << i;
    }
  }
  EXPECT_EQ(std::ranges::count(computed, 1), static_cast<std::ptrdiff_t>(computed.size()));
}

TEST(Sweep, TakesEveryFaceOnceBeforeItsBundlesMove) {
  const ModelOf<2> model = small_concrete();
  for (const int most_zones : {64, 8}) {
    const Layout<2> layout(model, {.most_zones = most_zones});
    ASSERT_GE(layout.parts.size(), 2U);
    for (int threads : {1, 2, 3, 7}) play(layout, threads);
    std::vector<int> leading;
    for (int b = 1; b < static_cast<int>(layout.bundles.size()); b += b % 3) leading.push_back(b);
    for (int threads : {1, 3}) play(layout, threads, leading);
  }
}

TEST(Sweep, HasWorkForFewerBundlesThanThreads) {
  const Layout<2> layout(bodies::column(2, 0.1));
  play(layout, 5);
}

}  // namespace
}  // namespace pyroclast
