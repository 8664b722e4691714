#include "pyroclast/specimen/block_sizes.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace pyroclast::specimen {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
/// Slope of the size over the distance: the middles of two blocks are as far from each other as half of both.
constexpr double kSlopeOfSize = 2.0 * kBlockGrowth / (2.0 + kBlockGrowth);
/// Least number of boxes along the longest side of a body.
template <int Dim>
constexpr double kFewestAlong = Dim == 2 ? 64.0 : 32.0;
/// Largest number of boxes along it: a deck may ask for sizes that no memory would hold.
template <int Dim>
constexpr double kMostAlong = Dim == 2 ? 2048.0 : 192.0;
constexpr int kHalvings = 60;

double distance_from(const std::array<Vec<3>, 2>& box, const Vec<3>& place) {
  Vec<3> away{};
  for (int d = 0; d < 3; ++d) away[d] = std::max({box[0][d] - place[d], place[d] - box[1][d], 0.0});
  return norm(away);
}

/// Returns the distance from a plane face, m, or `limit` where that is less.
double distance_from_face(const FinerPiece& corners, const Vec<3>& place, double limit) {
  Vec<3> normal{};
  for (std::size_t i = 1; i + 1 < corners.size(); ++i)
    normal += cross(corners[i] - corners[0], corners[i + 1] - corners[0]);
  const double height = dot(normal, place - corners[0]), squared = dot(normal, normal);
  if (height * height >= limit * limit * squared) return limit;
  double nearest = kInfinity;
  bool is_over_it = true;
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const Vec<3>&from = corners[i], &to = corners[(i + 1) % corners.size()];
    is_over_it = is_over_it && dot(cross(to - from, place - from), normal) >= 0.0;
    nearest = std::min(nearest, distance_from_segment(place, from, to));
  }
  return std::min(limit, is_over_it ? std::abs(height) / std::sqrt(squared) : nearest);
}

/// Returns the size that the parts allow at a place, m.
double size_near(const std::vector<FinerPart>& finer, const Vec<3>& place) {
  double size = kInfinity;
  for (const FinerPart& part : finer) {
    Vec<3> at = place;
    if (part.is_along_z) at[2] = 0.0;
    double distance = part.box ? distance_from(*part.box, at) : kInfinity;
    for (const FinerPiece& piece : part.pieces)
      distance = piece.size() > 2
                     ? distance_from_face(piece, at, distance)
                     : std::min(distance, distance_from_segment(at, piece.front(), piece.back()));
    size = std::min(size, part.size + kSlopeOfSize * std::max(0.0, distance - part.distance));
  }
  return size;
}

template <int Dim>
double power(double size) {
  return Dim == 2 ? size * size : size * size * size;
}

template <int Dim>
struct Cuboid {
  Vec<Dim> low, high;

  Vec<Dim> middle() const { return 0.5 * (low + high); }
  double extent() const {
    double product = 1.0;
    for (int d = 0; d < Dim; ++d) product *= high[d] - low[d];
    return product;
  }
  /// Returns the axis along which it is longest, the first of several.
  int longest_axis() const {
    const Vec<Dim> sides = high - low;
    return static_cast<int>(std::ranges::max_element(sides.c) - sides.c.begin());
  }
  double longest() const {
    const int d = longest_axis();
    return high[d] - low[d];
  }
};

/// Cuts a box in halves until each is no larger than the size in its middle, within bounds.
template <int Dim, class Size, class Take>
void cut(const Cuboid<Dim>& box, double least, double most, Size size, Take take) {
  if (box.longest() <= std::clamp(size(box.middle()), least, most)) return take(box);
  const int d = box.longest_axis();
  Cuboid<Dim> low = box, high = box;
  low.high[d] = high.low[d] = box.middle()[d];
  cut(low, least, most, size, take);
  cut(high, least, most, size, take);
}

/// Cuts the box of a body. Takes boxes whose middles lie in the body or less than `reach` of their half
/// diagonals away from it.
template <int Dim, class Size, class Take>
void cut(const Room<Dim>& body, double reach, Size size, Take take) {
  const Cuboid<Dim> all{body.low, body.high};
  cut(all, all.longest() / kMostAlong<Dim>, all.longest() / kFewestAlong<Dim>, size,
      [&](const Cuboid<Dim>& box) {
        const double away = 0.5 * reach * norm(box.high - box.low);
        if (!body.distance || body.distance(box.middle()) < away) take(box);
      });
}

}  // namespace

double BlockSizes::at(const Vec<3>& place) const {
  if (finer_.empty()) return mean_;
  return std::min(largest_, scale_ * size_near(finer_, place));
}

double BlockSizes::smallest() const {
  double size = largest_;
  for (const FinerPart& part : finer_) size = std::min(size, scale_ * part.size);
  return size;
}

BlockSizes BlockSizes::scaled_to(double mean) const {
  if (finer_.empty()) return BlockSizes(mean);
  BlockSizes scaled = *this;
  const double factor = mean / mean_;
  scaled.mean_ = mean;
  scaled.largest_ *= factor;
  scaled.scale_ = scale_ * factor;
  return scaled;
}

template <int Dim>
SizedExtent<Dim>::SizedExtent(const Room<Dim>& body, const std::vector<FinerPart>& finer) {
  double all = 0.0;
  const auto size = [&](const Vec<Dim>& place) { return size_near(finer, resized<3>(place)); };
  cut(body, 0.0, size, [&](const Cuboid<Dim>& box) {
    pieces_.push_back({box.extent(), size(box.middle())});
    all += pieces_.back().extent;
  });
  for (Piece& piece : pieces_) piece.extent *= body.extent / all;
}

template <int Dim>
double SizedExtent<Dim>::blocks(double largest) const {
  double sum = 0.0;
  for (const auto& [extent, size] : pieces_) sum += extent / power<Dim>(std::min(size, largest));
  return sum;
}

template <int Dim>
std::optional<double> SizedExtent<Dim>::largest_for(double count) const {
  double low = kInfinity, high = 0.0;
  for (const Piece& piece : pieces_) {
    low = std::min(low, piece.size);
    high = std::max(high, piece.size);
  }
  if (!(blocks(high) <= count)) return std::nullopt;
  while (blocks(low) < count) low *= 0.5;
  for (int i = 0; i < kHalvings; ++i) {
    const double middle = 0.5 * (low + high);
    (blocks(middle) > count ? low : high) = middle;
  }
  return high;
}

template class SizedExtent<2>;
template class SizedExtent<3>;

template <int Dim>
PlaceDraw<Dim>::PlaceDraw(const Room<Dim>& body, const BlockSizes& sizes) : sizes_(sizes) {
  double sum = 0.0;
  cut(
      body, 1.0, [&](const Vec<Dim>& place) { return sizes.at(place); },
      [&](const Cuboid<Dim>& box) {
        const double half_diagonal = 0.5 * norm(box.high - box.low);
        const double least =
            std::max(sizes.smallest(), sizes.at(box.middle()) - kSlopeOfSize * half_diagonal);
        parts_.push_back({box.low, box.high, least});
        sum += box.extent() / power<Dim>(least);
        up_to_.push_back(sum);
      });
}

template <int Dim>
Vec<Dim> PlaceDraw<Dim>::draw(Random& random) const {
  while (true) {
    const auto found = std::ranges::upper_bound(up_to_, random.uniform(0.0, up_to_.back()));
    const auto number = std::min<std::ptrdiff_t>(found - up_to_.begin(), std::ssize(up_to_) - 1);
    const auto& [low, high, least] = parts_[static_cast<std::size_t>(number)];
    Vec<Dim> place;
    for (int d = 0; d < Dim; ++d) place[d] = random.uniform(low[d], high[d]);
    if (random.uniform() < power<Dim>(least / sizes_.at(place))) return place;
  }
}

template class PlaceDraw<2>;
template class PlaceDraw<3>;

}  // namespace pyroclast::specimen
