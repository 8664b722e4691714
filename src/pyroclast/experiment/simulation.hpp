#pragma once

#include <memory>

#include "pyroclast/experiment/case.hpp"
#include "pyroclast/experiment/temperature_field.hpp"

namespace pyroclast {

/// The specimen of a case as a model, with its temperatures: all that conduction alone needs. Not movable:
/// the solvers refer to the model beside them.
struct HeatSimulation {
  /// Throws Error when the specimen or the model cannot be made, or would not fit into the memory that is
  /// free.
  explicit HeatSimulation(const Case& c);
  HeatSimulation(const HeatSimulation&) = delete;
  HeatSimulation& operator=(const HeatSimulation&) = delete;

  HeatCase heat;
  specimen::Specimen specimen;
  ConcreteModel body;
  std::unique_ptr<TemperatureField> field;
};

/// Everything that a case with mechanics makes, ready to run.
struct Simulation : HeatSimulation {
  explicit Simulation(const Case& c);

  ConcreteMaterials materials;
  std::unique_ptr<Mechanics<2>> mechanics;
};

/// Upper estimate of the memory that a run with so many blocks needs, bytes.
double estimate_memory(std::int64_t blocks);

}  // namespace pyroclast
