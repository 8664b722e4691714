#include "pyroclast/specimen/blocks.hpp"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include <fmt/format.h>

#include "pyroclast/base/error.hpp"
#include "pyroclast/specimen/block_order.hpp"
#include "pyroclast/specimen/laguerre.hpp"
#include "pyroclast/specimen/outline_seeds.hpp"
#include "pyroclast/specimen/regularisation.hpp"
#include "pyroclast/specimen/topology.hpp"

namespace pyroclast::specimen {
namespace {

/// Largest number of rounds. Two to five rounds do for plain Voronoi seeds and edges up to 0.3 of the mean, a
/// few dozen for widely spread radii; this many mean that the parameters allow no tessellation without a
/// short edge.
constexpr int most_rounds = 60;
/// Number of places tried for a free seed before an Error says that there is none.
constexpr int kAttempts = 100'000;

/// Seeds of a region: first the seeds that its outline asks for, then the free ones.
class SeedDraw {
 public:
  SeedDraw(const BlockParameters& parameters, const Region& region, Random& random)
      : region_(region),
        random_(random),
        spacing_(std::sqrt(region.area() / parameters.count)),
        outline_(region, spacing_) {
    const auto needed = static_cast<int>(outline_.positions().size());
    if (needed > parameters.count)
      throw Error(fmt::format("{} blocks are too few for this outline: it takes {} by itself",
                              parameters.count, needed));
    seeds.position = outline_.positions();
    seeds.radius = outline_.radii();
    const double spread = parameters.radius_spread;
    for (int i = needed; i < parameters.count; ++i) {
      seeds.position.push_back(free_position());
      seeds.radius.push_back(0.5 * spacing_ * random_.uniform(1.0 - spread, 1.0 + spread));
    }
  }

  /// Draws the seed of an unfit block anew. Where the outline asks for this seed, draws the free seed nearest
  /// to it. A radius stays with its seed, or the cells of small radii would die out.
  void redraw(std::size_t unfit) {
    const std::size_t first = kept();
    if (first == seeds.position.size()) return;
    if (unfit < first) {
      const Vec<2> at = seeds.position[unfit];
      const auto nearest =
          std::min_element(seeds.position.begin() + static_cast<std::ptrdiff_t>(first), seeds.position.end(),
                           [&](const Vec<2>& a, const Vec<2>& b) { return norm(a - at) < norm(b - at); });
      unfit = static_cast<std::size_t>(nearest - seeds.position.begin());
    }
    seeds.position[unfit] = free_position();
  }

  std::size_t kept() const { return outline_.positions().size(); }

  Seeds seeds;

 private:
  Vec<2> free_position() {
    for (int attempt = 0; attempt < kAttempts; ++attempt) {
      const Box& box = region_.box();
      const double x = random_.uniform(box.low[0], box.high[0]);
      const Vec<2> position{{x, random_.uniform(box.low[1], box.high[1])}};
      if (region_.is_rectangle() || outline_.leave_room_at(position)) return position;
    }
    throw Error(
        fmt::format("no place for a seed was found in {} attempts: blocks of {:.3g} mm are too large for "
                    "this outline",
                    kAttempts, 1e3 * spacing_));
  }

  const Region& region_;
  Random& random_;
  double spacing_;
  OutlineSeeds outline_;
};

/// Returns the name of the side of the outline that is nearest to a point.
std::string side_near(const Region& region, const Vec<2>& point) {
  const auto nearest = std::ranges::min_element(region.pieces(), {}, [&](const Piece& piece) {
    return distance_from_segment(point, piece.from, piece.to);
  });
  return region.sides()[nearest->side].name;
}

Blocks tessellate_until_fit(const BlockParameters& parameters, const Region& region, Random& random,
                            Team* team) {
  SeedDraw draw(parameters, region, random);
  Blocks blocks{};
  while (true) {
    ++blocks.rounds;
    Seeds seeds = draw.seeds;
    for (int i = 0; i < parameters.relaxation; ++i) relax(seeds, region, draw.kept(), team);
    LaguerreResult result = laguerre_tessellation(seeds, region, team);
    std::vector<int> unfit = std::move(result.broken);
    if (unfit.empty()) {
      Regularisation done = regularise(result.tessellation, region, parameters.shortest_edge);
      blocks.tessellation = std::move(result.tessellation);
      blocks.edges_removed = done.edges_removed;
      blocks.edges_left_short = done.edges_left_short;
      unfit = std::move(done.unfit);
    }
    if (unfit.empty()) return blocks;
    if (blocks.rounds == most_rounds) {
      if (!blocks.tessellation.cells.empty()) return blocks;
      const Vec<2> at = seeds.position[static_cast<std::size_t>(unfit.front())];
      throw Error(fmt::format(
          "{}no tessellation of {} blocks came about in {} rounds: {} cells stay empty or unfit, "
          "the first near ({:.6g}, {:.6g}) m at the side \"{}\". What the outline has there must be "
          "some three blocks wide: take more blocks (count){}",
          parameters.place.empty() ? "" : parameters.place + ": ", parameters.count, most_rounds,
          unfit.size(), at[0], at[1], side_near(region, at),
          parameters.radius_spread > 0.0 ? ", or blocks more alike (radius_spread)" : ""));
    }
    for (const int i : unfit) draw.redraw(static_cast<std::size_t>(i));
    blocks.seeds_redrawn += static_cast<int>(unfit.size());
  }
}

}  // namespace

Blocks make_blocks(const BlockParameters& parameters, const Region& region, Random& random, Team* team) {
  Blocks blocks{};
  if (!parameters.tessellation) {
    blocks = tessellate_until_fit(parameters, region, random, team);
    require_valid(blocks.tessellation, region, fmt::format("Tessellation of {} blocks", parameters.count));
  } else {
    blocks.tessellation = *parameters.tessellation;
    const Regularisation done = regularise(blocks.tessellation, region, parameters.shortest_edge);
    blocks.edges_removed = done.edges_removed;
    blocks.edges_left_short = done.edges_left_short;
  }
  for (const std::size_t before : number_along_curve(blocks.tessellation, region.box()))
    if (!parameters.phase.empty()) blocks.phase.push_back(parameters.phase[before]);
  return blocks;
}

}  // namespace pyroclast::specimen
