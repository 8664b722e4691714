#include "pyroclast/results/results_writer.hpp"

#include <algorithm>
#include <functional>
#include <utility>

#include <fmt/format.h>

#include "pyroclast/results/properties_file.hpp"
#include "pyroclast/results/run_facts.hpp"
#include "pyroclast/results/specimen_files.hpp"
#include "pyroclast/results/text_file.hpp"

namespace pyroclast {

ResultsWriter::ResultsWriter(std::filesystem::path folder, const Setup& setup)
    : folder_(std::move(folder)),
      title_(setup.title),
      expansion_reading_(setup.expansion_reading == ExpansionReading::secant ? "secant" : "tangent"),
      specimen_(setup.specimen),
      references_(setup.references),
      temperatures_(setup.temperatures),
      exposure_(setup.exposure),
      has_fields_(setup.has_fields) {
  for (const Diagnostic& warning : setup.warnings) warnings_.push_back(without_place(warning));
}

void ResultsWriter::begin(const Run& run) {
  if (!folder_.empty()) std::filesystem::remove(folder_ / "summary.json");
  write_run_facts(file_in(folder_, "run.json"), run);
  history_.emplace(file_in(folder_, "history.csv"), run.history());
  if (!run.simulation().field().is_uniform())
    profile_.emplace(folder_, run.simulation(), exposure_, profile_rows_);
  if (has_fields_) fields_.emplace(file_in(folder_, "fields"), run.simulation(), run.history(), frames_);
  if (const Spalling* spalling = run.simulation().spalling())
    spalls_.emplace(folder_, run.simulation().model(), *spalling);
  lost_frames_.clear();
  for (const std::string& name : fields_ ? fields_->lost() : std::vector<std::string>())
    lost_frames_.push_back(fmt::format(
        "a frame is lost: fields/{} is missing or broken; a run from the beginning has it", name));
  if (temperatures_.upper > temperatures_.lower)
    write_text_file(file_in(folder_, "properties.csv"),
                    properties_csv(property_curves(run.simulation().materials(), run.simulation().moves()),
                                   temperatures_, PropertyRows::few));
  const Simulation& simulation = run.simulation();
  if (folder_.empty()) return;
  if (const SpecimenTold* told = simulation.told())
    write_specimen_files(folder_ / "specimen", told->files);
  else if (simulation.specimen())
    write_specimen_files(folder_ / "specimen", specimen_files(*simulation.specimen(), specimen_));
}

void ResultsWriter::write(const Run& run) {
  history_->write(run.history());
  if (profile_) profile_->write(run.simulation(), run.frame_is_due(), profile_rows_);
  if (spalls_) spalls_->write(run.simulation().model(), *run.simulation().spalling());
  if (fields_ && run.frame_is_due()) fields_->write(run.simulation(), run.history(), frames_);
}

Summary ResultsWriter::finish(const Run& run) {
  Summary made = summary(run);
  write_summary(file_in(folder_, "summary.json"), made, run);
  return made;
}

Summary ResultsWriter::summary(const Run& run) const {
  Summary summary = summarize(run, references_);
  summary.title = title_;
  std::vector<std::string> warnings = warnings_;
  const Simulation& simulation = run.simulation();
  const auto of_specimen = simulation.warnings_of_specimen();
  for (const auto& list : {lost_frames_, of_specimen, std::exchange(summary.warnings, {})})
    warnings.insert(warnings.end(), list.begin(), list.end());
  summary.warnings = std::move(warnings);
  summary.expansion_reading = expansion_reading_;
  summary.wall_time = wall_time();
  if (profile_) summary.heated_face = profile_->line().face();
  return summary;
}

double ResultsWriter::wall_time() const {
  return earlier_ + seconds_since(start_);
}

void ResultsWriter::visit_state(StateVisitor& visitor, std::size_t rows) {
  const StateVisitor::Scope scope(visitor, "results");
  double time = wall_time();
  visitor.visit("wall_time", time, state::at_least(0));
  visitor.visit("frame_rows", frames_.rows, state::index(rows));
  visitor.require(
      std::ranges::adjacent_find(frames_.rows, std::ranges::greater_equal()) == frames_.rows.end(),
      "frame_rows", "does not name each row once, in order");
  profile_rows_.visit_state(visitor);
  if (visitor.replaces()) earlier_ = time;
}

}  // namespace pyroclast
