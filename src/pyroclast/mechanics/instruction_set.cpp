#include "pyroclast/mechanics/instruction_set.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "pyroclast/base/error.hpp"
#include "pyroclast/mechanics/law_rows.hpp"
#include "pyroclast/mechanics/step/step.hpp"

namespace pyroclast {

#ifdef PYROCLAST_X86
template <int Dim>
StepFunctions<Dim> avx2_step(RowFunctions<Dim> (*rows_of)(const LawTable&));
template <int Dim>
StepFunctions<Dim> avx512_step(RowFunctions<Dim> (*rows_of)(const LawTable&));
#endif

const char* name(InstructionSet set) {
  switch (set) {
    case InstructionSet::portable:
      return "portable";
    case InstructionSet::avx2:
      return "avx2";
    case InstructionSet::avx512:
      return "avx512";
  }
  return "";
}

std::vector<InstructionSet> usable_instruction_sets() {
  std::vector<InstructionSet> sets{InstructionSet::portable};
#ifdef PYROCLAST_X86
  if (__builtin_cpu_supports("avx2")) sets.push_back(InstructionSet::avx2);
  if (__builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512dq") &&
      __builtin_cpu_supports("avx512vl"))
    sets.push_back(InstructionSet::avx512);
#endif
  return sets;
}

InstructionSet instruction_set(std::string_view wanted) {
  std::vector<std::string_view> names;
  for (InstructionSet set : usable_instruction_sets()) {
    if (name(set) == wanted) return set;
    names.emplace_back(name(set));
  }
  throw Error(fmt::format("instruction set \"{}\" is not one that this program and processor have: {}",
                          wanted, fmt::join(names, ", ")));
}

template <int Dim>
RowFunctions<Dim> rows_of(const LawTable& law, InstructionSet set) {
  if (!law.update(Dim))
    throw Error(fmt::format("the contact law \"{}\" is made for bodies in {}D, not in {}D", law.name,
                            Dim == 2 ? 3 : 2, Dim));
  const CompiledLaw* const compiled = law.rows ? law.rows->of_set[static_cast<std::size_t>(set)] : nullptr;
  if (!compiled)
    throw Error(fmt::format("the contact law \"{}\" is not compiled for the instruction set {}", law.name,
                            name(set)));
  return compiled->rows<Dim>();
}

template RowFunctions<2> rows_of(const LawTable&, InstructionSet);
template RowFunctions<3> rows_of(const LawTable&, InstructionSet);

template <int Dim>
StepFunctions<Dim> step_functions(InstructionSet set) {
#ifdef PYROCLAST_X86
  if (set == InstructionSet::avx512)
    return avx512_step<Dim>([](const LawTable& law) { return rows_of<Dim>(law, InstructionSet::avx512); });
  if (set == InstructionSet::avx2)
    return avx2_step<Dim>([](const LawTable& law) { return rows_of<Dim>(law, InstructionSet::avx2); });
#endif
  (void)set;
  return Step<Dim, Portable>::functions(
      [](const LawTable& law) { return rows_of<Dim>(law, InstructionSet::portable); });
}

template StepFunctions<2> step_functions(InstructionSet);
template StepFunctions<3> step_functions(InstructionSet);

}  // namespace pyroclast
