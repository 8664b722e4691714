#pragma once

#include <memory>

#include "pyroclast/experiment/case.hpp"
#include "pyroclast/experiment/temperature_field.hpp"

namespace pyroclast {

/// Everything that a case makes, ready to run: specimen, model, materials and solvers. Not movable: the
/// solvers refer to the model beside them.
struct Simulation {
  /// Throws Error when the specimen or the model cannot be made, or would not fit into the memory that is
  /// free.
  explicit Simulation(const Case& c);
  Simulation(const Simulation&) = delete;
  Simulation& operator=(const Simulation&) = delete;

  specimen::Specimen specimen;
  ConcreteModel body;
  ConcreteMaterials materials;
  std::unique_ptr<TemperatureField> field;
  std::unique_ptr<Mechanics<2>> mechanics;
};

/// Upper estimate of the memory that a run with so many blocks needs, bytes.
double estimate_memory(std::int64_t blocks);

}  // namespace pyroclast
