#pragma once

#include "pyroclast/mechanics/law_rows.hpp"
#include "pyroclast/mechanics/step/contacts.hpp"

/// What a file that compiles the rows of a law for one instruction set includes.
namespace pyroclast {

template <int Dim, class Set, class Law, Dimensions kDimensions>
constexpr RowFunctions<Dim> compiled_rows() {
  if constexpr (includes(kDimensions, Dim))
    return {Contacts<Dim, Set, Law>::update, Contacts<Dim, Set, Law>::place_stiffness};
  else
    return {};
}

template <class Set, class Law, Dimensions kDimensions>
const CompiledLaw Compiled<Set, Law, kDimensions>::law{
    {compiled_rows<2, Set, Law, kDimensions>(), compiled_rows<3, Set, Law, kDimensions>()},
    Probes<Set>::functions()};

}  // namespace pyroclast
