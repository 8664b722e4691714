#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <iterator>
#include <limits>
#include <optional>
#include <utility>

#include "pyroclast/base/sort_unique.hpp"
#include "pyroclast/specimen/polyhedron.hpp"
#include "pyroclast/specimen/regularisation.hpp"
#include "pyroclast/specimen/topology.hpp"

namespace pyroclast::specimen {

namespace {

/// Rounds of merges, after each of which vertices move; a third one merges hardly any more.
constexpr int kRounds = 3;
/// Moves of each vertex after the merges of a round; further ones make zones hardly rounder.
constexpr int kMoves = 5;
/// First way by which a vertex moves, and the shortest one, in sizes of a block. Ways are halved.
constexpr double kFirstWay = 0.1, kShortestWay = 1e-3;
/// A vertex whose zones become rounder by less in a move is near its best place, so that its way is halved.
constexpr double kLittle = 0.02;
/// Cosine of the angle to a plane from which on an axis tells no way along it.
constexpr double kAcross = 0.3;
/// Cosine of the angle between a face and the surface of a stone at a vertex from which on the vertex lies on
/// an edge of the stone.
constexpr double kCosineAtEdge = 0.9;
/// Distance, in sizes of a block, at which vertices merge even if they lie on surfaces of two stones.
constexpr double kTouching = 0.02;
/// Distance, in sizes of a block, at which vertices on surfaces are one but for rounding: no face bends more.
constexpr double kCoinciding = 1e-5;
/// Share of its flatness by which a fan must be better than another, beyond rounding.
constexpr double kRounding = 1e-9;

/// Edge of cells that is too short.
struct ShortEdge {
  std::array<int, 2> ends;  ///< vertices, ascending
  double length;            ///< over the relative size of the blocks there, m
};

/// Cells whose vertices merge and move. Faces that have vanished have no corners until `drop_unused`.
class CellRegulariser {
 public:
  CellRegulariser(Cells<3>& cells, const Prism& body, const std::vector<int>& plane,
                  const RegularCells& asked, const BlockSizes& sizes, std::span<const int> stone)
      : cells_(cells),
        body_(body),
        asked_(asked),
        size_(std::cbrt(body.extent() / static_cast<double>(cells.cells.size()))),
        planes_(cells.vertices.size()),
        faces_at_(cells.vertices.size()) {
    for (const Vec<3>& place : cells.vertices) {
      relative_.push_back(sizes.relative(place));
      way_.push_back(kFirstWay * size_ * relative_.back());
    }
    for (std::size_t f = 0; f < cells.faces.size(); ++f)
      for (const int v : cells.faces[f].corners) {
        faces_at_[v].push_back(static_cast<int>(f));
        if (plane[f] >= 0) planes_[v].push_back(plane[f]);
      }
    if (!stone.empty()) find_surfaces(stone);
    for (auto& planes : planes_) sort_unique(planes);
    for (std::size_t cell = 0; cell < cells.cells.size(); ++cell) {
      size_of_cell_.push_back(size_ * mean_relative(cells.cells[cell]));
      flatness_.push_back(flatness_of(static_cast<int>(cell)));
    }
  }

  RegularisedCells run() {
    RegularisedCells done;
    for (int round = 0; round < kRounds; ++round) {
      done.vertices_merged += merge_all();
      for (int i = 0; i < kMoves; ++i) {
        for (std::size_t f = 0; f < cells_.faces.size(); ++f) turn(cells_.faces[f]);
        for (int v = 0; v < static_cast<int>(faces_at_.size()); ++v) move(v);
      }
    }
    done.edges_left_short = static_cast<int>(short_edges().size());
    drop_unused(cells_);
    return done;
  }

 private:
  /// Lets vertices between cells of different stones lie on the surfaces of these, which count behind the
  /// planes of the body. An edge of a surface counts once more.
  void find_surfaces(std::span<const int> stone) {
    surface_of_face_.assign(cells_.faces.size(), -1);
    const int first = static_cast<int>(body_.planes().size());
    for (std::size_t f = 0; f < cells_.faces.size(); ++f) {
      const Facet<3>& face = cells_.faces[f];
      if (face.outer < 0 || stone[face.inner] == stone[face.outer]) continue;
      surface_of_face_[f] = first + 2 * std::max(stone[face.inner], stone[face.outer]);
      for (const int v : face.corners) planes_[v].push_back(surface_of_face_[f]);
    }
    for (std::size_t v = 0; v < planes_.size(); ++v) {
      sort_unique(planes_[v]);
      const std::vector<int> surfaces = planes_[v];
      for (const int surface : surfaces)
        if (surface >= first && is_on_edge(static_cast<int>(v), surface)) planes_[v].push_back(surface + 1);
    }
  }

  /// Returns the vector of a face's area that points out of the stone, or out of the cell with the lower
  /// number between two stones.
  Vec<3> area_on_surface(int face) const { return area_vector(cells_, cells_.faces[face]); }

  /// Returns the normal of a surface at a vertex, of any sense.
  Vec<3> normal_at(int vertex, int surface) const {
    Vec<3> sum{};
    for (const int f : faces_at_[vertex])
      if (surface_of_face_[f] == surface) {
        const Vec<3> area = area_on_surface(f);
        sum += dot(area, sum) < 0.0 ? -area : area;
      }
    const double length = norm(sum);
    return length > 0.0 ? sum * (1.0 / length) : sum;
  }

  bool is_on_edge(int vertex, int surface) const {
    const Vec<3> normal = normal_at(vertex, surface);
    return std::ranges::any_of(faces_at_[vertex], [&](int f) {
      if (surface_of_face_[f] != surface) return false;
      const Vec<3> area = area_on_surface(f);
      return std::abs(dot(area, normal)) < kCosineAtEdge * norm(area);
    });
  }

  /// Merges short edges and small faces as long as one can be merged. Returns the number of vertices that
  /// have gone.
  int merge_all() {
    int gone = 0;
    for (bool changed = true; changed;) {
      const int before = gone;
      for (const ShortEdge& edge : short_edges())
        if (merge({edge.ends.begin(), edge.ends.end()})) ++gone;
      for (const Facet<3>& face : cells_.faces) {
        if (!is_small(face.corners)) continue;
        const std::vector<int> corners = face.corners;
        if (merge(corners)) gone += static_cast<int>(corners.size()) - 1;
      }
      changed = gone > before;
    }
    return gone;
  }

  /// Sets the limit from the mean of the edges as they are now. Returns the edges that are too short,
  /// shortest first.
  std::vector<ShortEdge> short_edges() {
    std::vector<std::array<int, 2>> edges;
    for (const Facet<3>& face : cells_.faces)
      for (std::size_t i = 0; i < face.corners.size(); ++i) {
        const auto [low, high] = std::minmax(face.corners[i], face.corners[(i + 1) % face.corners.size()]);
        edges.push_back({low, high});
      }
    sort_unique(edges);
    std::vector<ShortEdge> found;
    double sum = 0.0, of_sizes = 0.0;
    for (const auto& ends : edges) {
      const double length = norm(at(ends[1]) - at(ends[0]));
      const double size = 0.5 * (relative_[ends[0]] + relative_[ends[1]]);
      found.push_back({ends, length / size});
      sum += length;
      of_sizes += size;
    }
    shortest_ = asked_.shortest_edge * sum / of_sizes;
    std::erase_if(found, [this](const ShortEdge& edge) { return edge.length >= shortest_; });
    std::ranges::stable_sort(found, {}, &ShortEdge::length);
    return found;
  }

  /// Tells whether the corners of a face are nearer to each other than an edge may be short.
  bool is_small(const std::vector<int>& corners) const {
    for (std::size_t i = 1; i < corners.size(); ++i)
      for (std::size_t j = 0; j < i; ++j)
        if (norm(at(corners[i]) - at(corners[j])) >= shortest_ * relative_[corners.front()]) return false;
    return !corners.empty();
  }

  /// Merges vertices into the first of them, at the place where zones become roundest. Returns false, and
  /// changes nothing, where none is allowed.
  bool merge(const std::vector<int>& group) {
    if (std::ranges::any_of(group, [this](int v) { return faces_at_[v].empty(); })) return false;
    std::vector<int> planes, faces;
    for (const int v : group) {
      planes.insert(planes.end(), planes_[v].begin(), planes_[v].end());
      faces.insert(faces.end(), faces_at_[v].begin(), faces_at_[v].end());
    }
    sort_unique(planes);
    sort_unique(faces);
    const std::vector<Vec<3>> places = places_of(group, planes);
    if (places.empty()) return false;
    const std::vector<int> cells = cells_of(faces);
    const auto before = loops_of(faces);
    const int kept = group.front();
    const bool may_bend = !surface_of_face_.empty() && lie_within(kCoinciding, group);
    const Vec<3> place_before = at(kept);
    if (!contract(group, faces) || !std::ranges::all_of(cells, [this](int cell) { return is_ball(cell); }) ||
        !put_best(kept, places, faces, cells, may_bend)) {
      cells_.vertices[kept] = place_before;
      put(faces, before);
      return false;
    }
    planes_[kept] = planes;
    for (const int v : group) faces_at_[v].clear();
    for (std::size_t i = 0; i < faces.size(); ++i) {
      if (const Facet<3>& face = cells_.faces[faces[i]]; face.corners.empty()) {
        std::erase(cells_.cells[face.inner], faces[i]);
        if (face.outer >= 0) std::erase(cells_.cells[face.outer], faces[i]);
        for (const int v : before[i]) std::erase(faces_at_[v], faces[i]);
      } else {
        faces_at_[kept].push_back(faces[i]);
      }
    }
    for (const int cell : cells) flatness_[cell] = flatness_of(cell);
    return true;
  }

  /// Returns the places where vertices may merge: on all planes of the body, and surfaces of stones, on which
  /// any of them lies. Vertices that nearly touch leave a surface, by no more than their distance.
  std::vector<Vec<3>> places_of(const std::vector<int>& group, const std::vector<int>& planes) const {
    std::vector<Vec<3>> places;
    for (const int v : group)
      if (planes_[v] == planes) places.push_back(at(v));
    if (places.empty() && lie_within(kTouching, group)) {
      const auto of_body = [this](std::vector<int> of) {
        std::erase_if(of, [this](int plane) { return plane >= static_cast<int>(body_.planes().size()); });
        return of;
      };
      for (const int v : group)
        if (of_body(planes_[v]) == of_body(planes)) places.push_back(at(v));
      return places;
    }
    if (places.size() == 2 && group.size() == 2) {
      const Vec<3> from = places[0], edge = places[1] - places[0];
      for (const double share : {0.25, 0.5, 0.75}) places.push_back(from + share * edge);
    } else if (places.size() > 1) {
      Vec<3> sum{};
      for (const Vec<3>& place : places) sum += place;
      places.push_back(sum * (1.0 / static_cast<double>(places.size())));
    }
    return places;
  }

  /// \param distance  in sizes of a block
  bool lie_within(double distance, const std::vector<int>& group) const {
    return std::ranges::all_of(group, [&](int v) {
      return norm(at(v) - at(group.front())) < distance * size_ * relative_[group.front()];
    });
  }

  /// Lets the first of some vertices take the places of all in the corners of faces. Faces with two corners
  /// left vanish. Returns false where a face would meet itself.
  bool contract(const std::vector<int>& group, const std::vector<int>& faces) {
    const int kept = group.front();
    for (const int f : faces) {
      auto& loop = cells_.faces[f].corners;
      for (int& v : loop)
        if (std::ranges::find(group, v) != group.end()) v = kept;
      loop.erase(std::unique(loop.begin(), loop.end()), loop.end());  // Clang 14 cannot do ranges::unique
      while (loop.size() > 1 && loop.front() == loop.back()) loop.pop_back();
      if (std::ranges::count(loop, kept) > 1) return false;
      if (loop.size() < 3) loop.clear();
    }
    return true;
  }

  /// Tells whether a cell has four faces, an opposite edge for each edge, and the Euler number of a ball.
  bool is_ball(int cell) {
    auto& edges = edges_;
    edges.clear();
    int faces = 0;
    for (const int f : cells_.cells[cell]) {
      const auto& [loop, inner, outer, side] = cells_.faces[f];
      if (!loop.empty()) ++faces;
      for (std::size_t i = 0; i < loop.size(); ++i) {
        const int from = loop[i], to = loop[(i + 1) % loop.size()];
        edges.push_back(inner == cell ? std::array{from, to} : std::array{to, from});
      }
    }
    std::ranges::sort(edges);
    if (std::ranges::adjacent_find(edges) != edges.end()) return false;
    int vertices = 0, before = -1;
    for (const auto& [from, to] : edges) {
      if (from != before) ++vertices;
      before = from;
      if (!std::ranges::binary_search(edges, std::array{to, from})) return false;
    }
    return faces >= 4 && vertices + faces == static_cast<int>(edges.size()) / 2 + 2;
  }

  /// Puts a vertex at the one of some places where the zones of cells become roundest, and turns the fans of
  /// its faces for it. Returns false where no place makes them rounder than they were.
  ///
  /// \param may_bend  true where faces may be bent beyond the limit
  bool put_best(int vertex, const std::vector<Vec<3>>& places, const std::vector<int>& faces,
                const std::vector<int>& cells, bool may_bend) {
    const auto contracted = loops_of(faces);
    std::optional<Vec<3>> best;
    std::vector<std::vector<int>> best_loops;
    double least = known_flatness(cells);
    for (const Vec<3>& place : places) {
      cells_.vertices[vertex] = place;
      put(faces, contracted);
      if (!std::ranges::all_of(faces,
                               [&](int f) { return turn_to_fan_allowed(cells_.faces[f]) || may_bend; }))
        continue;
      if (const double flat = flatness_up_to(least, cells); flat < least) {
        least = flat;
        best = place;
        best_loops = loops_of(faces);
      }
    }
    if (!best) return false;
    cells_.vertices[vertex] = *best;
    put(faces, best_loops);
    return true;
  }

  bool turn_to_fan_allowed(Facet<3>& face) const {
    if (face.corners.empty()) return true;
    return turn_to_best_fan(cells_.vertices, face.corners,
                            face.outer < 0 ? std::numeric_limits<double>::infinity() : asked_.largest_bend);
  }

  bool is_bent_too_far(const Facet<3>& face) const {
    return face.outer >= 0 && bend(cells_.vertices, face.corners) > asked_.largest_bend;
  }

  /// Turns a face to the fan that makes zones roundest.
  void turn(Facet<3>& face) {
    auto& loop = face.corners;
    if (loop.size() < 4) return;
    std::vector<int> cells{face.inner};
    if (face.outer >= 0) cells.push_back(face.outer);
    double least = known_flatness(cells) * (1.0 - kRounding);
    std::vector<int> best;
    for (std::size_t i = 0; i < loop.size(); ++i) {
      if (i > 0 && !is_bent_too_far(face)) {
        if (const double flat = flatness_up_to(least, cells); flat < least) {
          least = flat;
          best = loop;
        }
      }
      std::rotate(loop.begin(), loop.begin() + 1, loop.end());  // Clang 14 cannot do ranges::rotate
    }
    if (best.empty()) return;
    loop = best;
    for (const int cell : cells) flatness_[cell] = flatness_of(cell);
  }

  /// Moves a vertex along the planes of the body on which it lies, where that makes zones rounder.
  void move(int vertex) {
    if (faces_at_[vertex].empty() || way_[vertex] < kShortestWay * size_ * relative_[vertex]) return;
    const std::vector<int> cells = cells_of(faces_at_[vertex]);
    const double before = known_flatness(cells);
    double least = before;
    for (const Vec<3>& along : ways_of(vertex))
      for (const double way : {way_[vertex], -way_[vertex]}) {
        const Vec<3> place = at(vertex);
        cells_.vertices[vertex] = place + along * way;
        const bool is_allowed = std::ranges::none_of(
            faces_at_[vertex], [this](int f) { return is_bent_too_far(cells_.faces[f]); });
        if (const double flat = is_allowed ? flatness_up_to(least, cells) : least; flat < least) {
          least = flat;
          break;
        }
        cells_.vertices[vertex] = place;
      }
    if (least > (1.0 - kLittle) * before) way_[vertex] *= 0.5;
    if (least < before)
      for (const int cell : cells) flatness_[cell] = flatness_of(cell);
  }

  /// Returns the ways in which a vertex may move: the axes, as far as they lie along its planes.
  std::vector<Vec<3>> ways_of(int vertex) const {
    const auto& planes = planes_[vertex];
    std::vector<Vec<3>> ways;
    if (planes.size() > 2) return ways;
    const int first_surface = static_cast<int>(body_.planes().size());
    for (const int plane : planes)
      if (plane >= first_surface && (plane - first_surface) % 2 == 1) return ways;
    const auto normal = [&](std::size_t i) {
      return planes[i] < first_surface ? body_.planes()[planes[i]].normal : normal_at(vertex, planes[i]);
    };
    for (int d = 0; d < 3; ++d) {
      Vec<3> way{};
      way[d] = 1.0;
      if (planes.size() == 1) way -= normal(0) * dot(normal(0), way);
      if (planes.size() == 2) {
        const Vec<3> line = cross(normal(0), normal(1));
        if (planes[1] >= first_surface && !(norm(line) > kAcross)) return {};
        way = line * (dot(line, way) / dot(line, line));
      }
      if (const double length = norm(way); length > kAcross) ways.push_back(way * (1.0 / length));
    }
    return ways;
  }

  std::vector<int> cells_of(const std::vector<int>& faces) const {
    std::vector<int> cells;
    for (const int f : faces)
      for (const int cell : {cells_.faces[f].inner, cells_.faces[f].outer})
        if (cell >= 0) cells.push_back(cell);
    sort_unique(cells);
    return cells;
  }

  /// Returns the mean relative size of blocks at the corners of a cell's faces.
  double mean_relative(const std::vector<int>& faces) const {
    double sum = 0.0, corners = 0.0;
    for (const int f : faces)
      for (const int v : cells_.faces[f].corners) {
        sum += relative_[v];
        corners += 1.0;
      }
    return sum / corners;
  }

  double flatness_of(int cell) const {
    return flatness(cells_, static_cast<std::size_t>(cell), size_of_cell_[cell]);
  }

  double known_flatness(const std::vector<int>& cells) const {
    double sum = 0.0;
    for (const int cell : cells) sum += flatness_[cell];
    return sum;
  }

  /// Returns the flatness of cells, or of the first of them when it has come to a limit.
  double flatness_up_to(double limit, const std::vector<int>& cells) const {
    double sum = 0.0;
    for (const int cell : cells)
      if (sum += flatness_of(cell); !(sum < limit)) break;
    return sum;
  }

  std::vector<std::vector<int>> loops_of(const std::vector<int>& faces) const {
    std::vector<std::vector<int>> loops;
    for (const int f : faces) loops.push_back(cells_.faces[f].corners);
    return loops;
  }
  void put(const std::vector<int>& faces, const std::vector<std::vector<int>>& loops) {
    for (std::size_t i = 0; i < faces.size(); ++i) cells_.faces[faces[i]].corners = loops[i];
  }

  const Vec<3>& at(int v) const { return cells_.vertices[v]; }

  Cells<3>& cells_;
  const Prism& body_;
  RegularCells asked_;
  double size_;                             ///< mean of the blocks, m
  std::vector<double> relative_;            ///< size of blocks at each vertex before it moved, over the mean
  std::vector<double> size_of_cell_;        ///< size that each cell was to have, m
  double shortest_ = 0.0;                   ///< limit of edges, over the relative size of the blocks there, m
  std::vector<std::vector<int>> planes_;    ///< planes of the body on which each vertex lies, ascending
  std::vector<std::vector<int>> faces_at_;  ///< faces at each vertex; none: merged into another
  std::vector<double> way_;                 ///< by which each vertex moves next, m
  std::vector<int> surface_of_face_;        ///< number of the surface on which each face lies; -1: on none
  std::vector<double> flatness_;            ///< of each cell
  std::vector<std::array<int, 2>> edges_;   ///< scratch of is_ball
};

}  // namespace

RegularisedCells regularise(Cells<3>& cells, const Prism& body, const std::vector<int>& plane,
                            const RegularCells& asked, const BlockSizes& sizes, std::span<const int> stone) {
  return CellRegulariser(cells, body, plane, asked, sizes, stone).run();
}

}  // namespace pyroclast::specimen
