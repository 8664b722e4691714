#pragma once

#include <array>

#include "pyroclast/laws/built_in.hpp"
#include "pyroclast/mechanics/state.hpp"

namespace bench {

/// The packs of the program's laws, in the order of BuiltInLaws, as the parts are compiled.
using NativeLaws = std::array<pyroclast::PackFunctions<2>, pyroclast::BuiltInLaws::count>;
extern const NativeLaws kNativeLaws;

/// One part of the step over a whole body, the fastest compilation for this machine.
struct Part {
  const char* name;
  /// \param scratch  as of StepPasses::move_bundles
  void (*run)(pyroclast::State<2>& state, double* scratch);
};

/// Contacts, gather, zones, motion: together what the step does in one step that is not measured.
/// Where a part takes over from another, it finds plausible numbers in its place: `zones` takes displacements
/// and adds to what is in scratch memory, `motion` takes displacements and the last sums of forces.
extern const Part kParts[4];

}  // namespace bench
