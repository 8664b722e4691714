#include "pyroclast/results/heat_summary.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "pyroclast/results/text_file.hpp"

namespace pyroclast {

namespace {

/// Heat is conserved to rounding, which adds up over some 1e5 evaluations to far less than this share.
constexpr double kLedgerTolerance = 1e-6;

}  // namespace

double HeatSummary::ledger_error() const {
  const double largest =
      std::max({std::abs(heat.boundary.flux), std::abs(heat.boundary.convection),
                std::abs(heat.boundary.radiation), std::abs(heat.prescribed), std::abs(heat.stored)});
  return largest > 0.0 ? std::abs(heat.error()) / largest : 0.0;
}

HeatSummary summarize(const Case& c, const TemperatureField& field, HeatOutcome outcome) {
  const Conduction<2>& conduction = *field.conduction();
  HeatSummary s;
  s.title = c.title;
  s.outcome = outcome;
  s.time = field.time();
  s.mean = field.mean();
  s.minimum = field.minimum();
  s.maximum = field.maximum();
  s.rate = conduction.rate();
  s.heat = conduction.ledger();
  s.overshoot = conduction.largest_overshoot();
  s.steps = conduction.steps();
  s.retries = conduction.retries();
  s.stages = conduction.stages();
  if (outcome == HeatOutcome::interrupted) s.warnings.emplace_back(describe(outcome));
  if (outcome == HeatOutcome::completed && c.conduct->steady_rate)
    s.warnings.push_back(
        fmt::format("no steady state: the temperatures still change by {:.2g} K/s, more than {:.2g} K/s",
                    s.rate, *c.conduct->steady_rate));
  if (s.ledger_error() > kLedgerTolerance)
    s.warnings.push_back(
        fmt::format("the heat ledger closes only within {:.2g} of its largest term", s.ledger_error()));
  return s;
}

void write_summary(const std::filesystem::path& path, const HeatSummary& s) {
  nlohmann::ordered_json json;
  json["title"] = s.title;
  json["outcome"] = describe(s.outcome);
  json["stages"] = nlohmann::json::array({{{"kind", "conduct"}}});
  json["steady"] = s.outcome == HeatOutcome::steady;
  json["time_s"] = s.time;
  json["temperature_degC"] = {{"mean", s.mean}, {"minimum", s.minimum}, {"maximum", s.maximum}};
  json["rate_K_s"] = s.rate;
  json["heat_J"] = {{"stored", s.heat.stored},
                    {"prescribed", s.heat.prescribed},
                    {"flux", s.heat.boundary.flux},
                    {"convection", s.heat.boundary.convection},
                    {"radiation", s.heat.boundary.radiation},
                    {"error", s.heat.error()},
                    {"error_over_largest", s.ledger_error()}};
  json["largest_overshoot_K"] = s.overshoot;
  json["steps"] = s.steps;
  json["steps_taken_back"] = s.retries;
  json["evaluations"] = s.stages;
  json["wall_time_s"] = s.wall_time;
  json["warnings"] = s.warnings;
  write_text_file(path, json.dump(2) + "\n");
}

}  // namespace pyroclast
