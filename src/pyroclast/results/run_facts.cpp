#include "pyroclast/results/run_facts.hpp"

#include <set>
#include <string>

#include <nlohmann/json.hpp>

#include "pyroclast/results/text_file.hpp"
#include "pyroclast/simulation/watching/fields.hpp"

namespace pyroclast {

namespace {

using OrderedJson = nlohmann::ordered_json;

OrderedJson json_of(const Column& column) {
  OrderedJson json = {{"name", column.name},       {"unit", column.unit},          {"label", column.label},
                      {"meaning", column.meaning}, {"role", name_of(column.role)}, {"of", column.of}};
  if (!column.mode.empty()) {
    json["mode"] = column.mode;
    json["interface"] = column.interface;
  }
  return json;
}

OrderedJson json_of(const Result& result) {
  OrderedJson json = {{"name", result.name},       {"unit", result.unit},      {"label", result.label},
                      {"meaning", result.meaning}, {"of", name_of(result.of)}, {"digits", nullptr},
                      {"shown_in", result.unit}};
  if (result.digits != kAnyDigits) json["digits"] = result.digits;
  if (!result.shown_in.empty()) json["shown_in"] = result.shown_in;
  if (!result.about.empty()) json["about"] = result.about;
  return json;
}

/// Lists what the stages can tell, each name once.
OrderedJson results_of(const Run& run) {
  OrderedJson json = OrderedJson::array();
  std::set<std::string> told;
  for (const auto& stage : run.stages())
    for (const Result& result : stage->report(run.history(), {}, Outcome::not_begun).results)
      if (told.insert(result.name).second) json.push_back(json_of(result));
  return json;
}

OrderedJson fields_of_frames(const Simulation& simulation) {
  OrderedJson json = OrderedJson::array();
  for (const FieldInfo& field : fields_of(simulation))
    if (field.in_files)
      json.push_back({{"name", field.name},
                      {"unit", field.unit.si},
                      {"meaning", field.meaning},
                      {"of", name_of(field.item)},
                      {"components", components_of(field.kind, simulation.model().dimension())}});
  return json;
}

}  // namespace

std::string run_facts_text(const Run& run) {
  const Simulation& simulation = run.simulation();
  const Model& model = simulation.model();
  const bool is_plane = model.dimension() == 2;
  OrderedJson json;
  json["dimension"] = model.dimension();
  json["moves"] = simulation.moves();
  json["has_press"] = simulation.has_press();
  json["extent"] = {{"name", is_plane ? "length" : "area"}, {"unit", is_plane ? "m" : "m2"}};
  const int test = test_stage(run);
  json["test_stage"] = test < 0 ? OrderedJson() : OrderedJson(test);
  json["columns"] = OrderedJson::array();
  for (const Column& column : run.history().columns()) json["columns"].push_back(json_of(column));
  json["results"] = results_of(run);
  json["fields"] = fields_of_frames(simulation);
  json["sets"] = OrderedJson::array();
  for (const auto& [name, gridpoints] : model.sets) json["sets"].push_back(name);
  return json.dump(1) + "\n";
}

void write_run_facts(const std::filesystem::path& path, const Run& run) {
  write_text_file(path, run_facts_text(run));
}

}  // namespace pyroclast
