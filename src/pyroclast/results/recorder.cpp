#include "pyroclast/results/recorder.hpp"

#include <utility>

#include "pyroclast/results/specimen_files.hpp"

namespace pyroclast {

Recorder::Recorder(std::filesystem::path folder, const Setup& setup, const Run& run)
    : folder_(std::move(folder)),
      title_(setup.title),
      expansion_reading_(setup.expansion_reading == ExpansionReading::secant ? "secant" : "tangent"),
      history_(folder_ / "history.csv", run.history()),
      fields_(folder_ / "fields", run.simulation(), run.history()) {
  write_specimen_files(folder_ / "specimen", run.simulation().specimen(), setup.specimen);
}

void Recorder::record(const Run& run) {
  history_.write(run.history());
  if (run.frame_is_due()) fields_.write(run.simulation(), run.history());
}

Summary Recorder::finish(const Run& run) {
  Summary summary = summarize(run);
  summary.title = title_;
  summary.expansion_reading = expansion_reading_;
  summary.wall_time = std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
  write_summary(folder_ / "summary.json", summary, run);
  return summary;
}

}  // namespace pyroclast
