#pragma once

#include <span>

#include "pyroclast/laws/table.hpp"

namespace pyroclast {

/// The laws that are part of the program, in the order of BuiltInLaws. Who calls this links all of them.
std::span<const LawTable* const> built_in_laws();

/// Its place among them. Throws Error when it is not one of them.
int index_of(const LawTable& law);

}  // namespace pyroclast
