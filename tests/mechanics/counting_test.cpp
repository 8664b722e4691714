#include "counting.hpp"

#include <algorithm>

#include <gtest/gtest.h>

#include "bodies.hpp"
#include "model/small_specimen.hpp"
#include "pyroclast/mechanics/sweep.hpp"

namespace pyroclast {
namespace {

using namespace bodies;

/// A specimen torn until it cracks.
Mechanics<2> torn(const ModelOf<2>& model, bool counted) {
  auto m = mechanics(model, mortar_contact(), quasi_static<2>());
  if (counted) m.use(bench::counting_step<2>());
  for (int g = 0; g < model.gridpoint_count(); ++g)
    if (const double y = model.position[g][1]; y == 0.0 || y == 0.05)
      for (int i : {0, 1}) m.constraints().prescribe_velocity(g, i, y == 0.0 ? 0.0 : 5e-3);
  m.advance(100);
  return m;
}

TEST(Counting, LeavesTheBitsOfAnOrdinaryStep) {
  const ModelOf<2> model = tessellated(60, 0.05, 0.05, 3);
  const auto counted = torn(model, true), ordinary = torn(model, false);
  EXPECT_GT(ordinary.totals().energy().dissipated.total(), 0.0);
  EXPECT_TRUE(counted.read().displacements() == ordinary.read().displacements());
  EXPECT_TRUE(counted.read().velocities() == ordinary.read().velocities());
  EXPECT_EQ(counted.totals().energy().dissipated.total(), ordinary.totals().energy().dissipated.total());
}

TEST(Counting, ArithmeticAndRootsCountOnceALaneAndChoicesNothing) {
  using Real = Lanes<bench::Counting>;
  const Real a = 2.0, b = 3.0;
  bench::Counted::operations = 0;
  Real c = sqrt((a + b) * a - a / b);
  EXPECT_EQ(bench::Counted::operations, 5 * kLanes);
  c = select(a < b, larger(abs(c), b), smaller(signed_like(a, b), c));
  EXPECT_EQ(bench::Counted::operations, 5 * kLanes);
}

TEST(Counting, StepsThatAreMeasuredAreLeftOut) {
  const ModelOf<2> model = tessellated(20, 0.05, 0.05, 3);
  auto m = mechanics(model, elastic_contact(), quasi_static<2>());
  m.use(bench::counting_step<2>());
  bench::reset_operations();
  m.advance(1);  // its last step is measured
  EXPECT_EQ(bench::operations().faces, 0);
  EXPECT_EQ(bench::operations().bundles, 0);
  m.advance(2);
  const auto one = bench::operations();
  EXPECT_GT(one.faces, 0);
  EXPECT_GT(one.bundles, 0);
  m.advance(3);  // an elastic body does the same in every step
  EXPECT_EQ(bench::operations().faces, 3 * one.faces);
  EXPECT_EQ(bench::operations().bundles, 3 * one.bundles);
}

/// Of one elastic contact point with small displacements: the jump, its two components, two tractions, the
/// stored energy, and the force along two directions.
TEST(Counting, AnElasticContactPointCostsWhatItsEquationsSay) {
  const ModelOf<2> model = tessellated(20, 0.05, 0.05, 3);
  auto m = mechanics(model, elastic_contact(), quasi_static<2>());
  m.use(bench::counting_step<2>());
  bench::reset_operations();
  m.advance(2);
  const int a_point = 2 + 2 * 3 + 2 + 5 + (2 * 3 + 2);
  const int normal = 1;  // one component of a face's normal is minus one of its tangent
  EXPECT_EQ(bench::operations().faces, kLanes * m.body().layout.face_packs() * (2 * a_point + normal));
}

TEST(Counting, CombinedDampingReadsTheForcesOfTheLastStep) {
  const ModelOf<2> model = tessellated(20, 0.05, 0.05, 3);
  auto parameters = quasi_static<2>();
  parameters.damping_form = DampingForm::local;
  const auto local = mechanics(model, mortar_contact(), parameters);
  parameters.damping_form = DampingForm::combined;
  const auto combined = mechanics(model, mortar_contact(), parameters);
  const auto one = bench::traffic(local), other = bench::traffic(combined);
  EXPECT_EQ(other.moved - one.moved, static_cast<double>(bytes_of(local.body().state.force)));
  EXPECT_EQ(other.working_set, one.working_set);
  EXPECT_GT(one.moved, one.working_set);
  EXPECT_LT(one.working_set, static_cast<double>(local.body().memory()));
}

/// Operations of each thread in a step, before its barrier and behind it.
struct OfThread {
  std::int64_t before = 0, behind = 0;
};

std::vector<OfThread> operations_of_threads(const Mechanics<2>& m, int threads) {
  State<2> s = m.body().state;
  const auto& passes = m.body().step.passes;
  auto scratch = m.body().make_scratch();
  const auto counted = [](auto work) {
    bench::reset_operations();
    work();
    return bench::operations().faces + bench::operations().bundles;
  };
  const auto update = [&](const IndexRange& faces) {
    for_each_law(s, faces.first, faces.last, [&](const PackFunctions<2>& law, int first, int last) {
      law.update(s, first, last, false);
    });
  };
  const auto shares = share_out(m.body().layout, threads);
  std::vector<OfThread> all(shares.size());
  for (std::size_t t = 0; t < shares.size(); ++t)
    all[t].before = counted([&] {
      for (const auto& faces : shares[t].crossing) update(faces);
      passes.place_corner_forces(s, shares[t].corner_parts.first, shares[t].corner_parts.last, Pass::move);
    });
  for (std::size_t t = 0; t < shares.size(); ++t)
    all[t].behind = counted([&] {
      for (const auto& strides : {shares[t].leading, shares[t].strides})
        for (const auto& stride : strides) {
          update(stride.faces);
          passes.move_bundles(s, stride.bundles.first, stride.bundles.last, Pass::move, scratch.data());
        }
    });
  return all;
}

// Promise: all threads share a step evenly, platens too. 10 % is the stone of bundles and of faces that cross
// in a body this small; the platens of one piece each would give the thread that has most 50 % more.
TEST(Sweep, GivesEveryThreadAboutTheSameWork) {
  const ModelOf<2> model = between_platens(small_specimen(3000), 0.01, 0.5);
  BodyProperties p;
  p.zones.assign(model.zones.size(), zone_properties<2>(29.4e9, 0.2));
  p.contacts.add(mortar_contact());
  p.of_contact.assign(model.contacts.size(), 0);
  Mechanics<2> m(model, std::vector<double>(model.material_names.size(), 2400.0), p, quasi_static<2>());
  ASSERT_GE(m.body().layout.parts.size(), 4U);
  m.use(bench::counting_step<2>());
  for (const int threads : {2, 4, 8}) {
    std::int64_t most = 0, all = 0;
    for (const auto& [before, behind] : operations_of_threads(m, threads)) {
      most = std::max(most, before + behind);
      all += before + behind;
    }
    EXPECT_LT(static_cast<double>(most) * threads, 1.1 * static_cast<double>(all)) << threads << " threads";
  }
}

}  // namespace
}  // namespace pyroclast
