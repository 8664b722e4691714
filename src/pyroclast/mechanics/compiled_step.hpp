#pragma once

#include <array>
#include <functional>

#include "pyroclast/mechanics/instruction_set.hpp"
#include "pyroclast/mechanics/state.hpp"

/// Step compiled for each instruction set that this build holds.
namespace pyroclast {

/// Functions of the step of a body.
template <int Dim>
struct StepFunctions {
  StepPasses<Dim> passes;
  std::function<PackFunctions<Dim>(const LawTable& law)> functions_of;
};

/// Returns the step for an instruction set. Throws Error when this build does not hold it.
template <int Dim>
StepFunctions<Dim> step_functions(InstructionSet set);

/// Step compiled for `Set`, a type of base/lanes.hpp. `step/step.hpp` defines it, included where the options
/// of that set hold.
template <class Set>
struct CompiledStep {
  static const ByDimension<StepPasses> step;
};

/// Step by InstructionSet; null for a set that this build does not hold.
struct Steps {
  std::array<const ByDimension<StepPasses>*, kInstructionSets> of_set{};

  static const Steps built;  ///< list that CMake writes (cmake/steps.cpp.in)
};

}  // namespace pyroclast
