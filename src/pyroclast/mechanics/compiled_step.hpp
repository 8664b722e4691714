#pragma once

#include <array>

#include "pyroclast/mechanics/instruction_set.hpp"
#include "pyroclast/mechanics/state.hpp"

/// The step for each instruction set that this build holds.
namespace pyroclast {

/// All of the step but the rows of laws, which are compiled with their law.
struct StepOfSet {
  StepFunctions<2> in_2d;
  StepFunctions<3> in_3d;

  template <int Dim>
  const StepFunctions<Dim>& functions() const {
    if constexpr (Dim == 2)
      return in_2d;
    else
      return in_3d;
  }
};

/// `Set` by its type in base/lanes.hpp; `step/step.hpp` defines it, included where that set's options hold.
template <class Set>
struct CompiledStep {
  static const StepOfSet step;
};

/// By InstructionSet; null where this build does not hold one.
struct Steps {
  std::array<const StepOfSet*, kInstructionSets> of_set{};
};
/// CMake writes the list (cmake/steps.cpp.in).
extern const Steps steps;

}  // namespace pyroclast
