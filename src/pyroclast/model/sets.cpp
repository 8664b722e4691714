#include "pyroclast/model/sets.hpp"

#include <algorithm>
#include <limits>
#include <numeric>
#include <unordered_map>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "pyroclast/base/error.hpp"
#include "pyroclast/base/overloaded.hpp"
#include "pyroclast/base/sort_unique.hpp"

namespace pyroclast {

namespace {

/// Largest distance from a bound or a line at which a point is on it, in sizes of the model.
constexpr double kOnBound = 1e-9;
/// Largest distance from the body of a place that is meant, in sizes of a block.
constexpr double kNear = 1.0;

template <int Dim>
double size_of(const Model<Dim>& model) {
  double size = 0.0;
  for (const auto& x : model.position) size = std::max(size, norm(x - model.position.front()));
  return size;
}

/// Returns the distance of a point from a straight line between two others, m.
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

/// Items of which a set may be made: the gridpoints or the contact of each item, the points that must lie in
/// the place, and its middle.
template <int Dim>
struct Items {
  std::vector<std::vector<int>> members;
  std::vector<std::vector<Vec<Dim>>> points;
  std::vector<Vec<Dim>> middle;

  void add(std::vector<int> of, std::vector<Vec<Dim>> at, const Vec<Dim>& in_the_middle) {
    members.push_back(std::move(of));
    points.push_back(std::move(at));
    middle.push_back(in_the_middle);
  }
};

/// Returns the centroid of each block.
template <int Dim>
std::vector<Vec<Dim>> centroids(const Model<Dim>& model) {
  const auto volume = zone_geometry(model).volume;
  std::vector<Vec<Dim>> moment(model.block_count());
  std::vector<double> whole(model.block_count());
  for (int block = 0; block < model.block_count(); ++block) {
    for (int z = model.block_zones[block]; z < model.block_zones[block + 1]; ++z) {
      whole[block] += volume[z];
      for (int g : model.zones[z]) moment[block] += volume[z] / (Dim + 1) * model.position[g];
    }
    moment[block] = (1.0 / whole[block]) * moment[block];
  }
  return moment;
}

/// Returns the distance of a point from the nearest gridpoint, m.
template <int Dim>
double distance_of(const Model<Dim>& model, const Vec<Dim>& point) {
  double least = std::numeric_limits<double>::infinity();
  for (const auto& x : model.position) least = std::min(least, norm(x - point));
  return least;
}

/// Returns the size of the largest block that is of no bearing, m: the largest distance of its gridpoints
/// from its first.
template <int Dim>
double block_size(const Model<Dim>& model) {
  double largest = 0.0;
  for (int block = 0; block < model.block_count(); ++block)
    for (int g = model.block_gridpoints[block];
         g < model.block_gridpoints[block + 1] && !model.is_of_bearing(block); ++g)
      largest = std::max(largest, norm(model.position[g] - model.position[model.block_gridpoints[block]]));
  return largest;
}

template <int Dim>
std::vector<OutlineFace<Dim>> outline_of(const Model<Dim>& model) {
  return outline(model, zone_geometry(model), std::vector<bool>(model.material_names.size(), true));
}

template <int Dim>
Items<Dim> items_of(const Model<Dim>& model, SetOf of) {
  Items<Dim> items;
  const auto add_point = [&](int member, int g) {
    items.add({member}, {model.position[g]}, model.position[g]);
  };
  switch (of) {
    case SetOf::gridpoints:
      for (int g = 0; g < model.gridpoint_count(); ++g) add_point(g, g);
      break;
    case SetOf::faces:
      for (const auto& face : outline_of(model)) {
        std::vector<Vec<Dim>> corners;
        for (int g : face.gridpoints) corners.push_back(model.position[g]);
        items.add({face.gridpoints.begin(), face.gridpoints.end()}, corners, face.centre);
      }
      break;
    case SetOf::blocks: {
      const auto middle = centroids(model);
      for (int block = 0; block < model.block_count(); ++block) {
        std::vector<int> members(model.block_gridpoints[block + 1] - model.block_gridpoints[block]);
        std::iota(members.begin(), members.end(), model.block_gridpoints[block]);
        items.add(std::move(members), {middle[block]}, middle[block]);
      }
      break;
    }
    case SetOf::contacts:
      for (int c = 0; c < model.contact_count(); ++c) add_point(c, model.contacts[c].a);
      break;
  }
  return items;
}

/// Returns the members of the items that lie in the place and within another set, ascending.
template <int Dim>
std::vector<int> chosen(const Items<Dim>& items, const std::vector<int>* within, const Place<Dim>& place,
                        double slack) {
  std::vector<bool> allowed;
  if (within != nullptr) {
    allowed.resize(1 + *std::ranges::max_element(*within));
    for (int i : *within) allowed[i] = true;
  }
  const auto is_allowed = [&](int i) { return within == nullptr || (i < std::ssize(allowed) && allowed[i]); };
  std::vector<std::size_t> candidates;
  for (std::size_t i = 0; i < items.members.size(); ++i)
    if (std::ranges::all_of(items.members[i], is_allowed)) candidates.push_back(i);
  double reach = std::numeric_limits<double>::infinity();
  const auto* nearest = std::get_if<NearestTo<Dim>>(&place);
  if (nearest != nullptr)
    for (const auto i : candidates) reach = std::min(reach, norm(items.middle[i] - nearest->point) + slack);
  std::vector<int> result;
  for (const auto i : candidates) {
    const bool is_in =
        nearest != nullptr
            ? norm(items.middle[i] - nearest->point) <= reach
            : std::ranges::all_of(items.points[i], [&](const Vec<Dim>& x) { return holds(place, x, slack); });
    if (is_in) result.insert(result.end(), items.members[i].begin(), items.members[i].end());
  }
  sort_unique(result);
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
    const bool is_of_contacts = asked.of == SetOf::contacts;
    auto& all = is_of_contacts ? model.contact_sets : model.sets;
    if (all.contains(asked.name)) fail("has the name of one that there is already");
    const std::vector<int>* within = nullptr;
    if (!asked.within.empty()) {
      const auto found = all.find(asked.within);
      if (found == all.end() || found->second.empty())
        fail(fmt::format("lies within \"{}\", but there is no such set of {}; there are {}", asked.within,
                         is_of_contacts ? "contacts" : "gridpoints", names_of(all)));
      within = &found->second;
    }
    const auto items = items_of(model, asked.of);
    if (const auto* nearest = std::get_if<NearestTo<Dim>>(&asked.place))
      if (const double away = distance_of(model, nearest->point); away > kNear * block_size(model))
        fail(fmt::format(
            "is of what is nearest to a place that lies {:.4g} m from the body, more than a block is wide",
            away));
    auto members = chosen(items, within, asked.place, slack);
    if (members.empty()) fail("is empty: nothing lies there");
    all[asked.name] = std::move(members);
  }
}

std::string names_of(const NamedSets& sets) {
  std::vector<std::string> names;
  for (const auto& [name, members] : sets)
    if (!members.empty()) names.push_back(name);
  return names.empty() ? "none" : fmt::format("{}", fmt::join(names, ", "));
}

template <int Dim>
std::vector<OutlineFace<Dim>> faces_in(const Model<Dim>& model, const std::vector<int>& set) {
  std::vector<bool> is_in(model.position.size());
  for (int g : set) is_in[g] = true;
  auto faces = outline_of(model);
  std::erase_if(faces, [&](const OutlineFace<Dim>& face) {
    return std::ranges::any_of(face.gridpoints, [&](int g) { return !is_in[g]; });
  });
  return faces;
}

template <int Dim>
std::vector<double> tributary_areas(const std::vector<int>& set, const std::vector<OutlineFace<Dim>>& faces) {
  std::unordered_map<int, double> of_gridpoint;
  for (const auto& face : faces)
    for (int g : face.gridpoints) of_gridpoint[g] += face.area / Dim;
  std::vector<double> areas;
  for (int g : set) areas.push_back(of_gridpoint[g]);
  return areas;
}

template void add_sets(Model<2>&, const std::vector<SetParameters<2>>&);
template void add_sets(Model<3>&, const std::vector<SetParameters<3>>&);
template std::vector<OutlineFace<2>> faces_in(const Model<2>&, const std::vector<int>&);
template std::vector<OutlineFace<3>> faces_in(const Model<3>&, const std::vector<int>&);
template std::vector<double> tributary_areas(const std::vector<int>&, const std::vector<OutlineFace<2>>&);
template std::vector<double> tributary_areas(const std::vector<int>&, const std::vector<OutlineFace<3>>&);

}  // namespace pyroclast
