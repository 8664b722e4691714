#include "pyroclast/stages/run_verdict.hpp"

#include <algorithm>
#include <array>
#include <string_view>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <fnmatch.h>
#include <nlohmann/json.hpp>

#include "pyroclast/base/error.hpp"
#include "pyroclast/base/read_file.hpp"
#include "pyroclast/simulation/loop/stage.hpp"
#include "pyroclast/stages/compression_response.hpp"

namespace pyroclast {

namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;

/// Outcomes of a run, or of a stage, whose numbers do not count.
constexpr std::array kNoNumbers{Outcome::not_begun, Outcome::running, Outcome::stopped, Outcome::unstable,
                                Outcome::not_settled};
/// Files with computed numbers in the folder of a run.
constexpr std::array kComputed{"history.csv", "isotherm.csv", "temperature_profile.csv", "blocks_*.hdf",
                               "contacts_*.hdf"};

Json read_json(const fs::path& file) {
  try {
    return Json::parse(read_file(file), nullptr, /*allow_exceptions=*/false);
  } catch (const Error&) {
    return {};
  }
}

Json value_at(const Json& object, const char* key) {
  return object.is_object() ? object.value(key, Json()) : Json();
}

std::string text_of(const Json& text) {
  return text.is_string() ? text.get<std::string>() : std::string();
}

bool has_no_numbers(const Json& ended) {
  const std::string id = text_of(value_at(ended, "outcome_id"));
  return std::ranges::any_of(kNoNumbers, [&](Outcome outcome) { return id == id_of(outcome); });
}

void add_warnings(const Json& of, std::vector<std::string>& doubts) {
  for (const Json& warning : value_at(of, "warnings"))
    if (warning.is_string()) doubts.push_back(warning.get<std::string>());
}

/// Tells how far the stress of a stage rises again behind its f_c; empty where it does not.
std::string rise_again(const Json& results) {
  const Json strength = value_at(results, "f_c_MPa"), largest = value_at(results, "stress_max_MPa");
  if (!strength.is_number() || !largest.is_number()) return {};
  const double f_c = strength.get<double>(), most = largest.get<double>();
  if (!(most > (1.0 + kRisesAgain) * f_c)) return {};
  return fmt::format("the stress rises again behind f_c {:.2f} MPa, to {:.2f} MPa", f_c, most);
}

bool is_run(const fs::path& folder) {
  return text_of(value_at(read_json(folder / "manifest.json"), "program")) == "pyroclast";
}

}  // namespace

std::string RunVerdict::text() const {
  std::vector<std::string> all;
  if (!does_not_count.empty()) all.push_back("the run's numbers do not count: " + does_not_count);
  all.insert(all.end(), doubts.begin(), doubts.end());
  return fmt::format("{}", fmt::join(all, "; "));
}

RunVerdict verdict_of(const Json& summary) {
  RunVerdict verdict;
  const auto refuse = [&](std::string why) {
    if (verdict.does_not_count.empty()) verdict.does_not_count = std::move(why);
  };
  const Json stages = value_at(summary, "stages");
  int number = 0;
  for (const Json& stage : stages.is_array() ? stages : Json::array()) {
    const std::string name = fmt::format("stage {} ({})", ++number, text_of(value_at(stage, "kind")));
    const Json results = value_at(stage, "results");
    const bool has_begun = text_of(value_at(stage, "outcome_id")) != id_of(Outcome::not_begun);
    if (has_begun && has_no_numbers(stage))
      refuse(fmt::format("{}: {}", name, text_of(value_at(stage, "outcome"))));
    else if (has_begun && value_at(stage, "is_good") == false)
      verdict.doubts.push_back(fmt::format("{}: {}", name, text_of(value_at(stage, "outcome"))));
    if (value_at(results, "quasi_static") == false) {
      const Json kinetic = value_at(results, "kinetic_over_elastic_to_peak");
      refuse(fmt::format("{} was not quasi-static{}", name,
                         kinetic.is_number() ? fmt::format(", kinetic over elastic energy up to {:.2g}",
                                                           kinetic.get<double>())
                                             : ""));
    }
    add_warnings(stage, verdict.doubts);
    if (const std::string rise = rise_again(results); !rise.empty())
      verdict.doubts.push_back(fmt::format("{}: {}", name, rise));
  }
  if (has_no_numbers(summary)) refuse(text_of(value_at(summary, "outcome")));
  add_warnings(summary, verdict.doubts);
  if (verdict.does_not_count.empty() && verdict.doubts.empty() && value_at(summary, "is_good") != true)
    verdict.doubts.emplace_back("its summary does not count the run as good");
  return verdict;
}

std::string verdict_on_run_of(const fs::path& file) {
  const std::string name = file.filename().string();
  const fs::path beside = fs::absolute(file).lexically_normal().parent_path();
  if (beside.filename() == "inputs" && is_run(beside.parent_path())) {
    for (const Json& input : value_at(read_json(beside.parent_path() / "manifest.json"), "inputs"))
      if (text_of(value_at(input, "name")) == "inputs/" + name) return text_of(value_at(input, "verdict"));
    return {};
  }
  if (std::ranges::none_of(kComputed,
                           [&](const char* known) { return fnmatch(known, name.c_str(), 0) == 0; }))
    return {};
  const fs::path run = beside.filename() == "fields" ? beside.parent_path() : beside;
  if (!is_run(run)) return {};
  const Json summary = read_json(run / "summary.json");
  if (!summary.is_object()) return "the run has no summary: it has not come to its end";
  return verdict_of(summary).text();
}

}  // namespace pyroclast
