#include "pyroclast/model/loose_bodies.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>

#include <fmt/format.h>

#include "pyroclast/base/error.hpp"
#include "pyroclast/base/place_in.hpp"

namespace pyroclast {

namespace {

/// Depth over the edge of a body within which it only touches another block.
constexpr double kOnlyTouching = 1e-6;
/// Radius of the innermost ring of zones over that of the outline.
constexpr double kInnermostRing = 0.25;

double area_of_triangle(const Vec<2>& a, const Vec<2>& b, const Vec<2>& c) {
  const Vec<2> u = b - a, v = c - a;
  return 0.5 * (u[0] * v[1] - u[1] * v[0]);
}

/// Returns the corners counter-clockwise.
std::vector<Vec<2>> counter_clockwise(std::vector<Vec<2>> corners) {
  double area = 0.0;
  for (std::size_t i = 2; i < corners.size(); ++i)
    area += area_of_triangle(corners[0], corners[i - 1], corners[i]);
  if (area < 0.0) std::ranges::reverse(corners);
  return corners;
}

/// Zones of a body, and its outline.
struct ZonedBody {
  std::vector<Vec<2>> gridpoints;
  std::vector<std::array<int, 3>> zones;
  std::vector<int> outline;  ///< gridpoints, counter-clockwise
};

int edges_along(double length, double edge) {
  return std::max(1, static_cast<int>(std::lround(length / edge)));
}

/// Returns a grid of zones over four corners, counter-clockwise.
ZonedBody grid_of(const std::vector<Vec<2>>& c, double edge) {
  const int columns = edges_along(std::max(norm(c[1] - c[0]), norm(c[2] - c[3])), edge),
            rows = edges_along(std::max(norm(c[2] - c[1]), norm(c[3] - c[0])), edge);
  ZonedBody body;
  for (int j = 0; j <= rows; ++j)
    for (int i = 0; i <= columns; ++i) {
      const double x = static_cast<double>(i) / columns, y = static_cast<double>(j) / rows;
      body.gridpoints.push_back((1.0 - y) * ((1.0 - x) * c[0] + x * c[1]) +
                                y * ((1.0 - x) * c[3] + x * c[2]));
    }
  const auto at = [&](int i, int j) { return j * (columns + 1) + i; };
  for (int j = 0; j < rows; ++j)
    for (int i = 0; i < columns; ++i) {
      const int p = at(i, j), q = at(i + 1, j), s = at(i, j + 1), t = at(i + 1, j + 1);
      // diagonals alternate, so that the body has no preferred direction
      if ((i + j) % 2 == 0)
        body.zones.insert(body.zones.end(), {{p, q, t}, {p, t, s}});
      else
        body.zones.insert(body.zones.end(), {{p, q, s}, {q, t, s}});
    }
  for (int i = 0; i < columns; ++i) body.outline.push_back(at(i, 0));
  for (int j = 0; j < rows; ++j) body.outline.push_back(at(columns, j));
  for (int i = columns; i > 0; --i) body.outline.push_back(at(i, rows));
  for (int j = rows; j > 0; --j) body.outline.push_back(at(0, j));
  return body;
}

/// Returns rings of zones around the centroid of corners, counter-clockwise. Each ring is about as high as
/// its zones are wide.
ZonedBody rings_of(const std::vector<Vec<2>>& corners, double edge) {
  std::vector<Vec<2>> outline;
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const Vec<2>&from = corners[i], &to = corners[(i + 1) % corners.size()];
    const int edges = edges_along(norm(to - from), edge);
    for (int k = 0; k < edges; ++k) outline.push_back(from + (static_cast<double>(k) / edges) * (to - from));
  }
  Vec<2> moment{};
  double area = 0.0;
  for (std::size_t i = 2; i < corners.size(); ++i) {
    const double of_triangle = area_of_triangle(corners[0], corners[i - 1], corners[i]);
    moment += (corners[0] + corners[i - 1] + corners[i]) * (of_triangle / 3.0);
    area += of_triangle;
  }
  const Vec<2> middle = moment * (1.0 / area);
  const int around = static_cast<int>(outline.size());
  const double shrink = 1.0 - 2.0 * std::numbers::pi / std::max(around, 8);
  ZonedBody body;
  int rings = 0;
  for (double scale = 1.0; scale == 1.0 || scale > kInnermostRing; scale *= shrink, ++rings)
    for (const Vec<2>& p : outline) body.gridpoints.push_back(middle + scale * (p - middle));
  const int centre = static_cast<int>(body.gridpoints.size());
  body.gridpoints.push_back(middle);
  for (int ring = 0; ring < rings; ++ring)
    for (int i = 0; i < around; ++i) {
      const int p = ring * around + i, q = ring * around + (i + 1) % around;
      if (ring + 1 == rings) {
        body.zones.push_back({p, q, centre});
        continue;
      }
      const int s = p + around, t = q + around;
      if ((ring + i) % 2 == 0)
        body.zones.insert(body.zones.end(), {{p, q, t}, {p, t, s}});
      else
        body.zones.insert(body.zones.end(), {{p, q, s}, {q, t, s}});
    }
  body.outline.resize(static_cast<std::size_t>(around));
  std::iota(body.outline.begin(), body.outline.end(), 0);
  return body;
}

/// Returns the depth of a point in a convex area whose corners go counter-clockwise, m; negative outside.
double depth_in(const std::vector<Vec<2>>& corners, const Vec<2>& point) {
  double depth = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const Vec<2>&from = corners[i], &to = corners[(i + 1) % corners.size()];
    depth = std::min(depth, 2.0 * area_of_triangle(from, to, point) / norm(to - from));
  }
  return depth;
}

/// Returns a place of the model that lies in the body, or of the body that lies in a block; none where they
/// at most touch.
const Vec<2>* common_place(const ModelOf<2>& model, const ZonedBody& body, const std::vector<Vec<2>>& corners,
                           double touching) {
  for (const Vec<2>& place : model.position)
    if (depth_in(corners, place) > touching) return &place;
  Vec<2> low = corners.front(), high = corners.front();
  for (const Vec<2>& p : corners)
    for (int i = 0; i < 2; ++i) {
      low[i] = std::min(low[i], p[i]);
      high[i] = std::max(high[i], p[i]);
    }
  for (const auto& zone : model.zones) {
    const std::vector<Vec<2>> triangle{model.position[zone[0]], model.position[zone[1]],
                                       model.position[zone[2]]};
    bool meets = true;
    for (int i = 0; i < 2; ++i) {
      const auto [least, most] = std::minmax({triangle[0][i], triangle[1][i], triangle[2][i]});
      meets = meets && most >= low[i] && least <= high[i];
    }
    if (!meets) continue;
    for (const int g : body.outline)
      if (depth_in(triangle, body.gridpoints[g]) > touching) return &body.gridpoints[g];
  }
  return nullptr;
}

void add_name(std::vector<std::string>& names, const std::string& name, int& count) {
  if (std::ranges::find(names, name) != names.end()) return;
  names.push_back(name);
  ++count;
}

}  // namespace

bool is_convex(const std::vector<Vec<2>>& corners) {
  const auto round = counter_clockwise(corners);
  const std::size_t n = round.size();
  for (std::size_t i = 0; i < n; ++i)
    if (!(area_of_triangle(round[i], round[(i + 1) % n], round[(i + 2) % n]) > 0.0)) return false;
  // corners that go round twice turn the same way at each of them too
  double turn = 0.0;
  for (std::size_t i = 0; i < n; ++i) {
    const Vec<2> u = round[(i + 1) % n] - round[i], v = round[(i + 2) % n] - round[(i + 1) % n];
    turn += std::atan2(u[0] * v[1] - u[1] * v[0], dot(u, v));
  }
  return n > 2 && turn < 3.0 * std::numbers::pi;
}

void add_loose_bodies(ModelOf<2>& model, const std::vector<LooseBody>& bodies) {
  for (const LooseBody& body : bodies) {
    const auto fail = [&](const std::string& why) {
      throw Error(fmt::format("{}: body \"{}\" {}", body.deck_place, body.name, why));
    };
    const std::string outline = body.name + "_outline";
    for (const std::string& set : {body.name, outline})
      if (model.sets.contains(set)) fail(fmt::format("needs a set \"{}\", but there is one already", set));
    const auto corners = counter_clockwise(body.corners);
    const ZonedBody zoned = corners.size() == 4 ? grid_of(corners, body.edge) : rings_of(corners, body.edge);
    if (const Vec<2>* place = common_place(model, zoned, corners, kOnlyTouching * body.edge))
      fail(fmt::format("lies in another block, at [{:.6g} m, {:.6g} m]", (*place)[0], (*place)[1]));
    add_name(model.material_names, body.material, model.bearing_materials);
    add_name(model.interface_names, body.name, model.bearing_interfaces);
    const int first = model.gridpoint_count();
    model.add_block(zoned.gridpoints, zoned.zones, place_in(model.material_names, body.material));
    auto& all = model.sets[body.name];
    all.resize(zoned.gridpoints.size());
    std::iota(all.begin(), all.end(), first);
    for (const int g : zoned.outline) model.sets[outline].push_back(first + g);
  }
}

std::vector<int> interfaces_of_loose_bodies(const Model& model) {
  std::vector<bool> joins(model.interface_names.size());
  for (int c = 0; c < model.contact_count(); ++c) joins[model.joint(c).interface] = true;
  std::vector<int> interfaces(static_cast<std::size_t>(model.block_count()), -1);
  const int count = static_cast<int>(model.interface_names.size());
  for (int i = count - model.bearing_interfaces; i < count; ++i) {
    const auto set = model.sets.find(model.interface_names[i]);
    if (!joins[i] && set != model.sets.end() && !set->second.empty())
      interfaces[model.block_of(set->second.front())] = i;
  }
  return interfaces;
}

}  // namespace pyroclast
