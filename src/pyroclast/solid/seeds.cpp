#include "pyroclast/solid/seeds.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

#include "pyroclast/specimen/grain_grid.hpp"

namespace pyroclast::solid {

namespace {

/// Least distance of seeds, in mean spacings. Seeds placed one by one find no more room from 0.90 on: hard
/// spheres then take a share of 0.38 (Torquato, Uche and Stillinger, Phys. Rev. E 74 (2006) 061308). At 0.62
/// the last ones find room in a third of their tries, so that the search ends soon.
constexpr double kLeastDistance = 0.62;

/// Seeds as balls that may touch.
class SeedGrid {
 public:
  SeedGrid(const Prism& body, std::size_t count)
      : distance_(kLeastDistance * std::cbrt(body.volume() / static_cast<double>(count))),
        grid_(body.low(), body.high(), distance_) {}

  bool has_room_at(const Vec<3>& point) const { return !grid_.overlaps({point, distance_}, 0.0); }
  void add(const Vec<3>& point) { grid_.insert({point, distance_}); }

 private:
  double distance_;
  specimen::GrainGrid<3> grid_;
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
    if (body.distance(point) >= 0.0 || !grid.has_room_at(point)) continue;
    grid.add(point);
    places.push_back(point);
  }
}

}  // namespace

SolidSeeds spaced_seeds(const Prism& body, int count, double spread, Random& random) {
  const double spacing = std::cbrt(body.volume() / count);
  SeedGrid grid(body, static_cast<std::size_t>(count));
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
  SeedGrid grid(body, count);
  std::vector<Vec<3>> places;
  for (std::size_t i = 0; i < count; ++i)
    if (!std::ranges::binary_search(which, static_cast<int>(i))) {
      grid.add(seeds.position[i]);
      places.push_back(seeds.position[i]);
    }
  fill(grid, body, count, random, places);
  std::size_t next = count - which.size();
  for (const int i : which) seeds.position[i] = places[next++];
}

}  // namespace pyroclast::solid
