#pragma once

#include <array>

#include "pyroclast/laws/built_in.hpp"
#include "pyroclast/mechanics/state.hpp"

namespace bench {

/// The packs of the program's laws, in the order of BuiltInLaws, as the parts are compiled.
template <int Dim>
using NativeLaws = std::array<pyroclast::PackFunctions<Dim>, pyroclast::BuiltInLaws::count>;
template <int Dim>
const NativeLaws<Dim>& native_laws();

/// One part of the step over a whole body, the fastest compilation for this machine.
template <int Dim>
struct Part {
  const char* name;
  /// \param scratch  as of StepPasses::move_bundles
  void (*run)(pyroclast::State<Dim>& state, double* scratch);
};

/// Contacts, gather, zones, motion: together what the step does in one step that is not measured.
/// Where a part takes over from another, it finds plausible numbers in its place: `zones` takes displacements
/// and adds to what is in scratch memory, `motion` takes displacements and the last sums of forces.
template <int Dim>
const std::array<Part<Dim>, 4>& parts();

}  // namespace bench
