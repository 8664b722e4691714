#include "pyroclast/specimen/superposition.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <map>
#include <numeric>

#include "pyroclast/specimen/polygon.hpp"
#include "pyroclast/specimen/polyhedron.hpp"
#include "pyroclast/specimen/stone_grid.hpp"
#include "pyroclast/specimen/topology.hpp"

namespace pyroclast::specimen {
namespace {

/// Calls f(vertex) for the vertices of a cell; those of its faces come several times.
template <class F>
void for_each_corner(const Cells<2>& cells, std::size_t cell, F f) {
  for (const int v : cells.cells[cell]) f(cells.vertices[v]);
}

template <class F>
void for_each_corner(const Cells<3>& cells, std::size_t cell, F f) {
  for (const int face : cells.cells[cell])
    for (const int v : cells.faces[face].corners) f(cells.vertices[v]);
}

/// Returns what a cell and a stone have in common, m².
double common(const Cells<2>& cells, std::size_t cell, const Stone<2>& stone) {
  std::vector<Vec<2>> polygon;
  corners(cells, cell, polygon);
  return stone.shape ? common_area(polygon, corners_of(stone))
                     : common_area(polygon, stone.centre, 0.5 * stone.diameter);
}

/// Returns what a cell and a ball have in common, m³.
double common(const Cells<3>& cells, std::size_t cell, const Stone<3>& stone) {
  return common_volume(cells, cell, stone.centre, 0.5 * stone.diameter);
}

/// Returns the stone in which the centroid of each cell lies, -1: in none.
template <int Dim>
std::vector<int> stones_at_centroids(const Cells<Dim>& cells, const OutlineOf<Dim>& outline,
                                     std::span<const Stone<Dim>> stones) {
  const StoneGrid<Dim> grid(outline.low(), outline.high(), stones);
  std::vector<int> found, nearby;
  for (std::size_t cell = 0; cell < cells.cells.size(); ++cell) {
    const Vec<Dim> centre = centroid(cells, cell);
    grid.collect(centre, centre, nearby);
    const auto around = std::ranges::find_if(nearby, [&](int stone) { return holds(stones[stone], centre); });
    found.push_back(around == nearby.end() ? -1 : *around);
  }
  return found;
}

/// Gives each stone, the largest first, the cell of which it covers most and that none took before, while
/// that brings the extent of the cells nearer to that of the stones.
/// \param missing  extent of the stones that no cell has; follows
template <int Dim>
void give_each_its_cell(const Cells<Dim>& cells, std::span<const Stone<Dim>> stones,
                        std::span<const CommonPart> parts, double& missing, Superposed& result) {
  std::vector<std::vector<CommonPart>> of_stone(stones.size());
  for (const CommonPart& part : parts) of_stone[part.stone].push_back(part);
  std::vector<int> order(stones.size());
  std::iota(order.begin(), order.end(), 0);
  std::ranges::stable_sort(order, std::greater<>(), [&](int stone) { return stones[stone].diameter; });
  for (const int stone : order) {
    std::ranges::stable_sort(of_stone[stone], std::greater<>(), &CommonPart::extent);
    const auto free = std::ranges::find_if(
        of_stone[stone], [&](const CommonPart& part) { return result.stone[part.cell] < 0; });
    if (free == of_stone[stone].end()) continue;
    const double taken = extent(cells, static_cast<std::size_t>(free->cell));
    if (0.5 * taken >= missing) break;
    missing -= taken;
    result.stone[free->cell] = stone;
    result.phase[free->cell] = stones[stone].phase;
  }
}

/// Finds the share above which covered cells are aggregate, so that their extent comes as near as it can to
/// that of the stones.
/// \param each  each stone has a cell before
template <int Dim>
void fit(const Cells<Dim>& cells, std::span<const Stone<Dim>> stones, std::span<const CommonPart> parts,
         std::span<const Cover> covers, bool each, Superposed& result) {
  double missing = extent_of(stones);
  if (each) give_each_its_cell(cells, stones, parts, missing, result);
  struct Candidate {
    double share, extent;
  };
  std::vector<Candidate> candidates;
  for (std::size_t cell = 0; cell < covers.size(); ++cell)
    if (result.stone[cell] < 0) candidates.push_back({covers[cell].share, extent(cells, cell)});
  std::ranges::sort(candidates, std::greater<>(), &Candidate::share);
  std::size_t taken = 0;
  for (; taken < candidates.size() && 0.5 * candidates[taken].extent < missing; ++taken)
    missing -= candidates[taken].extent;
  result.covered_fraction = 0.0;
  if (taken == 0)
    result.covered_fraction = std::nextafter(1.0, 0.0);
  else if (taken < candidates.size())
    result.covered_fraction = 0.5 * (candidates[taken - 1].share + candidates[taken].share);
}

/// Half of the plane, or of space, beside a facet of a cell.
template <int Dim>
struct Half {
  Vec<Dim> at;      ///< a place on the facet, m
  Vec<Dim> inward;  ///< way into the cell, of any length
};

/// Lists the halves beside the facets of a cell: their common part is the cell.
void halves_of(const Cells<2>& cells, std::size_t cell, std::vector<Half<2>>& halves) {
  std::vector<Vec<2>> polygon;
  corners(cells, cell, polygon);
  halves.clear();
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Vec<2> edge = polygon[(i + 1) % polygon.size()] - polygon[i];
    halves.push_back({polygon[i], {{-edge[1], edge[0]}}});
  }
}
void halves_of(const Cells<3>& cells, std::size_t cell, std::vector<Half<3>>& halves) {
  halves.clear();
  for (const int f : cells.cells[cell]) {
    const Facet<3>& face = cells.faces[f];
    Vec<3> middle{};
    for (const int v : face.corners)
      middle += cells.vertices[v] * (1.0 / static_cast<double>(face.corners.size()));
    const double sense = face.inner == static_cast<int>(cell) ? -1.0 : 1.0;
    halves.push_back({middle, area_vector(cells, face) * sense});
  }
}

/// Tells whether a fibre runs through the inside of a convex cell: clips it by the halves beside the facets.
template <int Dim>
bool crosses(const std::vector<Half<Dim>>& halves, const Fibre<Dim>& fibre) {
  const Vec<Dim> along = fibre.to - fibre.from;
  double enters = 0.0, leaves = 1.0;
  for (const auto& [at, inward] : halves) {
    const double start = dot(fibre.from - at, inward), rate = dot(along, inward);
    if (rate > 0.0)
      enters = std::max(enters, -start / rate);
    else if (rate < 0.0)
      leaves = std::min(leaves, -start / rate);
    else if (start <= 0.0)
      return false;
  }
  return leaves > enters;
}

}  // namespace

template <int Dim>
std::vector<CommonPart> common_parts(const Cells<Dim>& cells, const OutlineOf<Dim>& outline,
                                     std::span<const Stone<Dim>> stones) {
  const StoneGrid<Dim> grid(outline.low(), outline.high(), stones);
  std::vector<CommonPart> parts;
  std::vector<int> nearby;
  for (std::size_t cell = 0; cell < cells.cells.size(); ++cell) {
    Vec<Dim> lower, upper;
    lower.c.fill(std::numeric_limits<double>::infinity());
    upper.c.fill(-std::numeric_limits<double>::infinity());
    for_each_corner(cells, cell, [&](const Vec<Dim>& at) {
      for (int d = 0; d < Dim; ++d) {
        lower[d] = std::min(lower[d], at[d]);
        upper[d] = std::max(upper[d], at[d]);
      }
    });
    grid.collect(lower, upper, nearby);
    for (const int stone : nearby)
      if (const double its = common(cells, cell, stones[stone]); its > 0.0)
        parts.push_back({static_cast<int>(cell), stone, its});
  }
  return parts;
}

template <int Dim>
std::vector<Cover> covers_of(const Cells<Dim>& cells, std::span<const CommonPart> parts,
                             std::span<const Stone<Dim>> stones) {
  constexpr double kRounding = 1e-12;  // left by stones that do not touch the cell
  std::vector<Cover> covers(cells.cells.size());
  for (auto part = parts.begin(); part != parts.end();) {
    const int cell = part->cell;
    double covered = 0.0, most_of_one = 0.0, most = 0.0;
    std::map<int, double> by_phase;
    Cover& cover = covers[cell];
    for (; part != parts.end() && part->cell == cell; ++part) {
      covered += part->extent;
      by_phase[stones[part->stone].phase] += part->extent;
      if (part->extent <= most_of_one) continue;
      most_of_one = part->extent;
      cover.stone = part->stone;
    }
    for (const auto& [phase, its] : by_phase)
      if (its > most) {
        most = its;
        cover.phase = phase;
      }
    const double share = covered / extent(cells, static_cast<std::size_t>(cell));
    cover.share = share < kRounding ? 0.0 : std::min(share, 1.0);
  }
  return covers;
}

template <int Dim>
Superposed superpose(const Cells<Dim>& cells, const OutlineOf<Dim>& outline,
                     std::span<const Stone<Dim>> stones, const SpecimenParameters& parameters, int matrix) {
  const std::size_t count = cells.cells.size();
  Superposed result{std::vector<int>(count, matrix), std::vector<int>(count, -1),
                    parameters.covered_fraction};
  if (parameters.superposition == Superposition::centroid) {
    result.stone = stones_at_centroids(cells, outline, stones);
    for (std::size_t cell = 0; cell < count; ++cell)
      if (result.stone[cell] >= 0) result.phase[cell] = stones[result.stone[cell]].phase;
    return result;
  }
  const std::vector<CommonPart> parts = common_parts(cells, outline, stones);
  const std::vector<Cover> covers = covers_of<Dim>(cells, parts, stones);
  const bool each = parameters.superposition == Superposition::each;
  if (each || parameters.superposition == Superposition::fit)
    fit<Dim>(cells, stones, parts, covers, each, result);
  for (std::size_t cell = 0; cell < count; ++cell) {
    if (result.stone[cell] >= 0 || !(covers[cell].share > result.covered_fraction)) continue;
    result.phase[cell] = covers[cell].phase;
    result.stone[cell] = covers[cell].stone;
  }
  return result;
}

template std::vector<CommonPart> common_parts<2>(const Cells<2>&, const Region&, std::span<const Stone<2>>);
template std::vector<Cover> covers_of<2>(const Cells<2>&, std::span<const CommonPart>,
                                         std::span<const Stone<2>>);
template Superposed superpose<2>(const Cells<2>&, const Region&, std::span<const Stone<2>>,
                                 const SpecimenParameters&, int);
template Superposed superpose<3>(const Cells<3>&, const Prism&, std::span<const Stone<3>>,
                                 const SpecimenParameters&, int);

template <int Dim>
void superpose(const Cells<Dim>& cells, std::span<const Fibre<Dim>> fibres, std::vector<int>& phase,
               std::vector<int>& stone) {
  if (fibres.empty()) return;
  std::vector<Half<Dim>> halves;
  for (std::size_t c = 0; c < cells.cells.size(); ++c) {
    halves_of(cells, c, halves);
    for (const Fibre<Dim>& fibre : fibres)
      if (crosses(halves, fibre)) {
        phase[c] = fibre.phase;
        stone[c] = -1;
      }
  }
}

template void superpose<2>(const Cells<2>&, std::span<const Fibre<2>>, std::vector<int>&, std::vector<int>&);
template void superpose<3>(const Cells<3>&, std::span<const Fibre<3>>, std::vector<int>&, std::vector<int>&);

}  // namespace pyroclast::specimen
