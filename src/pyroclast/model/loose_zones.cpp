#include "pyroclast/model/loose_zones.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <numeric>
#include <utility>

#include "pyroclast/model/solid_zones.hpp"

namespace pyroclast {

namespace {

/// Radius of the innermost ring of zones, and of the innermost shell, over that of the outline.
constexpr double kInnermostRing = 0.25, kInnermostShell = 0.5;
/// Longest edge on the surface of a solid over the edge that is asked for.
constexpr double kLongestEdge = 1.5;

using Triangle = std::array<int, 3>;

int edges_along(double length, double edge) {
  return std::max(1, static_cast<int>(std::lround(length / edge)));
}

double area_of_triangle(const Vec<2>& a, const Vec<2>& b, const Vec<2>& c) {
  const Vec<2> u = b - a, v = c - a;
  return 0.5 * (u[0] * v[1] - u[1] * v[0]);
}

/// Returns a grid of zones over four corners, counter-clockwise.
LooseZones<2> grid_of(const std::vector<Vec<2>>& c, double edge) {
  const int columns = edges_along(std::max(norm(c[1] - c[0]), norm(c[2] - c[3])), edge),
            rows = edges_along(std::max(norm(c[2] - c[1]), norm(c[3] - c[0])), edge);
  LooseZones<2> body;
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
LooseZones<2> rings_of(const std::vector<Vec<2>>& corners, double edge) {
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
  LooseZones<2> body;
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

/// Returns the corners of a body with the faces of a box, [x][y][z] of a cube; none of another body.
std::vector<Vec<3>> corners_of_box(const LooseBody& body) {
  const auto& faces = body.faces;
  if (body.corners.size() != 8 || faces.size() != 6 ||
      !std::ranges::all_of(faces, [](const auto& face) { return face.size() == 4; }))
    return {};
  const auto& base = faces.front();
  const auto is_low = [&](int corner) { return std::ranges::find(base, corner) != base.end(); };
  std::vector<Vec<3>> box(8);
  for (int i = 0; i < 4; ++i) {
    const int low = base[i];
    const int at = i == 0 ? 0 : i == 1 ? 4 : i == 2 ? 6 : 2;
    box[at] = body.corners[low];
    for (const auto& face : faces)
      for (int k = 0; k < 4; ++k)
        if (face[k] == low && !is_low(face[(k + 1) % 4])) box[at + 1] = body.corners[face[(k + 1) % 4]];
  }
  return box;
}

/// Returns a grid of cells with five zones each.
/// \param c  corners, see corners_of_box
LooseZones<3> grid_of_box(const std::vector<Vec<3>>& c, double edge) {
  std::array<int, 3> cells{};
  for (int axis = 0; axis < 3; ++axis) {
    const int step = 4 >> axis;
    double longest = 0.0;
    for (int i = 0; i < 8; ++i)
      if ((i & step) == 0) longest = std::max(longest, norm(c[i + step] - c[i]));
    cells[axis] = edges_along(longest, edge);
  }
  const int nx = cells[0], ny = cells[1], nz = cells[2];
  LooseZones<3> body;
  for (int k = 0; k <= nz; ++k)
    for (int j = 0; j <= ny; ++j)
      for (int i = 0; i <= nx; ++i) {
        const double x = static_cast<double>(i) / nx, y = static_cast<double>(j) / ny,
                     z = static_cast<double>(k) / nz;
        Vec<3> place{};
        for (int n = 0; n < 8; ++n)
          place += ((n & 4) != 0 ? x : 1.0 - x) * ((n & 2) != 0 ? y : 1.0 - y) *
                   ((n & 1) != 0 ? z : 1.0 - z) * c[n];
        if (i == 0 || i == nx || j == 0 || j == ny || k == 0 || k == nz)
          body.outline.push_back(static_cast<int>(body.gridpoints.size()));
        body.gridpoints.push_back(place);
      }
  for (int k = 0; k < nz; ++k)
    for (int j = 0; j < ny; ++j)
      for (int i = 0; i < nx; ++i) {
        // a zone in the middle and four at corners; neighbours are mirror images, so that they fit
        const int flip = (i + j + k) % 2;
        const auto at = [&](int x, int y, int z) {
          return ((k + z) * (ny + 1) + j + y) * (nx + 1) + i + (flip == 0 ? x : 1 - x);
        };
        const std::array<std::array<int, 4>, 5> five{{{at(0, 0, 0), at(1, 1, 0), at(1, 0, 1), at(0, 1, 1)},
                                                      {at(1, 0, 0), at(0, 0, 0), at(1, 1, 0), at(1, 0, 1)},
                                                      {at(0, 1, 0), at(0, 0, 0), at(1, 1, 0), at(0, 1, 1)},
                                                      {at(0, 0, 1), at(0, 0, 0), at(1, 0, 1), at(0, 1, 1)},
                                                      {at(1, 1, 1), at(1, 1, 0), at(1, 0, 1), at(0, 1, 1)}}};
        for (const auto& zone : five) add_zone(zone, body.gridpoints, body.zones);
      }
  return body;
}

/// Returns triangles over the faces of a polyhedron: as they are, a quadrilateral in two, and around the
/// middle of a face with more corners, which is added to the gridpoints.
std::vector<Triangle> triangles_of(const LooseBody& body, std::vector<Vec<3>>& at) {
  std::vector<Triangle> triangles;
  for (const auto& face : body.faces) {
    const int count = static_cast<int>(face.size());
    if (count <= 4) {
      const bool is_other = count == 4 && norm(at[face[3]] - at[face[1]]) < norm(at[face[2]] - at[face[0]]);
      const auto corner = [&](int i) { return face[(i + (is_other ? 1 : 0)) % count]; };
      for (int i = 1; i + 1 < count; ++i) triangles.push_back({corner(0), corner(i), corner(i + 1)});
      continue;
    }
    Vec<3> middle{};
    for (const int corner : face) middle += at[corner] * (1.0 / count);
    for (int i = 0; i < count; ++i)
      triangles.push_back({face[i], face[(i + 1) % count], static_cast<int>(at.size())});
    at.push_back(middle);
  }
  return triangles;
}

/// Halves edges that are longer than `longest`, each as long as it is the longest one of both its triangles:
/// so no angle becomes less than half of the least one (Rosenberg and Stenger, SIAM J. Numer. Anal. 12 (1975)
/// 842).
void halve_long_edges(double longest, std::vector<Vec<3>>& at, std::vector<Triangle>& triangles) {
  using Edge = std::pair<int, int>;
  const auto length = [&](const Edge& edge) { return norm(at[edge.second] - at[edge.first]); };
  for (bool any = true; any;) {
    any = false;
    std::map<Edge, int> votes, middles;
    const auto first_of = [](const Triangle& t) { return Edge(std::minmax(t[0], t[1])); };
    for (Triangle& t : triangles) {  // turned so that its longest edge comes first
      const auto rank = [&](int i) {
        const Edge edge(std::minmax(t[i], t[(i + 1) % 3]));
        return std::pair(length(edge), edge);
      };
      int most = 0;
      for (int i = 1; i < 3; ++i)
        if (rank(i) > rank(most)) most = i;
      t = {t[most], t[(most + 1) % 3], t[(most + 2) % 3]};
      if (length(first_of(t)) > longest) ++votes[first_of(t)];
    }
    std::vector<Triangle> finer;
    for (const Triangle& t : triangles) {
      const Edge edge = first_of(t);
      const auto vote = votes.find(edge);
      if (vote == votes.end() || vote->second < 2) {
        finer.push_back(t);
        continue;
      }
      const auto [middle, is_new] = middles.emplace(edge, static_cast<int>(at.size()));
      if (is_new) at.push_back(0.5 * (at[edge.first] + at[edge.second]));
      finer.push_back({t[0], middle->second, t[2]});
      finer.push_back({middle->second, t[1], t[2]});
      any = true;
    }
    triangles = std::move(finer);
  }
}

/// Returns shells of zones around the centroid of a polyhedron. Each shell is about as high as its zones are
/// wide.
LooseZones<3> shells_of(const LooseBody& polyhedron, double edge) {
  std::vector<Vec<3>> outline = polyhedron.corners;
  std::vector<Triangle> triangles = triangles_of(polyhedron, outline);
  halve_long_edges(kLongestEdge * edge, outline, triangles);
  const Vec<3> origin = outline.front();
  Vec<3> moment{};
  double volume = 0.0, surface = 0.0;
  for (const auto& [p, q, r] : triangles) {
    const Vec<3> a = outline[p] - origin, b = outline[q] - origin, c = outline[r] - origin;
    const double of_pyramid = dot(a, cross(b, c)) / 6.0;
    moment += (a + b + c) * (0.25 * of_pyramid);
    volume += of_pyramid;
    surface += 0.5 * norm(cross(b - a, c - a));
  }
  const Vec<3> middle = origin + moment * (1.0 / volume);
  const double radius = 3.0 * volume / surface;
  const double shrink = 1.0 - std::min(0.5, edge / radius);
  LooseZones<3> body;
  int shells = 0;
  for (double scale = 1.0; scale == 1.0 || scale > kInnermostShell; scale *= shrink, ++shells)
    for (const Vec<3>& p : outline) body.gridpoints.push_back(middle + scale * (p - middle));
  const int on_shell = static_cast<int>(outline.size());
  const int centre = shells * on_shell;
  body.gridpoints.push_back(middle);
  for (int shell = 0; shell < shells; ++shell)
    for (const Triangle& t : triangles) {
      const int first = shell * on_shell;
      if (shell + 1 == shells)
        add_zone({first + t[0], first + t[1], first + t[2], centre}, body.gridpoints, body.zones);
      else
        add_prism(t, first + on_shell, first, body.gridpoints, body.zones);
    }
  body.outline.resize(outline.size());
  std::iota(body.outline.begin(), body.outline.end(), 0);
  return body;
}

}  // namespace

std::vector<Vec<2>> corners_around(const LooseBody& body) {
  std::vector<Vec<2>> corners;
  for (const Vec<3>& corner : body.corners) corners.push_back(resized<2>(corner));
  double area = 0.0;
  for (std::size_t i = 2; i < corners.size(); ++i)
    area += area_of_triangle(corners[0], corners[i - 1], corners[i]);
  if (area < 0.0) std::ranges::reverse(corners);
  return corners;
}

template <>
LooseZones<2> zones_of(const LooseBody& body) {
  const auto corners = corners_around(body);
  return corners.size() == 4 ? grid_of(corners, body.edge) : rings_of(corners, body.edge);
}

template <>
LooseZones<3> zones_of(const LooseBody& body) {
  const auto box = corners_of_box(body);
  return box.empty() ? shells_of(body, body.edge) : grid_of_box(box, body.edge);
}

}  // namespace pyroclast
