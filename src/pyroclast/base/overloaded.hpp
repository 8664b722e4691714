#pragma once

namespace pyroclast {

/// One function made of several functions, for std::visit.
template <class... F>
struct Overloaded : F... {
  using F::operator()...;
};
template <class... F>
Overloaded(F...) -> Overloaded<F...>;  // Clang before 17 does not deduce the arguments by itself

}  // namespace pyroclast
