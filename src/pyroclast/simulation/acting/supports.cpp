#include "pyroclast/simulation/acting/supports.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "pyroclast/base/error.hpp"
#include "pyroclast/simulation/simulation.hpp"

namespace pyroclast {

namespace {

/// Distance of two held lines below which they are one, in sizes of the body.
constexpr double kSameLine = 1e-6;

/// Rigid motions that supports hinder: the space of equations, as orthonormal rows.
class RigidMotions {
 public:
  explicit RigidMotions(int dimension) : dimension_(dimension) {}

  /// Hinders a component of the motion of a point: v_c + (omega x r)_c = 0.
  void hinder(const Vec<3>& r, int component) {
    if (are_all_hindered()) return;
    std::array<double, 6> row{};
    row[component] = 1.0;
    const int i = (component + 1) % 3, j = (component + 2) % 3;
    if (dimension_ == 3 || i == 2) row[3 + i] = r[j];
    if (dimension_ == 3 || j == 2) row[3 + j] = -r[i];
    for (const auto& known : rows_) {
      double share = 0.0;
      for (std::size_t k = 0; k < row.size(); ++k) share += row[k] * known[k];
      for (std::size_t k = 0; k < row.size(); ++k) row[k] -= share * known[k];
    }
    double length = 0.0;
    for (const double number : row) length += number * number;
    length = std::sqrt(length);
    if (length <= kSameLine) return;
    for (double& number : row) number /= length;
    rows_.push_back(row);
  }
  bool are_all_hindered() const { return static_cast<int>(rows_.size()) == (dimension_ == 2 ? 3 : 6); }

 private:
  int dimension_;
  std::vector<std::array<double, 6>> rows_;
};

}  // namespace

Supports::Supports(const Model& model) : model_(model), holders_(model.gridpoint_count()) {
  for (const PlaneOfSymmetry& plane : model.symmetry)
    hold(plane.set(), plane.component, {}, plane.deck_place);
}

/// Describes a motion that nothing hinders. A rigid motion has a velocity and a turn: two and one numbers in
/// 2D, three and three in 3D. A gridpoint whose component is held gives one equation for them, scaled so that
/// turns count by the size of the body. Motions are free where the equations leave some undetermined.
std::optional<std::string> Supports::free_motion() const {
  const int dimension = model_.dimension();
  Ranks& ranks = model_.ranks();
  const auto [first, last] = model_.gridpoint_chunks().own();
  const Vec<3> origin = ranks.collect(std::vector{model_.place(first)}).front();
  struct HeldComponent {
    Vec<3> place;
    int component;
  };
  std::vector<HeldComponent> all_held;
  double size = 0.0;
  for (int g = first; g < last; ++g) {
    size = std::max(size, norm(model_.place(g) - origin));
    for (int c = 0; c < dimension; ++c)
      if (holders_[g][c] > 0) all_held.push_back({model_.place(g), c});
  }
  size = ranks.largest(size);

  RigidMotions held(dimension);
  std::array<bool, 3> any{};
  for (const auto& [place, component] : ranks.collect(all_held)) {
    any[component] = true;
    held.hinder((place - origin) * (1.0 / size), component);
  }
  if (held.are_all_hindered()) return std::nullopt;
  std::vector<std::string> along;
  for (int c = 0; c < dimension; ++c)
    if (!any[c]) along.push_back(std::string(1, "xyz"[c]));
  std::string free = along.empty() ? "" : fmt::format("moving along {}", fmt::join(along, " and "));
  if (static_cast<int>(along.size()) == dimension) return free + ", and turning";
  if (!free.empty()) return free;
  return dimension == 2 ? "turning about one point" : "turning about an axis";
}

void Supports::count(const std::string& set, int component, int more) {
  for (int g : model_.set(set)) holders_[g][component] += more;
}

void Supports::hold(const std::string& set, int component, const HeldMotion& motion,
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

void Supports::release(const std::string& set, int component, const std::string& place) {
  for (const PlaneOfSymmetry& plane : model_.symmetry)
    if (plane.set() == set && plane.component == component)
      throw Error(
          fmt::format("{}: set \"{}\" lies in a plane of symmetry ({}), which holds it along {} in the "
                      "whole run",
                      place, set, plane.deck_place, "xyz"[component]));
  if (held_.erase({set, component}) > 0) {
    count(set, component, -1);
    return;
  }
  std::string who = "nothing holds it";
  for (int g : model_.set(set))
    if (holds(g, component))
      who = fmt::format("another set holds the body there ({})", place_of(g, component));
  throw Error(fmt::format("{}: set \"{}\" is to be released along {}, but is neither held nor driven so: {}",
                          place, set, "xyz"[component], who));
}

void Supports::halt(const std::string& set, int component) {
  const auto found = held_.find({set, component});
  if (found != held_.end()) found->second.motion = {};
}

std::string Supports::place_of(int gridpoint, int component) const {
  for (const auto& [key, held] : held_)
    if (key.second == component &&
        std::ranges::find(model_.set(key.first), gridpoint) != model_.set(key.first).end())
      return held.place;
  return {};
}

void Supports::visit_state(StateVisitor& visitor) {
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
  visitor.visit("components", components, state::index(model_.dimension()).of(sets.size()));
  visitor.visit("places", places);
  visitor.require(places.size() == sets.size(), "places", "are not as many as the sets");
  visitor.visit("velocities", velocities, state::finite().of(sets.size()));
  visitor.visit("ramp_times", ramp_times, state::finite().of(sets.size()));
  visitor.visit("are_free", are_free, state::within(0, 1).of(sets.size()));
  if (!visitor.replaces()) return;
  held_.clear();
  std::ranges::fill(holders_, std::array<int, 3>{});
  for (std::size_t i = 0; i < sets.size(); ++i) {
    held_[{sets[i], components[i]}] = {{velocities[i], ramp_times[i], are_free[i] != 0}, places[i]};
    count(sets[i], components[i], 1);
  }
}

bool has_weight(const Simulation& simulation) {
  return simulation.motion().parameters().gravity != Vec<3>{};
}

void require_held(const Simulation& simulation, const Supports& supports, const std::string& what) {
  if (simulation.has_press()) return;
  if (const auto motion = supports.free_motion())
    throw Error(
        fmt::format("{}: nothing holds the body against {}, but it has weight or a load: hold "
                    "a set of it by a drive, or set gravity to 0",
                    what, *motion));
}

}  // namespace pyroclast
