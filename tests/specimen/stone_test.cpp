#include "pyroclast/specimen/stone.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <numbers>
#include <string>
#include <utility>

#include <clipper.hpp>

#include "examples.hpp"
#include "pyroclast/specimen/gradation.hpp"
#include "pyroclast/specimen/outline.hpp"
#include "pyroclast/specimen/placement.hpp"
#include "pyroclast/specimen/polygon.hpp"

namespace pyroclast::specimen::stone_test {
namespace {

using Points = std::vector<Vec<2>>;

constexpr int kPairs = 1000;
/// Number of points that tell the distance of a line from others.
constexpr int kSamples = 2000;

/// Polygons come more often, for they alone cross without a corner in each other.
constexpr std::array kKinds{StoneShape::circle,  StoneShape::ellipse, StoneShape::harmonics,
                            StoneShape::polygon, StoneShape::polygon, StoneShape::polygon};

StoneShape random_kind(Random& random) {
  return kKinds[static_cast<std::size_t>(random.uniform(0.0, kKinds.size()))];
}

Stone<2> random_stone(StoneShape kind, const Vec<2>& centre, Random& random) {
  const ShapeParameters shape{
      .kind = kind, .elongation = {1.0, 5.0}, .corners = {3, 6}, .roughness = {0.0, 0.1}};
  const double width = random.uniform(0.5, 1.0);
  const auto drawn = draw_outline(shape, random);
  return {centre, width, 0, 0, drawn ? drawn->scaled(width) : nullptr};
}

Vec<2> random_direction(Random& random) {
  const double angle = random.uniform(0.0, 2.0 * std::numbers::pi);
  return {{std::cos(angle), std::sin(angle)}};
}

/// Returns points on a stone's surface: the corners of its outline, or of a polygon of so many sides that its
/// arcs rise 1e-6 of the radius above them.
Points line_of(const Stone<2>& stone) {
  if (stone.shape) return corners_of(stone);
  Points line;
  for (int i = 0; i < kSamples; ++i) {
    const double angle = 2.0 * std::numbers::pi * i / kSamples;
    line.push_back(stone.centre + 0.5 * stone.diameter * Vec<2>{{std::cos(angle), std::sin(angle)}});
  }
  return line;
}

/// Points along a line, evenly, and their distance.
struct Sampled {
  Points points;
  double step;
};

Sampled sampled(const Points& corners, bool is_closed = true) {
  std::vector<double> starts{0.0};
  const std::size_t pieces = is_closed ? corners.size() : corners.size() - 1;
  const auto end = [&](std::size_t i) { return corners[(i + 1) % corners.size()]; };
  for (std::size_t i = 0; i < pieces; ++i) starts.push_back(starts.back() + norm(end(i) - corners[i]));
  Sampled result{{}, starts.back() / kSamples};
  std::size_t piece = 0;
  for (int i = 0; i <= kSamples; ++i) {
    const double along = std::min(starts.back(), i * result.step);
    while (piece + 1 < pieces && starts[piece + 1] < along) ++piece;
    const double share = (along - starts[piece]) / (starts[piece + 1] - starts[piece]);
    result.points.push_back(corners[piece] + share * (end(piece) - corners[piece]));
  }
  return result;
}

/// Returns the least distance of the points of two lines.
double distance_of_points(const Sampled& a, Sampled b) {
  std::ranges::sort(b.points, {}, [](const Vec<2>& p) { return p[0]; });
  double least = std::numeric_limits<double>::infinity();
  for (const Vec<2>& p : a.points) {
    const auto middle = std::ranges::lower_bound(b.points, p[0], {}, [](const Vec<2>& q) { return q[0]; });
    for (auto q = middle; q != b.points.end() && (*q)[0] - p[0] < least; ++q)
      least = std::min(least, norm(*q - p));
    for (auto q = middle; q != b.points.begin() && p[0] - (*(q - 1))[0] < least; --q)
      least = std::min(least, norm(*(q - 1) - p));
  }
  return least;
}

/// \param cells  cells of Clipper's grid in a unit of length
ClipperLib::Path path_of(const Points& corners, double cells) {
  ClipperLib::Path path;
  for (const Vec<2>& corner : corners)
    path.emplace_back(std::llround(cells * corner[0]), std::llround(cells * corner[1]));
  return path;
}

/// Tells whether a line runs through a polygon, or the polygons of two have a part in common.
bool meet(const Points& line, const Points& polygon, bool is_closed = true, double cells = 1e12) {
  ClipperLib::Clipper clipper;
  clipper.AddPath(path_of(line, cells), ClipperLib::ptSubject, is_closed);
  clipper.AddPath(path_of(polygon, cells), ClipperLib::ptClip, true);
  ClipperLib::PolyTree found;
  clipper.Execute(ClipperLib::ctIntersection, found, ClipperLib::pftNonZero, ClipperLib::pftNonZero);
  return found.Total() > 0;
}

// Promise: two stones overlap where Clipper finds a common part, and else are as far apart as 2,000 points of
// each say: these are too far by less than half a step of each line, and a circle's points by its rise.
TEST(Stone, OverlapsAndDistancesAreThoseOfSides) {
  Random random(1);
  int overlaps = 0, without_corner = 0;
  for (int pair = 0; pair < kPairs; ++pair) {
    const Stone<2> a = random_stone(random_kind(random), {}, random);
    const Stone<2> b =
        random_stone(random_kind(random), random.uniform(0.0, 2.2) * random_direction(random), random);
    const Points of_a = line_of(a), of_b = line_of(b);
    const bool overlap = meet(of_a, of_b);
    const auto holds_corner = [](const Stone<2>& stone, const Points& points) {
      return std::ranges::any_of(points, [&](const Vec<2>& p) { return holds(stone, p); });
    };
    overlaps += overlap ? 1 : 0;
    without_corner += overlap && !holds_corner(a, of_b) && !holds_corner(b, of_a) ? 1 : 0;
    EXPECT_EQ(are_closer(a, b, 0.0), overlap) << pair;
    const double gap = approach(a, b).gap;
    EXPECT_EQ(gap < 0.0, overlap) << pair;
    EXPECT_TRUE(!overlap || are_closer(a, b, 0.01)) << pair;
    if (overlap) continue;
    const Sampled points_a = sampled(of_a), points_b = sampled(of_b);
    const double told = distance_of_points(points_a, points_b);
    const double bound = 0.5 * (points_a.step + points_b.step);
    EXPECT_GT(gap, told - bound - 1e-6) << pair;
    EXPECT_LT(gap, told + 1e-6) << pair;
    EXPECT_TRUE(are_closer(a, b, told + 1e-5)) << pair;
    if (told > bound + 1e-5) {
      EXPECT_FALSE(are_closer(a, b, told - bound - 1e-5)) << pair;
    }
  }
  EXPECT_GT(overlaps, kPairs / 4);
  EXPECT_LT(overlaps, 3 * kPairs / 4);
  EXPECT_GT(without_corner, 5);
}

/// Body of which a feature has a name and a line.
struct Featured {
  Region region;
  Points line;
  bool is_closed = true;
};

/// Returns a square of 20 around the origin, with a round hole, an uneven one, a notch or a slit in its
/// middle.
Featured random_feature(int kind, Random& random) {
  const auto at = [](double x, double y) { return Vec<2>{{x, y}}; };
  const Region square = Region::polygon({at(-10, -10), at(10, -10), at(10, 10), at(-10, 10)},
                                        {"bottom", "right", "top", "left"});
  if (kind < 2) {
    const Points hole = kind == 0 ? circle_corners({}, random.uniform(0.05, 0.5), 0.02)
                                  : corners_of(random_stone(StoneShape::polygon, {}, random));
    return {square.with_holes(std::array{Hole{"hole", hole, kind == 0}}), hole};
  }
  const Vec<2> mouth = at(random.uniform(-5, 5), -10), tip = at(0, random.uniform(-0.2, 0.2));
  if (kind == 3) return {square.with_notches(std::array{Notch{"slit", mouth, tip}}), {mouth, tip}, false};
  const double width = random.uniform(0.02, 0.3);
  const Region region = square.with_notches(std::array{Notch{"notch", mouth, tip, width, norm(tip - mouth)}});
  Featured result{region, {tip}};
  for (const Piece& piece : region.pieces())
    if (region.sides()[piece.side].is_cut)
      result.line.push_back(norm(piece.from - tip) < 1e-9 ? piece.to : piece.from);
  return result;
}

// Promise: the same of stones and holes, notches and slits of the body.
TEST(Stone, LiesInABodyWhereItIsClearOfHolesNotchesAndSlits) {
  Random random(2);
  int overlaps = 0, held = 0;
  for (int pair = 0; pair < kPairs; ++pair) {
    const int kind = pair % 4;
    const Featured feature = random_feature(kind, random);
    const Room<2> room = room_of_blocks(feature.region);
    const Stone<2> stone =
        random_stone(random_kind(random), random.uniform(0.0, 1.5) * random_direction(random), random);
    if (!stone.shape && kind == 3) continue;  // circles lie across a slit, as a saw cuts them
    const Points line = line_of(stone);
    // an open line is the subject
    const bool overlap = meet(feature.line, line, feature.is_closed);
    overlaps += overlap ? 1 : 0;
    held += overlap &&
            std::ranges::all_of(line, [&](const Vec<2>& p) { return feature.region.distance(p) < 0.0; });
    EXPECT_EQ(lies_within(stone, room, 0.0), !overlap) << pair;
    EXPECT_EQ(lies_within(stone, room, -1e-9), !overlap) << pair;
    if (overlap) {
      EXPECT_FALSE(lies_within(stone, room, 1e-3)) << pair;
      continue;
    }
    const Sampled points = sampled(line), of_feature = sampled(feature.line, feature.is_closed);
    const double told = distance_of_points(points, of_feature);
    const double bound = 0.5 * (points.step + of_feature.step);
    EXPECT_FALSE(lies_within(stone, room, told + 1e-5)) << pair;
    if (told > bound + 1e-5) {
      EXPECT_TRUE(lies_within(stone, room, told - bound - 1e-5)) << pair;
    }
  }
  EXPECT_GT(overlaps, kPairs / 4);
  EXPECT_LT(overlaps, 3 * kPairs / 4);
  EXPECT_GT(held, 30);  // all of their outline lies in the body
}

Points moved(Points points, const Vec<2>& by) {
  for (Vec<2>& point : points) point += by;
  return points;
}

/// Returns a stone that bends around its centroid, like a horseshoe.
Points horseshoe() {
  return {{{0, 0}}, {{6, 0}}, {{6, 6}}, {{5, 6}}, {{5, 1}}, {{1, 1}}, {{1, 6}}, {{0, 6}}};
}

// Promise: an outline that is given twice overlaps, wherever it begins, whichever way round it runs, and 1e-7
// of its size away.
TEST(Stone, AnOutlineThatIsGivenTwiceOverlaps) {
  Random random(3);
  std::vector<Points> all{horseshoe()};
  for (const StoneShape kind : {StoneShape::ellipse, StoneShape::harmonics, StoneShape::polygon})
    all.push_back(corners_of(random_stone(kind, {{3.0, 2.0}}, random)));
  for (const Points& once : all) {
    const Stone<2> first = stone_of(once);
    std::vector<Points> again{once, once, once, moved(once, {{1e-7, 0.0}})};
    std::rotate(again[1].begin(), again[1].begin() + 2, again[1].end());
    std::ranges::reverse(again[2]);
    for (const Points& corners : again) {
      const Stone<2> second = stone_of(corners);
      EXPECT_TRUE(are_closer(first, second, -kTouching * first.diameter));
      EXPECT_LT(approach(first, second).gap, -0.1 * first.diameter);
    }
  }
}

// Promise: outlines that cross at their corners alone overlap, and ones that touch do not.
TEST(Stone, TouchingIsNoOverlapAndCrossingAtCornersIs) {
  const auto box = [](double x0, double y0, double x1, double y1) {
    return Points{{{x0, y0}}, {{x1, y0}}, {{x1, y1}}, {{x0, y1}}};
  };
  const auto overlap = [](const Points& a, const Points& b) {
    return are_closer(stone_of(a), stone_of(b), -kTouching);
  };
  const Points lying{{{-3, -1}}, {{-1, -1}}, {{1, -1}}, {{3, -1}}, {{3, 1}}, {{1, 1}}, {{-1, 1}}, {{-3, 1}}};
  Points standing = lying;
  for (Vec<2>& corner : standing) std::swap(corner[0], corner[1]);
  EXPECT_TRUE(overlap(lying, standing));
  EXPECT_TRUE(overlap(box(-3, -1, 3, 1), box(-1, -3, 1, 3)));
  EXPECT_TRUE(overlap(box(0, 0, 4, 4), {{{2, 0}}, {{4, 2}}, {{2, 4}}, {{0, 2}}}));
  EXPECT_FALSE(overlap(box(0, 0, 1, 1), box(1, 0, 2, 1)));
  EXPECT_FALSE(overlap(box(0, 0, 1, 1), box(1, 0.5, 2, 0.7)));
  EXPECT_FALSE(overlap(box(0, 0, 1, 1), {{{1, 0.5}}, {{2, 0}}, {{2, 1}}}));
  EXPECT_FALSE(overlap(box(0, 0, 1, 1), box(1, 1, 2, 2)));
  EXPECT_FALSE(overlap(horseshoe(), box(1, 1, 5, 6)));
  EXPECT_TRUE(overlap(horseshoe(), box(0.9, 1, 5, 6)));
}

// Promise: where two convex outlines overlap without a corner in each other, the approach is the move that
// parts them.
TEST(Stone, AnApproachOfCrossingOutlinesPartsThem) {
  for (const double scale : {1e-3, 1.0, 1e3}) {
    const auto scaled = [scale](Points points) {
      for (Vec<2>& point : points) point *= scale;
      return points;
    };
    const Stone<2> bar = stone_of(scaled({{{-3, -0.5}}, {{3, -0.5}}, {{3, 0.5}}, {{-3, 0.5}}}));
    Stone<2> pole = stone_of(scaled({{{0, -2}}, {{1, -2}}, {{1, 3}}, {{0, 3}}}));
    const Approach<2> near = approach(bar, pole);
    EXPECT_DOUBLE_EQ(near.gap, -2.5 * scale);
    EXPECT_EQ(near.direction, (Vec<2>{{0, 1}}));
    pole.centre -= near.gap * near.direction;
    EXPECT_NEAR(approach(bar, pole).gap, 0.0, 1e-12 * scale);
    const Approach<2> of_line = approach(bar, scale * Vec<2>{{2, -4}}, scale * Vec<2>{{2, 1}});
    EXPECT_DOUBLE_EQ(of_line.gap, -1.0 * scale);
    EXPECT_EQ(of_line.direction, (Vec<2>{{1, 0}}));
  }
}

// Promise: an approach is the way of the second one out of the first, whichever of both has an outline;
// circles around one centre part along x.
TEST(Stone, AnApproachGoesFromTheFirstToTheSecond) {
  const Stone<2> circle{{{0, 0}}, 2.0, 0, 0, nullptr}, beside{{{0, 3}}, 1.0, 0, 0, nullptr};
  const Stone<2> box = stone_of({{{2, -1}}, {{4, -1}}, {{4, 1}}, {{2, 1}}});
  const Stone<2> other = stone_of({{{2, 4}}, {{4, 4}}, {{4, 6}}, {{2, 6}}});
  const auto expect = [](const Approach<2>& near, double gap, const Vec<2>& direction) {
    EXPECT_NEAR(near.gap, gap, 1e-12);
    EXPECT_NEAR(norm(near.direction - direction), 0.0, 1e-12);
  };
  const Vec<2> x{{1, 0}}, y{{0, 1}};
  expect(approach(circle, beside), 1.5, y);
  expect(approach(beside, circle), 1.5, -y);
  expect(approach(circle, box), 1.0, x);
  expect(approach(box, circle), 1.0, -x);
  expect(approach(box, other), 3.0, y);
  expect(approach(other, box), 3.0, -y);
  expect(approach(circle, Stone<2>{{{0, 0}}, 1.0, 0, 0, nullptr}), -1.5, x);
  const Stone<3> ball{{{1, 1, 1}}, 2.0, 0, 0, nullptr};
  EXPECT_EQ(approach(ball, ball).gap, -2.0);
  EXPECT_EQ(approach(ball, ball).direction, (Vec<3>{{1, 0, 0}}));
}

// Promise: an approach of a stone and a segment is the way of the segment, from its nearest place.
TEST(Stone, AnApproachOfASegmentIsFromItsNearestPlace) {
  const Stone<2> box = stone_of({{{2, -1}}, {{4, -1}}, {{4, 1}}, {{2, 1}}});
  const auto gap = [&](const Vec<2>& from, const Vec<2>& to) { return approach(box, from, to); };
  EXPECT_NEAR(gap({{3, 3}}, {{3, 5}}).gap, 2.0, 1e-12);  // an end over a side
  EXPECT_NEAR(norm(gap({{3, 3}}, {{3, 5}}).direction - Vec<2>{{0, 1}}), 0.0, 1e-12);
  EXPECT_NEAR(gap({{1, 3}}, {{5, 3}}).gap, 2.0, 1e-12);                 // a side along it
  EXPECT_NEAR(gap({{0, 0}}, {{2, 4}}).gap, 3 / std::sqrt(5.0), 1e-12);  // a corner across it
  const Vec<2> across = gap({{0, 0}}, {{2, 4}}).direction;
  EXPECT_NEAR(norm(across - Vec<2>{{-2, 1}} * (1 / std::sqrt(5.0))), 0.0, 1e-12);
  EXPECT_NEAR(gap({{0, 0}}, {{1, 0.5}}).gap, 1.0, 1e-12);  // the end, not the line beyond
  EXPECT_NEAR(gap({{1, 0.5}}, {{0, 0}}).gap, 1.0, 1e-12);
  EXPECT_EQ(gap({{1, 1}}, {{5, 1}}).gap, 0.0);  // it touches
}

// Promise: a place on the surface is held; a segment is closer than a gap up to the gap.
TEST(Stone, HoldsItsSurface) {
  const Stone<2> circle{{{0, 0}}, 2.0, 0, 0, nullptr};
  const Stone<2> box = stone_of({{{2, -1}}, {{4, -1}}, {{4, 1}}, {{2, 1}}});
  for (const double inside : {0.0, 0.999, 1.0}) EXPECT_TRUE(holds(circle, {{inside, 0}})) << inside;
  EXPECT_FALSE(holds(circle, {{1.001, 0}}));
  for (const double inside : {2.0, 2.001, 3.0, 4.0}) EXPECT_TRUE(holds(box, {{inside, 0}})) << inside;
  EXPECT_FALSE(holds(box, {{1.999, 0}}));
  EXPECT_DOUBLE_EQ(distance(circle, {{3, 0}}), 2.0);
  EXPECT_DOUBLE_EQ(distance(circle, {{0, 0.25}}), -0.75);
  EXPECT_DOUBLE_EQ(distance(box, {{3, 2}}), 1.0);
  EXPECT_EQ(place_within(circle), (Vec<2>{{0, 0}}));
  for (const Stone<2>& stone : {circle, box}) {
    const double right = stone.shape ? 4.0 : 1.0;
    const auto is_closer = [&](double x, double gap) { return are_closer(stone, {{x, -3}}, {{x, 3}}, gap); };
    EXPECT_TRUE(is_closer(right + 0.5, 0.51));
    EXPECT_FALSE(is_closer(right + 0.5, 0.49));
    EXPECT_TRUE(is_closer(right - 0.1, 0.0));
    EXPECT_FALSE(is_closer(right + 0.1, 0.0));
    EXPECT_TRUE(is_closer(right - 0.1, -0.09));
    EXPECT_FALSE(is_closer(right - 0.1, -0.11));
  }
  // within, without a side near
  EXPECT_TRUE(are_closer(box, {{2.9, 0}}, {{3.1, 0}}, 0.1));
}

void expect_apart(const std::vector<Stone<2>>& stones, const Room<2>& room, double gap) {
  for (std::size_t i = 0; i < stones.size(); ++i) {
    EXPECT_TRUE(lies_within(stones[i], room, gap * (1.0 - 1e-9)));
    for (std::size_t j = 0; j < i; ++j) {
      EXPECT_FALSE(are_closer(stones[i], stones[j], gap * (1.0 - 1e-9)));
      if (norm(stones[i].centre - stones[j].centre) < reach(stones[i]) + reach(stones[j])) {
        EXPECT_FALSE(meet(line_of(stones[i]), line_of(stones[j]), true, 1e15));
      }
    }
  }
}

// Promise: stones of any form keep the gap when they are placed and when they grow, in bodies with holes,
// notches and slits too.
TEST(Stone, PlacedAndGrownStonesOfAnyFormKeepTheGap) {
  const Region plate = Region::rectangle(0.12, 0.12);
  std::vector<Hole> holes;
  for (const double x : {0.03, 0.09})
    for (const double y : {0.04, 0.08})
      holes.push_back(
          {"hole_" + std::to_string(holes.size() + 1), circle_corners({{x, y}}, 8e-3, 2e-3), true});
  const Region pierced = plate.with_holes(holes).with_notches(
      std::array{Notch{"notch", {{0.06, 0.0}}, {{0.06, 0.03}}, 3e-3, 3e-3},
                 Notch{"slit", {{0.06, 0.12}}, {{0.06, 0.09}}}});
  AggregateParameters p;
  p.d_min = 6e-3;
  p.d_max = 14e-3;
  p.fuller_exponent = 0.5;
  p.sieves = {p.d_min, p.d_max};
  p.minimum_gap = 0.2e-3;
  for (const bool is_pierced : {false, true})
    for (const StoneShape kind : {StoneShape::ellipse, StoneShape::polygon, StoneShape::harmonics})
      for (const bool grow : {false, true}) {
        p.shape = {.kind = kind,
                   .elongation = {1.0, grow ? 1.8 : 3.0},
                   .corners = {3, 4},
                   .roughness = {0.02, 0.08}};
        p.fraction = grow ? 0.35 : 0.3;
        p.attempts = grow ? 20 : 100'000;
        const Region& region = is_pierced ? pierced : plate;
        Random random(4);
        const Room<2> room = room_of_blocks(region);
        expect_apart(place(draw_stones<2>(p, region.extent(), random), room, p, {}, random), room,
                     p.minimum_gap);
      }
}

// Promise: no fibre runs through a hole or a stone.
TEST(Stone, FibresRunThroughNoHoleAndNoStone) {
  const Region region = Region::rectangle(0.1, 0.1).with_holes(
      std::array{Hole{"hole", circle_corners({{0.05, 0.05}}, 0.03, 2e-3), true}});
  const std::vector<Stone<2>> stones{
      stone_of({{{0.02, 0.02}}, {{0.0205, 0.02}}, {{0.0205, 0.08}}, {{0.02, 0.08}}})};
  const FibreParameters p{
      .phase = "steel", .count = 100, .length = 0.05, .minimum_gap = 1e-3, .attempts = 100'000};
  Random random(5);
  for (const Fibre<2>& fibre : place_fibres<2>(p, region, stones, random)) {
    for (const Piece& piece : region.pieces())
      EXPECT_GE(distance_of_segments(fibre.from, fibre.to, piece.from, piece.to), p.minimum_gap);
    for (std::size_t i = 0; i < 4; ++i) {
      const Points corners = corners_of(stones[0]);
      EXPECT_GE(distance_of_segments(fibre.from, fibre.to, corners[i], corners[(i + 1) % 4]), p.minimum_gap);
    }
  }
}

}  // namespace
}  // namespace pyroclast::specimen::stone_test
