#include "pyroclast/setup/effects.hpp"

#include <algorithm>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "pyroclast/base/rounding.hpp"

namespace pyroclast {

namespace {

constexpr const char* kStressFree = "stress_free";

bool is_nothing(const Curve& strain) {
  const auto [lower, upper] = strain.range();
  return strain.minimum(lower, upper) == 0.0 && strain.maximum(lower, upper) == 0.0;
}

/// Tells whether temperature strains any part of the specimen.
bool expands(const Setup& setup) {
  const auto& of_concrete = setup.moving->strain_of_concrete;
  return (of_concrete && !is_nothing(of_concrete->strain)) ||
         std::ranges::any_of(setup.block_materials, [](const BlockMaterial& material) {
           return !material.is_of_bearing && (!is_nothing(material.thermal_strain) || material.contraction);
         });
}

/// Tells whether a stage or a boundary takes any temperature away from its value at the start.
bool changes_temperature(const Setup& setup) {
  if (!setup.heat.uniform) return heats_or_cools(setup.heat, setup.exposure);
  return std::ranges::any_of(setup.stages, [&](const auto& stage) {
    const auto to = stage->heating().to;
    return to && !same(*to, setup.heat.initial, absolute_zero);
  });
}

/// Returns the keys of the deck that have no effect without a change of temperature.
std::vector<std::string> keys_of_change(const Section& root, const Setup& setup) {
  std::vector<std::string> keys;
  const auto add = [&](bool is_there, const std::string& owner, const char* key) {
    if (is_there) keys.push_back(fmt::format("{}.{}", owner, key));
  };
  for (const BlockMaterial& material : setup.block_materials) {
    const std::string owner = "materials." + material.name;
    add(material.creep.has_value(), owner, "creep");
    add(material.contraction.has_value(), owner, "contraction");
    add(material.residual_ratio.has_value(), owner, "residual_ratio");
  }
  if (!setup.moving) return keys;
  for (const auto& interface : setup.moving->contacts.interfaces)
    add(root.section("contacts").section(interface.name).has("residual_ratio"), "contacts." + interface.name,
        "residual_ratio");
  return keys;
}

}  // namespace

void check_flow(const Section& root, const Setup& setup) {
  const auto lets_flow = [](const auto& stage) { return stage->heating().duration > 0.0; };
  if (setup.heat.boundaries.empty() || std::ranges::any_of(setup.stages, lets_flow)) return;
  root.section("heat").error("boundaries",
                             "have no effect: no stage lets heat flow (kinds \"expose\" and \"conduct\")");
}

void warn_of_first_strain(const Section& root, const Setup& setup) {
  if (!setup.moving) return;
  const auto& stress_free = setup.moving->stress_free;
  if (!expands(setup)) {
    if (stress_free)
      root.section("coupling")
          .warn(kStressFree, "strains nothing: no phase has an expansion or a thermal_strain");
    return;
  }
  if (stress_free && stress_free->is_field()) return;
  const double unstrained = stress_free ? stress_free->temperatures.front() : kReferenceTemperature;
  if (same(setup.heat.initial, unstrained, absolute_zero)) return;
  const std::string strained = fmt::format(
      "the body is unstrained at {:.6g} degC, and its strain from there to {:.6g} degC acts at once "
      "at the first step, which can crack it",
      unstrained, setup.heat.initial);
  if (const auto heat = root.optional_section("heat"))
    heat->warn("initial", strained + (stress_free ? ""
                                                  : ": a stage that heats the body does so gradually; "
                                                    "coupling.stress_free says another temperature"));
  else
    root.section("coupling").warn(kStressFree, strained);
}

void warn_of_even_temperatures(const Section& root, const Setup& setup) {
  if (!setup.heat.uniform) {
    if (!changes_temperature(setup))
      root.section("heat").warn(
          "boundaries", fmt::format("have no effect: all of them leave the specimen at {:.6g} degC, as it "
                                    "is at the start",
                                    setup.heat.initial));
    return;
  }
  const auto sections = root.sections("stages");
  double temperature = setup.heat.initial;
  for (std::size_t i = 0; i < setup.stages.size(); ++i) {
    const auto to = setup.stages[i]->heating().to;
    if (!to) continue;
    if (same(*to, temperature, absolute_zero))
      sections[i].warn("to", "is the temperature that the specimen has already: this stage changes nothing");
    temperature = *to;
  }
}

std::vector<std::string> unused_sets(const Setup& setup) {
  std::vector<std::string> used;
  for (const auto& stage : setup.stages)
    for (const std::string& set : stage->sets()) used.push_back(set);
  if (setup.moving)
    for (const StartVelocity& start : setup.moving->velocities) used.push_back(start.set);
  for (const RecordParameters& record : setup.records) used.insert(used.end(), {record.set, record.other});
  for (const HeatBoundaryCondition& boundary : setup.heat.boundaries) used.push_back(boundary.faces.part);
  if (setup.heat.moisture)
    for (const auto& boundary : setup.heat.moisture->boundaries) used.push_back(boundary.faces.part);
  for (const auto& set : setup.sets) used.push_back(set.within);
  for (const specimen::FinerPart& part : setup.specimen.blocks.finer) used.push_back(part.name);
  std::vector<std::string> unused;
  for (const auto& set : setup.sets)
    if (std::ranges::find(used, set.name) == used.end()) unused.push_back(set.name);
  return unused;
}

std::vector<std::string> unused_properties(const Section& root, const Setup& setup) {
  std::vector<std::string> lines;
  if (!root.ok()) return lines;
  for (const BlockMaterial& material : setup.block_materials)
    if (material.quartz_step && setup.temperatures.upper <= material.quartz_step->over.lower)
      lines.push_back(
          fmt::format("materials.{}.quartz_step begins at {:.6g} degC, and the run comes to {:.6g} degC at "
                      "most, so that it has no effect",
                      material.name, material.quartz_step->over.lower, setup.temperatures.upper));
  if (changes_temperature(setup) || (setup.moving && setup.moving->stress_free)) return lines;
  const auto keys = keys_of_change(root, setup);
  if (!keys.empty())
    lines.push_back(fmt::format("{}: no temperature changes in this run, so that {} no effect",
                                fmt::join(keys, ", "), keys.size() == 1 ? "it has" : "they have"));
  return lines;
}

}  // namespace pyroclast
