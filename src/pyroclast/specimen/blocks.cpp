#include "pyroclast/specimen/blocks.hpp"

#include <cmath>
#include <utility>

#include <fmt/format.h>

#include "pyroclast/base/error.hpp"
#include "pyroclast/specimen/block_order.hpp"
#include "pyroclast/specimen/laguerre.hpp"
#include "pyroclast/specimen/neper_tess.hpp"
#include "pyroclast/specimen/regularisation.hpp"
#include "pyroclast/specimen/topology.hpp"

namespace pyroclast::specimen {
namespace {

/// Two to five rounds do for plain Voronoi seeds and edges up to 0.3 of the mean, a few dozen for widely
/// spread radii; this many mean that the parameters allow no tessellation without a short edge.
constexpr int most_rounds = 60;

Vec<2> draw_position(double width, double height, Random& random) {
  const double x = random.uniform(0.0, width);
  return {{x, random.uniform(0.0, height)}};
}

Seeds draw_seeds(const BlockParameters& parameters, double width, double height, Random& random) {
  const double half_spacing = 0.5 * std::sqrt(width * height / parameters.count);
  Seeds seeds;
  for (int i = 0; i < parameters.count; ++i) {
    seeds.position.push_back(draw_position(width, height, random));
    seeds.radius.push_back(half_spacing *
                           random.uniform(1.0 - parameters.radius_spread, 1.0 + parameters.radius_spread));
  }
  return seeds;
}

LaguerreResult tessellate(Seeds seeds, const BlockParameters& parameters, double width, double height,
                          Team* team) {
  for (int i = 0; i < parameters.relaxation; ++i) relax(seeds, width, height, team);
  return laguerre_tessellation(seeds, width, height, team);
}

Blocks tessellate_until_fit(const BlockParameters& parameters, double width, double height, Random& random,
                            Team* team) {
  Seeds seeds = draw_seeds(parameters, width, height, random);
  Blocks blocks{};
  while (true) {
    ++blocks.rounds;
    LaguerreResult result = tessellate(seeds, parameters, width, height, team);
    std::vector<int> unfit = std::move(result.broken);
    if (unfit.empty()) {
      Regularisation done = regularise(result.tessellation, width, height, parameters.shortest_edge);
      blocks.tessellation = std::move(result.tessellation);
      blocks.edges_removed = done.edges_removed;
      blocks.edges_left_short = done.edges_left_short;
      unfit = std::move(done.unfit);
    }
    if (unfit.empty()) return blocks;
    if (blocks.rounds == most_rounds) {
      if (!blocks.tessellation.cells.empty()) return blocks;
      throw Error(fmt::format(
          "No tessellation of {} blocks came about in {} rounds, {} cells stay empty; allowed is a "
          "radius spread below {:.4g}.",
          parameters.count, most_rounds, unfit.size(), parameters.radius_spread));
    }
    // A radius stays with its seed, or the cells of small radii would die out.
    for (const int i : unfit)
      seeds.position[static_cast<std::size_t>(i)] = draw_position(width, height, random);
    blocks.seeds_redrawn += static_cast<int>(unfit.size());
  }
}

}  // namespace

Blocks make_blocks(const BlockParameters& parameters, double width, double height, Random& random,
                   Team* team) {
  Blocks blocks{};
  if (parameters.file.empty()) {
    blocks = tessellate_until_fit(parameters, width, height, random, team);
    require_valid(blocks.tessellation, width, height,
                  fmt::format("Tessellation of {} blocks", parameters.count));
  } else {
    blocks.tessellation = read_neper_tess(parameters.file, width, height);
    const Regularisation done = regularise(blocks.tessellation, width, height, parameters.shortest_edge);
    blocks.edges_removed = done.edges_removed;
    blocks.edges_left_short = done.edges_left_short;
  }
  number_along_curve(blocks.tessellation, width, height);
  return blocks;
}

}  // namespace pyroclast::specimen
