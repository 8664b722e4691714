#pragma once

namespace pyroclast {

/// One function made of several, for std::visit.
template <class... F>
struct Overloaded : F... {
  using F::operator()...;
};
template <class... F>
Overloaded(F...) -> Overloaded<F...>;  // Clang before 17 does not deduce it by itself

}  // namespace pyroclast
