#include "pyroclast/simulation/acting/loads.hpp"

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
/// \param x  places of the corners, m
Vec<3> share_of_corner(const std::array<Vec<3>, 3>& x, int corners, double thickness) {
  if (corners == 3) return (1.0 / 6.0) * cross(x[1] - x[0], x[2] - x[0]);
  const Vec<3> along = x[1] - x[0];
  return 0.5 * thickness * Vec<3>{{along[1], -along[0]}};
}

}  // namespace

Loads::Entry& Loads::entry(const std::string& set) {
  const auto found = entries_.find(set);
  if (found != entries_.end()) return found->second;
  const Model& model = motion_.model();
  std::vector<int> gridpoints = model.set(set);
  sort_unique(gridpoints);
  Entry entry;
  entry.set = gridpoint_set(motion_.model(), gridpoints);
  entry.faces = faces_in(model, gridpoints);
  entry.has_faces = model.ranks().any(!entry.faces.empty());
  entry.shares = tributary_areas(gridpoints, entry.faces);
  const double whole = chunked_sum(entry.set.chunks, [&](int i) { return entry.shares[i]; });
  for (double& share : entry.shares) share = whole > 0.0 ? share / whole : 1.0 / entry.set.whole_count;
  Entry& added = entries_.emplace(set, std::move(entry)).first->second;
  list_loaded();
  return added;
}

void Loads::list_loaded() {
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

SetLoad Loads::on(const std::string& set) const {
  const auto found = entries_.find(set);
  return found == entries_.end() ? SetLoad{} : found->second.load;
}

std::map<std::string, SetLoad> Loads::all() const {
  std::map<std::string, SetLoad> loads;
  for (const auto& [set, entry] : entries_) loads[set] = entry.load;
  return loads;
}

Vec<3> Loads::total(const std::string& set) const {
  const auto found = entries_.find(set);
  if (found == entries_.end()) return {};
  const auto on = forces(found->second);
  return chunked_sum<Vec<3>>(found->second.set.chunks, [&](int i, Vec<3>& total) { total += on[i]; });
}

void Loads::set(const std::map<std::string, SetLoad>& loads) {
  for (const auto& [set, load] : loads) {
    const Entry& changed = entry(set);
    for (int g : changed.set.gridpoints)
      for (int i = 0; i < motion_.model().dimension(); ++i)
        if (load.force[i] != 0.0 && motion_.read().is_prescribed(g, i))
          throw Error(fmt::format(
              "a force along {} on set \"{}\" acts on gridpoints that are held or driven along {}", "xyz"[i],
              set, "xyz"[i]));
    for (int i = motion_.model().dimension(); i < 3; ++i)
      if (load.force[i] != 0.0)
        throw Error(fmt::format("a force on set \"{}\" acts across the plane of this body", set));
    if (load.pressure != 0.0 && !changed.has_faces)
      throw Error(fmt::format("a pressure acts on set \"{}\", which has no face of the outline", set));
  }
  for (const auto& [set, load] : loads) entry(set).load = load;
  apply();
}

/// Returns the forces of a load on each gridpoint of its set.
std::vector<Vec<3>> Loads::forces(const Entry& entry) const {
  const auto& gridpoints = entry.set.gridpoints;
  std::vector<Vec<3>> result;
  for (double share : entry.shares) result.push_back(share * entry.load.force);
  if (entry.load.pressure == 0.0) return result;
  const Model& model = motion_.model();
  for (const Face& face : entry.faces) {
    std::array<Vec<3>, 3> x;
    for (int i = 0; i < face.corners; ++i) {
      x[i] = model.place(face.corner[i]);
      if (entry.load.is_follower) x[i] += motion_.read().displacement(face.corner[i]);
    }
    const Vec<3> share = -entry.load.pressure * share_of_corner(x, face.corners, model.thickness);
    for (int g : face.gridpoints())
      result[std::ranges::lower_bound(gridpoints, g) - gridpoints.begin()] += share;
  }
  return result;
}

void Loads::apply() {
  std::vector<Vec<3>> on(loaded_.size());
  for (const auto& [name, entry] : entries_) {
    const auto of_entry = forces(entry);
    for (std::size_t i = 0; i < of_entry.size(); ++i) on[entry.places[i]] += of_entry[i];
  }
  for (std::size_t i = 0; i < on.size(); ++i) motion_.constraints().apply_force(loaded_[i], on[i]);
}

/// Returns the way of a set along its force, m; under a pressure against its faces.
double Loads::way(const Entry& entry) const {
  const auto on = forces(entry);
  const auto along = chunked_sum<Vec<3>>(entry.set.chunks, [&](int i, Vec<3>& total) { total += on[i]; });
  const Vec<3> moved = motion_.totals().mean_displacement(entry.set);
  const double size = norm(along);
  return size > 0.0 ? dot(moved, along) / size : 0.0;
}

std::vector<double> Loads::ways() const {
  return motion_.model().ranks().together([&] {
    std::vector<double> ways;
    for (const auto& [name, entry] : entries_) ways.push_back(way(entry));
    return ways;
  });
}

void Loads::mark(const std::vector<double>& ways) {
  for (std::size_t i = 0; auto& [name, entry] : entries_) entry.marked = ways[i++];
}

double Loads::give() const {
  double most = 0.0;
  const std::vector<double> now = ways();
  for (std::size_t i = 0; const auto& [name, entry] : entries_)
    most = std::max(most, now[i++] - entry.marked);
  return most / size_;
}

void Loads::visit_state(StateVisitor& visitor) {
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
    for (int i = motion_.model().dimension(); i < 3; ++i)
      visitor.require(entry.load.force[i] == 0.0, "force", "acts across the plane of the body");
    visitor.visit("pressure", entry.load.pressure);
    visitor.visit("is_follower", entry.load.is_follower);
    visitor.visit("marked", entry.marked);
  }
}

}  // namespace pyroclast
