#include "pyroclast/solid/seeds.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

namespace pyroclast::solid {

namespace {

/// Least distance of seeds, in mean spacings. Seeds placed one by one find no more room from 0.90 on: hard
/// spheres then take a share of 0.38 (Torquato, Uche and Stillinger, Phys. Rev. E 74 (2006) 061308). At 0.62
/// the last ones find room in a third of their tries, so that the search ends soon.
constexpr double kLeastDistance = 0.62;

/// Boxes of the least distance's size, with the seeds in each.
class SeedGrid {
 public:
  SeedGrid(const Prism& body, double distance) : low_(body.low()), distance_(distance) {
    for (int d = 0; d < 3; ++d) count_[d] = static_cast<int>((body.high()[d] - body.low()[d]) / distance) + 1;
    seeds_.resize(static_cast<std::size_t>(count_[0]) * count_[1] * count_[2]);
  }

  bool has_room_at(const Vec<3>& point, const std::vector<Vec<3>>& seeds) const {
    const auto at = box_of(point);
    std::array<int, 3> first, last;
    for (int d = 0; d < 3; ++d) {
      first[d] = std::max(0, at[d] - 1);
      last[d] = std::min(count_[d] - 1, at[d] + 1);
    }
    for (int i = first[0]; i <= last[0]; ++i)
      for (int j = first[1]; j <= last[1]; ++j)
        for (int k = first[2]; k <= last[2]; ++k)
          for (const int seed : seeds_[index({i, j, k})])
            if (norm(seeds[seed] - point) < distance_) return false;
    return true;
  }

  void add(const Vec<3>& point, int seed) { seeds_[index(box_of(point))].push_back(seed); }

 private:
  std::array<int, 3> box_of(const Vec<3>& point) const {
    std::array<int, 3> box;
    for (int d = 0; d < 3; ++d)
      box[d] = std::clamp(static_cast<int>((point[d] - low_[d]) / distance_), 0, count_[d] - 1);
    return box;
  }
  std::size_t index(const std::array<int, 3>& box) const {
    return (static_cast<std::size_t>(box[0]) * count_[1] + box[1]) * count_[2] + box[2];
  }

  Vec<3> low_;
  double distance_;
  std::array<int, 3> count_;
  std::vector<std::vector<int>> seeds_;
};

/// Returns the place of a point along Morton's curve (G. M. Morton, IBM, 1966): the bits of its coordinates,
/// by turns.
std::uint64_t place_on_curve(const Vec<3>& point, const Prism& body) {
  constexpr int kBits = 20;
  std::array<std::uint32_t, 3> box;
  for (int d = 0; d < 3; ++d) {
    const double share = (point[d] - body.low()[d]) / (body.high()[d] - body.low()[d]);
    box[d] = static_cast<std::uint32_t>(std::clamp(share, 0.0, 1.0) * ((1U << kBits) - 1U));
  }
  std::uint64_t place = 0;
  for (int bit = kBits - 1; bit >= 0; --bit)
    for (int d = 0; d < 3; ++d) place = 2 * place + ((box[d] >> bit) & 1U);
  return place;
}

/// Adds seeds at random places with room until there are so many.
void fill(SeedGrid& grid, const Prism& body, std::size_t count, Random& random, std::vector<Vec<3>>& places) {
  while (places.size() < count) {
    Vec<3> point;
    for (int d = 0; d < 3; ++d) point[d] = random.uniform(body.low()[d], body.high()[d]);
    if (body.distance(point) >= 0.0 || !grid.has_room_at(point, places)) continue;
    grid.add(point, static_cast<int>(places.size()));
    places.push_back(point);
  }
}

double least_distance(const Prism& body, std::size_t count) {
  return kLeastDistance * std::cbrt(body.volume() / static_cast<double>(count));
}

}  // namespace

SolidSeeds spaced_seeds(const Prism& body, int count, double spread, Random& random) {
  const double spacing = std::cbrt(body.volume() / count);
  SeedGrid grid(body, least_distance(body, static_cast<std::size_t>(count)));
  SolidSeeds seeds;
  auto& places = seeds.position;
  fill(grid, body, static_cast<std::size_t>(count), random, places);
  std::ranges::sort(places, {}, [&](const Vec<3>& p) { return place_on_curve(p, body); });
  for (int i = 0; i < count; ++i)
    seeds.radius.push_back(0.5 * spacing * random.uniform(1.0 - spread, 1.0 + spread));
  return seeds;
}

void redraw(SolidSeeds& seeds, const std::vector<int>& which, const Prism& body, Random& random) {
  const std::size_t count = seeds.position.size();
  SeedGrid grid(body, least_distance(body, count));
  std::vector<Vec<3>> places;
  for (std::size_t i = 0; i < count; ++i)
    if (!std::ranges::binary_search(which, static_cast<int>(i))) {
      grid.add(seeds.position[i], static_cast<int>(places.size()));
      places.push_back(seeds.position[i]);
    }
  fill(grid, body, count, random, places);
  std::size_t next = count - which.size();
  for (const int i : which) seeds.position[i] = places[next++];
}

}  // namespace pyroclast::solid
