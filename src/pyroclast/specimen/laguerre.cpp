#include "pyroclast/specimen/laguerre.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <utility>

#include <voro++/voro++.hh>

#include "pyroclast/base/same_points.hpp"
#include "pyroclast/specimen/clip.hpp"
#include "pyroclast/specimen/polygon.hpp"
#include "pyroclast/specimen/topology.hpp"

namespace pyroclast::specimen {
namespace {

/// Thickness of the slab. All lengths below are in mean spacings of the seeds, so that tolerances mean the
/// same at any size. Voro++ is three-dimensional: seeds lie in the middle plane of a slab and cells are
/// prisms. A slab thinner than the spacing keeps the prisms' vertices near their seed, and so the search for
/// neighbours short.
constexpr double slab_thickness = 0.5;
/// Largest distance between points that count as one. Voro++ decides with a tolerance of 1e-11.
constexpr double merge_distance = 1e-8;
/// Number of seeds in a computational block; Voro++ is fastest with about five.
constexpr double seeds_per_block = 5.0;
/// Number that Voro++ gives to the upper wall of the slab.
constexpr int upper_wall = -6;

/// Size of the slab: the mean spacing of the seeds, m, and the region's box in spacings.
struct SlabSize {
  SlabSize(const Seeds& seeds, const Region& region)
      : low(region.box().low),
        spacing(std::sqrt(region.area() / static_cast<double>(seeds.position.size()))),
        width(region.box().width() / spacing),
        height(region.box().height() / spacing) {}

  Vec<2> in_spacings(const Vec<2>& point) const { return (point - low) * (1.0 / spacing); }

  Vec<2> low;
  double spacing, width, height;
};

class Slab {
 public:
  Slab(const Seeds& seeds, const SlabSize& size)
      : container_(0.0, size.width, 0.0, size.height, -0.5 * slab_thickness, 0.5 * slab_thickness,
                   blocks(size.width), blocks(size.height), 1, false, false, false, 8) {
    for (std::size_t i = 0; i < seeds.position.size(); ++i) {
      const Vec<2> p = size.in_spacings(seeds.position[i]);
      container_.put(static_cast<int>(i), p[0], p[1], 0.0, seeds.radius[i] / size.spacing);
    }
  }

  /// Returns the number of computational blocks of Voro++; each holds the seeds of its square.
  int block_count() const { return container_.nxyz; }

  /// Calls f(seed, prism, position) for every seed of a block whose cell is not empty; lengths in spacings.
  template <class Prism, class F>
  void for_each_cell(int block, Prism& prism, F&& f) {
    for (int i = 0; i < container_.co[block]; ++i) {
      if (!container_.compute_cell(prism, block, i)) continue;
      const double* position = container_.p[block] + static_cast<std::ptrdiff_t>(4 * i);  // x, y, z, radius
      f(static_cast<std::size_t>(container_.id[block][i]), prism, Vec<2>{{position[0], position[1]}});
    }
  }

 private:
  static int blocks(double length) {
    return std::max(1, static_cast<int>(std::lround(length / std::sqrt(seeds_per_block))));
  }

  voro::container_poly container_;
};

/// Calls f(seed, prism, position), from several threads, for every seed whose cell is not empty. Voro++ cuts
/// in scratch memory of the container, so each thread has a container of its own. A cell does not depend on
/// the cells cut before it.
template <class Prism, class F>
void for_each_cell(const Seeds& seeds, const SlabSize& size, Team* team, F&& f) {
  Team alone;
  Team& threads = team ? *team : alone;
  const int count = threads.size();
  threads.run(count, [&](int thread) {
    Slab slab(seeds, size);
    Prism prism;
    const std::int64_t blocks = slab.block_count();
    const auto end = static_cast<int>(blocks * (thread + 1) / count);
    for (auto block = static_cast<int>(blocks * thread / count); block < end; ++block)
      slab.for_each_cell(block, prism, f);
  });
}

/// Returns the prism's upper face, counter-clockwise.
std::vector<Vec<2>> upper_face(voro::voronoicell_neighbor& prism, const Vec<2>& position) {
  std::vector<int> neighbours, faces;
  std::vector<double> vertices;
  prism.neighbors(neighbours);
  prism.face_vertices(faces);
  prism.vertices(position[0], position[1], 0.0, vertices);
  std::vector<Vec<2>> polygon;
  std::size_t at = 0;
  for (const int neighbour : neighbours) {
    const auto count = static_cast<std::size_t>(faces[at]);
    if (neighbour == upper_wall) {
      for (std::size_t i = at + 1; i <= at + count; ++i) {
        const auto v = 3 * static_cast<std::size_t>(faces[i]);
        polygon.push_back({{vertices[v], vertices[v + 1]}});
      }
      break;
    }
    at += count + 1;
  }
  if (polygon.size() >= 3 && area(polygon) < 0.0) std::reverse(polygon.begin(), polygon.end());
  return polygon;
}

double snapped(double x, double wall) {
  if (std::abs(x) < merge_distance) return 0.0;
  return std::abs(x - wall) < merge_distance ? wall : x;
}

/// Joins cells that each have their own corners into cells that share vertices.
Tessellation join(const std::vector<std::vector<Vec<2>>>& polygons) {
  std::vector<Vec<2>> points;
  for (const auto& polygon : polygons) points.insert(points.end(), polygon.begin(), polygon.end());
  const std::vector<int> same = same_points(points, merge_distance);

  Tessellation result;
  std::vector<int> number(points.size(), -1);
  std::size_t point = 0;
  for (const auto& polygon : polygons) {
    std::vector<int> cell;
    for (std::size_t i = 0; i < polygon.size(); ++i, ++point) {
      const auto first = static_cast<std::size_t>(same[point]);
      if (number[first] < 0) {
        number[first] = static_cast<int>(result.vertices.size());
        result.vertices.push_back(points[first]);
      }
      if (cell.empty() || cell.back() != number[first]) cell.push_back(number[first]);
    }
    while (cell.size() > 1 && cell.back() == cell.front()) cell.pop_back();
    result.cells.push_back(std::move(cell));
  }
  return result;
}

/// Moves each vertex that lies within the tolerance of a corner of the outline, or of the mouth or tip of a
/// notch, exactly onto it.
void snap_to_corners(Tessellation& tessellation, const Region& region, double tolerance) {
  std::vector<Vec<2>> corners;
  for (const Piece& piece : region.pieces()) corners.push_back(piece.from);
  for (const Notch& notch : region.notches()) {
    corners.push_back(notch.mouth);
    corners.push_back(notch.tip);
  }
  std::ranges::sort(corners, {}, &Vec<2>::c);
  for (Vec<2>& p : tessellation.vertices) {
    const Vec<2> lowest{{p[0] - tolerance, 0.0}};
    for (auto at = std::ranges::lower_bound(corners, lowest[0], {}, [](const Vec<2>& c) { return c[0]; });
         at != corners.end() && (*at)[0] <= p[0] + tolerance; ++at)
      if (std::abs((*at)[1] - p[1]) <= tolerance) p = *at;
  }
}

}  // namespace

LaguerreResult laguerre_tessellation(const Seeds& seeds, const Region& region, Team* team) {
  const SlabSize size(seeds, region);
  std::vector<Piece> pieces;  // none for a rectangle, which Voro++ clips by itself
  if (!region.is_rectangle())
    for (const auto& [from, to, side] : region.pieces())
      pieces.push_back({size.in_spacings(from), size.in_spacings(to), side});
  std::vector<std::vector<Vec<2>>> polygons(seeds.position.size());
  for_each_cell<voro::voronoicell_neighbor>(seeds, size, team,
                                            [&](std::size_t seed, auto& prism, const Vec<2>& position) {
                                              polygons[seed] = upper_face(prism, position);
                                              if (!clip(polygons[seed], position, pieces, merge_distance))
                                                polygons[seed].clear();
                                              for (Vec<2>& p : polygons[seed])
                                                p = {{snapped(p[0], size.width), snapped(p[1], size.height)}};
                                            });

  LaguerreResult result{join(polygons), {}};
  const Box& box = region.box();
  for (Vec<2>& p : result.tessellation.vertices)
    p = {{p[0] == size.width ? box.high[0] : size.low[0] + p[0] * size.spacing,
          p[1] == size.height ? box.high[1] : size.low[1] + p[1] * size.spacing}};
  if (!region.is_rectangle()) snap_to_corners(result.tessellation, region, merge_distance * size.spacing);
  result.broken = mismatched_cells(result.tessellation, region);
  return result;
}

namespace {

/// Returns how far the centroid of a cell moves where its area counts as size^-4, m: by the gradient of this
/// weight times the second moment of the area, that of a square.
Vec<2> towards_finer(const BlockSizes& sizes, const Vec<2>& place) {
  constexpr double kMoment = 1.0 / 12.0, kExponent = -4.0, kStep = 0.1;
  const double size = sizes.at(place), step = kStep * size;
  Vec<2> move{};
  for (const int d : {0, 1}) {
    Vec<2> aside{};
    aside[d] = step;
    const double slope = (sizes.at(place + aside) - sizes.at(place - aside)) / (2.0 * step);
    move[d] = kExponent * kMoment * slope * size;
  }
  return move;
}

}  // namespace

void relax(Seeds& seeds, const Region& region, std::size_t kept, Team* team, const BlockSizes& sizes) {
  const SlabSize size(seeds, region);
  std::vector<Vec<2>> relaxed = seeds.position;
  for_each_cell<voro::voronoicell>(seeds, size, team,
                                   [&](std::size_t seed, auto& prism, const Vec<2>& position) {
                                     double x, y, z;
                                     if (seed < kept) return;
                                     prism.centroid(x, y, z);
                                     Vec<2> to = size.low + (position + Vec<2>{{x, y}}) * size.spacing;
                                     if (!sizes.is_even()) to += towards_finer(sizes, to);
                                     if (region.is_rectangle() || region.distance(to) < 0.0)
                                       relaxed[seed] = to;
                                   });
  if (!sizes.is_even())
    for (std::size_t i = kept; i < relaxed.size(); ++i)
      seeds.radius[i] *= sizes.at(relaxed[i]) / sizes.at(seeds.position[i]);
  seeds.position = std::move(relaxed);
}

}  // namespace pyroclast::specimen
