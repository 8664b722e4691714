#include "pyroclast/app/load.hpp"

#include <cmath>

#include <fmt/format.h>
#include <omp.h>

namespace pyroclast::app {

Loaded::Loaded(const RunOptions& options)
    : deck(Deck::load(options.deck, options.changes)), c(read_case(deck, options.deck.parent_path())) {
  if (options.seed) c.specimen.seed = *options.seed;
  if (!options.instructions.empty()) c.mechanics.instructions = instruction_set(options.instructions);
  if (options.threads > 0) omp_set_num_threads(options.threads);
  threads = omp_get_max_threads();
}

std::filesystem::path output_folder(const RunOptions& options) {
  return options.out.empty() ? std::filesystem::path("runs") / options.deck.stem() : options.out;
}

RunFolder make_run_folder(const Loaded& loaded, const RunOptions& options) {
  RunFolder folder(output_folder(options), options.overwrite,
                   {loaded.deck.name(), loaded.deck.text(), loaded.c.specimen.seed, loaded.threads,
                    name(loaded.c.mechanics.instructions), options.command});
  for (const auto& file : folder.foreign())
    fmt::print("kept            {}, which no run writes\n", (folder.path() / file).string());
  return folder;
}

std::string describe(const specimen::Specimen& s) {
  return fmt::format(
      "specimen        {} blocks, {} aggregates; aggregate fraction {:.3f} asked, {:.3f} placed, {:.3f} "
      "after "
      "superposition\n"
      "block metrics   mean size {:.3f} mm, mean edge {:.3f} mm; shortest edge {:.3f} mm, block {} at "
      "({:.2f}, {:.2f}) mm; "
      "smallest zone angle {:.1f} deg, block {}; {} edges removed, {} left short, {} seeds redrawn\n",
      s.tessellation.cells.size(), s.aggregates.size(), s.fraction_asked, s.fraction_placed,
      s.fraction_superposed, 1e3 * s.metrics.mean_size, 1e3 * s.metrics.mean_edge,
      1e3 * s.metrics.shortest_edge, s.metrics.shortest_edge_cell, 1e3 * s.metrics.shortest_edge_at[0],
      1e3 * s.metrics.shortest_edge_at[1], s.metrics.smallest_angle, s.metrics.smallest_angle_cell,
      s.metrics.edges_removed, s.metrics.edges_left_short, s.metrics.seeds_redrawn);
}

std::string duration(double seconds) {
  const auto s = static_cast<long>(std::lround(seconds));
  if (s < 60) return fmt::format("{} s", s);
  if (s < 3600) return fmt::format("{} min {} s", s / 60, s % 60);
  return fmt::format("{} h {} min", s / 3600, s % 3600 / 60);
}

}  // namespace pyroclast::app
