#include "pyroclast/solid/laguerre.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <functional>
#include <limits>
#include <memory>
#include <unordered_map>
#include <utility>

#include <voro++/voro++.hh>

#include "pyroclast/base/same_points.hpp"

namespace pyroclast::solid {

namespace {

// All lengths below are in mean spacings of the seeds, so that tolerances mean the same at any size.

/// Largest distance between vertices that count as one. Voro++ decides with a tolerance of 1e-11; where faces
/// meet at flat angles a vertex is less certain.
constexpr double kMergeDistance = 1e-7;
/// Number of seeds in a computational block; Voro++ is fastest with about five.
constexpr double kSeedsPerBlock = 5.0;
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

/// Lengths in mean spacings of the seeds, from the lower corner of the body.
struct Spacings {
  Spacings(const SolidSeeds& seeds, const Prism& body)
      : low(body.low()), spacing(std::cbrt(body.volume() / static_cast<double>(seeds.position.size()))) {}

  Vec<3> of(const Vec<3>& point) const { return (point - low) * (1.0 / spacing); }
  Vec<3> in_metres(const Vec<3>& point) const { return low + point * spacing; }

  Vec<3> low;
  double spacing;  ///< m
};

/// The planes of a body, as Voro++ asks for them.
class Outline final : public voro::wall {
 public:
  Outline(const Prism& body, const Spacings& spacings) {
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

class Container {
 public:
  Container(const SolidSeeds& seeds, const Prism& body) {
    const Spacings spacings(seeds, body);
    const Vec<3> size = spacings.of(body.high());
    std::array<int, 3> blocks;
    for (int d = 0; d < 3; ++d)
      blocks[d] =
          std::max(1, static_cast<int>(std::lround((size[d] + 2.0 * kMargin) / std::cbrt(kSeedsPerBlock))));
    container_ = std::make_unique<voro::container_poly>(
        -kMargin, size[0] + kMargin, -kMargin, size[1] + kMargin, -kMargin, size[2] + kMargin, blocks[0],
        blocks[1], blocks[2], false, false, false, 8);
    for (std::size_t i = 0; i < seeds.position.size(); ++i) {
      const Vec<3> p = spacings.of(seeds.position[i]);
      container_->put(static_cast<int>(i), p[0], p[1], p[2], seeds.radius[i] / spacings.spacing);
    }
    outline_ = std::make_unique<Outline>(body, spacings);
    container_->add_wall(outline_.get());
  }

  /// Returns the number of computational blocks of Voro++.
  int block_count() const { return container_->nxyz; }

  /// Writes the cells of the seeds of a computational block.
  void take(int block, std::vector<RawCell>& cells) {
    voro::voronoicell_neighbor cell;
    std::vector<double> vertices;
    std::vector<int> loops;
    for (int i = 0; i < container_->co[block]; ++i) {
      if (!container_->compute_cell(cell, block, i)) continue;
      const double* const at = container_->p[block] + static_cast<std::ptrdiff_t>(4 * i);  // x, y, z, radius
      RawCell& raw = cells[static_cast<std::size_t>(container_->id[block][i])];
      cell.vertices(at[0], at[1], at[2], vertices);
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
    }
  }

 private:
  std::unique_ptr<Outline> outline_;  ///< to which the container points
  std::unique_ptr<voro::container_poly> container_;
};

/// Joins cells that each have their own vertices into cells that share vertices and faces.
class Joiner {
 public:
  Joiner(std::vector<RawCell>& cells, const Prism& body) : cells_(cells), body_(body) {}

  LaguerreComplex join() {
    number_vertices();
    result_.complex.cells.resize(cells_.size());
    broken_.assign(cells_.size(), false);
    for (std::size_t i = 0; i < cells_.size(); ++i) add(static_cast<int>(i));
    for (const auto& [between, face] : waiting_) broken_[result_.complex.faces[face].inner] = true;
    for (std::size_t i = 0; i < cells_.size(); ++i)
      if (broken_[i] || cells_[i].loops.empty()) result_.broken.push_back(static_cast<int>(i));
    return std::move(result_);
  }

 private:
  void number_vertices() {
    std::vector<Vec<3>> points;
    for (const RawCell& cell : cells_)
      points.insert(points.end(), cell.vertices.begin(), cell.vertices.end());
    const std::vector<int> same = same_points(points, kMergeDistance);
    std::vector<int> number(points.size(), -1);
    std::size_t point = 0;
    for (RawCell& cell : cells_) {
      std::vector<int> numbers;
      for (std::size_t v = 0; v < cell.vertices.size(); ++v, ++point) {
        int& its = number[same[point]];
        if (its < 0) {
          its = static_cast<int>(result_.complex.vertices.size());
          result_.complex.vertices.push_back(points[same[point]]);
        }
        numbers.push_back(its);
      }
      for (auto& loop : cell.loops) {
        for (int& v : loop) v = numbers[v];
        loop.erase(std::unique(loop.begin(), loop.end()), loop.end());  // Clang 14 cannot do ranges::unique
        while (loop.size() > 1 && loop.front() == loop.back()) loop.pop_back();
      }
    }
  }

  void add(int cell) {
    Complex& complex = result_.complex;
    for (std::size_t f = 0; f < cells_[cell].loops.size(); ++f) {
      auto& loop = cells_[cell].loops[f];
      if (loop.size() < 3) continue;
      const int beyond = cells_[cell].beyond[f];
      const auto key = [](int low, int high) {
        return static_cast<std::uint64_t>(low) << 32U | static_cast<std::uint64_t>(high);
      };
      if (beyond >= 0 && beyond < cell) {
        const auto found = waiting_.find(key(beyond, cell));
        if (found == waiting_.end() || !is_reverse(complex.faces[found->second].corners, loop)) {
          broken_[cell] = true;
          continue;
        }
        complex.faces[found->second].outer = cell;
        complex.cells[cell].push_back(found->second);
        waiting_.erase(found);
        continue;
      }
      const int number = static_cast<int>(complex.faces.size());
      if (beyond >= 0) waiting_[key(cell, beyond)] = number;
      const int plane = beyond >= 0 ? -1 : kFirstPlane - beyond,
                side = plane < 0 ? -1 : body_.planes()[plane].side;
      turn_to_best_fan(result_.complex.vertices, loop, std::numeric_limits<double>::infinity());
      result_.plane.push_back(plane);
      complex.faces.push_back({std::move(loop), cell, -1, side});
      complex.cells[cell].push_back(number);
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
  LaguerreComplex result_;
  std::vector<bool> broken_;
  std::unordered_map<std::uint64_t, int>
      waiting_;  ///< faces whose other cell has not come yet, by both cells
};

/// Moves the vertices of faces on planes along the axes exactly onto them.
/// \param plane  plane of each face; -1 within the body
void snap(Complex& complex, const Prism& body, const std::vector<int>& plane) {
  for (std::size_t f = 0; f < complex.faces.size(); ++f) {
    if (plane[f] < 0) continue;
    const auto& [normal, offset, side] = body.planes()[plane[f]];
    for (int d = 0; d < 3; ++d)
      if (std::abs(normal[d]) == 1.0)
        for (const int v : complex.faces[f].corners) complex.vertices[v][d] = offset * normal[d];
  }
}

}  // namespace

LaguerreComplex laguerre_complex(const SolidSeeds& seeds, const Prism& body, Team* team) {
  std::vector<RawCell> cells(seeds.position.size());
  Team alone;
  Team& threads = team ? *team : alone;
  const int count = threads.size();
  // Voro++ cuts in scratch memory of the container, so each thread has a container of its own.
  threads.run(count, [&](int thread) {
    Container container(seeds, body);
    const std::int64_t blocks = container.block_count();
    const auto end = static_cast<int>(blocks * (thread + 1) / count);
    for (auto block = static_cast<int>(blocks * thread / count); block < end; ++block)
      container.take(block, cells);
  });
  Joiner joiner(cells, body);
  LaguerreComplex result = joiner.join();
  const Spacings spacings(seeds, body);
  for (Vec<3>& v : result.complex.vertices) v = spacings.in_metres(v);
  snap(result.complex, body, result.plane);
  return result;
}

}  // namespace pyroclast::solid
