#include "pyroclast/simulation/supports.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "pyroclast/base/error.hpp"
#include "pyroclast/simulation/simulation.hpp"

namespace pyroclast {

namespace {

/// Distance of two held lines below which they are one, in sizes of the body.
constexpr double kSameLine = 1e-6;

}  // namespace

/// Describes a motion that nothing hinders. A gridpoint whose component is held hinders motion along a line,
/// in the direction of the component. All such lines hinder any turn but one about a point that lies on each
/// of them.
template <>
std::optional<std::string> Supports<2>::free_motion() const {
  const auto size_of = [&] {
    double size = 0.0;
    for (const auto& x : model_.position) size = std::max(size, norm(x - model_.position.front()));
    return size;
  };
  std::array<bool, 2> any{};
  // least and most by component: y of the lines along x, and x of the lines along y
  std::array<double, 2> least{{1e300, 1e300}}, most{{-1e300, -1e300}};
  for (int g = 0; g < model_.gridpoint_count(); ++g)
    for (const int c : {0, 1})
      if (holders_[g][c] > 0) {
        any[c] = true;
        least[c] = std::min(least[c], model_.position[g][1 - c]);
        most[c] = std::max(most[c], model_.position[g][1 - c]);
      }
  if (!any[0] && !any[1]) return "along x and y, and turning";
  if (!any[0]) return "along x";
  if (!any[1]) return "along y";
  const double tolerance = kSameLine * size_of();
  if (most[0] - least[0] <= tolerance && most[1] - least[1] <= tolerance) return "turning about one point";
  return std::nullopt;
}

template <int Dim>
void Supports<Dim>::count(const std::string& set, int component, int more) {
  for (int g : model_.set(set)) holders_[g][component] += more;
}

template <int Dim>
void Supports<Dim>::hold(const std::string& set, int component, const HeldMotion& motion,
                         const std::string& place) {
  const auto& own = model_.set(set);
  for (const auto& [key, other] : held_) {
    if (key.second != component || key.first == set || other.motion.is_like(motion)) continue;
    for (int g : model_.set(key.first))
      if (std::ranges::find(own, g) != own.end())
        throw Error(fmt::format(
            "{}: set \"{}\" shares gridpoint {} with set \"{}\" ({}), and both are held or driven "
            "along {}, {}",
            place, set, g, key.first, other.place, "xyz"[component],
            motion.is_free && other.motion.is_free
                ? "by velocities with factors, which may differ: drive one set that has both"
                : "in different ways"));
  }
  if (held_.insert_or_assign({set, component}, Held{motion, place}).second) count(set, component, 1);
}

template <int Dim>
void Supports<Dim>::release(const std::string& set, int component, const std::string& place) {
  if (held_.erase({set, component}) > 0) {
    count(set, component, -1);
    return;
  }
  std::string who = "nothing holds it";
  for (int g : model_.set(set))
    if (holds(g, component))
      who = fmt::format("what holds it there is another set ({})", place_of(g, component));
  throw Error(
      fmt::format("{}: set \"{}\" is to be released along {}, but it is neither held nor driven so: {}",
                  place, set, "xyz"[component], who));
}

template <int Dim>
void Supports<Dim>::halt(const std::string& set, int component) {
  const auto found = held_.find({set, component});
  if (found != held_.end()) found->second.motion = {};
}

template <int Dim>
std::string Supports<Dim>::place_of(int gridpoint, int component) const {
  for (const auto& [key, held] : held_)
    if (key.second == component &&
        std::ranges::find(model_.set(key.first), gridpoint) != model_.set(key.first).end())
      return held.place;
  return {};
}

template <int Dim>
void Supports<Dim>::visit_state(StateVisitor& visitor) {
  std::vector<std::string> sets, places;
  std::vector<int> components;
  std::vector<HeldMotion> motions;
  for (const auto& [key, held] : held_) {
    sets.push_back(key.first);
    components.push_back(key.second);
    places.push_back(held.place);
    motions.push_back(held.motion);
  }
  std::vector<double> velocities, ramp_times;
  std::vector<std::uint8_t> are_free;
  for (const HeldMotion& motion : motions) {
    velocities.push_back(motion.velocity);
    ramp_times.push_back(motion.ramp_time);
    are_free.push_back(motion.is_free ? 1 : 0);
  }
  visitor.visit("sets", sets);
  visitor.visit("components", components, state::index(Dim).of(sets.size()));
  visitor.visit("places", places);
  visitor.require(places.size() == sets.size(), "places", "are not as many as the sets");
  visitor.visit("velocities", velocities, state::finite().of(sets.size()));
  visitor.visit("ramp_times", ramp_times, state::finite().of(sets.size()));
  visitor.visit("are_free", are_free, state::within(0, 1).of(sets.size()));
  if (!visitor.replaces()) return;
  held_.clear();
  std::ranges::fill(holders_, std::array<int, Dim>{});
  for (std::size_t i = 0; i < sets.size(); ++i) {
    held_[{sets[i], components[i]}] = {{velocities[i], ramp_times[i], are_free[i] != 0}, places[i]};
    count(sets[i], components[i], 1);
  }
}

bool has_weight(const Simulation& simulation) {
  const Vec<2> gravity = simulation.mechanics().body().state.gravity;
  return gravity[0] != 0.0 || gravity[1] != 0.0;
}

void require_held(const Simulation& simulation, const Supports<2>& supports, const std::string& what) {
  if (simulation.has_press()) return;
  if (const auto motion = supports.free_motion())
    throw Error(
        fmt::format("{}: nothing holds the body against moving {}, but it has weight or a load: hold "
                    "a set of it by a drive, or set gravity to 0",
                    what, *motion));
}

template class Supports<2>;

}  // namespace pyroclast
