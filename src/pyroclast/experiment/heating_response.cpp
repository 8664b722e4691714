#include "pyroclast/experiment/heating_response.hpp"

#include <algorithm>

namespace pyroclast {

namespace {

const Coupling* coupling_of(const Stage& stage) {
  if (const auto* heat = std::get_if<HeatStage>(&stage)) return &heat->coupling;
  const auto* expose = std::get_if<ExposeStage>(&stage);
  return expose ? &expose->coupling : nullptr;
}

/// The last load before a stage; null if there is none.
const LoadStage* load_before(const std::vector<Stage>& stages, int stage) {
  const LoadStage* last = nullptr;
  for (int i = 0; i < stage; ++i)
    if (const auto* load = std::get_if<LoadStage>(&stages[i])) last = load;
  return last;
}

}  // namespace

std::optional<HeatingResponse> heating_response(const std::vector<Sample>& history,
                                                const std::vector<Stage>& stages, Outcome outcome) {
  HeatingResponse r;
  for (const Sample& s : history) {
    if (s.heat.exchange == 0) continue;
    const Coupling& coupling = *coupling_of(stages[s.stage]);
    if (const auto* load = load_before(stages, s.stage)) {
      r.load_stress = load->stress;
      r.level = load->level;
    }
    r.platen = coupling.platen;
    r.increment = std::max(r.increment, coupling.increment);
    ++r.exchanges;
    r.cycles += s.heat.cycles;
    r.highest = std::max(r.highest, s.heat.maximum);
    r.largest_thrust = std::max(r.largest_thrust, s.stress());
    const bool failed = outcome == Outcome::ran_away && &s == &history.back();
    if (failed) {
      r.critical_temperature = s.heat.mean;
      r.critical_time = s.heat.time;
    } else {
      r.not_converged += s.heat.converged ? 0 : 1;
      r.worst_ratio = std::max(r.worst_ratio, s.unbalanced_ratio);
    }
  }
  if (r.exchanges == 0) return std::nullopt;
  return r;
}

}  // namespace pyroclast
