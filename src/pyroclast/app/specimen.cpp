#include <fmt/format.h>

#include "pyroclast/app/load.hpp"
#include "pyroclast/experiment/simulation.hpp"
#include "pyroclast/results/field_files.hpp"
#include "pyroclast/results/specimen_files.hpp"

namespace pyroclast::app {

int make_specimen(const RunOptions& options) {
  const Loaded loaded(options);
  RunFolder::check(output_folder(options), options.overwrite);
  const HeatSimulation simulation(loaded.c);
  const RunFolder folder = make_run_folder(loaded, options);
  const FieldFiles mesh(folder.path() / "fields", simulation.body.model);
  write_specimen_files(folder.path() / "specimen", simulation.specimen, loaded.c.specimen.aggregates);
  fmt::print("{}results         {}\n", describe(simulation.specimen), folder.path().string());
  if (options.figures) draw_figures("specimen", folder.path());
  return 0;
}

}  // namespace pyroclast::app
