// Promise: a body of its own is one block of the volume, the outline and the sets that its corners say, in
// either dimension, and does not lie in another block, however they cross.
#include "pyroclast/model/loose_bodies.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "messages.hpp"
#include "pyroclast/model/outline.hpp"
#include "pyroclast/specimen/convex_hull.hpp"

namespace pyroclast {
namespace {

LooseBody solid(const std::string& name, const std::vector<Vec<3>>& corners, double edge) {
  return {name, corners, specimen::convex_hull(corners), edge, "platen", "deck.toml:1: bodies[0]"};
}

std::vector<Vec<3>> box(const Vec<3>& low, const Vec<3>& high) {
  std::vector<Vec<3>> corners;
  for (int i = 0; i < 8; ++i)
    corners.push_back({{(i & 1) != 0 ? high[0] : low[0], (i & 2) != 0 ? high[1] : low[1],
                        (i & 4) != 0 ? high[2] : low[2]}});
  return corners;
}

/// Expects a body alone in its model to be closed and to have a volume, m³, and a surface, m².
void expect_whole(const LooseBody& body, double volume, double surface) {
  SCOPED_TRACE(body.name);
  ModelOf<3> model;
  add_loose_bodies(model, {body});
  ASSERT_EQ(model.block_count(), 1);
  const auto geometry = zone_geometry(model);
  double filled = 0.0, area = 0.0;
  for (const double of_zone : geometry.volume) filled += of_zone;
  EXPECT_NEAR(filled, volume, 1e-12 * volume);
  const auto faces = outline(model, geometry, {true});
  Vec<3> sum{};
  std::vector<int> seen;
  for (const auto& face : faces) {
    sum += face.area * face.normal;
    area += face.area;
    seen.insert(seen.end(), face.gridpoints.begin(), face.gridpoints.end());
    for (int i = 0; i < 3; ++i) {
      const Vec<3> along = model.position[face.gridpoints[i]] - model.position[face.gridpoints[(i + 1) % 3]];
      EXPECT_LT(norm(along), 2.15 * body.edge);  // diagonals of a grid among them
    }
  }
  EXPECT_NEAR(norm(sum), 0.0, 1e-12 * area);
  EXPECT_NEAR(area, surface, 1e-12 * surface);
  std::ranges::sort(seen);
  seen.erase(std::unique(seen.begin(), seen.end()), seen.end());
  EXPECT_EQ(model.set(body.name + "_outline"), seen);
  EXPECT_EQ(std::ssize(model.set(body.name)), model.gridpoint_count());
  EXPECT_LT(std::ssize(seen), model.gridpoint_count());
  EXPECT_EQ(interfaces_of_loose_bodies(model), std::vector<int>{0});
}

TEST(LooseSolids, HaveTheirVolumeAndAClosedOutline) {
  expect_whole(solid("box", box({{0.1, 0.0, 0.0}}, {{0.13, 0.02, 0.1}}), 0.01), 6e-5,
               2.0 * (6e-4 + 2e-3 + 3e-3));
  // one whose faces are no rectangles, and slanted
  const std::vector<Vec<3>> frustum{{{0.0, 0.0, 0.0}},    {{0.04, 0.0, 0.0}},   {{0.04, 0.04, 0.0}},
                                    {{0.0, 0.04, 0.0}},   {{0.01, 0.01, 0.03}}, {{0.03, 0.01, 0.03}},
                                    {{0.03, 0.03, 0.03}}, {{0.01, 0.03, 0.03}}};
  expect_whole(solid("frustum", frustum, 0.008), 0.01 * (16e-4 + 8e-4 + 4e-4),
               16e-4 + 4e-4 + 4.0 * 0.03 * std::hypot(0.01, 0.03));
  const double s = 0.05;
  expect_whole(solid("tetrahedron", {{{s, s, s}}, {{s, -s, -s}}, {{-s, s, -s}}, {{-s, -s, s}}}, 0.02),
               8.0 / 3.0 * s * s * s, 8.0 * std::numbers::sqrt3 * s * s);
  std::vector<Vec<3>> prism;
  for (int i = 0; i < 12; ++i) {
    const double angle = std::numbers::pi / 3.0 * (i % 6);
    prism.push_back({{0.03 * std::cos(angle), i < 6 ? 0.0 : 0.02, 0.03 * std::sin(angle)}});
  }
  const double hexagon = 1.5 * std::numbers::sqrt3 * 9e-4;
  expect_whole(solid("prism", prism, 0.01), 0.02 * hexagon, 2.0 * hexagon + 6.0 * 0.03 * 0.02);
}

// Promise: a round body has the volume that its diameter says, in facets of about the edge that is asked for.
TEST(LooseSolids, MayBeRound) {
  for (const double edge : {0.2, 0.012, 0.007}) {
    const auto shape = specimen::ball_of_facets({{0.1, -0.2, 0.3}}, 0.06, edge);
    double area = 0.0;
    for (const auto& face : shape.faces)
      area += 0.5 * norm(cross(shape.corners[face[1]] - shape.corners[face[0]],
                               shape.corners[face[2]] - shape.corners[face[0]]));
    const double ball = std::numbers::pi * 0.06 * 0.06;
    EXPECT_GT(area, ball);
    EXPECT_LT(area, (edge > 0.1 ? 1.06 : 1.02) * ball);
    const double of_facet = std::sqrt(4.0 / std::numbers::sqrt3 * area / std::ssize(shape.faces));
    if (edge < 0.1)
      EXPECT_NEAR(of_facet, edge, 0.15 * edge);
    else
      EXPECT_EQ(shape.faces.size(), 80U);
    expect_whole({"ball", shape.corners, shape.faces, edge, "platen", "deck"}, ball * 0.01, area);
  }
}

TEST(ConvexHull, HasFacesOfAllTheirCornersAndLeavesOutOtherPoints) {
  auto points = box({{0.0, 0.0, 0.0}}, {{1.0, 2.0, 3.0}});
  const auto faces = specimen::convex_hull(points);
  ASSERT_EQ(faces.size(), 6U);
  for (const auto& face : faces) {
    ASSERT_EQ(face.size(), 4U);
    const Vec<3> normal = cross(points[face[1]] - points[face[0]], points[face[2]] - points[face[0]]);
    for (const Vec<3>& p : points) EXPECT_LE(dot(normal, p - points[face[0]]), 1e-12);
  }
  // in the body, in a face, on an edge, and once more
  for (const Vec<3>& p : {Vec<3>{{0.5, 0.5, 0.5}}, {{0.0, 0.5, 1.5}}, {{0.0, 0.0, 1.0}}, {{1.0, 2.0, 3.0}}})
    points.push_back(p);
  std::rotate(points.begin(), points.begin() + 8, points.end());  // the first ones are no corners
  const auto of_more = specimen::convex_hull(points);
  EXPECT_EQ(of_more.size(), 6U);
  for (const auto& face : of_more) EXPECT_EQ(face.size(), 4U);
  EXPECT_EQ(
      specimen::convex_hull({{{0.0, 0.0, 1.0}}, {{1.0, 0.0, 1.0}}, {{0.0, 1.0, 1.0}}, {{1.0, 1.0, 1.0}}})
          .size(),
      0U);
}

const std::string kNone = "no Error was thrown";

/// What is said of a second body.
template <int Dim>
std::string refusal(const LooseBody& first, const LooseBody& second) {
  ModelOf<Dim> model;
  return message([&] { add_loose_bodies(model, {first, second}); });
}

TEST(LooseSolids, DoNotLieInOtherBlocks) {
  const auto low = solid("low", box({{-0.1, -0.02, -0.1}}, {{0.1, 0.0, 0.1}}), 0.1);
  const auto refused = [&](const std::vector<Vec<3>>& corners) {
    return refusal<3>(low, solid("other", corners, 0.1)) != kNone;
  };
  EXPECT_FALSE(refused(box({{-0.05, 0.0, -0.05}}, {{0.05, 0.1, 0.05}})));  // it touches
  EXPECT_FALSE(refused(box({{0.1, -0.05, -0.2}}, {{0.2, 0.1, 0.2}})));
  EXPECT_TRUE(refused(box({{-0.05, -1e-5, -0.05}}, {{0.05, 0.1, 0.05}})));
  EXPECT_TRUE(refused(box({{-0.01, -0.2, -0.01}}, {{0.01, 0.2, 0.01}})));       // a rod goes through
  EXPECT_TRUE(refused(box({{-0.2, -0.2, -0.2}}, {{0.2, 0.2, 0.2}})));           // around it
  EXPECT_TRUE(refused(box({{0.02, -0.012, 0.03}}, {{0.021, -0.011, 0.031}})));  // within a zone
  // two edges that cross at (0.1, 0, 0): no corner of either body lies in the other one
  const auto wedge = [](double at) {
    return std::vector<Vec<3>>{{{at, -0.1, 0.0}},      {{at, 0.1, 0.0}},         {{at + 0.1, -0.1, 0.1}},
                               {{at + 0.1, 0.1, 0.1}}, {{at + 0.1, -0.1, -0.1}}, {{at + 0.1, 0.1, -0.1}}};
  };
  const auto across = solid("low",
                            {{{0.1, 0.0, -0.07}},
                             {{0.1, 0.0, 0.07}},
                             {{0.0, -0.1, -0.07}},
                             {{0.0, -0.1, 0.07}},
                             {{0.0, 0.1, -0.07}},
                             {{0.0, 0.1, 0.07}}},
                            0.2);
  EXPECT_EQ(refusal<3>(across, solid("other", wedge(0.1001), 0.2)), kNone);
  const std::string said = refusal<3>(across, solid("other", wedge(0.0999), 0.2));
  EXPECT_NE(said.find("deck.toml:1: bodies[0]: body \"other\" lies in another block, at (0.09"),
            std::string::npos)
      << said;
  EXPECT_NE(refusal<3>(low, solid("low", box({{1.0, 0.0, 0.0}}, {{1.1, 0.1, 0.1}}), 0.1))
                .find("needs a set \"low\", but there is one already"),
            std::string::npos);
}

TEST(LooseBodies, DoNotCrossInThePlaneEither) {
  const auto plate = [](const char* name, double width, double height) {
    return LooseBody{
        name,
        {{{-width, -height, 0.0}}, {{width, -height, 0.0}}, {{width, height, 0.0}}, {{-width, height, 0.0}}},
        {},
        0.5,
        "platen",
        "deck"};
  };
  EXPECT_NE(refusal<2>(plate("flat", 0.2, 0.01), plate("upright", 0.01, 0.2)), kNone);
}

}  // namespace
}  // namespace pyroclast
