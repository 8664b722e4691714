#include "pyroclast/specimen/grain_seeds.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

#include "pyroclast/specimen/grain.hpp"
#include "pyroclast/specimen/outline.hpp"
#include "pyroclast/specimen/polygon.hpp"

namespace pyroclast::specimen {
namespace {

// Lengths are in spacings.
constexpr double kFromSurface = 0.4;   ///< distance of a seed from the surface
constexpr double kAlongSurface = 0.9;  ///< distance from seed to seed along the surface
/// Half of the gap below which two grains share a row of seeds: wider ones have room for two.
constexpr double kNarrow = 0.7;
constexpr double kOneCell = 1.5;  ///< radius below which the cells of a grain become one
/// Least number of tangents around a grain of one cell.
constexpr int kFewestTangents = 7;
/// The same where a grain has corners, and its sides one tangent each: two in a line would make a flat
/// corner.
constexpr int kFewestSides = 4;
/// Radius of the ball around a small grain over that within it up to which the grain has one seed.
constexpr double kRound = 1.15;
/// Least distance between two seeds outside of grains.
constexpr double kApartBetween = 0.45;
/// Radii within a grain between which it has a seed in the middle: a free seed would seldom find the place.
constexpr double kFewestAround = 1.3, kMiddle = 2.0;
/// Distance of a grain's surface from the outline of the body up to which the outline cuts the grain.
constexpr double kCut = 1e-3;
/// Power of a point of the surface, in squared spacings: with it a seed at the offset has a radius of 0.5.
constexpr double kPower = 0.25 - kFromSurface * kFromSurface;

/// Returns the area of the polygon of tangents at points of an outline, counter-clockwise.
double area_of_tangents(const std::vector<SurfacePoint<2>>& points) {
  std::vector<Vec<2>> corners;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const auto& [at, normal] = points[i];
    const auto& [next, turned] = points[(i + 1) % points.size()];
    const double sine = cross(normal, turned);
    const Vec<2> along{{-normal[1], normal[0]}};
    const double reach =
        std::abs(sine) < 0.05 ? 0.5 * norm(next - at) : dot(next - at, turned) / dot(along, turned);
    corners.push_back(at + reach * along);
  }
  return area(corners);
}

}  // namespace

GrainSeeds::GrainSeeds(std::span<const Grain<2>> grains, std::span<const Way> ways, const Region& region,
                       const OutlineSeeds& outline, const BlockSizes& sizes)
    : region_(region),
      outline_(outline),
      sizes_(sizes),
      grid_(region.box().low, region.box().high, grains),
      between_(region.box().low, region.box().high, sizes.mean()) {
  for (std::size_t i = 0; i < grains.size(); ++i) grains_.push_back(followed(grains[i], ways[i]));
  std::vector<int> order(grains_.size());
  std::iota(order.begin(), order.end(), 0);
  std::ranges::stable_sort(order, std::greater<>(), [&](int i) { return grains_[i].shape->extent(); });
  for (const int number : order) follow(number);
}

GrainSeeds::Followed GrainSeeds::followed(const Grain<2>& grain, const Way& way) const {
  std::shared_ptr<const Surface<2>> shape = grain.shape;
  if (!shape) shape = std::make_shared<Ball<2>>(0.5 * grain.diameter);
  const double radius = std::sqrt(shape->extent() / std::numbers::pi), spacing = sizes_.at(grain.centre);
  Followed result{grain.centre, shape, radius < kOneCell * spacing, spacing};
  if (!result.is_one_cell)
    result.along = kAlongSurface * spacing;
  else if (shape->corner_count() > 0)
    result.along = shape->size() / kFewestSides;
  else  // seeds outside of the grain are as far from each other as those along a large one
    result.along = std::min(kAlongSurface * spacing * radius / (radius + kFromSurface * spacing),
                            shape->size() / kFewestTangents);
  const double larger =
      std::sqrt(area_of_tangents(shape->points(result.along, {}, spacing_over(result))) / shape->extent());
  result.drawn = way.size / std::clamp(larger, 0.9, 1.25);
  result.shape = shape->scaled(result.drawn);
  const double inner = result.shape->inner_radius(), outer = result.shape->bounding_radius();
  if (result.is_one_cell && (way.is_of_one_seed || outer < kRound * inner))
    result.power = inner * outer + kPower * spacing * spacing;
  return result;
}

/// Returns how the distance of seeds along a grain changes; empty where it does not. A grain of one cell has
/// tangents that are alike.
Surface<2>::Relative GrainSeeds::spacing_over(const Followed& grain) const {
  if (sizes_.is_even() || grain.is_one_cell) return {};
  return [this, centre = grain.centre, spacing = grain.spacing](const Vec<2>& place) {
    return sizes_.at(centre + place) / spacing;
  };
}

void GrainSeeds::follow(int number) {
  Followed& grain = grains_[number];
  const double inner = grain.shape->inner_radius() / grain.spacing;
  if (!grain.is_one_cell && inner > kFewestAround && inner < kMiddle)
    add(grain.centre, 0.25 * grain.spacing * grain.spacing, number);
  if (grain.power > 0.0) add(grain.centre, grain.power, number);
  std::vector<Vec<2>> taken;
  for (const Vec<2>& foot : grain.feet) taken.push_back(foot - grain.centre);
  for (const auto& [at, normal] : grain.shape->points(grain.along, taken, spacing_over(grain))) {
    const Foot foot{grain.centre + at, normal};
    grain.feet.push_back(foot.at);
    if (region_.distance_before_cuts(grain.centre + at * (1.0 / grain.drawn)) > -kCut * grain.spacing) {
      add_within(number, foot);
      continue;
    }
    const auto [half, other] = gap_from(number, foot);
    if (grain.power > 0.0) {
      // the edge to the one seed is the tangent, wherever on its normal the other seed stands
      const double support = dot(at, normal);
      add_between(grain.centre + (support + half) * normal, grain.power - support * support + half * half);
    } else {
      const double spacing = sizes_.at(foot.at);
      add_within(number, foot);
      add_between(foot.at + half * normal, half * half + kPower * spacing * spacing);
    }
    if (other < 0) continue;
    Followed& beside = grains_[other];
    const Foot across = nearest(other, foot.at + half * normal);
    const double along = beside.is_one_cell ? beside.along : kAlongSurface * sizes_.at(across.at);
    const bool is_free = std::ranges::none_of(
        beside.feet, [&](const Vec<2>& there) { return norm(there - across.at) < 0.5 * along; });
    if (!is_free) continue;
    beside.feet.push_back(across.at);
    add_within(other, across);
  }
}

GrainSeeds::Gap GrainSeeds::gap_from(int number, const Foot& foot) const {
  const double spacing = sizes_.at(foot.at), most = kNarrow * spacing;
  Gap gap{most, -1};
  // the place on the normal that is as far from another surface as from the foot
  const auto halve = [&](auto distance) {
    if (distance(gap.half) >= gap.half) return false;
    double low = 0.0, high = gap.half;
    for (int i = 0; i < 40; ++i) {
      const double middle = 0.5 * (low + high);
      (distance(middle) > middle ? low : high) = middle;
    }
    gap.half = 0.5 * (low + high);
    return true;
  };
  for (const int other : near(foot.at, 2.0 * most)) {
    if (other == number) continue;
    if (halve([&](double half) { return distance(other, foot.at + half * foot.normal); })) gap.other = other;
  }
  if (gap.other < 0) gap.half = kFromSurface * spacing;
  if (halve([&](double half) { return -region_.distance(foot.at + half * foot.normal); })) gap.other = -1;
  return gap;
}

GrainSeeds::Foot GrainSeeds::nearest(int number, const Vec<2>& place) const {
  const auto found = grains_[number].shape->nearest(place - grains_[number].centre);
  return {grains_[number].centre + found.point.at, found.point.normal};
}

double GrainSeeds::distance(int number, const Vec<2>& place) const {
  return grains_[number].shape->nearest(place - grains_[number].centre).distance;
}

std::vector<int> GrainSeeds::near(const Vec<2>& place, double distance) const {
  std::vector<int> numbers;
  Vec<2> half;
  half.c.fill(distance);
  grid_.collect(place - half, place + half, numbers);
  return numbers;
}

bool GrainSeeds::add(const Vec<2>& place, double square, int owner) {
  if (!region_.is_rectangle() && !outline_.leave_room_at(place)) return false;
  if (region_.distance(place) >= 0.0) return false;
  positions_.push_back(place);
  radii_.push_back(std::sqrt(std::max(square, 0.0)));
  owners_.push_back(owner);
  return true;
}

void GrainSeeds::add_within(int number, const Foot& foot) {
  if (grains_[number].power > 0.0) return;
  const double spacing = sizes_.at(foot.at);
  const double within = std::min(kFromSurface * spacing, 0.5 * grains_[number].shape->inner_radius());
  add(foot.at - within * foot.normal, within * within + kPower * spacing * spacing, number);
}

void GrainSeeds::add_between(const Vec<2>& place, double square) {
  if (grain_at(place) >= 0) return;
  const double apart = kApartBetween * sizes_.at(place);
  if (between_.overlaps({place, 0.0}, apart)) return;
  if (add(place, square, -1)) between_.insert({place, 0.0});
}

int GrainSeeds::grain_at(const Vec<2>& place) const {
  for (const int number : near(place, 0.0))
    if (distance(number, place) < 0.0) return number;
  return -1;
}

bool GrainSeeds::leave_room_at(const Vec<2>& place, double clear) const {
  const double away = clear * sizes_.at(place);
  for (const int number : near(place, away)) {
    const double outside = distance(number, place);
    if (std::abs(outside) < away || (outside < 0.0 && grains_[number].is_one_cell)) return false;
  }
  return true;
}

}  // namespace pyroclast::specimen
