#include "pyroclast/simulation/stage.hpp"

#include <algorithm>
#include <array>

namespace pyroclast {

namespace {

struct OutcomeInfo {
  Outcome outcome;
  const char* id;
  bool is_good;
  const char* sentence;
};

constexpr auto kOutcomes = std::to_array<OutcomeInfo>({
    {Outcome::not_begun, "not_begun", false, "not begun"},
    {Outcome::running, "running", false, "running"},
    {Outcome::completed, "completed", true, "completed"},
    {Outcome::steady, "steady", true, "the temperatures became steady"},
    {Outcome::not_reached, "not_reached", false, "the stage did not reach its aim"},
    {Outcome::crushed, "crushed", true, "the specimen was crushed while it was loaded"},
    {Outcome::stress_fallen, "stress_fallen", true, "the stress fell below the stated fraction of the peak"},
    {Outcome::ran_away, "ran_away", true, "the specimen failed: the upper platen ran away"},
    {Outcome::not_settled, "not_settled", false, "the body did not come to rest within the stated steps"},
    {Outcome::control_lost, "control_lost", false, "the controlled opening left its course"},
    {Outcome::unstable, "unstable", false, "the motion became unstable (a result is not finite)"},
    {Outcome::stopped, "stopped", false, "stopped"},
});

const OutcomeInfo& info_of(Outcome outcome) {
  return *std::ranges::find(kOutcomes, outcome, &OutcomeInfo::outcome);
}

}  // namespace

const char* describe(Outcome outcome) {
  return info_of(outcome).sentence;
}

const char* id_of(Outcome outcome) {
  return info_of(outcome).id;
}

bool is_good(Outcome outcome) {
  return info_of(outcome).is_good;
}

Forecast& Forecast::operator+=(const Forecast& other) {
  steps += other.steps;
  looks += other.looks;
  frames += other.frames;
  exchanges += other.exchanges;
  heating_duration += other.heating_duration;
  return *this;
}

Result::Value value_if(bool is_there, double value) {
  return is_there ? Result::Value(value) : Result::Value();
}

Result::Value last_value(const History& history, std::string_view column, RowRange rows) {
  return rows.empty() ? Result::Value() : Result::Value(history.values(column, rows).back());
}

}  // namespace pyroclast
