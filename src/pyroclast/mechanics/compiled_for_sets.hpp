#pragma once

#include <array>

#include "pyroclast/laws/table.hpp"
#include "pyroclast/mechanics/instruction_set.hpp"
#include "pyroclast/mechanics/state.hpp"

/// Packs of a law: the functions of the step that are compiled for the law, for each instruction set. A
/// program holds the functions of the laws that it names; other functions come from shared objects
/// (plugin/plugin.hpp).
namespace pyroclast {

/// Arithmetic that shows how a compiler was told to treat numbers: the compiler does not know the arguments.
struct ArithmeticProbe {
  double (*product)(double e);               ///< (1 + e)(1 - e) - 1
  double (*difference)(double a, double b);  ///< (a + b) - a
  double (*half)(double a);                  ///< a / 2
  bool (*is_number)(double a);               ///< a equals itself
};

/// \tparam Set  type that gives each instruction set its own functions
template <class Set>
struct Probes {
  static double product(double e) { return (1.0 + e) * (1.0 - e) - 1.0; }
  static double difference(double a, double b) { return (a + b) - a; }
  static double half(double a) { return 0.5 * a; }
  static bool is_number(double a) { return a == a; }

  static constexpr ArithmeticProbe functions() { return {product, difference, half, is_number}; }
};

/// Law compiled for one instruction set. The functions are null where the law is not made for a dimension.
struct CompiledLaw {
  ByDimension<PackFunctions> packs;
  ArithmeticProbe probe;
};

/// Compiled law by InstructionSet; null for a set for which it was not compiled.
struct CompiledForSets {
  std::array<const CompiledLaw*, kInstructionSets> of_set{};
};

/// Law compiled for `Set`, given by its type. `step/compiled_law.hpp` defines it, included where the options
/// of that set hold.
template <class Set, class Law, Dimensions kDimensions = Dimensions::both>
struct Compiled {
  static const CompiledLaw law;
};

/// Tells whether the packs of a law for that set are part of the program or of the law's shared object.
bool is_compiled(const LawTable& law, InstructionSet set);

/// Returns the functions of a law for an instruction set. Throws Error when the law is not made for that
/// dimension, or when neither the program nor the law's shared object holds them.
template <int Dim>
PackFunctions<Dim> functions_of(const LawTable& law, InstructionSet set);

}  // namespace pyroclast
