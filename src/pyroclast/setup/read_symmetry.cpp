#include "pyroclast/setup/read_symmetry.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "pyroclast/setup/make_body.hpp"

namespace pyroclast {

namespace {

/// Distance from a plane that counts as none, over the size of the specimen; and sine of such an angle.
constexpr double kInPlane = 1e-9;

/// Returns the plane of a side; none where it does not lie in one plane across an axis, at an end of the
/// specimen along that axis.
std::optional<PlaneOfSymmetry> plane_of(const specimen::SpecimenParameters& specimen, int side) {
  auto parts = specimen.flat_parts();
  std::erase_if(parts, [&](const specimen::FlatPart& part) {
    return part.side != side && specimen.sides()[part.side].part_of != side;
  });
  if (parts.empty()) return std::nullopt;
  const double size = norm(specimen.high() - specimen.low());
  for (int c = 0; c < specimen.dimension(); ++c) {
    const double sign = parts.front().normal[c];
    if (std::abs(sign) < 1.0 - kInPlane) continue;
    const double at = sign < 0.0 ? specimen.low()[c] : specimen.high()[c];
    const bool is_plane = std::ranges::all_of(parts, [&](const specimen::FlatPart& part) {
      return part.normal[c] * sign > 1.0 - kInPlane &&
             std::abs(part.corners.front()[c] - at) < kInPlane * size;
    });
    return is_plane ? std::optional(PlaneOfSymmetry{"", c, at, ""}) : std::nullopt;
  }
  return std::nullopt;
}

}  // namespace

std::vector<PlaneOfSymmetry> read_symmetry(const Section& root, const specimen::SpecimenParameters& specimen,
                                           const std::vector<Bearing>& bearings) {
  const Section s = root.section("specimen");
  const bool is_known = is_outline_known(root, specimen);
  const auto sides = specimen::names_of(specimen.sides());
  std::vector<PlaneOfSymmetry> planes;
  for (const std::string& name : s.optional_texts(
           "symmetry",
           "sides in planes of symmetry, such as [\"left\"]: they are held along their normals, and "
           "the specimen is a half or a quarter; see [Symmetry](../do/bodies.md#symmetry)")) {
    if (!is_known) return {};
    const auto found = std::ranges::find(sides, name);
    if (found == sides.end()) {
      s.error("symmetry", fmt::format("must name sides, {}; got \"{}\"", fmt::join(sides, ", "), name));
      return {};
    }
    const int side = static_cast<int>(found - sides.begin());
    const auto pressed = std::ranges::find(bearings, name, &Bearing::side);
    auto plane = plane_of(specimen, side);
    if (pressed != bearings.end()) {
      s.error("symmetry",
              fmt::format("\"{}\" is pressed by {}: a side with a bearing is no plane of symmetry", name,
                          pressed->name));
    } else if (!plane) {
      s.error("symmetry", fmt::format("\"{}\" does not lie in a plane across x{} at an end of the specimen",
                                      name, specimen.dimension() == 2 ? " or y" : ", y or z"));
    } else if (const auto facing = std::ranges::find(planes, plane->component, &PlaneOfSymmetry::component);
               facing != planes.end()) {
      s.error("symmetry",
              facing->side == name
                  ? fmt::format("names \"{}\" twice", name)
                  : fmt::format("\"{}\" and \"{}\" face each other, so that nothing between them could "
                                "widen: hold one of them by a drive",
                                facing->side, name));
    } else {
      plane->side = name;
      plane->deck_place = fmt::format("{}: {}.symmetry", s.where("symmetry"), s.path());
      planes.push_back(std::move(*plane));
      continue;
    }
    return {};
  }
  return planes;
}

}  // namespace pyroclast
