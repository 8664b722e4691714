#include "pyroclast/solid/superposition.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <numeric>

#include "pyroclast/specimen/gradation.hpp"
#include "pyroclast/specimen/grain_grid.hpp"

namespace pyroclast::solid {

namespace {

/// Returns the solid angle of the triangle (a, b, c) seen from the origin, signed by its sense (van Oosterom
/// and Strackee, IEEE Trans. Biomed. Eng. 30 (1983) 125).
double solid_angle(const Vec<3>& a, const Vec<3>& b, const Vec<3>& c) {
  const double la = norm(a), lb = norm(b), lc = norm(c);
  return 2.0 *
         std::atan2(dot(a, cross(b, c)), la * lb * lc + dot(a, b) * lc + dot(b, c) * la + dot(c, a) * lb);
}

/// Returns the volume that the tetrahedron of the origin and a triangle has in common with the ball around
/// the origin, signed by the sense of the triangle. The ball cuts a disc out of the triangle's plane. Over
/// the part of the triangle in that disc stands a pyramid, over the rest a sector of the ball.
double common_volume_of_tetrahedron(const std::array<Vec<3>, 3>& corner, double radius) {
  const Vec<3> doubled = cross(corner[1] - corner[0], corner[2] - corner[0]);
  const double length = norm(doubled);
  if (length == 0.0) return 0.0;
  const Vec<3> normal = doubled * (1.0 / length);
  const double distance = dot(normal, corner[0]);
  const double sector = radius * radius * radius / 3.0;
  const double all = solid_angle(corner[0], corner[1], corner[2]);
  if (std::abs(distance) >= radius) return sector * all;
  const Vec<3> foot = normal * distance;
  const double of_disc = std::sqrt(radius * radius - distance * distance);
  // solid angle of a part of the disc, over its angle at the foot
  const double a_radian = std::copysign(1.0 - std::abs(distance) / radius, distance);
  double area = 0.0, angle = 0.0;  // of the part of the triangle in the disc
  for (int i = 0; i < 3; ++i) {
    const Vec<3> a = corner[i] - foot, ab = corner[(i + 1) % 3] - corner[i];
    const double squared = dot(ab, ab);
    const double middle = -dot(a, ab) / squared;
    const double discriminant = middle * middle - (dot(a, a) - of_disc * of_disc) / squared;
    const double half = discriminant > 0.0 ? std::sqrt(discriminant) : 0.0;
    const double enter = std::clamp(middle - half, 0.0, 1.0), leave = std::clamp(middle + half, 0.0, 1.0);
    const auto turn = [&](double from, double to) {
      const Vec<3> p = a + ab * from, q = a + ab * to;
      return std::atan2(dot(normal, cross(p, q)), dot(p, q));
    };
    const auto add_sector = [&](double from, double to) {
      const double turned = turn(from, to);
      area += 0.5 * of_disc * of_disc * turned;
      angle += a_radian * turned;
    };
    if (discriminant <= 0.0 || enter >= leave) {
      add_sector(0.0, 1.0);
      continue;
    }
    const Vec<3> p = a + ab * enter, q = a + ab * leave;
    area += 0.5 * dot(normal, cross(p, q));
    angle += solid_angle(foot, foot + p, foot + q);
    if (enter > 0.0) add_sector(0.0, enter);
    if (leave < 1.0) add_sector(leave, 1.0);
  }
  return distance * area / 3.0 + sector * (all - angle);
}

/// Share of a cell that a ball covers.
struct Cover {
  int cell;
  int ball;
  double volume;  ///< m³
};

/// Returns the covers of all cells, cell by cell.
std::vector<Cover> covers_of(const Complex& complex, const Prism& body, const std::vector<Ball>& balls) {
  const specimen::GrainGrid<3> grid(body.low(), body.high(), balls);
  std::vector<Cover> covers;
  std::vector<int> nearby;
  for (std::size_t cell = 0; cell < complex.cells.size(); ++cell) {
    Vec<3> lower = complex.vertices[complex.faces[complex.cells[cell].front()].corners.front()];
    Vec<3> upper = lower;
    for (const int face : complex.cells[cell])
      for (const int v : complex.faces[face].corners)
        for (int d = 0; d < 3; ++d) {
          lower[d] = std::min(lower[d], complex.vertices[v][d]);
          upper[d] = std::max(upper[d], complex.vertices[v][d]);
        }
    grid.collect(lower, upper, nearby);
    for (const int ball : nearby) {
      const double common = common_volume(complex, cell, balls[ball].centre, 0.5 * balls[ball].diameter);
      if (common > 0.0) covers.push_back({static_cast<int>(cell), ball, common});
    }
  }
  return covers;
}

/// Returns the ball around the centroid of each cell.
std::vector<int> balls_at_centroids(const Complex& complex, const Prism& body,
                                    const std::vector<Ball>& balls) {
  const specimen::GrainGrid<3> grid(body.low(), body.high(), balls);
  std::vector<int> grain, nearby;
  for (std::size_t cell = 0; cell < complex.cells.size(); ++cell) {
    const Vec<3> centre = zone_cell(complex, cell).gridpoints.back();
    grid.collect(centre, centre, nearby);
    const auto around = std::ranges::find_if(
        nearby, [&](int ball) { return norm(centre - balls[ball].centre) <= 0.5 * balls[ball].diameter; });
    grain.push_back(around == nearby.end() ? -1 : *around);
  }
  return grain;
}

/// Gives each ball, the largest first, the cell of which it covers most and that none took before, while that
/// brings the volume of the cells nearer to that of the balls. Returns the volume that is missing then, m³.
double give_each_its_cell(const Complex& complex, const std::vector<Ball>& balls,
                          const std::vector<Cover>& covers, std::vector<int>& grain) {
  std::vector<std::vector<Cover>> of_ball(balls.size());
  for (const Cover& cover : covers) of_ball[cover.ball].push_back(cover);
  std::vector<int> order(balls.size());
  std::iota(order.begin(), order.end(), 0);
  std::ranges::stable_sort(order, std::greater<>(), [&](int ball) { return balls[ball].diameter; });
  double missing = 0.0;
  for (const Ball& ball : balls) missing += specimen::extent_of_round<3>(ball.diameter);
  for (const int ball : order) {
    std::ranges::stable_sort(of_ball[ball], std::greater<>(), &Cover::volume);
    const auto free = std::ranges::find_if(of_ball[ball], [&](const Cover& c) { return grain[c.cell] < 0; });
    if (free == of_ball[ball].end()) continue;
    const double taken = volume(complex, free->cell);
    if (0.5 * taken >= missing) break;
    missing -= taken;
    grain[free->cell] = ball;
  }
  return missing;
}

}  // namespace

double common_volume(const Complex& complex, std::size_t cell, const Vec<3>& centre, double radius) {
  // A centre in the very plane of a face would see it from both sides.
  const Vec<3> beside = centre + Vec<3>{{1.1e-10, 0.7e-10, 1.3e-10}} * radius;
  double volume = 0.0;
  const auto& at = complex.vertices;
  for_each_triangle(complex, cell, [&](int a, int b, int c) {
    volume += common_volume_of_tetrahedron({at[a] - beside, at[b] - beside, at[c] - beside}, radius);
  });
  constexpr double kRounding = 1e-12;  // left by a ball that does not touch the cell
  const double ball = specimen::extent_of_round<3>(2.0 * radius);
  return volume < kRounding * ball ? 0.0 : volume;
}

SuperposedBalls superpose(const Complex& complex, const Prism& body, const std::vector<Ball>& balls,
                          const specimen::SpecimenParameters& parameters) {
  SuperposedBalls result{std::vector<int>(complex.cells.size(), -1), parameters.covered_fraction};
  if (balls.empty()) return result;
  if (parameters.superposition == specimen::Superposition::centroid) {
    result.grain = balls_at_centroids(complex, body, balls);
    return result;
  }
  const std::vector<Cover> covers = covers_of(complex, body, balls);
  struct Covered {
    int cell;
    double volume = 0.0, share = 0.0;
    int most = -1;  // ball that covers most of it
  };
  std::vector<Covered> cells;
  for (std::size_t i = 0; i < covers.size();) {
    Covered of{covers[i].cell, volume(complex, covers[i].cell)};
    double covered = 0.0, largest = 0.0;
    for (; i < covers.size() && covers[i].cell == of.cell; ++i) {
      covered += covers[i].volume;
      if (covers[i].volume <= largest) continue;
      largest = covers[i].volume;
      of.most = covers[i].ball;
    }
    of.share = std::min(covered / of.volume, 1.0);
    cells.push_back(of);
  }
  if (parameters.superposition == specimen::Superposition::fit) {
    double missing = give_each_its_cell(complex, balls, covers, result.grain);
    std::ranges::stable_sort(cells, std::greater<>(), &Covered::share);
    // cells become aggregate, the most covered first, while that brings their volume nearer to the balls'
    result.covered_fraction = std::nextafter(1.0, 0.0);
    for (const Covered& cell : cells) {
      if (result.grain[cell.cell] >= 0) continue;
      if (0.5 * cell.volume >= missing) break;
      missing -= cell.volume;
      result.grain[cell.cell] = cell.most;
      result.covered_fraction = cell.share;
    }
    return result;
  }
  for (const Covered& cell : cells)
    if (cell.share > parameters.covered_fraction) result.grain[cell.cell] = cell.most;
  return result;
}

}  // namespace pyroclast::solid
