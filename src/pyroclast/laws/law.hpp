#pragma once

#include <cstdint>
#include <type_traits>

#include "pyroclast/base/lanes.hpp"
#include "pyroclast/base/range.hpp"
#include "pyroclast/base/unit.hpp"
#include "pyroclast/base/vec.hpp"

/// What a contact law is, and how it names its numbers.
///
/// A law is a struct that takes one contact point from jump to traction. It holds
///
///     Properties<Real>    what a deck gives, at one temperature      each(f, p...), each_choice(f, p...)
///     Constants<Real>     what follows from them, worked out once    each(f, c...), each_choice(f, c...)
///     Internals<Dim, Real>  what a contact point remembers             each(f, h...)
///     Losses<Sum>         what it lost for good                      each(f, l...)
///     derive, update, stiffness, check                               see laws/cohesive.hpp
///
/// Opening alone gives the same however it is cut into steps; so does sliding at a steady opening, unless the
/// law says `static constexpr bool exact_in_shear = false`. Elsewhere a law converges with the number of
/// steps. What else a law must hold, laws/kit.cpp tries.
///
/// Each list calls `f(info, number...)` for one number after the other; several objects of the same kind go
/// side by side. The info says once what the number is called, its unit and its meaning: decks, docs, memory,
/// fields and columns follow from it.
///
/// Real is a double for one point, or lanes for eight (base/lanes.hpp). Sign: tension and opening are
/// positive. All energies are per unit of contact area, J/m².
namespace pyroclast {

/// What the step compiles of a law (mechanics/compiled_for_sets.hpp); a law that is part of the program
/// declares its own as `static const CompiledForSets compiled`.
struct CompiledForSets;

/// Components of a contact's tangential jump and traction: 1 in 2D, 2 in 3D.
template <int Dim, class Real = double>
using Tangential = Vec<Dim - 1, Real>;

/// What a property is, to factors of an interface, ratios over temperature and K = E / t_b.
enum class Role : std::uint8_t {
  plain,             ///< nothing acts on it
  normal_stiffness,  ///< E / t_b where a deck says nothing, Eq. (17)
  shear_stiffness,   ///< G / t_b, likewise
  strength,
  energy
};

struct PropertyInfo {
  const char* key;      ///< in decks
  const char* meaning;  ///< for people
  Unit unit;
  Range range;
  Role role = Role::plain;
};

struct OptionInfo {
  const char* name;
  const char* meaning;
};

/// One of few ways, the same at every temperature. The first option is the default.
struct ChoiceInfo {
  static constexpr int kMostOptions = 4;

  const char* key;
  const char* meaning;
  OptionInfo options[kMostOptions];  ///< the last ones may be empty
};

/// What a remembered number is, to cracks, columns and figures.
enum class Remembers : std::uint8_t {
  other,
  tension_damage,  ///< 0 intact, 1 broken; never decreases
  shear_damage,    ///< likewise
  mixed_damage,    ///< of tension and shear together
  closure          ///< added to the opening it gives that of the crack, m
};

struct InternalInfo {
  const char* name;
  const char* meaning;
  Unit unit;
  Remembers what = Remembers::other;
  /// Bit of ContactResponse::changed that says that it may have changed; 0: it changes in every update.
  unsigned when = 0;
  bool in_files = true;  ///< a field of the results
};

struct LossInfo {
  const char* name;
  const char* meaning;
  Unit unit;

  /// Energies are counted in the ledger.
  constexpr bool is_energy() const { return unit == unit::fracture_energy; }
};

/// What a contact point answers to a jump.
template <int Dim, class Real = double>
struct ContactResponse {
  Real normal_traction = 0.0;              ///< sigma, Pa, tension positive
  Tangential<Dim, Real> shear_traction{};  ///< tau, Pa
  Real stored = 0.0;                       ///< elastic energy now held, J/m²
  unsigned changed = 0;                    ///< InternalInfo::when of what changed in any lane
};

/// Bounds of a contact's stiffness over all its states at one temperature, Pa/m.
template <class Real>
struct ContactStiffness {
  Real normal{}, shear{};
};

/// Why properties cannot make a law: `key = value, but it must be <wanted>`.
struct Objection {
  const char* key = nullptr;
  const char* wanted = nullptr;  ///< in words, may hold one %g for `bound`
  double bound = 0.0;
};

/// Numbers of a list.
template <class List>
constexpr int count_of() {
  List list{};
  int count = 0;
  List::each([&](const auto&, auto&) { ++count; }, list);
  return count;
}

/// Choices of properties or constants.
template <class List>
constexpr int choices_of() {
  List list{};
  int count = 0;
  List::each_choice([&](const auto&, auto&) { ++count; }, list);
  return count;
}

/// Takes the numbers of a list from where they follow one another, and puts them there.
template <class List>
constexpr void take(List& list, const double* from) {
  List::each([&](const auto&, auto& number) { number = *from++; }, list);
}
template <class List>
constexpr void put(const List& list, double* to) {
  List::each([&](const auto&, const auto& number) { *to++ = number; }, list);
}
/// The same for choices.
template <class List>
constexpr void take_choices(List& list, const int* from) {
  List::each_choice(
      [&](const auto&, auto& choice) { choice = static_cast<std::decay_t<decltype(choice)>>(*from++); },
      list);
}
template <class List>
constexpr void put_choices(const List& list, int* to) {
  List::each_choice([&](const auto&, const auto& choice) { *to++ = static_cast<int>(choice); }, list);
}

/// A list without numbers. Also the info of a number that has none.
struct Nothing {
  template <class F, class... N>
  static constexpr void each(F&&, N&...) {}
};

}  // namespace pyroclast
