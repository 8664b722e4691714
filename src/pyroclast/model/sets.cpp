#include "pyroclast/model/sets.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <unordered_map>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "pyroclast/base/error.hpp"
#include "pyroclast/base/overloaded.hpp"
#include "pyroclast/base/sort_unique.hpp"
#include "pyroclast/model/outline.hpp"

namespace pyroclast {

namespace {

/// Largest distance from a bound, a line or a plane at which a point is on it, in sizes of the model.
constexpr double kOnBound = 1e-9;
/// Largest distance from the body of a place that is meant, in sizes of a block.
constexpr double kNear = 1.0;

double size_of(const Model& model) {
  double size = 0.0;
  for (int g = 0; g < model.gridpoint_count(); ++g)
    size = std::max(size, norm(model.place(g) - model.place(0)));
  return size;
}

/// Returns the distance of a point from a straight line between two others, m.
double distance(const Vec<3>& x, const OnLine& line) {
  const Vec<3> along = line.to - line.from;
  const double length2 = dot(along, along);
  const double share = length2 > 0.0 ? std::clamp(dot(x - line.from, along) / length2, 0.0, 1.0) : 0.0;
  return norm(x - (line.from + along * share));
}

bool holds(const Place& place, const Vec<3>& x, double slack) {
  return std::visit(Overloaded{
                        [](const Everywhere&) { return true; },
                        [&](const InBox& box) {
                          for (int i = 0; i < 3; ++i)
                            if (x[i] < box.low[i] - slack || x[i] > box.high[i] + slack) return false;
                          return true;
                        },
                        [&](const InBall& ball) { return norm(x - ball.centre) <= ball.radius + slack; },
                        [&](const OnLine& line) { return distance(x, line) <= slack; },
                        [](const NearestTo&) { return true; },
                    },
                    place);
}

/// Items of which a set may be made: the gridpoints or the contact of each item, the points that must lie in
/// the place, and its middle.
struct Items {
  std::vector<std::vector<int>> members;
  std::vector<std::vector<Vec<3>>> points;
  std::vector<Vec<3>> middle;

  void add(std::vector<int> of, std::vector<Vec<3>> at, const Vec<3>& in_the_middle) {
    members.push_back(std::move(of));
    points.push_back(std::move(at));
    middle.push_back(in_the_middle);
  }
};

/// Returns the distance of a point from the nearest gridpoint, m.
double distance_of(const Model& model, const Vec<3>& point) {
  double least = std::numeric_limits<double>::infinity();
  for (int g = 0; g < model.gridpoint_count(); ++g) least = std::min(least, norm(model.place(g) - point));
  return least;
}

/// Returns the size of the largest block that is of no bearing, m: the largest distance of its gridpoints
/// from its first.
double block_size(const Model& model) {
  double largest = 0.0;
  for (int block = 0; block < model.block_count(); ++block)
    for (int g = model.block_gridpoints[block];
         g < model.block_gridpoints[block + 1] && !model.is_of_bearing(block); ++g)
      largest = std::max(largest, norm(model.place(g) - model.place(model.block_gridpoints[block])));
  return largest;
}

/// Returns a point without the coordinate that a set does not read.
Vec<3> seen_by(const SetParameters& set, const Vec<3>& point) {
  return set.is_along_z ? Vec<3>{{point[0], point[1]}} : point;
}

Items items_of(const Model& model, const SetParameters& set) {
  Items items;
  const auto place = [&](int g) { return seen_by(set, model.place(g)); };
  const auto add_point = [&](int member, int g) { items.add({member}, {place(g)}, place(g)); };
  switch (set.of) {
    case SetOf::gridpoints:
      for (int g = 0; g < model.gridpoint_count(); ++g) add_point(g, g);
      break;
    case SetOf::faces:
      for (const Face& face : faces_of(model)) {
        std::vector<Vec<3>> corners;
        for (int g : face.gridpoints()) corners.push_back(place(g));
        items.add({face.gridpoints().begin(), face.gridpoints().end()}, corners, seen_by(set, face.centre));
      }
      break;
    case SetOf::blocks: {
      const auto middle = block_centroids(model);
      for (int block = 0; block < model.block_count(); ++block) {
        std::vector<int> members(model.block_gridpoints[block + 1] - model.block_gridpoints[block]);
        std::iota(members.begin(), members.end(), model.block_gridpoints[block]);
        const Vec<3> at = seen_by(set, middle[block]);
        items.add(std::move(members), {at}, at);
      }
      break;
    }
    case SetOf::contacts:
      for (int c = 0; c < model.contact_count(); ++c) add_point(c, model.joint(c).a);
      break;
  }
  return items;
}

/// Returns the members of the items that lie in the place and within another set, ascending.
std::vector<int> chosen(const Items& items, const std::vector<int>* within, const Place& place,
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
  const auto* nearest = std::get_if<NearestTo>(&place);
  if (nearest != nullptr)
    for (const auto i : candidates) reach = std::min(reach, norm(items.middle[i] - nearest->point) + slack);
  std::vector<int> result;
  for (const auto i : candidates) {
    const bool is_in =
        nearest != nullptr
            ? norm(items.middle[i] - nearest->point) <= reach
            : std::ranges::all_of(items.points[i], [&](const Vec<3>& x) { return holds(place, x, slack); });
    if (is_in) result.insert(result.end(), items.members[i].begin(), items.members[i].end());
  }
  sort_unique(result);
  return result;
}

}  // namespace

std::vector<Vec<3>> block_centroids(const Model& model) {
  const auto volume = model.zone_volumes();
  std::vector<Vec<3>> moment(model.block_count());
  std::vector<double> whole(model.block_count());
  for (int block = 0; block < model.block_count(); ++block) {
    for (int z = model.block_zones[block]; z < model.block_zones[block + 1]; ++z) {
      whole[block] += volume[z];
      for (int g : model.gridpoints_of_zone(z))
        moment[block] += volume[z] / (model.dimension() + 1) * model.place(g);
    }
    moment[block] = (1.0 / whole[block]) * moment[block];
  }
  return moment;
}

void add_sets(Model& model, const std::vector<SetParameters>& sets) {
  const double slack = kOnBound * size_of(model);
  for (const SetParameters& asked : sets) {
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
    const auto items = items_of(model, asked);
    if (const auto* nearest = std::get_if<NearestTo>(&asked.place))
      if (const double away = distance_of(model, nearest->point); away > kNear * block_size(model))
        fail(fmt::format(
            "takes the items nearest to a place that lies {:.4g} m from the body, more than a block is wide",
            away));
    auto members = chosen(items, within, asked.place, slack);
    if (members.empty()) fail("is empty: nothing lies there");
    all[asked.name] = std::move(members);
  }
}

void add_symmetry(Model& model, const std::vector<PlaneOfSymmetry>& planes) {
  const double slack = kOnBound * size_of(model);
  for (const PlaneOfSymmetry& plane : planes) {
    std::vector<int> its = model.set(plane.side);
    for (int block = 0; block < model.block_count(); ++block)
      if (model.is_of_bearing(block))
        for (int g = model.block_gridpoints[block]; g < model.block_gridpoints[block + 1]; ++g)
          if (std::abs(model.place(g)[plane.component] - plane.at) <= slack) its.push_back(g);
    sort_unique(its);
    model.sets[plane.set()] = std::move(its);
    model.symmetry.push_back(plane);
  }
}

std::string names_of(const NamedSets& sets) {
  std::vector<std::string> names;
  for (const auto& [name, members] : sets)
    if (!members.empty()) names.push_back(name);
  return names.empty() ? "none" : fmt::format("{}", fmt::join(names, ", "));
}

std::vector<Face> faces_of(const Model& model) {
  return with_dimension(model, [](const auto& of_dimension) {
    std::vector<Face> faces;
    const std::vector<bool> all(of_dimension.block_count(), true);
    for (const auto& face : outline(of_dimension, zone_geometry(of_dimension), all)) {
      Face added{{}, of_dimension.dimension(), resized<3>(face.centre), resized<3>(face.normal), face.area};
      std::ranges::copy(face.gridpoints, added.corner.begin());
      faces.push_back(added);
    }
    return faces;
  });
}

std::vector<Face> faces_in(const Model& model, const std::vector<int>& set) {
  std::vector<bool> is_in(model.gridpoint_count());
  for (int g : set) is_in[g] = true;
  auto faces = faces_of(model);
  const auto own = model.gridpoint_chunks().own();  // of foreign blocks a part may lack the neighbours
  std::erase_if(faces, [&](const Face& face) {
    return std::ranges::any_of(face.gridpoints(), [&](int g) { return !is_in[g] || !own.contain(g); });
  });
  return faces;
}

std::vector<double> tributary_areas(const std::vector<int>& set, const std::vector<Face>& faces) {
  std::unordered_map<int, double> of_gridpoint;
  for (const Face& face : faces)
    for (int g : face.gridpoints()) of_gridpoint[g] += face.area / face.corners;
  std::vector<double> areas;
  for (int g : set) areas.push_back(of_gridpoint[g]);
  return areas;
}

}  // namespace pyroclast
