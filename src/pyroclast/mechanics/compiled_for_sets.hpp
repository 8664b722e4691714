#pragma once

#include <array>

#include "pyroclast/laws/table.hpp"
#include "pyroclast/mechanics/instruction_set.hpp"
#include "pyroclast/mechanics/state.hpp"

/// The packs of a law: what the step is compiled of it, for each instruction set. A program holds those of
/// the laws that it names; others come from shared objects (plugin/plugin.hpp).
namespace pyroclast {

/// Arithmetic that shows how a compiler was told to treat numbers: the arguments are not known to it.
struct ArithmeticProbe {
  double (*product)(double e);               ///< (1 + e)(1 - e) - 1
  double (*difference)(double a, double b);  ///< (a + b) - a
  double (*half)(double a);                  ///< a / 2
  bool (*is_number)(double a);               ///< a equals itself
};

/// \tparam Set  so that each instruction set has its own
template <class Set>
struct Probes {
  static double product(double e) { return (1.0 + e) * (1.0 - e) - 1.0; }
  static double difference(double a, double b) { return (a + b) - a; }
  static double half(double a) { return 0.5 * a; }
  static bool is_number(double a) { return a == a; }

  static constexpr ArithmeticProbe functions() { return {product, difference, half, is_number}; }
};

/// A law for one instruction set. Where it is not made for a dimension the functions are null.
struct CompiledLaw {
  ByDimension<PackFunctions> packs;
  ArithmeticProbe probe;
};

/// By InstructionSet; null where it was not compiled for one.
struct CompiledForSets {
  std::array<const CompiledLaw*, kInstructionSets> of_set{};
};

/// `Set` by its type, `step/compiled_law.hpp` defines it: included where that set's options hold.
template <class Set, class Law, Dimensions kDimensions = Dimensions::both>
struct Compiled {
  static const CompiledLaw law;
};

/// Whether the packs of a law for that set are part of the program or of the law's shared object.
bool is_compiled(const LawTable& law, InstructionSet set);

/// Throws Error when the law is not made for that dimension, or its packs for that set are not part of the
/// program.
template <int Dim>
PackFunctions<Dim> functions_of(const LawTable& law, InstructionSet set);

}  // namespace pyroclast
