#include "pyroclast/specimen/laguerre.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <functional>
#include <limits>
#include <memory>
#include <unordered_map>
#include <utility>

#include <voro++/voro++.hh>

#include "pyroclast/base/same_points.hpp"
#include "pyroclast/specimen/clip.hpp"
#include "pyroclast/specimen/polygon.hpp"
#include "pyroclast/specimen/polyhedron.hpp"
#include "pyroclast/specimen/topology.hpp"

namespace pyroclast::specimen {
namespace {

// All lengths below are in mean spacings of the seeds, so that tolerances mean the same at any size.

/// Largest distance between vertices that count as one. Voro++ decides with a tolerance of 1e-11; where faces
/// meet at flat angles a vertex is less certain.
template <int Dim>
constexpr double kMergeDistance = Dim == 2 ? 1e-8 : 1e-7;
/// Thickness of the slab that stands for the plane. Voro++ is three-dimensional: seeds lie in the middle
/// plane of a slab and cells are prisms. A slab thinner than the spacing keeps the prisms' vertices near
/// their seed, and so the search for neighbours short.
constexpr double kSlabThickness = 0.5;
/// Number of seeds in a computational block; Voro++ is fastest with about five.
constexpr double kSeedsPerBlock = 5.0;
/// Number that Voro++ gives to the upper wall of the slab.
constexpr int kUpperWall = -6;
/// Distance of the container's own walls from the body: only planes of the body cut cells.
constexpr double kMargin = 1.0;
/// Number that Voro++ gives to a cell beyond the first plane of a body; those of other planes count down.
constexpr int kFirstPlane = -10;

/// Most planes of a body that cut one cell, the nearest ones: only a few reach it. Voro++ goes astray where a
/// cut takes more than 256 vertices away, the room of its stack at first. With the six sides of the container
/// a cell of so many planes has at most 2 * (124 + 6) - 4 vertices.
constexpr std::size_t kMostPlanes = 124;

/// Cell as Voro++ makes it.
struct RawCell {
  std::vector<Vec<3>> vertices;
  std::vector<std::vector<int>> loops;  ///< vertices of each face, counter-clockwise seen from outside
  std::vector<int> beyond;              ///< cell or plane beyond each face
};

/// Lengths in mean spacings of the seeds, from the lower corner of the outline.
template <int Dim>
struct Spacings {
  Spacings(const Seeds<Dim>& seeds, const OutlineOf<Dim>& outline)
      : low(outline.low()),
        spacing(side_of<Dim>(outline.extent() / static_cast<double>(seeds.position.size()))) {
    if constexpr (Dim == 2)
      size = {{outline.box().width() / spacing, outline.box().height() / spacing}};
    else
      size = of(outline.high());
  }

  Vec<Dim> of(const Vec<Dim>& point) const { return (point - low) * (1.0 / spacing); }
  Vec<Dim> in_metres(const Vec<Dim>& point) const { return low + point * spacing; }

  Vec<Dim> low;
  double spacing;  ///< m
  Vec<Dim> size;   ///< of the outline's box, in spacings
};

/// The planes of a body, as Voro++ asks for them.
class Walls final : public voro::wall {
 public:
  Walls(const Prism& body, const Spacings<3>& spacings) {
    for (const auto& [normal, offset, side] : body.planes()) {
      planes_.push_back({normal, (offset - dot(normal, spacings.low)) / spacings.spacing, side});
      walls_.emplace_back(normal[0], normal[1], normal[2], planes_.back().offset,
                          kFirstPlane - static_cast<int>(walls_.size()));
    }
  }

  bool point_inside(double x, double y, double z) override {
    return std::ranges::all_of(planes_, [&](const Plane& plane) {
      return plane.distance({{x, y, z}}) < 0.0;
    });
  }
  bool cut_cell(voro::voronoicell& cell, double x, double y, double z) override {
    return cut(cell, {{x, y, z}});
  }
  bool cut_cell(voro::voronoicell_neighbor& cell, double x, double y, double z) override {
    return cut(cell, {{x, y, z}});
  }

 private:
  template <class Cell>
  bool cut(Cell& cell, const Vec<3>& seed) {
    double farthest = -std::numeric_limits<double>::infinity();
    if (planes_.size() > kMostPlanes) {
      distances_.clear();
      for (const Plane& plane : planes_) distances_.push_back(plane.distance(seed));
      const auto last = distances_.begin() + kMostPlanes - 1;
      std::ranges::nth_element(distances_, last, std::greater<>());
      farthest = *last;
    }
    for (std::size_t i = 0; i < planes_.size(); ++i)
      if (planes_[i].distance(seed) >= farthest && !walls_[i].cut_cell(cell, seed[0], seed[1], seed[2]))
        return false;
    return true;
  }

  std::vector<Plane> planes_;  ///< in mean spacings
  std::vector<voro::wall_plane> walls_;
  std::vector<double> distances_;  ///< scratch: of a seed from each plane, negative
};

/// Container of Voro++ with the seeds: in the plane a slab over the outline's box, in space the planes of a
/// body within a wider box.
template <int Dim>
class Container {
 public:
  Container(const Seeds<Dim>& seeds, const OutlineOf<Dim>& outline, const Spacings<Dim>& spacings) {
    Vec<3> from{}, to = resized<3>(spacings.size);
    std::array<int, 3> blocks{1, 1, 1};
    const double of_block = side_of<Dim>(kSeedsPerBlock);
    if constexpr (Dim == 2) {
      from[2] = -0.5 * kSlabThickness;
      to[2] = 0.5 * kSlabThickness;
    } else {
      for (int d = 0; d < 3; ++d) {
        from[d] -= kMargin;
        to[d] += kMargin;
      }
    }
    for (int d = 0; d < Dim; ++d) {
      const double length = Dim == 2 ? to[d] : spacings.size[d] + 2.0 * kMargin;
      blocks[d] = std::max(1, static_cast<int>(std::lround(length / of_block)));
    }
    container_ =
        std::make_unique<voro::container_poly>(from[0], to[0], from[1], to[1], from[2], to[2], blocks[0],
                                               blocks[1], blocks[2], false, false, false, 8);
    for (std::size_t i = 0; i < seeds.position.size(); ++i) {
      const Vec<3> p = resized<3>(spacings.of(seeds.position[i]));
      container_->put(static_cast<int>(i), p[0], p[1], p[2], seeds.radius[i] / spacings.spacing);
    }
    if constexpr (Dim == 3) {
      walls_ = std::make_unique<Walls>(outline, spacings);
      container_->add_wall(walls_.get());
    }
  }

  /// Returns the number of computational blocks of Voro++.
  int block_count() const { return container_->nxyz; }

  /// Calls f(seed, cell, position) for every seed of a block whose cell is not empty; lengths in spacings.
  template <class Cell, class F>
  void for_each_cell(int block, Cell& cell, F&& f) {
    for (int i = 0; i < container_->co[block]; ++i) {
      if (!container_->compute_cell(cell, block, i)) continue;
      const double* const at = container_->p[block] + static_cast<std::ptrdiff_t>(4 * i);  // x, y, z, radius
      f(static_cast<std::size_t>(container_->id[block][i]), cell, Vec<3>{{at[0], at[1], at[2]}});
    }
  }

 private:
  std::unique_ptr<Walls> walls_;  ///< to which the container points
  std::unique_ptr<voro::container_poly> container_;
};

/// Calls f(seed, cell, position), from several threads, for every seed whose cell is not empty. Voro++ cuts
/// in scratch memory of the container, so each thread has a container of its own. A cell does not depend on
/// the cells cut before it.
template <class Cell, int Dim, class F>
void for_each_cell(const Seeds<Dim>& seeds, const OutlineOf<Dim>& outline, const Spacings<Dim>& spacings,
                   Team* team, F&& f) {
  Team alone;
  Team& threads = team ? *team : alone;
  const int count = threads.size();
  threads.run(count, [&](int thread) {
    Container<Dim> container(seeds, outline, spacings);
    Cell cell;
    const std::int64_t blocks = container.block_count();
    const auto end = static_cast<int>(blocks * (thread + 1) / count);
    for (auto block = static_cast<int>(blocks * thread / count); block < end; ++block)
      container.for_each_cell(block, cell, f);
  });
}

double snapped(double x, double wall) {
  if (std::abs(x) < kMergeDistance<2>) return 0.0;
  return std::abs(x - wall) < kMergeDistance<2> ? wall : x;
}

/// Returns the cell that Voro++ has made, in spacings.
RawCell raw_cell(voro::voronoicell_neighbor& cell, const Vec<3>& position) {
  RawCell raw;
  std::vector<double> vertices;
  std::vector<int> loops;
  cell.vertices(position[0], position[1], position[2], vertices);
  for (std::size_t v = 0; v + 2 < vertices.size(); v += 3)
    raw.vertices.push_back({{vertices[v], vertices[v + 1], vertices[v + 2]}});
  cell.neighbors(raw.beyond);
  cell.face_vertices(loops);
  for (std::size_t begin = 0; begin < loops.size();) {
    const auto first = loops.begin() + static_cast<std::ptrdiff_t>(begin) + 1;
    raw.loops.emplace_back(first, first + loops[begin]);
    std::ranges::reverse(raw.loops.back());  // Voro++ walks them clockwise
    begin += 1 + raw.loops.back().size();
  }
  return raw;
}

/// Returns the upper face of a cell in the slab, counter-clockwise.
std::vector<Vec<2>> upper_face(const RawCell& prism) {
  std::vector<Vec<2>> polygon;
  for (std::size_t f = 0; f < prism.loops.size(); ++f)
    if (prism.beyond[f] == kUpperWall)
      for (const int v : prism.loops[f]) polygon.push_back(resized<2>(prism.vertices[v]));
  return polygon;
}

/// Returns the number of the vertex of each point: those of the cells in turn, of which some coincide.
/// \param vertices  vertices, to which these are added
template <int Dim>
std::vector<int> numbered(const std::vector<Vec<Dim>>& points, std::vector<Vec<Dim>>& vertices) {
  std::vector<int> number = same_points(points, kMergeDistance<Dim>);
  for (std::size_t point = 0; point < points.size(); ++point)
    if (number[point] == static_cast<int>(point)) {
      number[point] = static_cast<int>(vertices.size());
      vertices.push_back(points[point]);
    } else {
      number[point] = number[number[point]];
    }
  return number;
}

/// Lets a loop of vertices have each once where neighbours are the same.
void drop_repeats(std::vector<int>& loop) {
  loop.erase(std::unique(loop.begin(), loop.end()), loop.end());  // Clang 14 cannot do ranges::unique
  while (loop.size() > 1 && loop.front() == loop.back()) loop.pop_back();
}

/// Joins cells that each have their own corners into cells that share vertices.
Cells<2> join(const std::vector<std::vector<Vec<2>>>& polygons) {
  std::vector<Vec<2>> points;
  for (const auto& polygon : polygons) points.insert(points.end(), polygon.begin(), polygon.end());
  Cells<2> result;
  const std::vector<int> number = numbered(points, result.vertices);
  auto next = number.begin();
  for (const auto& polygon : polygons) {
    auto& cell = result.cells.emplace_back(next, next + std::ssize(polygon));
    next += std::ssize(polygon);
    drop_repeats(cell);
  }
  return result;
}

/// Moves each vertex that lies within the tolerance of a corner of the outline, or of the mouth or tip of a
/// notch, exactly onto it.
void snap_to_corners(Cells<2>& cells, const Region& region, double tolerance) {
  std::vector<Vec<2>> corners;
  for (const Piece& piece : region.pieces()) corners.push_back(piece.from);
  for (const Notch& notch : region.notches()) {
    corners.push_back(notch.mouth);
    corners.push_back(notch.tip);
  }
  std::ranges::sort(corners, {}, &Vec<2>::c);
  for (Vec<2>& p : cells.vertices) {
    const Vec<2> lowest{{p[0] - tolerance, 0.0}};
    for (auto at = std::ranges::lower_bound(corners, lowest[0], {}, [](const Vec<2>& c) { return c[0]; });
         at != corners.end() && (*at)[0] <= p[0] + tolerance; ++at)
      if (std::abs((*at)[1] - p[1]) <= tolerance) p = *at;
  }
}

/// Joins cells that each have their own vertices into cells that share vertices and faces.
class Joiner {
 public:
  Joiner(std::vector<RawCell>& cells, const Prism& body) : cells_(cells), body_(body) {}

  Laguerre<3> join() {
    number_vertices();
    result_.cells.cells.resize(cells_.size());
    broken_.assign(cells_.size(), false);
    for (std::size_t i = 0; i < cells_.size(); ++i) add(static_cast<int>(i));
    for (const auto& [between, face] : waiting_) broken_[result_.cells.faces[face].inner] = true;
    for (std::size_t i = 0; i < cells_.size(); ++i)
      if (broken_[i] || cells_[i].loops.empty()) result_.broken.push_back(static_cast<int>(i));
    return std::move(result_);
  }

 private:
  void number_vertices() {
    std::vector<Vec<3>> points;
    for (const RawCell& cell : cells_)
      points.insert(points.end(), cell.vertices.begin(), cell.vertices.end());
    const std::vector<int> number = numbered(points, result_.cells.vertices);
    std::size_t first = 0;
    for (RawCell& cell : cells_) {
      for (auto& loop : cell.loops) {
        for (int& v : loop) v = number[first + static_cast<std::size_t>(v)];
        drop_repeats(loop);
      }
      first += cell.vertices.size();
    }
  }

  void add(int cell) {
    Cells<3>& cells = result_.cells;
    for (std::size_t f = 0; f < cells_[cell].loops.size(); ++f) {
      auto& loop = cells_[cell].loops[f];
      if (loop.size() < 3) continue;
      const int beyond = cells_[cell].beyond[f];
      const auto key = [](int low, int high) {
        return static_cast<std::uint64_t>(low) << 32U | static_cast<std::uint64_t>(high);
      };
      if (beyond >= 0 && beyond < cell) {
        const auto found = waiting_.find(key(beyond, cell));
        if (found == waiting_.end() || !is_reverse(cells.faces[found->second].corners, loop)) {
          broken_[cell] = true;
          continue;
        }
        cells.faces[found->second].outer = cell;
        cells.cells[cell].push_back(found->second);
        waiting_.erase(found);
        continue;
      }
      const int number = static_cast<int>(cells.faces.size());
      if (beyond >= 0) waiting_[key(cell, beyond)] = number;
      const int plane = beyond >= 0 ? -1 : kFirstPlane - beyond,
                side = plane < 0 ? -1 : body_.planes()[plane].side;
      turn_to_best_fan(result_.cells.vertices, loop, std::numeric_limits<double>::infinity());
      result_.plane.push_back(plane);
      cells.faces.push_back({std::move(loop), cell, -1, side});
      cells.cells[cell].push_back(number);
    }
  }

  /// Tells whether a loop is another walked backwards.
  static bool is_reverse(const std::vector<int>& loop, std::vector<int> other) {
    if (loop.size() != other.size()) return false;
    std::ranges::reverse(other);
    const auto first = std::ranges::find(other, loop.front());
    if (first == other.end()) return false;
    std::rotate(other.begin(), first, other.end());  // Clang 14 cannot do ranges::rotate
    return loop == other;
  }

  std::vector<RawCell>& cells_;
  const Prism& body_;
  Laguerre<3> result_;
  std::vector<bool> broken_;
  std::unordered_map<std::uint64_t, int>
      waiting_;  ///< faces whose other cell has not come yet, by both cells
};

/// Moves the vertices of faces on planes along the axes exactly onto them.
/// \param plane  plane of each face; -1 within the body
void snap(Cells<3>& cells, const Prism& body, const std::vector<int>& plane) {
  for (std::size_t f = 0; f < cells.faces.size(); ++f) {
    if (plane[f] < 0) continue;
    const auto& [normal, offset, side] = body.planes()[plane[f]];
    for (int d = 0; d < 3; ++d)
      if (std::abs(normal[d]) == 1.0)
        for (const int v : cells.faces[f].corners) cells.vertices[v][d] = offset * normal[d];
  }
}

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

Laguerre<2> laguerre_cells(const Seeds<2>& seeds, const Region& region, Team* team) {
  const Spacings<2> spacings(seeds, region);
  const double width = spacings.size[0], height = spacings.size[1];
  std::vector<Piece> pieces;  // none for a rectangle, which Voro++ clips by itself
  if (!region.is_rectangle())
    for (const auto& [from, to, side] : region.pieces())
      pieces.push_back({spacings.of(from), spacings.of(to), side});
  std::vector<std::vector<Vec<2>>> polygons(seeds.position.size());
  for_each_cell<voro::voronoicell_neighbor>(
      seeds, region, spacings, team, [&](std::size_t seed, auto& prism, const Vec<3>& position) {
        std::vector<Vec<2>>& polygon = polygons[seed] = upper_face(raw_cell(prism, position));
        if (!clip(polygon, resized<2>(position), pieces, kMergeDistance<2>)) polygon.clear();
        for (Vec<2>& p : polygon) p = {{snapped(p[0], width), snapped(p[1], height)}};
      });

  Laguerre<2> result{join(polygons)};
  for (Vec<2>& p : result.cells.vertices)
    p = {{p[0] == width ? region.high()[0] : spacings.low[0] + p[0] * spacings.spacing,
          p[1] == height ? region.high()[1] : spacings.low[1] + p[1] * spacings.spacing}};
  if (!region.is_rectangle()) snap_to_corners(result.cells, region, kMergeDistance<2> * spacings.spacing);
  result.broken = mismatched_cells(result.cells, region);
  return result;
}

Laguerre<3> laguerre_cells(const Seeds<3>& seeds, const Prism& body, Team* team) {
  const Spacings<3> spacings(seeds, body);
  std::vector<RawCell> cells(seeds.position.size());
  for_each_cell<voro::voronoicell_neighbor>(
      seeds, body, spacings, team,
      [&](std::size_t seed, auto& cell, const Vec<3>& position) { cells[seed] = raw_cell(cell, position); });
  Laguerre<3> result = Joiner(cells, body).join();
  for (Vec<3>& v : result.cells.vertices) v = spacings.in_metres(v);
  snap(result.cells, body, result.plane);
  return result;
}

void relax(Seeds<2>& seeds, const Region& region, std::size_t kept, Team* team, const BlockSizes& sizes) {
  const Spacings<2> spacings(seeds, region);
  std::vector<Vec<2>> relaxed = seeds.position;
  for_each_cell<voro::voronoicell>(seeds, region, spacings, team,
                                   [&](std::size_t seed, auto& prism, const Vec<3>& position) {
                                     double x, y, z;
                                     if (seed < kept) return;
                                     prism.centroid(x, y, z);
                                     Vec<2> to = spacings.in_metres({{position[0] + x, position[1] + y}});
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
