#pragma once

#include <span>

#include "pyroclast/laws/table.hpp"

namespace pyroclast {

/// Returns the laws that are part of the program, in the order of BuiltInLaws. A program that calls this
/// function links all of them.
std::span<const LawTable* const> built_in_laws();

/// Returns the place of a law among the built-in laws. Throws Error when the law is none of them.
int index_of(const LawTable& law);

}  // namespace pyroclast
