#include "pyroclast/specimen/block_order.hpp"

#include <algorithm>
#include <cstdint>
#include <utility>
#include <vector>

#include "pyroclast/specimen/polygon.hpp"
#include "pyroclast/specimen/topology.hpp"

namespace pyroclast::specimen {
namespace {

/// Number of squares along each side; the curve passes through all 2^16 x 2^16 squares, each once.
constexpr std::uint32_t curve_side = 1U << 16;

/// Returns the place of a square along Hilbert's curve (D. Hilbert, Math. Ann. 38 (1891) 459): finds the
/// quarter in which the square lies, then the quarter of that one, each turned as the curve enters it.
std::uint64_t place_on_curve(std::uint32_t x, std::uint32_t y) {
  std::uint64_t place = 0;
  for (std::uint32_t half = curve_side / 2; half > 0; half /= 2) {
    const bool right = (x & half) != 0;
    const bool upper = (y & half) != 0;
    const std::uint64_t quarter = right ? (upper ? 2 : 3) : (upper ? 1 : 0);
    place += quarter * half * half;
    if (upper) continue;
    if (right) {
      x = curve_side - 1 - x;
      y = curve_side - 1 - y;
    }
    std::swap(x, y);
  }
  return place;
}

std::uint32_t square(double x, double length) {
  return static_cast<std::uint32_t>(std::clamp(x / length * curve_side, 0.0, curve_side - 1.0));
}

std::vector<std::size_t> number_cells(Cells<2>& cells, const Box& box) {
  std::vector<std::pair<std::uint64_t, std::size_t>> order;
  std::vector<Vec<2>> polygon;
  for (std::size_t c = 0; c < cells.cells.size(); ++c) {
    corners(cells, c, polygon);
    const Vec<2> centre = centroid(polygon) - box.low;
    order.emplace_back(place_on_curve(square(centre[0], box.width()), square(centre[1], box.height())), c);
  }
  std::sort(order.begin(), order.end());
  std::vector<std::vector<int>> in_order;
  std::vector<std::size_t> before;
  in_order.reserve(order.size());
  for (const auto& [place, c] : order) {
    in_order.push_back(std::move(cells.cells[c]));
    before.push_back(c);
  }
  cells.cells = std::move(in_order);
  return before;
}

void number_vertices(Cells<2>& cells) {
  std::vector<int> number(cells.vertices.size(), -1);
  std::vector<Vec<2>> vertices;
  vertices.reserve(number.size());
  for (auto& cell : cells.cells) {
    for (int& v : cell) {
      int& n = number[static_cast<std::size_t>(v)];
      if (n < 0) {
        n = static_cast<int>(vertices.size());
        vertices.push_back(cells.vertices[static_cast<std::size_t>(v)]);
      }
      v = n;
    }
  }
  cells.vertices = std::move(vertices);
}

}  // namespace

std::vector<std::size_t> number_along_curve(Cells<2>& cells, const Box& box) {
  std::vector<std::size_t> before = number_cells(cells, box);
  number_vertices(cells);
  return before;
}

}  // namespace pyroclast::specimen
