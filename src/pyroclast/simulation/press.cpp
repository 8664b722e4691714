#include "pyroclast/simulation/press.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <utility>

#include <fmt/format.h>

#include "pyroclast/base/error.hpp"
#include "pyroclast/simulation/sums.hpp"

namespace pyroclast {

namespace {

/// Least share of the load that rests on the lower platen with which the platen carries the specimen.
constexpr double kCarried = 0.8;

/// Sides of the specimen across the axis, lower and upper, in the order of the components.
constexpr std::array<std::array<std::string_view, 2>, 2> kSides{{{"left", "right"}, {"front", "back"}}};

template <int Dim>
std::array<int, Dim - 1> components_across(int axis) {
  if (axis < 0 || axis >= Dim)
    throw Error(fmt::format("the axis of the press is {}, but it must be from 0 to {}", axis, Dim - 1));
  std::array<int, Dim - 1> across{};
  for (int i = 0, next = 0; i < Dim; ++i)
    if (i != axis) across[next++] = i;
  return across;
}

}  // namespace

template <int Dim>
Press<Dim>::Press(Mechanics<Dim>& mechanics, int axis, double height,
                  const std::array<double, Dim - 1>& widths)
    : mechanics_(mechanics),
      axis_(axis),
      height_(height),
      widths_(widths),
      across_(components_across<Dim>(axis)) {
  for (const char* name : {"bottom_platen_support", "top_platen_support", "bottom_platen_face",
                           "top_platen_face", "bottom", "top", "specimen", "bottom_platen"})
    summed_.emplace(name, gridpoint_set(mechanics_.model(), set(name)));
  for (int d = 0; d < Dim - 1; ++d)
    for (const auto side : kSides[d]) summed_.emplace(side, gridpoint_set(mechanics_.model(), set(side)));
  for (int g : set("bottom_platen_support"))
    for (int i = 0; i < Dim; ++i) mechanics_.constraints().prescribe_velocity(g, i, 0.0);
  for (int g : set("top_platen_support"))
    for (int i : across_) mechanics_.constraints().prescribe_velocity(g, i, 0.0);
}

template <int Dim>
void Press<Dim>::let_go() {
  for (int g : set("top_platen_support")) mechanics_.constraints().release(g, axis_);
  kept_.is_driven = false;
}

template <int Dim>
void Press<Dim>::control_by_force() {
  const double borne = kept_.is_driven ? std::max(0.0, stress_top()) : kept_.stress_held;
  mechanics_.constraints().untie();
  let_go();
  mechanics_.constraints().tie(set("top_platen_support"), axis_);
  hold(borne);
}

template <int Dim>
void Press<Dim>::control_by_motion(double velocity) {
  kept_.is_driven = true;
  mechanics_.constraints().untie();
  hold(0.0);
  move_platen(velocity);
}

template <int Dim>
void Press<Dim>::move_platen(double velocity) {
  for (int g : set("top_platen_support")) mechanics_.constraints().prescribe_velocity(g, axis_, -velocity);
}

template <int Dim>
void Press<Dim>::hold(double stress) {
  const double force = stress * area();
  const auto& support = set("top_platen_support");
  Vec<Dim> share{};
  share[axis_] = -force / static_cast<double>(support.size());
  for (int g : support) mechanics_.constraints().apply_force(g, share);
  kept_.stress_held = stress;
}

template <int Dim>
bool Press<Dim>::is_supported() const {
  const auto weight = [&](const GridpointSet& of) {
    return -mechanics_.totals().total_weight(of)[axis_] / area();
  };
  const double carries = stress_bottom() - weight(summed("bottom_platen"));
  return carries >= kCarried * (weight(specimen()) + kept_.stress_held);
}

template <int Dim>
double Press<Dim>::volume() const {
  return area() * height_;
}

/// Returns the rise over the width of the line on which the specimen stands: the edge of the lower hull of
/// its lower end that lies under the middle. 0 in 3D.
template <int Dim>
double Press<Dim>::rise_of_stand() const {
  if constexpr (Dim != 2) {
    return 0.0;
  } else {
    std::vector<Vec<2>> points;  // position across the axis, and displacement along it
    for (int g : set("bottom"))
      points.push_back(
          {{mechanics_.model().position[g][across_[0]], mechanics_.read().displacement(g)[axis_]}});
    std::ranges::sort(points, {}, [](const Vec<2>& p) { return std::pair(p[0], p[1]); });
    std::vector<Vec<2>> hull;
    for (const Vec<2>& p : points) {
      while (hull.size() > 1 && cross(hull.back() - hull[hull.size() - 2], p - hull.back()) <= 0.0)
        hull.pop_back();
      hull.push_back(p);
    }
    const double middle = 0.5 * (points.front()[0] + points.back()[0]);
    const auto right = std::ranges::find_if(hull, [&](const Vec<2>& p) { return p[0] > middle; });
    if (right == hull.begin() || right == hull.end()) return 0.0;
    const Vec<2> edge = *right - *std::prev(right);
    return edge[1] / edge[0];
  }
}

/// Returns the clearances between the platens and the gridpoints of the ends that stand out most, m.
/// \param up  function that returns the way of a gridpoint along the axis since the start
template <int Dim>
template <class Up>
typename Press<Dim>::Clearances Press<Dim>::clearances(const Up& up) const {
  const double lowest = up(*std::ranges::min_element(set("bottom"), {}, up));
  const double highest = up(*std::ranges::max_element(set("top"), {}, up));
  return {lowest - mechanics_.totals().mean_displacement(summed("bottom_platen_face"))[axis_],
          mechanics_.totals().mean_displacement(summed("top_platen_face"))[axis_] - highest};
}

template <int Dim>
typename Press<Dim>::EvenMotion Press<Dim>::to_touch() const {
  const double tilt = -rise_of_stand();
  const double middle = mean_position(mechanics_.model(), specimen(), across_[0]);
  const auto up = [&](int g) {
    return mechanics_.read().displacement(g)[axis_] +
           tilt * (mechanics_.model().position[g][across_[0]] - middle);
  };
  const auto [below, above] = clearances(up);
  return {.lift = -std::max(0.0, below), .tilt = tilt, .platen_lift = -above};
}

template <int Dim>
double Press<Dim>::way(const EvenMotion& motion) const {
  return std::abs(motion.lift) + std::abs(motion.tilt) * widths_[0];
}

template <int Dim>
double Press<Dim>::gap() const {
  const auto up = [&](int g) { return mechanics_.read().displacement(g)[axis_]; };
  const auto [below, above] = clearances(up);
  return std::max(0.0, below) + std::max(0.0, above);
}

template <int Dim>
double Press<Dim>::area() const {
  double area = mechanics_.model().thickness;
  for (double width : widths_) area *= width;
  return area;
}

template <int Dim>
double Press<Dim>::shortening(std::string_view top, std::string_view bottom) const {
  return mechanics_.totals().mean_displacement(summed(bottom))[axis_] -
         mechanics_.totals().mean_displacement(summed(top))[axis_];
}

template <int Dim>
double Press<Dim>::widening(int direction) const {
  const auto& [lower, upper] = kSides[direction];
  return mechanics_.totals().mean_displacement(summed(upper))[across_[direction]] -
         mechanics_.totals().mean_displacement(summed(lower))[across_[direction]];
}

template <int Dim>
void Press<Dim>::set_zero() {
  kept_.shortening_at_zero += strain() * height_;
  kept_.specimen_shortening_at_zero += specimen_strain() * height_;
  for (int d = 0; d < Dim - 1; ++d)
    kept_.widening_at_zero[d] += (widening(d) - kept_.widening_at_zero[d]) / widths_[d] * widths_[d];
}

template <int Dim>
void Press<Dim>::begin_stage() {
  kept_.stage_first_strain = strain();
}

template <int Dim>
double Press<Dim>::strain() const {
  return (shortening("top_platen_face", "bottom_platen_face") - kept_.shortening_at_zero) / height_;
}

template <int Dim>
double Press<Dim>::specimen_strain() const {
  return (shortening("top", "bottom") - kept_.specimen_shortening_at_zero) / height_;
}

template <int Dim>
double Press<Dim>::lateral_strain() const {
  double sum = 0.0;
  for (int d = 0; d < Dim - 1; ++d) sum += (widening(d) - kept_.widening_at_zero[d]) / widths_[d];
  return sum / (Dim - 1);
}

template <int Dim>
double Press<Dim>::stress_top() const {
  const GridpointSet& support = summed("top_platen_support");
  return (mechanics_.totals().total_force(support)[axis_] -
          mechanics_.totals().total_applied_force(support)[axis_]) /
         area();
}

template <int Dim>
double Press<Dim>::stress_bottom() const {
  return -mechanics_.totals().total_force(summed("bottom_platen_support"))[axis_] / area();
}

template <int Dim>
void Press<Dim>::move_evenly(const EvenMotion& motion, double speed, bool platen_follows) {
  const auto& model = mechanics_.model();
  const double bottom = model.position[set("bottom").front()][axis_];
  std::array<double, Dim - 1> middle{};
  for (int d = 0; d < Dim - 1; ++d)
    middle[d] = 0.5 * (mean_position(model, summed(kSides[d][0]), across_[d]) +
                       mean_position(model, summed(kSides[d][1]), across_[d]));
  const double rate = speed / mechanics_.time_step();
  for (int g : set("specimen")) {
    const Vec<Dim>& x = model.position[g];
    const double turned = motion.tilt * (x[across_[0]] - middle[0]);
    for (int d = 0; d < Dim - 1; ++d) {
      const double aside = d == 0 ? -motion.tilt * (x[axis_] - bottom) : 0.0;
      mechanics_.constraints().prescribe_velocity(
          g, across_[d], rate * (motion.lateral * (x[across_[d]] - middle[d]) + aside));
    }
    mechanics_.constraints().prescribe_velocity(
        g, axis_, rate * (motion.axial * (x[axis_] - bottom) + motion.lift + turned));
  }
  if (!platen_follows) return;
  for (int g : set("top_platen"))
    mechanics_.constraints().prescribe_velocity(
        g, axis_, rate * (motion.axial * height_ + motion.lift + motion.platen_lift));
}

template <int Dim>
void Press<Dim>::end_even_motion(bool platen_follows) {
  for (int g : set("specimen"))
    for (int i = 0; i < Dim; ++i) mechanics_.constraints().release(g, i);
  if (!platen_follows) return;
  for (int g : set("top_platen")) mechanics_.constraints().release(g, axis_);
}

template <int Dim>
void Press<Dim>::visit_state(StateVisitor& visitor) {
  auto& [is_driven, stress_held, shortening_at_zero, specimen_shortening_at_zero, widening_at_zero,
         stage_first_strain] = kept_;  // another member does not compile until it has a name here
  visitor.visit("is_driven", is_driven);
  visitor.visit("stress_held", stress_held);
  visitor.visit("shortening_at_zero", shortening_at_zero);
  visitor.visit("specimen_shortening_at_zero", specimen_shortening_at_zero);
  for (int d = 0; d < Dim - 1; ++d)
    visitor.visit(fmt::format("widening_at_zero{}", kSides[d][1]), widening_at_zero[d]);
  visitor.visit("stage_first_strain", stage_first_strain);
}

template class Press<2>;
template class Press<3>;

}  // namespace pyroclast
