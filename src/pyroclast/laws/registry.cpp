#include "pyroclast/laws/registry.hpp"

#include <algorithm>

#include <fmt/format.h>

#include "pyroclast/base/error.hpp"
#include "pyroclast/laws/built_in.hpp"

namespace pyroclast {

namespace {

template <class... Laws>
requires(requires { &Laws::compiled; } && ...) std::span<const LawTable* const> tables_of(LawList<Laws...>) {
  static const std::array<const LawTable*, sizeof...(Laws)> tables{&table_of<Laws>()...};
  return tables;
}

}  // namespace

std::span<const LawTable* const> built_in_laws() {
  return tables_of(BuiltInLaws());
}

int index_of(const LawTable& law) {
  const auto laws = built_in_laws();
  const auto found = std::ranges::find(laws, &law);
  if (found == laws.end())
    throw Error(fmt::format("the contact law \"{}\" is not part of the program", law.name));
  return static_cast<int>(found - laws.begin());
}

}  // namespace pyroclast
