#include "pyroclast/model/loose_bodies.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <numeric>
#include <optional>
#include <utility>

#include <fmt/format.h>

#include "pyroclast/base/error.hpp"
#include "pyroclast/base/place_in.hpp"
#include "pyroclast/base/place_text.hpp"
#include "pyroclast/model/loose_zones.hpp"
#include "pyroclast/model/zone_shape.hpp"

namespace pyroclast {

namespace {

/// Depth over the edge of a body within which it only touches another block.
constexpr double kOnlyTouching = 1e-6;

/// Half of all space that holds a convex body.
template <int Dim>
struct HalfSpace {
  Vec<Dim> from{};    ///< place on its bound, m
  Vec<Dim> inward{};  ///< unit normal

  double depth(const Vec<Dim>& place) const { return dot(inward, place - from); }
};

std::vector<HalfSpace<2>> half_spaces(const LooseBody& body, const ModelOf<2>& /*model*/) {
  std::vector<HalfSpace<2>> result;
  const auto corners = corners_around(body);
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const Vec<2> along = corners[(i + 1) % corners.size()] - corners[i];
    result.push_back({corners[i], Vec<2>{{-along[1], along[0]}} * (1.0 / norm(along))});
  }
  return result;
}

std::vector<HalfSpace<3>> half_spaces(const LooseBody& body, const ModelOf<3>& /*model*/) {
  std::vector<HalfSpace<3>> result;
  for (const auto& face : body.faces) {
    const Vec<3>& from = body.corners[face[0]];
    Vec<3> outward{};
    for (std::size_t i = 2; i < face.size(); ++i)
      outward += cross(body.corners[face[i - 1]] - from, body.corners[face[i]] - from);
    result.push_back({from, outward * (-1.0 / norm(outward))});
  }
  return result;
}

/// Returns the half spaces of a zone.
template <int Dim>
std::array<HalfSpace<Dim>, Dim + 1> half_spaces(const std::array<Vec<Dim>, Dim + 1>& zone) {
  std::array<Vec<Dim>, Dim> gradient;
  shape_gradients<Dim, double>(zone, gradient);
  std::array<HalfSpace<Dim>, Dim + 1> result;
  Vec<Dim> last{};
  for (int n = 0; n < Dim; ++n) {
    result[n] = {zone[Dim], gradient[n] * (1.0 / norm(gradient[n]))};
    last -= gradient[n];
  }
  result[Dim] = {zone[0], last * (1.0 / norm(last))};
  return result;
}

/// Cuts off the part of a convex polygon, in the plane of an edge, that does not lie deeper than `depth` in a
/// half space (Sutherland and Hodgman).
template <int Dim>
void cut(std::vector<Vec<Dim>>& polygon, const HalfSpace<Dim>& half, double depth) {
  std::vector<Vec<Dim>> rest;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Vec<Dim>&from = polygon[i], &to = polygon[(i + 1) % polygon.size()];
    const double before = half.depth(from) - depth, after = half.depth(to) - depth;
    if (before > 0.0) rest.push_back(from);
    if ((before > 0.0) != (after > 0.0)) rest.push_back(from + (before / (before - after)) * (to - from));
  }
  polygon = std::move(rest);
}

/// Returns a place where a body lies in a block of the model; none where they at most touch. Where a convex
/// body and a zone have a part in common, a face of the zone reaches into the body, or all of the body lies
/// in the zone.
template <int Dim>
std::optional<Vec<Dim>> common_place(const ModelOf<Dim>& model, const LooseBody& body) {
  const double touching = kOnlyTouching * body.edge;
  const auto halves = half_spaces(body, model);
  std::array<std::pair<double, double>, Dim> box;
  for (int i = 0; i < Dim; ++i) {
    const auto [low, high] = std::ranges::minmax(body.corners, {}, [i](const Vec<3>& p) { return p[i]; });
    box[i] = {low[i], high[i]};
  }
  for (const auto& zone : model.zones) {
    std::array<Vec<Dim>, Dim + 1> x;
    for (int n = 0; n <= Dim; ++n) x[n] = model.position[zone[n]];
    bool is_near = true;
    for (int i = 0; i < Dim; ++i) {
      const auto [low, high] = std::ranges::minmax(x, {}, [i](const Vec<Dim>& p) { return p[i]; });
      is_near = is_near && high[i] >= box[i].first && low[i] <= box[i].second;
    }
    if (!is_near) continue;
    for (int opposite = 0; opposite <= Dim; ++opposite) {
      std::vector<Vec<Dim>> face;
      for (int n = 0; n <= Dim; ++n)
        if (n != opposite) face.push_back(x[n]);
      for (const auto& half : halves) cut(face, half, touching);
      if (face.empty()) continue;
      Vec<Dim> middle{};
      for (const Vec<Dim>& p : face) middle += p * (1.0 / static_cast<double>(face.size()));
      return middle;
    }
    const Vec<Dim> corner = resized<Dim>(body.corners.front());
    if (std::ranges::all_of(half_spaces<Dim>(x),
                            [&](const auto& half) { return half.depth(corner) > touching; }))
      return corner;
  }
  return std::nullopt;
}

void add_name(std::vector<std::string>& names, const std::string& name, int& count) {
  if (std::ranges::find(names, name) != names.end()) return;
  names.push_back(name);
  ++count;
}

}  // namespace

bool goes_round_convex_area(const LooseBody& body) {
  const auto round = corners_around(body);
  const std::size_t n = round.size();
  for (std::size_t i = 0; i < n; ++i)
    if (!(cross(round[(i + 1) % n] - round[i], round[(i + 2) % n] - round[i]) > 0.0)) return false;
  // corners that go round twice turn the same way at each of them too
  double turn = 0.0;
  for (std::size_t i = 0; i < n; ++i) {
    const Vec<2> u = round[(i + 1) % n] - round[i], v = round[(i + 2) % n] - round[(i + 1) % n];
    turn += std::atan2(cross(u, v), dot(u, v));
  }
  return n > 2 && turn < 3.0 * std::numbers::pi;
}

template <int Dim>
void add_loose_bodies(ModelOf<Dim>& model, const std::vector<LooseBody>& bodies) {
  for (const LooseBody& body : bodies) {
    const auto fail = [&](const std::string& why) {
      throw Error(fmt::format("{}: body \"{}\" {}", body.deck_place, body.name, why));
    };
    const std::string outline = body.name + "_outline";
    for (const std::string& set : {body.name, outline})
      if (model.sets.contains(set)) fail(fmt::format("needs a set \"{}\", but there is one already", set));
    if (const auto place = common_place(model, body))
      fail(fmt::format("lies in another block, at {} m", place_text(resized<3>(*place), Dim, "{:.6g}")));
    add_name(model.material_names, body.material, model.bearing_materials);
    add_name(model.interface_names, body.name, model.bearing_interfaces);
    const int first = model.gridpoint_count();
    const auto zoned = zones_of<Dim>(body);
    model.add_block(zoned.gridpoints, zoned.zones, place_in(model.material_names, body.material));
    auto& all = model.sets[body.name];
    all.resize(zoned.gridpoints.size());
    std::iota(all.begin(), all.end(), first);
    for (const int g : zoned.outline) model.sets[outline].push_back(first + g);
  }
}

template void add_loose_bodies(ModelOf<2>&, const std::vector<LooseBody>&);
template void add_loose_bodies(ModelOf<3>&, const std::vector<LooseBody>&);

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
