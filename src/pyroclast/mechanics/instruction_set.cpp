#include "pyroclast/mechanics/instruction_set.hpp"

#include <algorithm>
#include <iterator>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "pyroclast/base/error.hpp"
#include "pyroclast/mechanics/compiled_for_sets.hpp"
#include "pyroclast/mechanics/compiled_step.hpp"

namespace pyroclast {

namespace {

constexpr InstructionSet kAll[kInstructionSets]{InstructionSet::portable, InstructionSet::avx2,
                                                InstructionSet::avx512};

const ByDimension<StepPasses>* step_of(InstructionSet set) {
  return Steps::built.of_set[static_cast<std::size_t>(set)];
}

bool processor_has(InstructionSet set) {
  switch (set) {
    case InstructionSet::portable:
      return true;
#ifdef __x86_64__
    case InstructionSet::avx2:
      return __builtin_cpu_supports("avx2") != 0;
    case InstructionSet::avx512:
      return __builtin_cpu_supports("avx512f") != 0 && __builtin_cpu_supports("avx512dq") != 0 &&
             __builtin_cpu_supports("avx512vl") != 0;
#else
    case InstructionSet::avx2:
    case InstructionSet::avx512:
      break;
#endif
  }
  return false;
}

std::string names_of(const std::vector<InstructionSet>& sets) {
  std::vector<const char*> names;
  for (const InstructionSet set : sets) names.push_back(name(set));
  return fmt::format("{}", fmt::join(names, ", "));
}

/// Returns advice for people where this build lacks sets that this processor has; else an empty text.
std::string remedy() {
  const auto is_missing = [](InstructionSet set) { return processor_has(set) && !step_of(set); };
  if (std::none_of(std::begin(kAll), std::end(kAll), is_missing)) return {};
  return fmt::format(
      "; this pyroclast was built for {} alone: build it again with cmake -DPYROCLAST_SETS=all, or on this "
      "machine",
      describe_built_instruction_sets());
}

}  // namespace

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

std::vector<InstructionSet> built_instruction_sets() {
  std::vector<InstructionSet> sets;
  for (const InstructionSet set : kAll)
    if (step_of(set)) sets.push_back(set);
  return sets;
}

std::string describe_built_instruction_sets() {
  return names_of(built_instruction_sets());
}

std::vector<InstructionSet> usable_instruction_sets() {
  std::vector<InstructionSet> sets;
  for (const InstructionSet set : built_instruction_sets())
    if (processor_has(set)) sets.push_back(set);
  return sets;
}

InstructionSet best_instruction_set() {
  const auto sets = usable_instruction_sets();
  if (sets.empty())
    throw Error(fmt::format("this processor does not have the instruction set {}{}",
                            describe_built_instruction_sets(), remedy()));
  return sets.back();
}

InstructionSet instruction_set(std::string_view wanted) {
  const auto sets = usable_instruction_sets();
  for (const InstructionSet set : sets)
    if (name(set) == wanted) return set;
  if (sets.empty()) best_instruction_set();  // throws an Error that says why
  throw Error(fmt::format("instruction set \"{}\" is not one that this program and processor have: {}{}",
                          wanted, names_of(sets), remedy()));
}

namespace {

/// Describes the sets that a law could run with instead, for people; empty where there are none.
std::string other_sets_of(const LawTable& law) {
  std::vector<InstructionSet> sets;
  for (const InstructionSet set : usable_instruction_sets())
    if (is_compiled(law, set)) sets.push_back(set);
  return sets.empty() ? ""
                      : fmt::format(", but for {}: --instructions {}", names_of(sets), name(sets.back()));
}

}  // namespace

template <int Dim>
PackFunctions<Dim> functions_of(const LawTable& law, InstructionSet set) {
  if (!law.update(Dim))
    throw Error(fmt::format("the contact law \"{}\" is made for bodies in {}D, not in {}D", law.name,
                            Dim == 2 ? 3 : 2, Dim));
  if (!is_compiled(law, set))
    throw Error(fmt::format("the contact law \"{}\" is not compiled for the instruction set {}{}", law.name,
                            name(set), other_sets_of(law)));
  return law.compiled->of_set[static_cast<std::size_t>(set)]->packs.of<Dim>();
}

template PackFunctions<2> functions_of(const LawTable&, InstructionSet);
template PackFunctions<3> functions_of(const LawTable&, InstructionSet);

bool is_compiled(const LawTable& law, InstructionSet set) {
  return law.compiled && law.compiled->of_set[static_cast<std::size_t>(set)];
}

template <int Dim>
StepFunctions<Dim> step_functions(InstructionSet set) {
  const auto* const step = step_of(set);
  if (!step)
    throw Error(
        fmt::format("there is no step for the instruction set {} in this build{}", name(set), remedy()));
  return {step->of<Dim>(), [set](const LawTable& law) { return functions_of<Dim>(law, set); }};
}

template StepFunctions<2> step_functions(InstructionSet);
template StepFunctions<3> step_functions(InstructionSet);

}  // namespace pyroclast
