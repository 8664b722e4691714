#include "pyroclast/solid/pieces.hpp"

#include <algorithm>
#include <cstddef>
#include <map>
#include <numeric>
#include <utility>

#include <fmt/format.h>

#include "pyroclast/base/error.hpp"
#include "pyroclast/specimen/pieces.hpp"

namespace pyroclast::solid {

namespace {

/// Returns the corners of a face from the lowest on, towards the lower of its neighbours: the same for two
/// faces that have the same corners in turn.
std::vector<int> from_lowest(std::vector<int> corners) {
  std::rotate(corners.begin(), std::ranges::min_element(corners), corners.end());
  if (corners.back() < corners[1]) std::reverse(corners.begin() + 1, corners.end());
  return corners;
}

/// Returns for each face the first one with the same corners in turn, or the face itself.
/// \param first  vertex that stands for each vertex
std::vector<int> first_alike(const Complex& complex, const std::vector<int>& first) {
  std::map<std::vector<int>, int> known;
  std::vector<int> alike;
  for (const CellFace& face : complex.faces) {
    std::vector<int> corners;
    for (const int v : face.corners) corners.push_back(first[v]);
    alike.push_back(
        known.emplace(from_lowest(std::move(corners)), static_cast<int>(alike.size())).first->second);
  }
  return alike;
}

/// Keeps the items that are used, and renumbers them in `numbers`. Returns the number that each had.
template <class T, class Numbers>
std::vector<int> keep_used(std::vector<T>& items, Numbers& lists, auto numbers_of) {
  std::vector<int> number(items.size(), -1), former;
  for (const auto& list : lists)
    for (const int i : numbers_of(list)) number[i] = 0;
  std::vector<T> kept;
  for (std::size_t i = 0; i < items.size(); ++i) {
    if (number[i] < 0) continue;
    number[i] = static_cast<int>(kept.size());
    former.push_back(static_cast<int>(i));
    kept.push_back(std::move(items[i]));
  }
  for (auto& list : lists)
    for (int& i : numbers_of(list)) i = number[i];
  items = std::move(kept);
  return former;
}

void require_apart(const Complex& complex, const std::vector<int>& first, double distance) {
  for (std::size_t f = 0; f < complex.faces.size(); ++f) {
    std::vector<int> corners;
    for (const int v : complex.faces[f].corners) corners.push_back(first[v]);
    std::ranges::sort(corners);
    const auto twice = std::ranges::adjacent_find(corners);
    if (twice == corners.end()) continue;
    const Vec<3>& at = complex.vertices[*twice];
    throw Error(fmt::format(
        "face {} (from 0) has two corners near ({:.6g}, {:.6g}, {:.6g}) m that are nearer to each "
        "other than {:.6g} m, by which vertices are joined; join less",
        f, at[0], at[1], at[2], distance));
  }
}

}  // namespace

std::vector<int> join(Complex& complex, double distance) {
  const std::vector<int> first = specimen::first_near<3>(complex.vertices, distance);
  require_apart(complex, first, distance);
  const std::vector<int> alike = first_alike(complex, first);
  for (CellFace& face : complex.faces)
    for (int& v : face.corners) v = first[v];
  for (auto& cell : complex.cells)
    for (int& face : cell) face = alike[face];
  const auto former = keep_used(
      complex.faces, complex.cells, [](auto& cell) -> auto& { return cell; });
  keep_used(
      complex.vertices, complex.faces, [](auto& face) -> auto& { return face.corners; });
  return former;
}

std::string describe_pieces(const Complex& complex) {
  std::vector<std::pair<int, int>> neighbours;
  for (const CellFace& face : complex.faces) neighbours.emplace_back(face.inner, face.outer);
  return specimen::describe_pieces(
      specimen::pieces_of(complex.cells.size(), neighbours), "face", [&](int cell) {
        const Vec<3> at = zone_cell(complex, cell).gridpoints.back();
        return fmt::format("cell {} (from 0) at ({:.6g}, {:.6g}, {:.6g}) m", cell, at[0], at[1], at[2]);
      });
}

std::string describe_joinable(const Complex& complex) {
  Vec<3> low = complex.vertices.front(), high = low;
  for (const Vec<3>& v : complex.vertices)
    for (int d = 0; d < 3; ++d) {
      low[d] = std::min(low[d], v[d]);
      high[d] = std::max(high[d], v[d]);
    }
  const Vec<3> size = high - low;
  const double near = specimen::kCoincide * std::max({size[0], size[1], size[2]});
  if (!(near > 0.0)) return {};
  const std::vector<int> first = specimen::first_near<3>(complex.vertices, near);
  const auto repeats = [](const std::vector<int>& of) {
    std::ptrdiff_t count = 0;
    for (int i = 0; i < static_cast<int>(of.size()); ++i) count += of[i] != i ? 1 : 0;
    return count;
  };
  const std::ptrdiff_t vertices = repeats(first), faces = repeats(first_alike(complex, first));
  if (vertices == 0 && faces == 0) return "; no vertices coincide, and no face has the corners of another";
  const std::string coincide =
      fmt::format("; {} vert{} with others", vertices, vertices == 1 ? "ex coincides" : "ices coincide");
  if (faces == 0)
    return coincide + ", but no face has the corners of another then: neighbours must share whole faces";
  return fmt::format("{}, and {} the corners of another: join = \"{:.3g} m\" joins them", coincide,
                     faces == 1 ? "1 face has" : fmt::format("{} faces have", faces), near);
}

}  // namespace pyroclast::solid
