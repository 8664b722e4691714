#include "pyroclast/specimen/prism.hpp"

#include <algorithm>
#include <array>
#include <limits>
#include <utility>

#include <fmt/format.h>

#include "pyroclast/base/error.hpp"

namespace pyroclast::specimen {

namespace {

/// Sine of the angle by which a corner may jut into the body by rounding.
constexpr double kStraight = 1e-9;

/// Throws Error unless a section is convex and whole.
void require_convex(const Region& section) {
  if (section.loops().size() > 1) throw Error("a solid cannot have holes yet");
  if (!section.notches().empty()) throw Error("a solid cannot have notches or slits yet");
  const auto& pieces = section.pieces();
  for (std::size_t i = 0; i < pieces.size(); ++i) {
    const auto& [from, corner, side] = pieces[i];
    const Vec<2> before = corner - from, after = pieces[(i + 1) % pieces.size()].to - corner;
    if (cross(before, after) < -kStraight * norm(before) * norm(after))
      throw Error(fmt::format(
          "the outline of a solid must be convex yet, but at ({:g}, {:g}) m a corner juts into the body",
          corner[0], corner[1]));
  }
}

}  // namespace

Prism::Prism(Region section, Axis axis, double length) : section_(std::move(section)), axis_(axis) {
  require_convex(section_);
  sides_ = section_.sides();
  for (const auto& [from, to, side] : section_.pieces()) {
    const Vec<2> along = to - from;
    const Vec<2> out = Vec<2>{{along[1], -along[0]}} * (1.0 / norm(along));
    planes_.push_back({in_space(out, axis_, 0.0), dot(out, from), side});
  }
  const int first_end = static_cast<int>(sides_.size());
  for (const char* const end : axis == Axis::z ? std::array{"front", "back"} : std::array{"bottom", "top"}) {
    if (find_side(sides_, end) >= 0)
      throw Error(fmt::format("a side of the section has the name of an end of the prism, \"{}\"", end));
    sides_.push_back({end});
  }
  planes_.push_back({in_space({}, axis_, -1.0), 0.0, first_end});
  planes_.push_back({in_space({}, axis_, 1.0), length, first_end + 1});
  low_ = in_space(section_.box().low, axis_, 0.0);
  high_ = in_space(section_.box().high, axis_, length);
  volume_ = section_.extent() * length;
}

Vec<3> in_space(const Vec<2>& of_section, Prism::Axis axis, double along) {
  if (axis == Prism::Axis::z) return {{of_section[0], of_section[1], along}};
  return {{of_section[1], along, of_section[0]}};
}

double Prism::distance(const Vec<3>& point) const {
  double farthest = -std::numeric_limits<double>::infinity();
  for (const Plane& plane : planes_) farthest = std::max(farthest, plane.distance(point));
  return farthest;
}

std::vector<FlatPart> Prism::flat_parts() const {
  std::vector<FlatPart> parts;
  for (const Plane& plane : planes_) parts.push_back({{}, plane.normal, plane.side});
  const auto& pieces = section_.pieces();
  for (std::size_t i = 0; i < pieces.size(); ++i) {
    const auto& [from, to, side] = pieces[i];
    parts[i].corners = {in_space(from, axis_, 0.0), in_space(to, axis_, 0.0), in_space(to, axis_, length()),
                        in_space(from, axis_, length())};
    for (const bool is_far : {false, true})
      parts[pieces.size() + (is_far ? 1 : 0)].corners.push_back(
          in_space(from, axis_, is_far ? length() : 0.0));
  }
  return parts;
}

Room<3> room_in(const Prism& body) {
  return {body.low(), body.high(), body.extent(),
          [&body](const Vec<3>& point) { return body.distance(point); }};
}

}  // namespace pyroclast::specimen
