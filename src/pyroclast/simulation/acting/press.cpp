#include "pyroclast/simulation/acting/press.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <utility>

#include <fmt/format.h>

#include "pyroclast/base/error.hpp"
#include "pyroclast/simulation/sums.hpp"

namespace pyroclast {

namespace {

/// Least share of the load that rests on the lower platen with which the platen carries the specimen.
constexpr double kCarried = 0.8;

std::vector<int> components_across(int axis, int dimension) {
  if (axis < 0 || axis >= dimension)
    throw Error(fmt::format("the axis of the press is {}, but it must be from 0 to {}", axis, dimension - 1));
  std::vector<int> across;
  for (int i = 0; i < dimension; ++i)
    if (i != axis) across.push_back(i);
  return across;
}

/// Gridpoint of the lower end of a solid.
struct StandingPoint {
  Vec<2> across{};  ///< position across the axis, m
  double up = 0.0;  ///< displacement along the axis, m
};

/// Share of a triangle by which a point must differ from a corner to take its place.
constexpr double kLeastShare = 1e-12;
/// Distance of a point from a plane that counts as none, over the size of the points.
constexpr double kOnPlane = 1e-12;

/// Returns the shares by which the corners of a triangle make a place.
std::array<double, 3> shares_of(const std::array<StandingPoint, 3>& corner, const Vec<2>& place) {
  const Vec<2> first = corner[1].across - corner[0].across, second = corner[2].across - corner[0].across;
  const Vec<2> to = place - corner[0].across;
  const double doubled = cross(first, second);
  const double b = cross(to, second) / doubled, c = cross(first, to) / doubled;
  return {1.0 - b - c, b, c};
}

/// Returns the slopes of the plane through three points around a place that no other point is below: of all
/// such triangles it is the lowest at the place, found by the simplex method. Returns 0 where no triangle of
/// points is around the place.
/// \param size  size of all points across the axis, m
std::array<double, 2> slopes_under(const std::vector<StandingPoint>& points, const Vec<2>& place,
                                   double size) {
  // The method begins with three points that are too high and too far away to stay.
  const double far = 10.0 * size, high = 1e3 * size;
  std::array<StandingPoint, 3> corner{{{place + far * Vec<2>{{1.0, 0.0}}, high},
                                       {place + far * Vec<2>{{-0.5, 0.9}}, high},
                                       {place + far * Vec<2>{{-0.5, -0.9}}, high}}};
  const auto above = [&](const StandingPoint& point) {
    const auto [a, b, c] = shares_of(corner, point.across);
    return point.up - (a * corner[0].up + b * corner[1].up + c * corner[2].up);
  };
  for (std::size_t round = 0; round < points.size(); ++round) {
    const StandingPoint& lowest = *std::ranges::min_element(points, {}, above);
    if (above(lowest) >= -kOnPlane * size) break;
    const auto of_place = shares_of(corner, place), of_lowest = shares_of(corner, lowest.across);
    int leaves = -1;
    double least = 0.0;
    for (int i = 0; i < 3; ++i) {
      if (of_lowest[i] <= kLeastShare) continue;
      const double ratio = of_place[i] / of_lowest[i];
      if (leaves >= 0 && ratio >= least) continue;
      leaves = i;
      least = ratio;
    }
    if (leaves < 0) break;
    corner[leaves] = lowest;
  }
  if (std::ranges::any_of(corner, [&](const StandingPoint& point) { return point.up == high; })) return {};
  const Vec<2> first = corner[1].across - corner[0].across, second = corner[2].across - corner[0].across;
  const double rise = corner[1].up - corner[0].up, other = corner[2].up - corner[0].up;
  const double doubled = cross(first, second);
  return {(rise * second[1] - other * first[1]) / doubled, (other * first[0] - rise * second[0]) / doubled};
}

}  // namespace

Press::Press(Motion& motion, Specimen between)
    : motion_(motion),
      between_(std::move(between)),
      across_(components_across(between_.axis, motion.model().dimension())) {
  const auto is_no_length = [](double length) { return !(length > 0.0); };
  if (between_.widths.size() != across_.size() || between_.sides.size() < across_.size() ||
      std::ranges::any_of(between_.widths, is_no_length) || is_no_length(between_.area) ||
      is_no_length(between_.height))
    throw Error(
        fmt::format("a specimen between platens needs a height, an area and {} widths", across_.size()));
  for (const char* name : {"bottom_platen_support", "top_platen_support", "bottom_platen_face",
                           "top_platen_face", "bottom", "top", "specimen", "bottom_platen"})
    summed_.emplace(name, gridpoint_set(motion_.model(), set(name)));
  for (std::size_t d = 0; d < across_.size(); ++d)
    for (const auto& side : between_.sides[d])
      summed_.emplace(side, gridpoint_set(motion_.model(), set(side)));
  const GridpointSet& bottom = summed("bottom");
  std::vector<double> heights;
  if (const auto [first, last] = bottom.chunks.own(); first < last)
    heights.push_back(motion_.model().place(bottom.gridpoints[first])[between_.axis]);
  bottom_ = motion_.model().ranks().collect(heights).at(0);
  middle_ = motion_.model().ranks().together([&] { return middle_across(); });
  for (int g : set("bottom_platen_support"))
    for (int i = 0; i < motion_.model().dimension(); ++i) motion_.constraints().prescribe_velocity(g, i, 0.0);
  for (int g : set("top_platen_support"))
    for (int i : across_) motion_.constraints().prescribe_velocity(g, i, 0.0);
}

void Press::let_go() {
  for (int g : set("top_platen_support")) motion_.constraints().release(g, between_.axis);
  kept_.is_driven = false;
}

void Press::control_by_force() {
  const double borne = kept_.is_driven ? std::max(0.0, stress_top()) : kept_.stress_held;
  motion_.constraints().untie();
  let_go();
  motion_.constraints().tie(set("top_platen_support"), between_.axis);
  hold(borne);
}

void Press::control_by_motion(double velocity) {
  kept_.is_driven = true;
  motion_.constraints().untie();
  hold(0.0);
  move_platen(velocity);
}

void Press::move_platen(double velocity) {
  for (int g : set("top_platen_support"))
    motion_.constraints().prescribe_velocity(g, between_.axis, -velocity);
}

void Press::hold(double stress) {
  const double force = stress * between_.area;
  const GridpointSet& support = summed("top_platen_support");
  Vec<3> share{};
  share[between_.axis] = -force / support.whole_count;
  for (int g : support.gridpoints) motion_.constraints().apply_force(g, share);
  kept_.stress_held = stress;
}

bool Press::is_supported() const {
  const auto weight = [&](const GridpointSet& of) {
    return -motion_.totals().total_weight(of)[between_.axis] / between_.area;
  };
  const double carries = stress_bottom() - weight(summed("bottom_platen"));
  return carries >= kCarried * (weight(specimen()) + kept_.stress_held);
}

double Press::volume() const {
  return between_.area * between_.height;
}

/// Returns the plane of symmetry across a direction; null where there is none.
const PlaneOfSymmetry* Press::symmetry_across(std::size_t direction) const {
  for (const PlaneOfSymmetry& plane : motion_.model().symmetry)
    if (plane.component == across_[direction]) return &plane;
  return nullptr;
}

/// Returns the rise over the width of the line on which the specimen stands: the edge of the lower hull of
/// its lower end that lies under the middle.
double Press::rise_of_stand(std::size_t direction) const {
  struct Point {
    double across, up;  // position across the axis, and displacement along it
  };
  std::vector<Point> points;
  const GridpointSet& bottom = summed("bottom");
  for (auto [i, last] = bottom.chunks.own(); i < last; ++i) {
    const int g = bottom.gridpoints[i];
    points.push_back(
        {motion_.model().place(g)[across_[direction]], motion_.read().displacement(g)[between_.axis]});
  }
  points = motion_.model().ranks().collect(points);
  std::ranges::sort(points, {}, [](const Point& p) { return std::pair(p.across, p.up); });
  const auto turns_left = [](const Point& a, const Point& b, const Point& c) {
    return (b.across - a.across) * (c.up - b.up) - (b.up - a.up) * (c.across - b.across) > 0.0;
  };
  std::vector<Point> hull;
  for (const Point& p : points) {
    while (hull.size() > 1 && !turns_left(hull[hull.size() - 2], hull.back(), p)) hull.pop_back();
    hull.push_back(p);
  }
  const double middle = 0.5 * (points.front().across + points.back().across);
  const auto right = std::ranges::find_if(hull, [&](const Point& p) { return p.across > middle; });
  if (right == hull.begin() || right == hull.end()) return 0.0;
  const Point &from = *std::prev(right), &to = *right;
  return (to.up - from.up) / (to.across - from.across);
}

/// Returns the slopes of the plane on which the specimen stands in 3D: that through three points of its lower
/// end around its middle which lies on no point, a facet of their lower hull. Flat where there are no such
/// points.
std::array<double, 2> Press::slopes_of_stand() const {
  std::vector<StandingPoint> points;
  const GridpointSet& bottom = summed("bottom");
  for (auto [i, last] = bottom.chunks.own(); i < last; ++i) {
    const int g = bottom.gridpoints[i];
    const Vec<3> at = motion_.model().place(g);
    points.push_back({{{at[across_[0]], at[across_[1]]}}, motion_.read().displacement(g)[between_.axis]});
  }
  points = motion_.model().ranks().collect(points);
  Vec<2> low = points.front().across, high = low;
  for (const StandingPoint& point : points)
    for (int d : {0, 1}) {
      low[d] = std::min(low[d], point.across[d]);
      high[d] = std::max(high[d], point.across[d]);
    }
  return slopes_under(points, 0.5 * (low + high), norm(high - low));
}

/// Returns the clearances between the platens and the gridpoints of the ends that stand out most, m.
/// \param up  function that returns the way of a gridpoint along the axis since the start
template <class Up>
Press::Clearances Press::clearances(const Up& up) const {
  constexpr double kFar = std::numeric_limits<double>::infinity();  // of a part without such gridpoints
  double lowest = kFar, highest = -kFar;
  const GridpointSet &bottom = summed("bottom"), &top = summed("top");
  for (auto [i, last] = bottom.chunks.own(); i < last; ++i)
    lowest = std::min(lowest, up(bottom.gridpoints[i]));
  for (auto [i, last] = top.chunks.own(); i < last; ++i) highest = std::max(highest, up(top.gridpoints[i]));
  lowest = motion_.model().ranks().least(lowest);
  highest = motion_.model().ranks().largest(highest);
  return {lowest - motion_.totals().mean_displacement(summed("bottom_platen_face"))[between_.axis],
          motion_.totals().mean_displacement(summed("top_platen_face"))[between_.axis] - highest};
}

/// Returns the middle between the sides, or a plane of symmetry, m: about it an even motion turns and widens
/// the specimen.
std::array<double, 2> Press::middle_across() const {
  std::array<double, 2> middle{};
  for (std::size_t d = 0; d < across_.size(); ++d)
    if (const PlaneOfSymmetry* const plane = symmetry_across(d))
      middle[d] = plane->at;
    else
      middle[d] = 0.5 * (mean_position(motion_.model(), summed(between_.sides[d][0]), across_[d]) +
                         mean_position(motion_.model(), summed(between_.sides[d][1]), across_[d]));
  return middle;
}

Press::EvenMotion Press::to_touch() const {
  std::array<double, 2> tilt{}, middle{};
  if (!motion_.model().symmetry.empty()) {
    for (std::size_t d = 0; d < across_.size(); ++d)
      if (symmetry_across(d) == nullptr) tilt[d] = -rise_of_stand(d);
    middle = middle_;
  } else if (across_.size() == 1) {
    tilt[0] = -rise_of_stand(0);
    // This middle is not that of the motion, so the lift is off by the tilt times their distance: too little
    // to change results for it.
    middle[0] = mean_position(motion_.model(), specimen(), across_[0]);
  } else {
    for (int d = 0; const double slope : slopes_of_stand()) tilt[d++] = -slope;
    middle = middle_;
  }
  const auto up = [&](int g) {
    double way = motion_.read().displacement(g)[between_.axis];
    for (std::size_t d = 0; d < across_.size(); ++d)
      way += tilt[d] * (motion_.model().place(g)[across_[d]] - middle[d]);
    return way;
  };
  const auto [below, above] = clearances(up);
  return {.lift = -std::max(0.0, below), .tilt = tilt, .platen_lift = -above};
}

double Press::way(const EvenMotion& motion) const {
  double way = std::abs(motion.lift);
  for (std::size_t d = 0; d < across_.size(); ++d) way += std::abs(motion.tilt[d]) * between_.widths[d];
  return way;
}

double Press::gap() const {
  const auto up = [&](int g) { return motion_.read().displacement(g)[between_.axis]; };
  const auto [below, above] = clearances(up);
  return std::max(0.0, below) + std::max(0.0, above);
}

double Press::shortening(std::string_view top, std::string_view bottom) const {
  return motion_.totals().mean_displacement(summed(bottom))[between_.axis] -
         motion_.totals().mean_displacement(summed(top))[between_.axis];
}

double Press::widening(std::size_t direction) const {
  const auto& [lower, upper] = between_.sides[direction];
  return motion_.totals().mean_displacement(summed(upper))[across_[direction]] -
         motion_.totals().mean_displacement(summed(lower))[across_[direction]];
}

void Press::set_zero() {
  kept_.shortening_at_zero += strain() * between_.height;
  kept_.specimen_shortening_at_zero += specimen_strain() * between_.height;
  for (std::size_t d = 0; d < across_.size(); ++d)
    kept_.widening_at_zero[d] +=
        (widening(d) - kept_.widening_at_zero[d]) / between_.widths[d] * between_.widths[d];
}

void Press::begin_stage() {
  kept_.stage_first_strain = strain();
}

double Press::strain() const {
  return (shortening("top_platen_face", "bottom_platen_face") - kept_.shortening_at_zero) / between_.height;
}

double Press::specimen_strain() const {
  return (shortening("top", "bottom") - kept_.specimen_shortening_at_zero) / between_.height;
}

double Press::lateral_strain() const {
  double sum = 0.0;
  for (std::size_t d = 0; d < across_.size(); ++d)
    sum += (widening(d) - kept_.widening_at_zero[d]) / between_.widths[d];
  return sum / static_cast<double>(across_.size());
}

double Press::stress_top() const {
  const GridpointSet& support = summed("top_platen_support");
  return (motion_.totals().total_force(support)[between_.axis] -
          motion_.totals().total_applied_force(support)[between_.axis]) /
         between_.area;
}

double Press::stress_bottom() const {
  return -motion_.totals().total_force(summed("bottom_platen_support"))[between_.axis] / between_.area;
}

void Press::move_evenly(const EvenMotion& motion, double speed, bool platen_follows) {
  const auto& model = motion_.model();
  const double rate = speed / motion_.time_step();
  for (int g : set("specimen")) {
    const Vec<3> x = model.place(g);
    double turned = 0.0;
    for (std::size_t d = 0; d < across_.size(); ++d) {
      turned += motion.tilt[d] * (x[across_[d]] - middle_[d]);
      const double aside = -motion.tilt[d] * (x[between_.axis] - bottom_);
      motion_.constraints().prescribe_velocity(
          g, across_[d], rate * (motion.lateral * (x[across_[d]] - middle_[d]) + aside));
    }
    motion_.constraints().prescribe_velocity(
        g, between_.axis, rate * (motion.axial * (x[between_.axis] - bottom_) + motion.lift + turned));
  }
  if (!platen_follows) return;
  for (int g : set("top_platen"))
    motion_.constraints().prescribe_velocity(
        g, between_.axis, rate * (motion.axial * between_.height + motion.lift + motion.platen_lift));
}

void Press::end_even_motion(bool platen_follows) {
  for (int g : set("specimen"))
    for (int i = 0; i < motion_.model().dimension(); ++i) motion_.constraints().release(g, i);
  for (const PlaneOfSymmetry& plane : motion_.model().symmetry)
    for (int g : set(plane.set())) motion_.constraints().prescribe_velocity(g, plane.component, 0.0);
  if (!platen_follows) return;
  for (int g : set("top_platen")) motion_.constraints().release(g, between_.axis);
}

void Press::visit_state(StateVisitor& visitor) {
  auto& [is_driven, stress_held, shortening_at_zero, specimen_shortening_at_zero, widening_at_zero,
         stage_first_strain] = kept_;  // another member does not compile until it has a name here
  visitor.visit("is_driven", is_driven);
  visitor.visit("stress_held", stress_held);
  visitor.visit("shortening_at_zero", shortening_at_zero);
  visitor.visit("specimen_shortening_at_zero", specimen_shortening_at_zero);
  for (std::size_t d = 0; d < across_.size(); ++d)
    visitor.visit(fmt::format("widening_at_zero{}", between_.sides[d][1]), widening_at_zero[d]);
  visitor.visit("stage_first_strain", stage_first_strain);
}

}  // namespace pyroclast
