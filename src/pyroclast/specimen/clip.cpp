#include "pyroclast/specimen/clip.hpp"

#include <algorithm>
#include <utility>

namespace pyroclast::specimen {
namespace {

/// Tells whether a piece runs through the inside of a convex polygon.
bool crosses(const std::vector<Vec<2>>& polygon, const Piece& piece, double tolerance) {
  const Vec<2> along = piece.to - piece.from;
  double enters = 0.0, leaves = 1.0;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Vec<2> edge = polygon[(i + 1) % polygon.size()] - polygon[i];
    const double length = norm(edge);
    if (length <= tolerance) continue;
    const Vec<2> inward = Vec<2>{{-edge[1], edge[0]}} * (1.0 / length);
    const double start = dot(piece.from - polygon[i], inward) - tolerance, rate = dot(along, inward);
    if (start <= 0.0 && start + rate <= 0.0) return false;
    if (rate > 0.0)
      enters = std::max(enters, -start / rate);
    else if (rate < 0.0)
      leaves = std::min(leaves, -start / rate);
  }
  return (leaves - enters) * norm(along) > tolerance;
}

/// Returns the part of a polygon that lies on the left of a line, or on it.
std::vector<Vec<2>> left_of(const std::vector<Vec<2>>& polygon, const Piece& line, double tolerance) {
  const Vec<2> along = (line.to - line.from) * (1.0 / norm(line.to - line.from));
  const auto side = [&](const Vec<2>& p) {
    const double distance = cross(along, p - line.from);
    return std::abs(distance) <= tolerance ? 0.0 : distance;
  };
  std::vector<Vec<2>> kept;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Vec<2>&p = polygon[i], &q = polygon[(i + 1) % polygon.size()];
    const double a = side(p), b = side(q);
    if (a >= 0.0) kept.push_back(p);
    if (a * b < 0.0) kept.push_back(p + (q - p) * (a / (a - b)));
  }
  return kept;
}

}  // namespace

bool clip(std::vector<Vec<2>>& polygon, const Vec<2>& seed, std::span<const Piece> pieces, double tolerance) {
  if (pieces.empty() || polygon.size() < 3) return true;
  const Box box = box_of(polygon);
  std::vector<std::pair<double, const Piece*>> near;
  for (const Piece& piece : pieces)
    if (box_of(std::array{piece.from, piece.to}).touches(box))
      near.emplace_back(distance_from_segment(seed, piece.from, piece.to), &piece);
  std::ranges::sort(near);
  // the nearest piece comes first, for it may hide others behind it
  for (const auto& [distance, piece] : near) {
    if (!crosses(polygon, *piece, tolerance)) continue;
    if (!(cross(piece->to - piece->from, seed - piece->from) > 0.0)) return false;
    polygon = left_of(polygon, *piece, tolerance);
    if (polygon.size() < 3) return false;
  }
  return true;
}

}  // namespace pyroclast::specimen
