#pragma once

#include <cstdint>
#include <type_traits>

#include "pyroclast/base/lanes.hpp"
#include "pyroclast/base/range.hpp"
#include "pyroclast/base/unit.hpp"
#include "pyroclast/base/vec.hpp"

/// Interface of a contact law, and the infos that name its numbers.
///
/// A law is a struct that takes one contact point from jump to traction. It holds
///
///     Properties<Real>      parameters of a deck, at one temperature   each(f, p...), each_choice(f, p...)
///     Constants<Real>       constants derived from them, once          each(f, c...), each_choice(f, c...)
///     Internals<Dim, Real>  internal variables of a contact point      each(f, h...)
///     Losses<Sum>           final losses of a contact point            each(f, l...)
///     derive, update, stiffness, check                                 see laws/cohesive.hpp
///
/// Opening alone gives the same result however it is cut into steps; so does sliding at a steady opening,
/// unless the law says `static constexpr bool exact_in_shear = false`. On other paths a law converges with
/// the number of steps. laws/kit.cpp tries all other properties that a law must hold.
///
/// Each list calls `f(info, number...)` for one number after the other; several objects of the same kind go
/// side by side. The info gives the number's name, unit and meaning once: decks, docs, memory, fields and
/// columns follow from it.
///
/// Real is a double for one point, or lanes for eight points (base/lanes.hpp). Sign: tension and opening are
/// positive. All energies are per unit of contact area, J/m².
namespace pyroclast {

/// Functions that the step compiles for a law (mechanics/compiled_for_sets.hpp); a law that is part of the
/// program declares its own as `static const CompiledForSets compiled`.
struct CompiledForSets;

/// Components of a contact's tangential jump and traction: 1 in 2D, 2 in 3D.
template <int Dim, class Real = double>
using Tangential = Vec<Dim - 1, Real>;

/// Role of a property, on which factors of an interface, ratios over temperature and K = E / t_b act.
enum class Role : std::uint8_t {
  plain,             ///< property on which none of them acts
  normal_stiffness,  ///< E / t_b where a deck says nothing, Eq. (17)
  shear_stiffness,   ///< G / t_b where a deck says nothing, Eq. (17)
  strength,
  energy,
  sliding_energy,   ///< energy lost by sliding: a deck may let it go with the block size
  first_softening,  ///< softening as it begins: a deck may let it go with the block size
  second_slope,     ///< slope over the normal stiffness: a deck may keep the slope the same at any block size
  cold_strength,    ///< strength at 20 °C; without a statement the contact's first strength there
  hidden_cracks     ///< share of strengths lost to cracks below the mesh; curves of strengths include it
};

/// Tells whether the property is a fracture energy.
constexpr bool is_energy(Role role) {
  return role == Role::energy || role == Role::sliding_energy;
}

/// Tells whether the property is the same at any temperature but where a deck states a curve for it.
constexpr bool is_apart_from_temperature(Role role) {
  return role == Role::plain || role == Role::first_softening || role == Role::second_slope ||
         role == Role::cold_strength || role == Role::hidden_cracks;
}

struct PropertyInfo {
  const char* key;      ///< key in decks
  const char* meaning;  ///< meaning for people
  Unit unit;
  Range range;
  Role role = Role::plain;
  /// Option of a choice to which the property belongs; null: to all. Where another option is chosen a deck
  /// may not state it, and it is 1.
  const char* of_option = nullptr;
};

struct OptionInfo {
  const char* name;
  const char* meaning;
};

/// Choice among few options, the same at every temperature. The first option is the default.
struct ChoiceInfo {
  static constexpr int kMostOptions = 4;

  const char* key;
  const char* meaning;
  OptionInfo options[kMostOptions];  ///< options; the last ones may be empty
};

/// Meaning of an internal variable to cracks, columns and figures.
enum class Remembers : std::uint8_t {
  other,
  tension_damage,  ///< 0 intact, 1 broken; never decreases
  shear_damage,    ///< 0 intact, 1 broken; never decreases
  mixed_damage,    ///< one damage of tension and shear together
  closure,         ///< length, m, that added to the opening gives the opening of the crack
  lost_strength,   ///< share of the strengths lost to cracks below the mesh; never decreases
  parameter        ///< extreme of a parameter so far: a new point has that of its temperature
};

struct InternalInfo {
  const char* name;
  const char* meaning;
  Unit unit;
  Remembers what = Remembers::other;
  /// Bit of ContactResponse::changed that tells that the variable may have changed; 0: it changes in every
  /// update.
  unsigned when = 0;
  bool in_files = true;  ///< true for a field of the results
};

struct LossInfo {
  const char* name;
  const char* meaning;
  Unit unit;
  const char* label = "";  ///< few words for legends; empty: the name

  /// Tells whether the loss is an energy, which the ledger counts.
  constexpr bool is_energy() const { return unit == unit::fracture_energy; }
};

/// Answer of a contact point to a jump.
template <int Dim, class Real = double>
struct ContactResponse {
  Real normal_traction = 0.0;              ///< sigma, Pa, tension positive
  Tangential<Dim, Real> shear_traction{};  ///< tau, Pa
  Real stored = 0.0;                       ///< elastic energy held after the update, J/m²
  /// InternalInfo::when of every internal variable that changed in any lane.
  unsigned changed = 0;
};

/// Bounds of a contact's stiffness over all its states at one temperature, Pa/m.
template <class Real>
struct ContactStiffness {
  Real normal{}, shear{};
};

/// Reason why properties cannot make a law: `key = value, but it must be <wanted>`.
struct Objection {
  const char* key = nullptr;
  const char* wanted = nullptr;  ///< wanted values in words; may hold one %g for `bound`
  double bound = 0.0;
};

/// Returns how many numbers a list has.
template <class List>
constexpr int count_of() {
  List list{};
  int count = 0;
  List::each([&](const auto&, auto&) { ++count; }, list);
  return count;
}

/// Returns how many choices properties or constants have.
template <class List>
constexpr int choices_of() {
  List list{};
  int count = 0;
  List::each_choice([&](const auto&, auto&) { ++count; }, list);
  return count;
}

/// Takes the numbers of a list from consecutive places; `put` writes them there, or `stride` places apart.
template <class List>
constexpr void take(List& list, const double* from) {
  List::each([&](const auto&, auto& number) { number = *from++; }, list);
}
template <class List>
constexpr void put(const List& list, double* to, int stride = 1) {
  List::each(
      [&](const auto&, const auto& number) {
        *to = number;
        to += stride;
      },
      list);
}
/// Takes the choices of a list from consecutive places; `put_choices` writes them there.
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

/// List without numbers. Also the info of a number that has none.
struct Nothing {
  template <class F, class... N>
  static constexpr void each(F&&, N&...) {}
};

}  // namespace pyroclast
