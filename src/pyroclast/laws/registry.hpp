#pragma once

#include <span>

#include "pyroclast/laws/table.hpp"

namespace pyroclast {

/// All laws of the program, in the order of BuiltInLaws.
std::span<const LawTable* const> laws();

/// Its place among `laws`. Throws Error when it is not one of them.
int index_of(const LawTable& law);

}  // namespace pyroclast
