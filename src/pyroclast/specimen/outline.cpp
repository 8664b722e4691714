#include "pyroclast/specimen/outline.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

#include <fmt/format.h>

#include "pyroclast/base/error.hpp"
#include "pyroclast/specimen/polygon.hpp"

namespace pyroclast::specimen {
namespace {

/// Number of straight pieces of a drawn curve.
constexpr int kPieces = 72;
/// Turn of a line above which it has a corner, radians.
constexpr double kCorner = std::numbers::pi / 9.0;
/// Radius of the ball around the centroid over that of the ball around the outline below which the outline
/// bends around its centroid.
constexpr double kThin = 0.05;
/// Distances, as a share of the size, up to which a corner is the one before, and the last corner closes the
/// line at the first: files round both.
constexpr double kSamePlace = 1e-12, kClosing = 1e-6;
/// Harmonics of a drawn outline: from 3 up to this one.
constexpr int kHarmonics = 12;
/// Share of the mean angle between two corners of a drawn polygon by which each is off its even place.
constexpr double kUneven = 0.35;

Vec<2> turned(const Vec<2>& v, double angle) {
  const double c = std::cos(angle), s = std::sin(angle);
  return {{c * v[0] - s * v[1], s * v[0] + c * v[1]}};
}

/// Returns places along a closed line, evenly between the places that are taken.
/// \param fixed  places, ascending, at which each arc ends, and whether a point is taken there; else there is
///               a corner, from which the arc keeps half a step
std::vector<double> fill(double length, double spacing, const std::vector<std::pair<double, bool>>& fixed) {
  std::vector<double> result;
  if (fixed.empty()) {
    const int count = std::max(3, static_cast<int>(std::lround(length / spacing)));
    for (int i = 0; i < count; ++i) result.push_back(length * i / count);
    return result;
  }
  for (std::size_t i = 0; i < fixed.size(); ++i) {
    const auto& [from, from_taken] = fixed[i];
    const bool last = i + 1 == fixed.size();
    const auto& [next, to_taken] = fixed[last ? 0 : i + 1];
    const double to = last ? next + length : next;
    // half a step stands free beside a corner, a whole one beside a point that is taken
    const double ends = (from_taken ? 1.0 : 0.5) + (to_taken ? 1.0 : 0.5);
    const double steps = (to - from) / spacing;
    int count = static_cast<int>(std::lround(steps - ends)) + 1;
    if (!from_taken && !to_taken) count = std::max(count, 1);
    if (count < 1) continue;
    const double step = (to - from) / (count - 1 + ends);
    for (int k = 0; k < count; ++k) {
      const double place = from + (k + (from_taken ? 1.0 : 0.5)) * step;
      result.push_back(place >= length ? place - length : place);
    }
  }
  return result;
}

/// The same with a spacing that is `relative(place)` times as large.
template <class RelativeAt>
std::vector<double> fill_unevenly(double length, double spacing, std::vector<std::pair<double, bool>> fixed,
                                  RelativeAt relative) {
  constexpr int kStretches = 720;
  std::vector<double> stretched{0.0};  // length over the relative spacing, up to each part
  for (int part = 0; part < kStretches; ++part)
    stretched.push_back(stretched.back() +
                        length / kStretches / relative(length * (part + 0.5) / kStretches));
  const auto stretch = [&](double along) {
    const double place = std::clamp(along / length, 0.0, 1.0) * kStretches;
    const auto part = std::min(static_cast<std::size_t>(place), static_cast<std::size_t>(kStretches - 1));
    return std::lerp(stretched[part], stretched[part + 1], place - static_cast<double>(part));
  };
  const auto shrink = [&](double along) {
    const auto after = std::ranges::upper_bound(stretched, along);
    if (after == stretched.end()) return length;
    const double before = *(after - 1);
    return (static_cast<double>(after - stretched.begin() - 1) + (along - before) / (*after - before)) *
           length / kStretches;
  };
  for (auto& [along, is_end] : fixed) along = stretch(along);
  std::vector<double> result = fill(stretched.back(), spacing, fixed);
  for (double& along : result) along = shrink(along);
  return result;
}

/// Returns the corners of the convex hull, counter-clockwise.
std::vector<Vec<2>> hull_of(std::vector<Vec<2>> points) {
  std::ranges::sort(points, {}, &Vec<2>::c);
  std::vector<Vec<2>> hull;
  for (int half = 0; half < 2; ++half) {
    const std::size_t begin = hull.size();
    for (const Vec<2>& p : points) {
      while (hull.size() >= begin + 2 && cross(hull.back() - hull[hull.size() - 2], p - hull.back()) <= 0.0)
        hull.pop_back();
      hull.push_back(p);
    }
    hull.pop_back();
    std::ranges::reverse(points);
  }
  return hull;
}

double larger_side(std::span<const Vec<2>> corners) {
  const Box box = box_of(corners);
  return std::max(box.width(), box.height());
}

}  // namespace

std::optional<std::size_t> repeated_corner(std::span<const Vec<2>> corners) {
  const double same = kSamePlace * larger_side(corners);
  for (std::size_t i = 1; i < corners.size(); ++i)
    if (norm(corners[i] - corners[i - 1]) <= same) return i;
  return std::nullopt;
}

template <int Dim>
NearestPoint<Dim> Ball<Dim>::nearest(const Vec<Dim>& place) const {
  const double from_origin = norm(place);
  Vec<Dim> normal{};
  normal[0] = 1.0;
  if (from_origin > 0.0) normal = place * (1.0 / from_origin);
  return {{radius_ * normal, normal}, from_origin - radius_};
}

template <int Dim>
double Ball<Dim>::extent() const {
  return Dim == 2 ? std::numbers::pi * radius_ * radius_
                  : 4.0 / 3.0 * std::numbers::pi * radius_ * radius_ * radius_;
}

template <int Dim>
double Ball<Dim>::size() const {
  return Dim == 2 ? 2.0 * std::numbers::pi * radius_ : 4.0 * std::numbers::pi * radius_ * radius_;
}

template <int Dim>
std::shared_ptr<const Surface<Dim>> Ball<Dim>::scaled(double factor) const {
  return std::make_shared<Ball>(factor * radius_);
}

template <>
std::vector<SurfacePoint<2>> Ball<2>::points(double spacing, std::span<const Vec<2>> taken,
                                             const Relative& relative) const {
  std::vector<std::pair<double, bool>> fixed;
  for (const Vec<2>& point : taken) {
    const double angle = std::atan2(point[1], point[0]);
    fixed.emplace_back(radius_ * (angle < 0.0 ? angle + 2.0 * std::numbers::pi : angle), true);
  }
  std::ranges::sort(fixed);
  const auto normal_at = [&](double along) {
    return Vec<2>{{std::cos(along / radius_), std::sin(along / radius_)}};
  };
  std::vector<SurfacePoint<2>> points;
  for (const double along :
       relative ? fill_unevenly(size(), spacing, fixed,
                                [&](double place) { return relative(radius_ * normal_at(place)); })
                : fill(size(), spacing, fixed)) {
    const Vec<2> normal = normal_at(along);
    points.push_back({radius_ * normal, normal});
  }
  return points;
}

template class Ball<2>;
template class Ball<3>;

Outline::Outline(std::vector<Vec<2>> corners) : corners_(std::move(corners)) {
  const std::size_t n = corners_.size();
  if (n < 3) throw Error(fmt::format("an outline of a stone has {} corners; allowed are three or more", n));
  if (const auto repeated = repeated_corner(corners_))
    throw Error(fmt::format(
        "corner {} of an outline of a stone (from 0) repeats the one before, at ({:.6g}, {:.6g}) m",
        *repeated, corners_[*repeated][0], corners_[*repeated][1]));
  area_ = area(corners_);
  if (area_ < 0.0) {
    std::ranges::reverse(corners_);
    area_ = -area_;
  }
  for (std::size_t i = 0; i < n; ++i)
    for (std::size_t k = i + 2; k < n; ++k)
      if (cross_each_other(corners_[i], corners_[next(i)], corners_[k], corners_[next(k)]))
        throw Error("an outline of a stone crosses itself");
  double length = 0.0;
  for (std::size_t i = 0; i < n; ++i) {
    const double piece = norm(corners_[next(i)] - corners_[i]);
    starts_.push_back(length);
    length += piece;
  }
  starts_.push_back(length);
  if (!(area_ > 1e-6 * length * length)) throw Error("an outline of a stone has no area");
  const Vec<2> middle = centroid(corners_);
  for (Vec<2>& corner : corners_) corner -= middle;
  double turn = 0.0;
  for (std::size_t i = 0; i < n; ++i) {
    bounding_radius_ = std::max(bounding_radius_, norm(corners_[i]));
    const Vec<2> before = corners_[i] - corners_[i == 0 ? n - 1 : i - 1],
                 after = corners_[next(i)] - corners_[i];
    const double turn_here = std::atan2(cross(before, after), dot(before, after));
    turn += turn_here;
    if (std::abs(turn_here) > kCorner) corners_along_.push_back(starts_[i]);
  }
  if (turn > 3.0 * std::numbers::pi)
    throw Error("an outline of a stone runs around more than once: are two stones under one number?");
  inner_radius_ = std::max(0.0, -nearest({}).distance);
  if (inner_radius_ < kThin * bounding_radius_) place_within_ = middle_of_chord();
}

/// Returns the middle of a chord that lies deep within, of several at even heights.
Vec<2> Outline::middle_of_chord() const {
  constexpr int kHeights = 8;
  const Box box = box_of(corners_);
  Vec<2> deepest{};
  double least = std::numeric_limits<double>::infinity();
  for (int k = 0; k < kHeights; ++k) {
    const double y = std::lerp(box.low[1], box.high[1], (k + 0.5) / kHeights);
    std::vector<double> ends;
    for (std::size_t i = 0; i < corners_.size(); ++i) {
      const Vec<2>&from = corners_[i], &to = corners_[next(i)];
      if ((from[1] > y) != (to[1] > y))
        ends.push_back(from[0] + (y - from[1]) / (to[1] - from[1]) * (to[0] - from[0]));
    }
    std::ranges::sort(ends);
    for (std::size_t i = 0; i + 1 < ends.size(); i += 2) {
      const Vec<2> place{{0.5 * (ends[i] + ends[i + 1]), y}};
      if (const double distance = nearest(place).distance; distance < least) {
        least = distance;
        deepest = place;
      }
    }
  }
  return deepest;
}

/// Returns the place of the line that is nearest to a point.
Outline::Foot Outline::foot_of(const Vec<2>& point) const {
  Foot foot{0, 0.0, std::numeric_limits<double>::infinity(), {}};
  for (std::size_t i = 0; i < corners_.size(); ++i) {
    const Vec<2> piece = corners_[next(i)] - corners_[i], there = point - corners_[i];
    const double share = std::clamp(dot(there, piece) / dot(piece, piece), 0.0, 1.0);
    const Vec<2> away = there - share * piece;
    if (const double square = dot(away, away); square < foot.square)
      foot = {i, share, square, corners_[i] + share * piece};
  }
  return foot;
}

NearestPoint<2> Outline::nearest(const Vec<2>& place) const {
  const Foot foot = foot_of(place);
  bool inside = false;
  for (std::size_t i = 0; i < corners_.size(); ++i) {
    // a ray to the right crosses the outline an odd number of times
    const Vec<2>&from = corners_[i], &to = corners_[next(i)];
    if ((from[1] > place[1]) != (to[1] > place[1]) &&
        place[0] < from[0] + (place[1] - from[1]) / (to[1] - from[1]) * (to[0] - from[0]))
      inside = !inside;
  }
  const double distance = std::sqrt(foot.square);
  const Vec<2> normal = distance > 1e-9 * bounding_radius_
                            ? (place - foot.at) * ((inside ? -1.0 : 1.0) / distance)
                            : normal_of(foot.piece);
  return {{foot.at, normal}, inside ? -distance : distance};
}

Vec<2> Outline::normal_of(std::size_t piece) const {
  const Vec<2> along = corners_[next(piece)] - corners_[piece];
  return Vec<2>{{along[1], -along[0]}} * (1.0 / norm(along));
}

/// Returns the point at a place on the line; its normal turns from the middle of one piece to that of the
/// next, but not at a true corner.
SurfacePoint<2> Outline::at(double along) const {
  const std::size_t n = corners_.size();
  const auto found = std::ranges::upper_bound(starts_, along) - starts_.begin() - 1;
  const auto i = std::min(static_cast<std::size_t>(std::max<std::ptrdiff_t>(found, 0)), n - 1);
  const double piece = starts_[i + 1] - starts_[i], share = (along - starts_[i]) / piece;
  Vec<2> normal = normal_of(i);
  const std::size_t other = share < 0.5 ? (i == 0 ? n - 1 : i - 1) : next(i);
  const Vec<2> beside = normal_of(other);
  if (dot(normal, beside) > std::cos(kCorner)) {
    normal = normal + std::abs(share - 0.5) * (beside - normal);
    normal = normal * (1.0 / norm(normal));
  }
  return {corners_[i] + share * (corners_[next(i)] - corners_[i]), normal};
}

double Outline::along_of(const Vec<2>& point) const {
  const Foot foot = foot_of(point);
  return starts_[foot.piece] + foot.share * norm(corners_[next(foot.piece)] - corners_[foot.piece]);
}

std::vector<SurfacePoint<2>> Outline::points(double spacing, std::span<const Vec<2>> taken,
                                             const Relative& relative) const {
  std::vector<std::pair<double, bool>> fixed;
  for (const double corner : corners_along_) fixed.emplace_back(corner, false);
  for (const Vec<2>& point : taken) fixed.emplace_back(along_of(point), true);
  std::ranges::sort(fixed);
  std::vector<SurfacePoint<2>> points;
  for (const double along :
       relative ? fill_unevenly(size(), spacing, fixed, [&](double place) { return relative(at(place).at); })
                : fill(size(), spacing, fixed))
    points.push_back(at(along));
  return points;
}

std::shared_ptr<const Surface<2>> Outline::scaled(double factor) const {
  std::vector<Vec<2>> corners = corners_;
  for (Vec<2>& corner : corners) corner *= factor;
  return std::make_shared<Outline>(std::move(corners));
}

double Outline::width() const {
  const std::vector<Vec<2>> hull = hull_of(corners_);
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < hull.size(); ++i) {
    Vec<2> edge = hull[(i + 1) % hull.size()] - hull[i];
    edge = edge * (1.0 / norm(edge));
    double most = 0.0;
    for (const Vec<2>& p : hull) most = std::max(most, cross(edge, p - hull[i]));
    least = std::min(least, most);
  }
  return least;
}

std::pair<std::shared_ptr<const Outline>, Vec<2>> outline_around(std::vector<Vec<2>> points) {
  if (points.size() > 1 && norm(points.back() - points.front()) <= kClosing * larger_side(points))
    points.pop_back();
  auto outline = std::make_shared<const Outline>(points);
  return {std::move(outline), centroid(points)};
}

std::shared_ptr<const Outline> draw_outline(const ShapeParameters& p, Random& random) {
  if (p.kind == StoneShape::circle) return nullptr;
  const double elongation = random.uniform(p.elongation.low, p.elongation.high);
  const double angle = random.uniform(p.orientation.low, p.orientation.high);
  std::vector<Vec<2>> corners;
  const auto add = [&](double radius, double at) {
    corners.push_back(turned({{radius * std::cos(at) * elongation, radius * std::sin(at)}}, angle));
  };
  const auto around = [](double i, double n) { return 2.0 * std::numbers::pi * i / n; };
  if (p.kind == StoneShape::ellipse) {
    for (int i = 0; i < kPieces; ++i) add(1.0, around(i, kPieces));
  } else if (p.kind == StoneShape::polygon) {
    const int count = static_cast<int>(random.uniform(p.corners.low, p.corners.high + 1.0));
    const double first = random.uniform();
    for (int i = 0; i < count; ++i) add(1.0, around(first + i + random.uniform(-kUneven, kUneven), count));
  } else {
    const double roughness = random.uniform(p.roughness.low, p.roughness.high);
    std::vector<double> phase;
    for (int n = 3; n <= kHarmonics; ++n) phase.push_back(2.0 * std::numbers::pi * random.uniform());
    for (int i = 0; i < kPieces; ++i) {
      double radius = 1.0;
      for (int n = 3; n <= kHarmonics; ++n)
        radius += roughness * std::pow(n / 3.0, -p.decay) * std::cos(n * around(i, kPieces) + phase[n - 3]);
      add(radius, around(i, kPieces));
    }
  }
  const Outline drawn(std::move(corners));
  return std::static_pointer_cast<const Outline>(drawn.scaled(1.0 / drawn.width()));
}

}  // namespace pyroclast::specimen
