#include "pyroclast/model/sets.hpp"

#include <algorithm>
#include <limits>

#include <fmt/format.h>

#include "pyroclast/base/error.hpp"
#include "pyroclast/base/overloaded.hpp"
#include "pyroclast/model/outline.hpp"

namespace pyroclast {

namespace {

/// What is this near to a bound or a line, in sizes of the model, is on it.
constexpr double kOnBound = 1e-9;

template <int Dim>
double size_of(const Model<Dim>& model) {
  double size = 0.0;
  for (const auto& x : model.position) size = std::max(size, norm(x - model.position.front()));
  return size;
}

/// Of a point from a straight line between two others, m.
template <int Dim>
double distance(const Vec<Dim>& x, const OnLine<Dim>& line) {
  const Vec<Dim> along = line.to - line.from;
  const double length2 = dot(along, along);
  const double share = length2 > 0.0 ? std::clamp(dot(x - line.from, along) / length2, 0.0, 1.0) : 0.0;
  return norm(x - (line.from + along * share));
}

template <int Dim>
bool holds(const Place<Dim>& place, const Vec<Dim>& x, double slack) {
  return std::visit(Overloaded{
                        [](const Everywhere&) { return true; },
                        [&](const InBox<Dim>& box) {
                          for (int i = 0; i < Dim; ++i)
                            if (x[i] < box.low[i] - slack || x[i] > box.high[i] + slack) return false;
                          return true;
                        },
                        [&](const InBall<Dim>& ball) { return norm(x - ball.centre) <= ball.radius + slack; },
                        [&](const OnLine<Dim>& line) { return distance(x, line) <= slack; },
                        [](const NearestTo<Dim>&) { return true; },
                    },
                    place);
}

/// \param at  where each candidate is
template <int Dim, class At>
std::vector<int> chosen(const std::vector<int>& candidates, const Place<Dim>& place, double slack,
                        const At& at) {
  std::vector<int> result;
  if (const auto* nearest = std::get_if<NearestTo<Dim>>(&place)) {
    const auto from = [&](int i) { return norm(at(i) - nearest->point); };
    double least = std::numeric_limits<double>::infinity();
    for (int i : candidates) least = std::min(least, from(i));
    for (int i : candidates)
      if (from(i) <= least + slack) result.push_back(i);
    return result;
  }
  for (int i : candidates)
    if (holds(place, at(i), slack)) result.push_back(i);
  return result;
}

}  // namespace

template <int Dim>
void add_sets(Model<Dim>& model, const std::vector<SetParameters<Dim>>& sets) {
  const double slack = kOnBound * size_of(model);
  for (const SetParameters<Dim>& asked : sets) {
    const auto fail = [&](const std::string& why) {
      throw Error(fmt::format("{}: set \"{}\" {}", asked.deck_place, asked.name, why));
    };
    auto& all = asked.of_contacts ? model.contact_sets : model.sets;
    if (all.contains(asked.name)) fail("has the name of one that there is already");
    std::vector<int> candidates;
    if (asked.within.empty()) {
      const int count = asked.of_contacts ? model.contact_count() : model.gridpoint_count();
      for (int i = 0; i < count; ++i) candidates.push_back(i);
    } else if (const auto found = all.find(asked.within); found != all.end()) {
      candidates = found->second;
      std::ranges::sort(candidates);
      const auto repeated = std::ranges::unique(candidates);
      candidates.erase(repeated.begin(), repeated.end());
    } else {
      std::string names;
      for (const auto& [name, members] : all) names += fmt::format("{}{}", names.empty() ? "" : ", ", name);
      fail(fmt::format("lies within \"{}\", but there is no such set of {}; there are {}", asked.within,
                       asked.of_contacts ? "contacts" : "gridpoints", names.empty() ? "none" : names));
    }
    const auto at = [&](int i) -> const Vec<Dim>& {
      return model.position[asked.of_contacts ? model.contacts[i].a : i];
    };
    auto members = chosen(candidates, asked.place, slack, at);
    if (members.empty()) fail("is empty: nothing lies there");
    all[asked.name] = std::move(members);
  }
}

template <int Dim>
std::vector<double> tributary_areas(const Model<Dim>& model, const std::vector<int>& set) {
  std::vector<double> of_gridpoint(model.position.size(), -1.0);
  for (int g : set) of_gridpoint[g] = 0.0;
  for (const auto& face :
       outline(model, zone_geometry(model), std::vector<bool>(model.material_names.size(), true))) {
    if (std::ranges::any_of(face.gridpoints, [&](int g) { return of_gridpoint[g] < 0.0; })) continue;
    for (int g : face.gridpoints) of_gridpoint[g] += face.area / Dim;
  }
  std::vector<double> areas;
  for (int g : set) areas.push_back(of_gridpoint[g]);
  return areas;
}

template void add_sets(Model<2>&, const std::vector<SetParameters<2>>&);
template void add_sets(Model<3>&, const std::vector<SetParameters<3>>&);
template std::vector<double> tributary_areas(const Model<2>&, const std::vector<int>&);
template std::vector<double> tributary_areas(const Model<3>&, const std::vector<int>&);

}  // namespace pyroclast
