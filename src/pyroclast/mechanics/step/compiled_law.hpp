#pragma once

#include "pyroclast/mechanics/compiled_for_sets.hpp"
#include "pyroclast/mechanics/step/contacts.hpp"

/// Header of every file that compiles the packs of a law for one instruction set.
namespace pyroclast {

template <int Dim, class Set, class Law, Dimensions kDimensions>
constexpr PackFunctions<Dim> compiled_functions() {
  if constexpr (includes(kDimensions, Dim))
    return {Contacts<Dim, Set, Law>::update, Contacts<Dim, Set, Law>::place_stiffness,
            Contacts<Dim, Set, Law>::update_lanes};
  else
    return {};
}

template <class Set, class Law, Dimensions kDimensions>
const CompiledLaw Compiled<Set, Law, kDimensions>::law{
    {compiled_functions<2, Set, Law, kDimensions>(), compiled_functions<3, Set, Law, kDimensions>()},
    Probes<Set>::functions()};

}  // namespace pyroclast
