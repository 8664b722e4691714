#include "pyroclast/specimen/stone_seeds.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

#include "pyroclast/specimen/outline.hpp"
#include "pyroclast/specimen/polygon.hpp"
#include "pyroclast/specimen/seed_pairs.hpp"
#include "pyroclast/specimen/stone.hpp"

namespace pyroclast::specimen {
namespace {

// Lengths are in spacings.
/// Half of the gap below which two stones share a row of seeds: wider ones have room for two.
constexpr double kNarrow = 0.7;
/// Radius below which the cells of a stone become one; in space it has one seed.
template <int Dim>
constexpr double kOneCell = Dim == 2 ? 1.5 : 1.1;
/// Least number of tangents around a stone of one cell.
constexpr int kFewestTangents = 7;
/// The same where a stone has corners, and its sides one tangent each: two in a line would make a flat
/// corner.
constexpr int kFewestSides = 4;
/// Largest distance of tangents around a stone of one cell in space, over its radius: some 16 tangents. Where
/// it has sides, of one of them alone: each side has a tangent, unless larger ones are near.
constexpr double kOfOneTangent = 0.95, kOfOneSide = 1.2;
/// Radius of the ball around a small stone over that within it up to which the stone has one seed.
constexpr double kRound = 1.15;
/// Least distance between two seeds outside of stones.
constexpr double kApartBetween = 0.45;
/// Radii within a stone between which it has a seed in the middle: a free seed would seldom find the place.
template <int Dim>
constexpr double kFewestAround = Dim == 2 ? 1.3 : 0.0;
constexpr double kMiddle = 2.0;
/// Halvings of the gap in the search for its middle.
template <int Dim>
constexpr int kHalvingsOfGap = Dim == 2 ? 40 : 20;
/// Distance of a stone's surface from the outline of the body up to which the outline cuts the stone.
constexpr double kCut = 1e-3;

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

/// Returns the radius of a circle of an area, or of a ball of a volume.
template <int Dim>
double radius_of(double extent) {
  return Dim == 2 ? std::sqrt(extent / std::numbers::pi) : std::cbrt(0.75 * extent / std::numbers::pi);
}

/// Returns the factor by which the polygon of tangents `along` apart is larger than a shape.
double larger_by_tangents(const Surface<2>& shape, double along, const Surface<2>::Relative& relative) {
  return std::sqrt(area_of_tangents(shape.points(along, {}, relative)) / shape.extent());
}

/// Returns the factor by which the polyhedron of tangents is larger: over each hexagon of tangents on a ball
/// stands 0.0802 of its area over the radius on average. Sides are tangents of themselves.
double larger_by_tangents(const Surface<3>& shape, double along, const Surface<3>::Relative& /*relative*/) {
  if (shape.corner_count() > 0) return 1.0;
  const double radius = radius_of<3>(shape.extent());
  return std::cbrt(1.0 + 3.0 * 0.0802 * 0.866 * along * along / (radius * radius));
}

double distance_before_cuts(const Region& region, const Vec<2>& place) {
  return region.distance_before_cuts(place);
}
double distance_before_cuts(const Prism& body, const Vec<3>& place) {
  return body.distance_before_cuts(place);
}

}  // namespace

template <int Dim>
StoneSeeds<Dim>::StoneSeeds(std::span<const Stone<Dim>> stones, std::span<const Way> ways,
                            const OutlineOf<Dim>& region, const OutlineSeeds* outline,
                            const BlockSizes& sizes)
    : region_(region),
      outline_(outline),
      sizes_(sizes),
      grid_(region.low(), region.high(), stones),
      between_(region.low(), region.high(), sizes.mean()) {
  for (std::size_t i = 0; i < stones.size(); ++i) stones_.push_back(followed(stones[i], ways[i]));
  std::vector<int> order(stones_.size());
  std::iota(order.begin(), order.end(), 0);
  std::ranges::stable_sort(order, std::greater<>(), [&](int i) { return stones_[i].shape->extent(); });
  for (const int number : order) follow(number);
}

template <int Dim>
typename StoneSeeds<Dim>::Followed StoneSeeds<Dim>::followed(const Stone<Dim>& stone, const Way& way) const {
  std::shared_ptr<const Surface<Dim>> shape = stone.shape;
  if (!shape) shape = std::make_shared<Ball<Dim>>(0.5 * stone.diameter);
  const double radius = radius_of<Dim>(shape->extent()), spacing = sizes_.at(stone.centre);
  Followed result{stone.centre, shape, radius < kOneCell<Dim> * spacing, spacing};
  if (!result.is_one_cell)
    result.along = kAlongSurface * spacing;
  else if (shape->corner_count() > 0)
    result.along = Dim == 2 ? shape->size() / kFewestSides : kOfOneSide * radius;
  else  // seeds outside of the stone are as far from each other as those along a large one
    result.along = std::min(kAlongSurface * spacing * radius / (radius + kFromSurface * spacing),
                            Dim == 2 ? shape->size() / kFewestTangents : kOfOneTangent * radius);
  const double larger = larger_by_tangents(*shape, result.along, spacing_over(result));
  result.drawn = way.size / std::clamp(larger, 0.9, 1.25);
  result.shape = shape->scaled(result.drawn);
  const double inner = result.shape->inner_radius(), outer = result.shape->bounding_radius();
  if (result.is_one_cell && (Dim == 3 || way.is_of_one_seed || outer < kRound * inner))
    result.power = inner * outer + kPower * spacing * spacing;
  return result;
}

/// Returns how the distance of seeds along a stone changes; empty where it does not. A stone of one cell has
/// tangents that are alike.
template <int Dim>
typename Surface<Dim>::Relative StoneSeeds<Dim>::spacing_over(const Followed& stone) const {
  if (sizes_.is_even() || stone.is_one_cell) return {};
  return [this, centre = stone.centre, spacing = stone.spacing](const Vec<Dim>& place) {
    return sizes_.at(centre + place) / spacing;
  };
}

template <int Dim>
void StoneSeeds<Dim>::follow(int number) {
  Followed& stone = stones_[number];
  const double inner = stone.shape->inner_radius() / stone.spacing;
  if (!stone.is_one_cell && inner > kFewestAround<Dim> && inner < kMiddle)
    add(stone.centre, 0.25 * stone.spacing * stone.spacing, number);
  if (stone.power > 0.0) add(stone.centre, stone.power, number);
  std::vector<Vec<Dim>> taken;
  for (const Vec<Dim>& foot : stone.feet) taken.push_back(foot - stone.centre);
  for (const auto& [at, normal] : stone.shape->points(stone.along, taken, spacing_over(stone))) {
    const Foot foot{stone.centre + at, normal};
    stone.feet.push_back(foot.at);
    if (distance_before_cuts(region_, stone.centre + at * (1.0 / stone.drawn)) > -kCut * stone.spacing) {
      add_within(number, foot);
      continue;
    }
    const auto [half, other] = gap_from(number, foot);
    if (stone.power > 0.0) {
      // the edge to the one seed is the tangent, wherever on its normal the other seed stands
      const double support = dot(at, normal);
      add_between(stone.centre + (support + half) * normal, stone.power - support * support + half * half);
    } else {
      const double spacing = sizes_.at(foot.at);
      add_within(number, foot);
      add_between(foot.at + half * normal, half * half + kPower * spacing * spacing);
    }
    if (other < 0) continue;
    Followed& beside = stones_[other];
    const Foot across = nearest(other, foot.at + half * normal);
    const double along = beside.is_one_cell ? beside.along : kAlongSurface * sizes_.at(across.at);
    const bool is_free = std::ranges::none_of(
        beside.feet, [&](const Vec<Dim>& there) { return norm(there - across.at) < 0.5 * along; });
    if (!is_free) continue;
    beside.feet.push_back(across.at);
    add_within(other, across);
  }
}

template <int Dim>
typename StoneSeeds<Dim>::Gap StoneSeeds<Dim>::gap_from(int number, const Foot& foot) const {
  const double spacing = sizes_.at(foot.at), most = kNarrow * spacing;
  Gap gap{most, -1};
  // the place on the normal that is as far from another surface as from the foot
  const auto halve = [&](auto distance) {
    if (distance(gap.half) >= gap.half) return false;
    double low = 0.0, high = gap.half;
    for (int i = 0; i < kHalvingsOfGap<Dim>; ++i) {
      const double middle = 0.5 * (low + high);
      (distance(middle) > middle ? low : high) = middle;
    }
    gap.half = 0.5 * (low + high);
    return true;
  };
  for (const int other : near(foot.at, 2.0 * most)) {
    if (other == number || is_surely_farther(other, foot.at + gap.half * foot.normal, gap.half)) continue;
    if (halve([&](double half) { return distance(other, foot.at + half * foot.normal); })) gap.other = other;
  }
  if (gap.other < 0) gap.half = kFromSurface * spacing;
  if (halve([&](double half) { return -region_.distance(foot.at + half * foot.normal); })) gap.other = -1;
  return gap;
}

template <int Dim>
typename StoneSeeds<Dim>::Foot StoneSeeds<Dim>::nearest(int number, const Vec<Dim>& place) const {
  const auto found = stones_[number].shape->nearest(place - stones_[number].centre);
  return {stones_[number].centre + found.point.at, found.point.normal};
}

template <int Dim>
double StoneSeeds<Dim>::distance(int number, const Vec<Dim>& place) const {
  return stones_[number].shape->nearest(place - stones_[number].centre).distance;
}

/// Tells whether a place is farther from a stone than a distance (m), as the ball around the stone tells.
template <int Dim>
bool StoneSeeds<Dim>::is_surely_farther(int number, const Vec<Dim>& place, double distance) const {
  return norm(place - stones_[number].centre) - stones_[number].shape->bounding_radius() > distance;
}

template <int Dim>
std::vector<int> StoneSeeds<Dim>::near(const Vec<Dim>& place, double distance) const {
  std::vector<int> numbers;
  Vec<Dim> half;
  half.c.fill(distance);
  grid_.collect(place - half, place + half, numbers);
  return numbers;
}

template <int Dim>
bool StoneSeeds<Dim>::add(const Vec<Dim>& place, double square, int owner) {
  if constexpr (Dim == 2)
    if (!region_.is_rectangle() && !outline_->leave_room_at(place)) return false;
  if (region_.distance(place) >= 0.0) return false;
  positions_.push_back(place);
  radii_.push_back(std::sqrt(std::max(square, 0.0)));
  owners_.push_back(owner);
  return true;
}

template <int Dim>
void StoneSeeds<Dim>::add_within(int number, const Foot& foot) {
  if (stones_[number].power > 0.0) return;
  const double spacing = sizes_.at(foot.at);
  const double within = std::min(kFromSurface * spacing, 0.5 * stones_[number].shape->inner_radius());
  add(foot.at - within * foot.normal, within * within + kPower * spacing * spacing, number);
}

template <int Dim>
void StoneSeeds<Dim>::add_between(const Vec<Dim>& place, double square) {
  if (stone_at(place) >= 0) return;
  const double apart = kApartBetween * sizes_.at(place);
  if (between_.overlaps({place, 0.0}, apart)) return;
  if (add(place, square, -1)) between_.insert({place, 0.0});
}

template <int Dim>
int StoneSeeds<Dim>::stone_at(const Vec<Dim>& place) const {
  for (const int number : near(place, 0.0))
    if (!is_surely_farther(number, place, 0.0) && distance(number, place) < 0.0) return number;
  return -1;
}

template <int Dim>
bool StoneSeeds<Dim>::leave_room_at(const Vec<Dim>& place, double clear) const {
  const double away = clear * sizes_.at(place);
  for (const int number : near(place, away)) {
    if (is_surely_farther(number, place, away)) continue;
    const double outside = distance(number, place);
    if (std::abs(outside) < away || (outside < 0.0 && stones_[number].is_one_cell)) return false;
  }
  return true;
}

template class StoneSeeds<2>;
template class StoneSeeds<3>;

}  // namespace pyroclast::specimen
