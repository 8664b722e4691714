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

/// Returns the outward unit normals of all faces of a side.
std::vector<Vec<3>> normals_of(const AskedSpecimen& specimen, int side) {
  std::vector<Vec<3>> normals;
  if (specimen.prism) {
    for (const specimen::Plane& plane : specimen.prism->planes())
      if (plane.side == side || specimen.prism->sides()[plane.side].part_of == side)
        normals.push_back(plane.normal);
    return normals;
  }
  const auto& sides = specimen.region.sides();
  for (const specimen::Piece& piece : specimen.region.pieces()) {
    if (piece.side != side && sides[piece.side].part_of != side) continue;
    const Vec<2> along = piece.to - piece.from;
    normals.push_back(Vec<3>{{along[1], -along[0], 0.0}} * (1.0 / norm(along)));
  }
  return normals;
}

/// Returns the plane of a side; none where it does not lie in one plane across an axis, at an end of the
/// specimen along that axis.
std::optional<PlaneOfSymmetry> plane_of(const AskedSpecimen& specimen, int side) {
  const auto normals = normals_of(specimen, side);
  if (normals.empty()) return std::nullopt;
  for (int c = 0; c < specimen.dimension(); ++c) {
    const double sign = normals.front()[c];
    if (std::abs(sign) < 1.0 - kInPlane) continue;
    if (!std::ranges::all_of(normals, [&](const Vec<3>& n) { return n[c] * sign > 1.0 - kInPlane; }))
      return std::nullopt;
    return PlaneOfSymmetry{"", c, sign < 0.0 ? specimen.low()[c] : specimen.high()[c], ""};
  }
  return std::nullopt;
}

/// Tells whether a side lies at the end of the specimen where its plane is.
bool ends_there(const AskedSpecimen& specimen, int side, const PlaneOfSymmetry& plane) {
  if (specimen.prism) return true;  // sections are convex
  const double size = norm(specimen.high() - specimen.low());
  return std::ranges::all_of(specimen.region.pieces(), [&](const specimen::Piece& piece) {
    return piece.side != side || std::abs(piece.from[plane.component] - plane.at) < kInPlane * size;
  });
}

}  // namespace

std::vector<PlaneOfSymmetry> read_symmetry(const Section& root, const AskedSpecimen& specimen,
                                           const std::vector<Bearing>& bearings) {
  const Section s = root.section("specimen");
  const bool is_known = is_outline_known(root, specimen);
  const auto sides = specimen.sides();
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
    } else if (!plane || !ends_there(specimen, side, *plane)) {
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
