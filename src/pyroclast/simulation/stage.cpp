#include "pyroclast/simulation/stage.hpp"

namespace pyroclast {

const char* describe(Outcome outcome) {
  switch (outcome) {
    case Outcome::not_begun:
      return "not begun";
    case Outcome::running:
      return "running";
    case Outcome::completed:
      return "completed";
    case Outcome::steady:
      return "the temperatures became steady";
    case Outcome::not_reached:
      return "the stated stress was not reached";
    case Outcome::crushed:
      return "the specimen was crushed while it was loaded";
    case Outcome::stress_fallen:
      return "the stress fell below the stated fraction of the peak";
    case Outcome::ran_away:
      return "the specimen failed: the upper platen ran away";
    case Outcome::not_settled:
      return "the body did not come to rest within the stated steps";
    case Outcome::unstable:
      return "the motion became unstable (a result is not finite)";
    case Outcome::stopped:
      return "stopped";
  }
  return "";
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
