#include <cmath>
#include <numbers>

#include "examples.hpp"
#include "pyroclast/specimen/specimen.hpp"

namespace pyroclast::specimen {
namespace {

TEST(Metrics, OfTwoCellsWorkedOutByHand) {
  // A 3 x 2 rectangle cut at x = 1.
  const Cells<2> t{{{{0, 0}}, {{1, 0}}, {{3, 0}}, {{3, 2}}, {{1, 2}}, {{0, 2}}},
                   {{0, 1, 4, 5}, {1, 2, 3, 4}}};
  const Metrics<2> m = measure(t);
  EXPECT_DOUBLE_EQ(m.mean_edge, (1 + 2 + 1 + 2 + 2 + 2 + 2) / 7.0);
  EXPECT_DOUBLE_EQ(m.shortest_edge, 1);
  EXPECT_EQ(m.shortest_edge_cell, 0);
  EXPECT_EQ(m.shortest_edge_at, (Vec<2>{{0.5, 0}}));
  EXPECT_DOUBLE_EQ(m.mean_size, std::sqrt(3.0));
  EXPECT_DOUBLE_EQ(m.zones_per_block, 4);
  // In the 1 x 2 cell the zones on the long sides have base angles with tangent 1/2.
  EXPECT_NEAR(m.smallest_angle, std::atan(0.5) * 180 / std::numbers::pi, 1e-12);
  EXPECT_EQ(m.smallest_angle_cell, 0);
}

}  // namespace
}  // namespace pyroclast::specimen
