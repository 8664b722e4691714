#include "pyroclast/simulation/loads.hpp"

#include <algorithm>
#include <array>
#include <utility>

#include <fmt/format.h>

#include "pyroclast/base/chunked_sum.hpp"
#include "pyroclast/base/error.hpp"
#include "pyroclast/base/sort_unique.hpp"
#include "pyroclast/model/sets.hpp"

namespace pyroclast {

namespace {

/// Returns the normal of a face times its area over its number of corners: the force of a unit pressure on
/// one corner, m².
Vec<2> share_of_corner(const std::array<Vec<2>, 2>& x, double thickness) {
  const Vec<2> along = x[1] - x[0];
  return 0.5 * thickness * Vec<2>{{along[1], -along[0]}};
}
Vec<3> share_of_corner(const std::array<Vec<3>, 3>& x, double /*thickness*/) {
  return (1.0 / 6.0) * cross(x[1] - x[0], x[2] - x[0]);
}

}  // namespace

template <int Dim>
typename Loads<Dim>::Entry& Loads<Dim>::entry(const std::string& set) {
  const auto found = entries_.find(set);
  if (found != entries_.end()) return found->second;
  const Model<Dim>& model = mechanics_.model();
  std::vector<int> gridpoints = model.set(set);
  sort_unique(gridpoints);
  Entry entry;
  entry.set = gridpoint_set(mechanics_.model(), gridpoints);
  const auto faces = faces_in(model, gridpoints);
  for (const auto& face : faces) entry.faces.push_back(face.gridpoints);
  entry.shares = tributary_areas(gridpoints, faces);
  const double whole = chunked_sum(entry.set.chunks, [&](int i) { return entry.shares[i]; });
  for (double& share : entry.shares)
    share = whole > 0.0 ? share / whole : 1.0 / static_cast<double>(gridpoints.size());
  Entry& added = entries_.emplace(set, std::move(entry)).first->second;
  list_loaded();
  return added;
}

template <int Dim>
void Loads<Dim>::list_loaded() {
  loaded_.clear();
  for (const auto& [name, entry] : entries_)
    loaded_.insert(loaded_.end(), entry.set.gridpoints.begin(), entry.set.gridpoints.end());
  sort_unique(loaded_);
  for (auto& [name, entry] : entries_) {
    entry.places.clear();
    for (int g : entry.set.gridpoints)
      entry.places.push_back(static_cast<int>(std::ranges::lower_bound(loaded_, g) - loaded_.begin()));
  }
}

template <int Dim>
SetLoad<Dim> Loads<Dim>::on(const std::string& set) const {
  const auto found = entries_.find(set);
  return found == entries_.end() ? SetLoad<Dim>{} : found->second.load;
}

template <int Dim>
std::map<std::string, SetLoad<Dim>> Loads<Dim>::all() const {
  std::map<std::string, SetLoad<Dim>> loads;
  for (const auto& [set, entry] : entries_) loads[set] = entry.load;
  return loads;
}

template <int Dim>
Vec<Dim> Loads<Dim>::total(const std::string& set) const {
  const auto found = entries_.find(set);
  if (found == entries_.end()) return {};
  const auto on = forces(found->second);
  return chunked_sum<Vec<Dim>>(found->second.set.chunks, [&](int i, Vec<Dim>& total) { total += on[i]; });
}

template <int Dim>
void Loads<Dim>::set(const std::map<std::string, SetLoad<Dim>>& loads) {
  for (const auto& [set, load] : loads) {
    const Entry& changed = entry(set);
    for (int g : changed.set.gridpoints)
      for (int i = 0; i < Dim; ++i)
        if (load.force[i] != 0.0 && mechanics_.read().is_prescribed(g, i))
          throw Error(fmt::format(
              "a force along {} on set \"{}\" acts on gridpoints that are held or driven along {}", "xyz"[i],
              set, "xyz"[i]));
    if (load.pressure != 0.0 && changed.faces.empty())
      throw Error(fmt::format("a pressure acts on set \"{}\", which has no face of the outline", set));
  }
  for (const auto& [set, load] : loads) entry(set).load = load;
  apply();
}

/// Returns the forces of a load on each gridpoint of its set.
template <int Dim>
std::vector<Vec<Dim>> Loads<Dim>::forces(const Entry& entry) const {
  const auto& gridpoints = entry.set.gridpoints;
  std::vector<Vec<Dim>> result;
  for (double share : entry.shares) result.push_back(share * entry.load.force);
  if (entry.load.pressure == 0.0) return result;
  const Model<Dim>& model = mechanics_.model();
  for (const auto& face : entry.faces) {
    std::array<Vec<Dim>, Dim> x;
    for (int i = 0; i < Dim; ++i) {
      x[i] = model.position[face[i]];
      if (entry.load.is_follower) x[i] += mechanics_.read().displacement(face[i]);
    }
    const Vec<Dim> share = -entry.load.pressure * share_of_corner(x, model.thickness);
    for (int g : face) result[std::ranges::lower_bound(gridpoints, g) - gridpoints.begin()] += share;
  }
  return result;
}

template <int Dim>
void Loads<Dim>::apply() {
  std::vector<Vec<Dim>> on(loaded_.size());
  for (const auto& [name, entry] : entries_) {
    const auto of_entry = forces(entry);
    for (std::size_t i = 0; i < of_entry.size(); ++i) on[entry.places[i]] += of_entry[i];
  }
  for (std::size_t i = 0; i < on.size(); ++i) mechanics_.constraints().apply_force(loaded_[i], on[i]);
}

/// Returns the way of a set along its force, m; under a pressure against its faces.
template <int Dim>
double Loads<Dim>::way(const Entry& entry) const {
  const auto on = forces(entry);
  const auto along = chunked_sum<Vec<Dim>>(entry.set.chunks, [&](int i, Vec<Dim>& total) { total += on[i]; });
  const double size = norm(along);
  return size > 0.0 ? dot(mechanics_.totals().mean_displacement(entry.set), along) / size : 0.0;
}

template <int Dim>
void Loads<Dim>::mark() {
  for (auto& [name, entry] : entries_) entry.marked = way(entry);
}

template <int Dim>
double Loads<Dim>::give() const {
  double most = 0.0;
  for (const auto& [name, entry] : entries_) most = std::max(most, way(entry) - entry.marked);
  return most / size_;
}

template <int Dim>
void Loads<Dim>::visit_state(StateVisitor& visitor) {
  std::vector<std::string> sets;
  for (const auto& [name, entry] : entries_) sets.push_back(name);
  visitor.visit("sets", sets);
  if (visitor.replaces()) {
    entries_.clear();
    for (const std::string& set : sets) entry(set);
  }
  for (auto& [name, entry] : entries_) {
    const StateVisitor::Scope scope(visitor, name);
    visitor.visit_numbers("force", entry.load.force);
    visitor.visit("pressure", entry.load.pressure);
    visitor.visit("is_follower", entry.load.is_follower);
    visitor.visit("marked", entry.marked);
  }
}

template class Loads<2>;
template class Loads<3>;

}  // namespace pyroclast
