#pragma once

#include <cstdint>
#include <string_view>
#include <vector>

#include "pyroclast/mechanics/state.hpp"

namespace pyroclast {

/// What the step is compiled for. Results are the same, bit by bit.
enum class InstructionSet : std::uint8_t {
  portable,  ///< any processor
  avx2,      ///< 4 lanes an instruction
  avx512     ///< 8 lanes an instruction (AVX-512 F, DQ and VL)
};
inline constexpr int kInstructionSets = 3;

const char* name(InstructionSet set);

/// Those that this build holds and this processor has, the fastest last.
std::vector<InstructionSet> usable_instruction_sets();

/// The one of that name. Throws Error when there is none or this processor does not have it.
InstructionSet instruction_set(std::string_view name);

template <int Dim>
StepFunctions<Dim> step_functions(InstructionSet set);

}  // namespace pyroclast
