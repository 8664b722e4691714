#include "pyroclast/specimen/region.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <optional>
#include <string>

#include "examples.hpp"
#include "pyroclast/specimen/blocks.hpp"
#include "pyroclast/specimen/outline_seeds.hpp"
#include "pyroclast/specimen/polygon.hpp"
#include "pyroclast/specimen/topology.hpp"

// of its own, as tests of a module are one unit
namespace pyroclast::specimen::region_test {
namespace {

Vec<2> at(double x, double y) {
  return {{x, y}};
}

std::vector<std::string> names(std::size_t count) {
  std::vector<std::string> result;
  for (std::size_t i = 0; i < count; ++i) result.push_back("side_" + std::to_string(i + 1));
  return result;
}

Region polygon(const std::vector<Vec<2>>& corners) {
  return Region::polygon(corners, names(corners.size()));
}

Region with_hole(const Region& region, const std::vector<Vec<2>>& corners) {
  return region.with_holes(std::array{Hole{"hole", corners}});
}

Region with_notch(const Region& region, const Vec<2>& mouth, const Vec<2>& tip, double width = 0.0,
                  double point = 1.0) {
  return region.with_notches(std::array{Notch{"notch", mouth, tip, width, point}});
}

const Region square = Region::rectangle(1.0, 1.0);

TEST(Region, DistancesAreNegativeInsideAndGoAroundHoles) {
  const Region holed = with_hole(square, {at(0.4, 0.4), at(0.6, 0.4), at(0.6, 0.6), at(0.4, 0.6)});
  EXPECT_DOUBLE_EQ(square.distance(at(0.5, 0.45)), -0.45);
  EXPECT_DOUBLE_EQ(holed.distance(at(0.5, 0.45)), 0.05);
  EXPECT_DOUBLE_EQ(holed.distance(at(0.3, 0.5)), -0.1);
  EXPECT_DOUBLE_EQ(holed.distance(at(0.9, 0.5)), -0.1);
  EXPECT_DOUBLE_EQ(holed.distance(at(1.3, 1.4)), 0.5);
  EXPECT_NEAR(holed.extent(), 0.96, 1e-15);
}

TEST(Region, SidesKeepTheirNamesWhicheverWayCornersRun) {
  for (const bool backwards : {false, true}) {
    std::vector<Vec<2>> corners{at(0, 0), at(2, 0), at(0, 1)};
    std::vector<std::string> sides{"base", "slope", "wall"};
    if (backwards) {
      std::ranges::reverse(corners);  // (0, 1), (2, 0), (0, 0)
      sides = {"slope", "base", "wall"};
    }
    const Region region = Region::polygon(corners, sides);
    EXPECT_DOUBLE_EQ(region.extent(), 1.0);
    EXPECT_EQ(region.sides()[region.side_of(at(0.5, 0), at(1, 0)).value()].name, "base");
    EXPECT_EQ(region.sides()[region.side_of(at(2, 0), at(0, 1)).value()].name, "slope");
    EXPECT_EQ(region.sides()[region.side_of(at(0, 0.2), at(0, 0.3)).value()].name, "wall");
    EXPECT_EQ(region.side_of(at(0.5, 0), at(0, 0.5)), std::nullopt);
  }
}

TEST(Region, ACircleHasItsArea) {
  const std::vector<Vec<2>> corners = circle_corners(at(0.3, -0.1), 0.2, 0.01);
  EXPECT_EQ(corners.size(), 63U);
  EXPECT_NEAR(area(corners), std::numbers::pi * 0.01, 1e-15);
  EXPECT_EQ(circle_corners({}, 0.1, 1.0).size(), 12U);
}

TEST(Region, ANotchWithAWidthIsCutOutAndOneWithoutIsNot) {
  const Region wedge = with_notch(square, at(0.5, 0.0), at(0.5, 0.4), 0.1);
  EXPECT_NEAR(wedge.extent(), 1.0 - 0.5 * 0.1 * 0.4, 1e-12);
  EXPECT_NEAR(wedge.distance(at(0.5, 0.0)), 0.05 * 0.4 / std::hypot(0.4, 0.05), 1e-12);
  EXPECT_EQ(wedge.distance_before_cuts(at(0.5, 0.1)), -0.1);
  EXPECT_EQ(wedge.sides()[wedge.side_of(at(0.55, 0.0), at(0.5, 0.4)).value()].name, "notch");
  EXPECT_EQ(wedge.sides()[wedge.side_of(at(0.6, 0.0), at(0.7, 0.0)).value()].name, "bottom");
  const Region slot = with_notch(square, at(0.5, 0.0), at(0.5, 0.4), 0.1, 0.1);
  EXPECT_NEAR(slot.extent(), 1.0 - 0.1 * 0.3 - 0.5 * 0.1 * 0.1, 1e-12);
  EXPECT_NEAR(slot.distance(at(0.5, 0.2)), 0.05, 1e-12);
  EXPECT_EQ(slot.sides()[slot.side_of(at(0.55, 0.1), at(0.55, 0.2)).value()].name, "notch");
  const Region slit = with_notch(square, at(0.5, 0.0), at(0.5, 0.4));
  EXPECT_EQ(slit.extent(), 1.0);
  EXPECT_EQ(slit.slit_of(at(0.5, 0.1), at(0.5, 0.2)), std::optional(0));
  EXPECT_EQ(slit.slit_of(at(0.5, 0.1), at(0.5, 0.5)), std::nullopt);
}

TEST(Region, WhatIsNoBodyIsRefusedByName) {
  EXPECT_TRUE(says(message([] { polygon({at(0, 0), at(1, 0)}); }), "2 corners"));
  EXPECT_TRUE(says(message([] { polygon({at(0, 0), at(1, 1), at(1, 0), at(0, 1)}); }), "cross or touch"));
  EXPECT_TRUE(says(message([] {
                     polygon({at(0, 0), at(1, 0), at(1, 0), at(0, 1)});
                   }),
                   "corner 2 and the next"));
  EXPECT_TRUE(says(message([] {
                     with_hole(square, {at(0.5, 0.5), at(1.5, 0.5), at(1, 1)});
                   }),
                   "hole: .*not within"));
  EXPECT_TRUE(says(message([] {
                     with_hole(with_hole(square, {at(0.4, 0.4), at(0.6, 0.4), at(0.5, 0.6)}),
                               {at(0.1, 0.1), at(0.9, 0.1), at(0.5, 0.9)});
                   }),
                   "it holds hole"));
  EXPECT_TRUE(says(message([] { with_notch(square, at(0.5, 0.1), at(0.5, 0.5)); }),
                   "notch: .*100 mm from the outline"));
  EXPECT_TRUE(says(message([] { with_notch(square, at(0.5, 0.0), at(0.5, 1.5)); }), "not within the body"));
  EXPECT_TRUE(says(
      message([] {
        with_notch(with_hole(square, {at(0.4, 0.4), at(0.6, 0.4), at(0.5, 0.6)}), at(0.5, 0.0), at(0.5, 0.8));
      }),
      "it crosses hole"));
  EXPECT_TRUE(says(message([] { with_notch(square, at(0.5, 0.0), at(0.5, 0.1), 0.2); }), "longer than wide"));
}

/// Around the origin, with some corners that jut into the body; sides longer than `shortest` (m).
std::vector<Vec<2>> random_polygon(Random& random, double shortest) {
  while (true) {
    const int n = 5 + static_cast<int>(random.uniform(0.0, 6.0));
    std::vector<Vec<2>> corners;
    for (int i = 0; i < n; ++i) {
      const double angle = 2.0 * std::numbers::pi * (i + random.uniform(-0.25, 0.25)) / n;
      corners.push_back(random.uniform(0.06, 0.15) * at(std::cos(angle), std::sin(angle)));
    }
    bool fits = true;
    for (int i = 0; i < n; ++i) {
      const Vec<2> side = corners[(i + 1) % n] - corners[i],
                   next = corners[(i + 2) % n] - corners[(i + 1) % n];
      // no corner sharper than 54 degrees
      fits = fits && norm(side) > shortest && std::abs(std::atan2(cross(side, next), dot(side, next))) < 2.2;
    }
    if (fits) return corners;
  }
}

/// With a hole in the middle and a notch from a side, both of three to five block sizes.
std::optional<Region> random_body(Random& random, int blocks) {
  const std::vector<Vec<2>> corners = random_polygon(random, 0.03);
  Region region = polygon(corners);
  const double size = std::sqrt(region.extent() / blocks);
  const Vec<2> centre = at(random.uniform(-0.01, 0.01), random.uniform(-0.01, 0.01));
  const double width = random.uniform(3.0, 5.0) * size;
  const bool is_round = random.uniform() < 0.5;
  const auto side = static_cast<std::size_t>(random.uniform() * static_cast<double>(corners.size()));
  const Vec<2> along = corners[(side + 1) % corners.size()] - corners[side];
  const Vec<2> mouth = corners[side] + random.uniform(0.35, 0.65) * along;
  const Vec<2> tip = mouth + random.uniform(3.0, 5.0) * size / norm(along) * at(-along[1], along[0]);
  const double opening = random.uniform() < 0.5 ? 0.0 : random.uniform(0.3, 1.5) * size;
  try {
    region = region.with_holes(std::array{
        is_round ? Hole{"hole", circle_corners(centre, width, size), true}
                 : Hole{"hole",
                        {centre, centre + at(width, 0), centre + at(width, width), centre + at(0, width)}}});
    region = with_notch(region, mouth, tip, opening, slot_point(norm(tip - mouth), opening, size));
  } catch (const Error&) {
    return std::nullopt;  // they meet
  }
  const double ligament = std::abs(region.with_notches({}).distance(tip));
  return opening == 0.0 && ligament < 3.0 * size ? std::nullopt : std::optional(region);
}

BlockParameters of_count(int count) {
  BlockParameters p;
  p.count = count;
  p.shortest_edge = 0.2;
  return p;
}

bool has_vertex(const Cells<2>& t, const Vec<2>& corner) {
  return std::ranges::find(t.vertices, corner) != t.vertices.end();
}

/// That the blocks are the body: their area, its corners, every face in two blocks or on the outline.
void expect_body(const Cells<2>& t, const Region& region) {
  require_valid(t, region, "blocks");
  for (const Piece& piece : region.pieces()) EXPECT_TRUE(has_vertex(t, piece.from));
  double slits = 0.0, outline = 0.0;
  for (const Facet<2>& e : facets(t)) {
    const Vec<2>&a = t.vertices[e.corners[0]], &b = t.vertices[e.corners[1]];
    EXPECT_EQ(e.outer < 0, region.side_of(a, b).has_value());
    if (e.outer < 0) outline += norm(b - a);
    if (region.slit_of(a, b)) slits += norm(b - a);
  }
  double long_slits = 0.0, long_outline = 0.0;
  for (const Notch& notch : region.notches()) {
    EXPECT_TRUE(has_vertex(t, notch.tip));
    if (notch.width == 0.0) long_slits += norm(notch.tip - notch.mouth);
  }
  for (const Piece& piece : region.pieces()) long_outline += norm(piece.to - piece.from);
  EXPECT_NEAR(slits, long_slits, 1e-9);
  EXPECT_NEAR(outline, long_outline, 1e-9);
}

TEST(Region, RandomPolygonsWithNotchesAndHolesAreCutIntoBlocks) {
  constexpr int kBodies = 200, kBlocks = 600;
  Random random(1);
  int made = 0;
  for (int body = 0; body < kBodies;) {
    const std::optional<Region> region = random_body(random, kBlocks);
    if (!region) continue;
    ++body;
    try {
      const Blocks<2> blocks = make_blocks(of_count(kBlocks), *region, random);
      EXPECT_EQ(std::ssize(blocks.cells.cells), kBlocks);
      EXPECT_EQ(blocks.done.edges_left_short, 0);
      expect_body(blocks.cells, *region);
      ++made;
    } catch (const Error& error) {
      EXPECT_TRUE(
          says(error.what(), "at the side \"(hole|notch|side_[0-9]+)\"|too (few|large) for this outline"));
    }
  }
  EXPECT_GE(made, kBodies - 2);
}

TEST(Region, ATooFineOutlineIsNamed) {
  // a hole of one block size
  const Region region =
      square.with_holes(std::array{Hole{"bolt", circle_corners(at(0.5, 0.5), 0.1, 0.1), true}});
  Random random(1);
  EXPECT_TRUE(says(message([&] { make_blocks(of_count(10), region, random); }), "10 blocks are too few"));
}

TEST(Region, AggregatesKeepAwayFromTheOutlineButNotFromCuts) {
  SpecimenParameters p = paper_specimen(1);
  p.blocks.count = 400;
  p.aggregates.fraction = 0.3;
  p.outline =
      with_notch(polygon({at(0, 0), at(0.2, 0), at(0.2, 0.1), at(0.1, 0.1), at(0.1, 0.3), at(0, 0.3)}),
                 at(0, 0.2), at(0.05, 0.2), 0.006);
  const Specimen<2> specimen = make_specimen(p);
  int cut = 0;
  for (const Stone<2>& a : specimen.stones) {
    EXPECT_LE(p.region()->distance_before_cuts(a.centre), -(0.5 * a.diameter + p.aggregates.minimum_gap));
    if (p.region()->distance(a.centre) > -0.5 * a.diameter) ++cut;
  }
  EXPECT_GT(cut, 0);
  EXPECT_NEAR(specimen.fraction_placed, 0.3, 0.01);
}

}  // namespace
}  // namespace pyroclast::specimen::region_test
