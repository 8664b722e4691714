#include "pyroclast/specimen/walls.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>

#include <fmt/format.h>

#include "pyroclast/base/error.hpp"
#include "pyroclast/specimen/seed_pairs.hpp"

namespace pyroclast::specimen {
namespace {

/// Largest difference between the volume of the blocks and that of a body with holes or notches, as a share.
constexpr double kOff = 0.02;

/// Least angle by which walls turn at a corner that juts into the body and has a pair of its own, radians.
constexpr double kSharp = 2.0 / 3.0 * std::numbers::pi;
/// Distance of the seed within from such a corner, in spacings: one farther back would reach across the
/// walls.
constexpr double kBehindCorner = 0.1;

/// Returns the unit vector into the body at the corner between two walls; none where it is blunt, or juts
/// out.
std::optional<Vec<2>> way_into(const Piece& before, const Piece& after) {
  const Vec<2> a = before.to - before.from, b = after.to - after.from;
  if (std::atan2(-cross(a, b), dot(a, b)) < kSharp) return std::nullopt;
  const Vec<2> way = a * (1.0 / norm(a)) - b * (1.0 / norm(b));
  return way * (1.0 / norm(way));
}

/// Returns how far from its wall a seed stands, m: half of the way to the middle where another line of the
/// section is near.
/// \param way  unit vector across the wall
double depth_from(const Region& section, const Vec<2>& foot, const Vec<2>& way, double most) {
  constexpr double kStep = 0.9, kNearest = 0.999;
  const double nearest = std::abs(section.distance(foot + way * (1e-3 * most))) / (1e-3 * most);
  const auto is_wall_nearest = [&](double depth) {
    return std::abs(section.distance(foot + way * depth)) >= kNearest * nearest * depth;
  };
  if (is_wall_nearest(most)) return most;
  double depth = most;
  while (!is_wall_nearest(depth) && depth > 1e-3 * most) depth *= kStep;
  return 0.5 * depth;
}

}  // namespace

WallSeeds wall_seeds(const Prism& body, const BlockSizes& sizes) {
  WallSeeds seeds;
  const double length = body.length();
  const auto size_at = [&](const Vec<2>& place, double along) {
    return sizes.at(in_space(place, body.axis(), along));
  };
  // pairs along a line through the body: the line, the way into the body, and how deep the seed within stands
  const auto add_column = [&](const Vec<2>& at, const Vec<2>& into, bool is_shifted, double most_within) {
    const double size = size_at(at, 0.5 * length);
    const int rows =
        std::max(1, static_cast<int>(std::round(length / (kAlongSurface * size)))) + (is_shifted ? 1 : 0);
    for (int j = 0; j < rows; ++j) {
      const double along = (j + 0.5) / rows * length, spacing = size_at(at, along);
      for (const bool is_within : {false, true}) {
        const Vec<2> way = into * (is_within ? -1.0 : 1.0);
        const double from =
            depth_from(body.section(), at, way, (is_within ? most_within : kFromSurface) * spacing);
        seeds.positions.push_back(in_space(at + way * from, body.axis(), along));
        seeds.radii.push_back(std::sqrt(from * from + kPower * spacing * spacing));
        seeds.are_within.push_back(is_within ? 1 : 0);
      }
    }
  };
  const auto& walls = body.walls();
  for (std::size_t w = 0; w < walls.size(); ++w) {
    const Vec<2> way = walls[w].to - walls[w].from, into = out_of(walls[w]) * -1.0;
    const double size = size_at(walls[w].from + way * 0.5, 0.5 * length);
    const int columns = std::max(1, static_cast<int>(std::round(norm(way) / (kAlongSurface * size))));
    for (int i = 0; i < columns; ++i) {
      // walls that face each other have the same columns from both ends, every other of them shifted
      const int column = columns == 1 ? static_cast<int>(w) : std::min(i, columns - 1 - i);
      add_column(walls[w].from + way * ((i + 0.5) / columns), into, column % 2 == 1, kFromSurface);
    }
    const auto after =
        std::ranges::find_if(walls, [&](const Piece& wall) { return wall.from == walls[w].to; });
    if (after == walls.end()) continue;
    if (const auto into_corner = way_into(walls[w], *after))
      add_column(walls[w].to, *into_corner, true, kBehindCorner);
  }
  return seeds;
}

int nearest_wall(const Facet<3>& face, const Cells<3>& cells, const Prism& body) {
  Vec<3> mean{};
  for (const int v : face.corners)
    mean += cells.vertices[v] * (1.0 / static_cast<double>(face.corners.size()));
  const Vec<2> at = body.in_section(mean);
  const auto wall = std::ranges::min_element(
      body.walls(), {}, [&](const Piece& piece) { return distance_from_segment(at, piece.from, piece.to); });
  return wall->side;
}

void take_out(Cells<3>& cells, const std::vector<char>& is_out, const Prism& body) {
  std::vector<int> number(cells.cells.size(), -1);
  int left = 0;
  for (std::size_t cell = 0; cell < number.size(); ++cell)
    if (!is_out[cell]) number[cell] = left++;
  std::vector<int> number_of_face(cells.faces.size(), -1), number_of_vertex(cells.vertices.size(), -1);
  std::vector<Facet<3>> faces;
  std::vector<Vec<3>> vertices;
  for (std::size_t f = 0; f < cells.faces.size(); ++f) {
    Facet<3> face = cells.faces[f];
    const bool was_within = face.outer >= 0;
    const int inner = number[face.inner], outer = was_within ? number[face.outer] : -1;
    if (inner < 0 && outer < 0) continue;
    if (was_within && (inner < 0 || outer < 0)) face.side = nearest_wall(face, cells, body);
    if (inner < 0) std::reverse(face.corners.begin() + 1, face.corners.end());  // the first begins the fan
    face.inner = inner < 0 ? outer : inner;
    face.outer = inner < 0 ? -1 : outer;
    for (int& v : face.corners) {
      if (number_of_vertex[v] < 0) {
        number_of_vertex[v] = static_cast<int>(vertices.size());
        vertices.push_back(cells.vertices[v]);
      }
      v = number_of_vertex[v];
    }
    number_of_face[f] = static_cast<int>(faces.size());
    faces.push_back(std::move(face));
  }
  std::vector<std::vector<int>> kept;
  for (std::size_t cell = 0; cell < number.size(); ++cell) {
    if (is_out[cell]) continue;
    for (int& f : cells.cells[cell]) f = number_of_face[f];
    kept.push_back(std::move(cells.cells[cell]));
  }
  cells = {std::move(vertices), std::move(faces), std::move(kept)};
}

void require_filled(const Cells<3>& cells, const Prism& body, const std::string& what) {
  double filled = 0.0;
  for (std::size_t cell = 0; cell < cells.cells.size(); ++cell) filled += extent(cells, cell);
  if (std::abs(filled - body.extent()) <= kOff * body.extent()) return;
  throw Error(
      fmt::format("{}: they fill {:.6g} m3, but the body without its holes and notches has {:.6g} m3: "
                  "blocks are too large to follow the walls, take more",
                  what, filled, body.extent()));
}

}  // namespace pyroclast::specimen
