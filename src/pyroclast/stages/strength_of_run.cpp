#include "pyroclast/stages/strength_of_run.hpp"

#include <cstddef>
#include <string_view>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "pyroclast/base/error.hpp"
#include "pyroclast/base/read_file.hpp"
#include "pyroclast/stages/run_verdict.hpp"

namespace pyroclast {

namespace {

nlohmann::json json_in(const std::filesystem::path& file) {
  const auto read = nlohmann::json::parse(read_file(file), nullptr, false);
  if (!read.is_object()) throw Error(fmt::format("{}: is no file of a run", file.string()));
  return read;
}

}  // namespace

StrengthOfRun strength_of_run(const std::filesystem::path& place) {
  StrengthOfRun found;
  found.summary = is_directory(place) ? place / "summary.json" : place;
  const std::string name = found.summary.filename().string();
  const auto at = name.find("summary");
  if (at == std::string::npos) throw Error(fmt::format("{}: is no folder of a run", place.string()));
  const auto beside = [&](std::string_view kind) {
    std::string other = name;
    return found.summary.parent_path() / other.replace(at, std::string_view("summary").size(), kind);
  };
  found.manifest = beside("manifest");
  found.facts = beside("run");
  const auto summary = json_in(found.summary);
  found.deck_sha256 = json_in(found.manifest).value("deck_sha256", "");
  const auto test = json_in(found.facts).value("test_stage", nlohmann::json());
  std::string why = "none of its stages measures one";
  if (test.is_number_unsigned()) {
    const nlohmann::json::json_pointer place_of(fmt::format("/stages/{}/results", test.get<std::size_t>()));
    const auto results = summary.value(place_of, nlohmann::json());
    if (const auto f_c = results.find("f_c_MPa"); f_c != results.end() && f_c->is_number())
      found.value = f_c->get<double>() * 1e6;
    else if (const auto reason = results.find("f_c_none_because");
             reason != results.end() && reason->is_string())
      why = reason->get<std::string>();
  }
  if (!(found.value > 0.0))
    throw Error(fmt::format("{}: the run has no f_c: {}", found.summary.string(), why));
  RunVerdict verdict = verdict_of(summary);
  if (!verdict.does_not_count.empty())
    throw Error(
        fmt::format("{}: the run's numbers do not count: {}; take a run that is quasi-static and came to its "
                    "end, or state "
                    "the strength yourself, with its reason: f_c = \"{:.4g} MPa\", f_c_of = \"...\"",
                    found.summary.string(), verdict.does_not_count, found.value * 1e-6));
  found.doubts = verdict.text();
  return found;
}

}  // namespace pyroclast
