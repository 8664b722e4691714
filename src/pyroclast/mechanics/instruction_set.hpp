#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace pyroclast {

/// Instruction set for which the step is compiled. Results are the same, bit by bit.
enum class InstructionSet : std::uint8_t {
  portable,  ///< any processor: 2 lanes an instruction where it has vectors at all
  avx2,      ///< 4 lanes an instruction
  avx512     ///< 8 lanes an instruction (AVX-512 F, DQ and VL)
};
inline constexpr int kInstructionSets = 3;

// declared so that a file without the options of a set can name it (base/lanes.hpp)
struct Portable;
struct Avx2;
struct Avx512;

const char* name(InstructionSet set);

/// Returns the sets that this build holds (cmake -DPYROCLAST_SETS), the fastest last; at least one.
std::vector<InstructionSet> built_instruction_sets();
/// Lists the sets that this build holds for people, "portable, avx2, avx512".
std::string describe_built_instruction_sets();

/// Returns the sets that this build holds and this processor has, the fastest last. May be empty.
std::vector<InstructionSet> usable_instruction_sets();

/// Returns the fastest usable set. Throws Error when there is none: this build is for other processors.
InstructionSet best_instruction_set();

/// Returns the set of a name. Throws Error when there is no set of this name, this build does not hold it or
/// this processor does not have it.
InstructionSet instruction_set(std::string_view name);

}  // namespace pyroclast
