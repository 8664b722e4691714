#include "pyroclast/specimen/block_sizes.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace pyroclast::specimen {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
/// Slope of the size over the distance: the middles of two blocks are as far from each other as half of both.
constexpr double kSlopeOfSize = 2.0 * kBlockGrowth / (2.0 + kBlockGrowth);
/// Least number of boxes along the region.
constexpr double kFewestAlong = 64.0;
constexpr int kHalvings = 60;

double distance_from(const Box& box, const Vec<2>& place) {
  const double x = std::max({box.low[0] - place[0], place[0] - box.high[0], 0.0});
  const double y = std::max({box.low[1] - place[1], place[1] - box.high[1], 0.0});
  return std::hypot(x, y);
}

/// Returns the size that the parts allow at a place, m.
double size_near(const std::vector<FinerPart>& finer, const Vec<2>& place) {
  double size = kInfinity;
  for (const FinerPart& part : finer) {
    double distance = part.box ? distance_from(*part.box, place) : kInfinity;
    for (const auto& [from, to] : part.pieces)
      distance = std::min(distance, distance_from_segment(place, from, to));
    size = std::min(size, part.size + kSlopeOfSize * std::max(0.0, distance - part.distance));
  }
  return size;
}

Vec<2> middle_of(const Box& box) {
  return 0.5 * (box.low + box.high);
}

/// Cuts a box in halves until each is no larger than the size in its middle.
template <class Size, class Take>
void cut(const Box& box, double most, Size size, Take take) {
  const double longest = std::max(box.width(), box.height());
  if (longest <= std::min(most, size(middle_of(box)))) return take(box);
  const int d = box.width() >= box.height() ? 0 : 1;
  Box low = box, high = box;
  low.high[d] = high.low[d] = middle_of(box)[d];
  cut(low, most, size, take);
  cut(high, most, size, take);
}

double longest_side(const Region& region) {
  return std::max(region.box().width(), region.box().height());
}

}  // namespace

double BlockSizes::at(const Vec<2>& place) const {
  if (finer_.empty()) return mean_;
  return std::min(largest_, scale_ * size_near(finer_, place));
}

double BlockSizes::relative(const Vec<2>& place) const {
  return finer_.empty() ? 1.0 : at(place) / mean_;
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

SizedArea::SizedArea(const Region& region, const std::vector<FinerPart>& finer) {
  double area = 0.0;
  cut(
      region.box(), longest_side(region) / kFewestAlong,
      [&](const Vec<2>& place) { return size_near(finer, place); },
      [&](const Box& box) {
        const Vec<2> middle = middle_of(box);
        if (!region.is_rectangle() && region.distance(middle) >= 0.0) return;
        pieces_.push_back({box.width() * box.height(), size_near(finer, middle)});
        area += pieces_.back().area;
      });
  for (Piece& piece : pieces_) piece.area *= region.area() / area;
}

double SizedArea::blocks(double largest) const {
  double sum = 0.0;
  for (const auto& [area, size] : pieces_) {
    const double side = std::min(size, largest);
    sum += area / (side * side);
  }
  return sum;
}

std::optional<double> SizedArea::largest_for(double count) const {
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

PlaceDraw::PlaceDraw(const Region& region, const BlockSizes& sizes) : sizes_(sizes) {
  double sum = 0.0;
  cut(
      region.box(), longest_side(region) / kFewestAlong, [&](const Vec<2>& place) { return sizes.at(place); },
      [&](const Box& box) {
        const double half_diagonal = 0.5 * std::hypot(box.width(), box.height());
        const Vec<2> middle = middle_of(box);
        const double size = sizes.at(middle);
        if (!region.is_rectangle() && region.distance(middle) >= half_diagonal) return;
        const double least = std::max(sizes.smallest(), size - kSlopeOfSize * half_diagonal);
        parts_.push_back({box, least});
        sum += box.width() * box.height() / (least * least);
        up_to_.push_back(sum);
      });
}

Vec<2> PlaceDraw::draw(Random& random) const {
  while (true) {
    const auto found = std::ranges::upper_bound(up_to_, random.uniform(0.0, up_to_.back()));
    const auto number = std::min<std::ptrdiff_t>(found - up_to_.begin(), std::ssize(up_to_) - 1);
    const auto& [box, least] = parts_[static_cast<std::size_t>(number)];
    const double x = random.uniform(box.low[0], box.high[0]);
    const Vec<2> place{{x, random.uniform(box.low[1], box.high[1])}};
    const double share = least / sizes_.at(place);
    if (random.uniform() < share * share) return place;
  }
}

}  // namespace pyroclast::specimen
