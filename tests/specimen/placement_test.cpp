#include "pyroclast/specimen/placement.hpp"

#include <algorithm>
#include <cmath>

#include "examples.hpp"
#include "pyroclast/specimen/gradation.hpp"

namespace pyroclast::specimen {
namespace {

std::vector<Aggregate> place_paper_aggregates(const AggregateParameters& p, std::uint64_t seed) {
  Random random(seed);
  return place(draw_diameters<2>(p, 0.15 * 0.3, random), room_in(Region::rectangle(0.15, 0.3)), p, {},
               random);
}

TEST(Placement, KeepsTheGapBetweenAggregatesAndToTheOutline) {
  const AggregateParameters p = paper_aggregates();
  const double gap = p.minimum_gap * (1 - 1e-9);  // the comparison is one of squares
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    const std::vector<Aggregate> circles = place_paper_aggregates(p, seed);
    for (std::size_t i = 0; i < circles.size(); ++i) {
      const double radius = circles[i].diameter / 2;
      for (int axis = 0; axis < 2; ++axis) {
        EXPECT_GE(circles[i].centre[axis] - radius, gap);
        EXPECT_LE(circles[i].centre[axis] + radius, (axis == 0 ? 0.15 : 0.3) - gap);
      }
      for (std::size_t j = 0; j < i; ++j) {
        EXPECT_GE(norm(circles[i].centre - circles[j].centre) - radius - circles[j].diameter / 2, gap);
      }
    }
  }
}

TEST(Placement, PlacesThousandsOfSmallAggregatesBetweenLargeOnes) {
  AggregateParameters p = paper_aggregates();
  p.fraction = 0.5;
  p.d_min = 1e-3;
  p.sieves.front() = 1e-3;
  p.minimum_gap = 0;
  Random random(1);
  const std::vector<double> diameters = draw_diameters<2>(p, 0.15 * 0.3, random);
  ASSERT_GT(diameters.size(), 1000U);
  EXPECT_EQ(place(diameters, room_in(Region::rectangle(0.15, 0.3)), p, {}, random).size(), diameters.size());
}

TEST(Placement, SaysHowMuchIsMissing) {
  AggregateParameters p = paper_aggregates();
  p.fraction = 0.7;
  p.attempts = 100;
  p.place = "mine.toml:12: aggregates";
  const std::string said = message([&] { place_paper_aggregates(p, 1); });
  EXPECT_TRUE(says(said, "^mine.toml:12: aggregates: the aggregates do not fit: after [0-9]+ of [0-9]+"));
  EXPECT_TRUE(says(said, "an area fraction of 0\\.[0-9]+ of the 0\\.700 asked for"));
  EXPECT_TRUE(says(said, "one of [0-9.]+ mm found no place in 100 attempts"));
}

TEST(Placement, SaysWhatThoseThatFoundAPlaceTake) {
  AggregateParameters p = paper_aggregates();
  p.attempts = 100;
  Random random(1);
  const std::vector<double> diameters{20e-3, 10e-3, 50e-3};  // the last is wider than the specimen
  // pi/4 (20^2 + 10^2) / (40 x 300) = 0.0327
  EXPECT_TRUE(says(message([&] { place(diameters, room_in(Region::rectangle(0.04, 0.3)), p, {}, random); }),
                   "after 2 of 3, an area fraction of 0\\.033 of"));
}

TEST(Placement, AnAggregateWiderThanTheSpecimenIsMissing) {
  AggregateParameters p = paper_aggregates();
  Random random(1);
  const std::vector<double> diameters{30e-3};
  EXPECT_TRUE(says(message([&] { place(diameters, room_in(Region::rectangle(0.02, 0.3)), p, {}, random); }),
                   "after 0 of 1"));
}

}  // namespace
}  // namespace pyroclast::specimen
