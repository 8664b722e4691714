#pragma once

#include <array>
#include <functional>

#include "pyroclast/mechanics/instruction_set.hpp"
#include "pyroclast/mechanics/state.hpp"

/// The step for each instruction set that this build holds.
namespace pyroclast {

/// The step of a body.
template <int Dim>
struct StepFunctions {
  StepPasses<Dim> passes;
  std::function<PackFunctions<Dim>(const LawTable& law)> functions_of;
};

/// Throws Error when this build does not hold the step for that set.
template <int Dim>
StepFunctions<Dim> step_functions(InstructionSet set);

/// `Set` by its type in base/lanes.hpp; `step/step.hpp` defines it, included where that set's options hold.
template <class Set>
struct CompiledStep {
  static const ByDimension<StepPasses> step;
};

/// By InstructionSet; null where this build does not hold one.
struct Steps {
  std::array<const ByDimension<StepPasses>*, kInstructionSets> of_set{};

  static const Steps built;  ///< CMake writes the list (cmake/steps.cpp.in)
};

}  // namespace pyroclast
