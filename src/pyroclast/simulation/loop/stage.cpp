#include "pyroclast/simulation/loop/stage.hpp"

#include <algorithm>
#include <array>

#include <fmt/format.h>

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

const char* name_of(ResultOf of) {
  switch (of) {
    case ResultOf::test:
      return "test";
    case ResultOf::computation:
      return "computation";
    case ResultOf::reason:
      return "reason";
    case ResultOf::doubt:
      return "doubt";
  }
  return "";
}

namespace {

/// Returns a text about a result, under its name without the unit.
Result text_about(const ResultInfo& info, const char* ending, const char* meaning, ResultOf of,
                  Result::Value text) {
  std::string name = info.name;
  if (const std::string unit = fmt::format("_{}", info.unit); name.ends_with(unit))
    name.resize(name.size() - unit.size());
  Result result(fmt::format("{}_{}", name, ending), std::move(text), of);
  result.unit.clear();
  result.meaning = meaning;
  result.about = info.name;
  return result;
}

}  // namespace

Result reason_of(const ResultInfo& info, Result::Value why) {
  return text_about(info, "none_because", "why the result has no value", ResultOf::reason, std::move(why));
}

Result doubt_of(const ResultInfo& info, Result::Value why) {
  return text_about(info, "doubtful_because", "why the result does not tell what it should", ResultOf::doubt,
                    std::move(why));
}

Result reason_of_all(std::string why) {
  Result result("none_because", std::move(why), ResultOf::reason);
  result.unit.clear();
  return result;
}

Result::Value value_if(bool is_there, double value) {
  return is_there ? Result::Value(value) : Result::Value();
}

Result::Value last_value(const History& history, std::string_view column, RowRange rows) {
  return rows.empty() ? Result::Value() : Result::Value(history.values(column, rows).back());
}

}  // namespace pyroclast
