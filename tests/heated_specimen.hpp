#pragma once

#include <memory>
#include <utility>
#include <vector>

#include "model/small_specimen.hpp"
#include "phases.hpp"
#include "pyroclast/simulation/acting/heat_conditions.hpp"
#include "pyroclast/thermal/fire_curves.hpp"
#include "pyroclast/thermal/temperature_field.hpp"

/// A small specimen between platens and what it needs to be heated, for tests.
namespace pyroclast {

inline constexpr double kSpecimenWidth = 0.05, kSpecimenHeight = 0.1, kSpecimenThickness = 0.5;  // m

inline ModelOf<2> small_body(int blocks = 300) {
  return between_platens(small_specimen(blocks), 0.01, kSpecimenThickness);
}

struct HeatConstants {
  double conductivity = 1.6;     // W/(m K)
  double specific_heat = 900.0;  // J/(kg K)
  double density = 2400.0;       // kg/m³
  double diffusivity() const { return conductivity / (specific_heat * density); }
};

/// Aggregate and mortar conduct alike.
inline std::vector<BlockMaterial> alike_materials(const HeatConstants& constants = {}) {
  std::vector<BlockMaterial> block_materials(3);
  block_materials.back().is_of_bearing = true;
  block_materials[aggregate_material].name = "aggregate";
  block_materials[mortar_material].name = "mortar";
  for (const int m : {aggregate_material, mortar_material}) {
    block_materials[m].conductivity = Curve::constant(constants.conductivity);
    block_materials[m].specific_heat = Curve::constant(constants.specific_heat);
    block_materials[m].density = Curve::constant(constants.density);
  }
  return block_materials;
}

/// The same of a specimen without platens.
inline std::vector<BlockMaterial> alike_phases() {
  std::vector<BlockMaterial> block_materials = alike_materials();
  block_materials.pop_back();
  return block_materials;
}

inline HeatConditions heat_conditions(std::vector<HeatBoundaryCondition> boundaries) {
  HeatConditions heat;
  heat.uniform = false;
  heat.safety = 0.9;
  heat.largest_change = 2.0;
  heat.largest_step = 60.0;
  heat.boundaries = std::move(boundaries);
  return heat;
}

inline HeatBoundaryCondition on(const std::string& part, HeatCondition condition) {
  return {{.part = part}, std::move(condition), "deck.toml:1: heat.boundaries[0]"};
}

inline Convection convection(double coefficient, Curve gas) {
  return {Curve::constant(coefficient), std::move(gas)};
}

/// The fire of ISO 834 on the left.
inline HeatConditions fire_from_the_left() {
  const Curve fire = fire_curves().at("iso834").curve;
  return heat_conditions(
      {on("left", convection(25.0, fire)), on("left", Radiation{Curve::constant(0.7), fire})});
}

/// The field of heat conditions on a body, for a run of `duration`, s.
inline TemperatureField conduct(const ModelOf<2>& body, const HeatConditions& heat, double duration,
                                const HeatConstants& constants = {}) {
  return {body, make_conduction(body, alike_materials(constants), heat, temperature_range(heat, duration))};
}

}  // namespace pyroclast
