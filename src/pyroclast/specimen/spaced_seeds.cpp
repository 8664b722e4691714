#include "pyroclast/specimen/spaced_seeds.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <numeric>
#include <utility>

#include <fmt/format.h>

#include "pyroclast/base/error.hpp"

namespace pyroclast::specimen {

namespace {

/// Least distance of seeds, in sizes of the blocks there. Seeds placed one by one find no more room from 0.90
/// on: hard spheres then take a share of 0.38 (Torquato, Uche and Stillinger, Phys. Rev. E 74 (2006) 061308).
/// At 0.62 the last ones find room in a third of their tries, so that the search ends soon.
constexpr double kLeastDistance = 0.62;

/// Tries of one seed, after which there is no place.
constexpr int kMostTries = 1'000'000;

double distance_at(double size) {
  return kLeastDistance * size;
}

/// Returns the place of a point along Morton's curve (G. M. Morton, IBM, 1966): the bits of its coordinates,
/// by turns.
std::uint64_t place_on_curve(const Vec<3>& point, const Prism& body) {
  constexpr int kBits = 20;
  std::array<std::uint32_t, 3> box;
  for (int d = 0; d < 3; ++d) {
    const double share = (point[d] - body.low()[d]) / (body.high()[d] - body.low()[d]);
    box[d] = static_cast<std::uint32_t>(share * ((1U << kBits) - 1U));
  }
  std::uint64_t place = 0;
  for (int bit = kBits - 1; bit >= 0; --bit)
    for (int d = 0; d < 3; ++d) place = 2 * place + ((box[d] >> bit) & 1U);
  return place;
}

}  // namespace

SpacedSeedDraw::SpacedSeedDraw(const Prism& body, const BlockSizes& sizes, Random& random, Allows allows)
    : body_(body),
      sizes_(sizes),
      random_(random),
      allows_(std::move(allows)),
      grid_(body.low(), body.high(), distance_at(sizes.mean())) {
  if (!sizes.is_even()) places_.emplace(room_in(body), sizes);
}

void SpacedSeedDraw::add(const Vec<3>& point) {
  grid_.insert({point, distance_at(sizes_.at(point))});
}

Vec<3> SpacedSeedDraw::draw() {
  for (int i = 0; i < kMostTries; ++i) {
    const Vec<3> point = places_ ? places_->draw(random_) : anywhere();
    if (body_.distance(point) >= 0.0 || grid_.overlaps({point, distance_at(sizes_.at(point))}, 0.0)) continue;
    if (allows_ && !allows_(point, i)) continue;
    add(point);
    return point;
  }
  throw Error(fmt::format("after {} blocks there is no place for more: blocks of {:.3g} mm are too large",
                          grid_.stones().size(), 1e3 * sizes_.mean()));
}

Vec<3> SpacedSeedDraw::anywhere() {
  Vec<3> point;
  for (int d = 0; d < 3; ++d) point[d] = random_.uniform(body_.low()[d], body_.high()[d]);
  return point;
}

std::vector<std::size_t> order_along_curve(const std::vector<Vec<3>>& places, const Prism& body) {
  std::vector<std::size_t> order(places.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::ranges::stable_sort(order, {}, [&](std::size_t i) { return place_on_curve(places[i], body); });
  return order;
}

Seeds<3> spaced_seeds(const Prism& body, const BlockSizes& sizes, int count, double spread, Random& random) {
  SpacedSeedDraw draw(body, sizes, random);
  Seeds<3> seeds;
  auto& places = seeds.position;
  for (int i = 0; i < count; ++i) places.push_back(draw.draw());
  std::ranges::sort(places, {}, [&](const Vec<3>& p) { return place_on_curve(p, body); });
  for (const Vec<3>& place : places)
    seeds.radius.push_back(0.5 * sizes.at(place) * random.uniform(1.0 - spread, 1.0 + spread));
  return seeds;
}

Seeds<3> spaced_seeds(const Prism& body, int count, double spread, Random& random) {
  return spaced_seeds(body, BlockSizes(std::cbrt(body.extent() / count)), count, spread, random);
}

void redraw(Seeds<3>& seeds, const std::vector<int>& which, const Prism& body, const BlockSizes& sizes,
            Random& random) {
  SpacedSeedDraw draw(body, sizes, random);
  for (std::size_t i = 0; i < seeds.position.size(); ++i)
    if (!std::ranges::binary_search(which, static_cast<int>(i))) draw.add(seeds.position[i]);
  for (const int i : which) {
    Vec<3>& place = seeds.position[i];
    const double before = sizes.at(place);
    place = draw.draw();
    seeds.radius[i] *= sizes.at(place) / before;
  }
}

}  // namespace pyroclast::specimen
