#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <new>
#include <span>
#include <type_traits>

#include "pyroclast/laws/law.hpp"

/// Law behind pointers: all that decks, files and the driver of one point know of a law. The step is compiled
/// with the law itself, see mechanics/step/contacts.hpp.
namespace pyroclast {

/// Answer of a single contact point; in a plane body the second shear component is zero.
struct PointResponse {
  double normal_traction = 0.0;            ///< Pa, tension positive
  std::array<double, 2> shear_traction{};  ///< Pa
  double stored = 0.0;                     ///< J/m²
};

/// Answer of eight contact points.
struct LanesResponse {
  Line normal_traction{};                ///< Pa
  std::array<Line, 2> shear_traction{};  ///< Pa
  Line stored{};                         ///< J/m²
  /// InternalInfo::when of every internal variable that changed in any lane; 0: nothing was lost.
  unsigned changed = 0;
};

/// Function that takes eight points to eight jumps, as the step does.
/// \param constants  constants of all eight points; only their choices count where each point has its own
///                   numbers
/// \param own        numbers of the points' own constants, or null
/// \param jump       opening and tangential components
/// \param internals  internal variables; they change only where the law says so
using LanesUpdate = LanesResponse (*)(const void* constants, const Line* own, const Line* jump,
                                      Line* internals, Line* losses);

/// Dimensions of bodies for which a law is made.
enum class Dimensions : std::uint8_t { plane = 1, space = 2, both = 3 };

constexpr bool includes(Dimensions dimensions, int dim) {
  return (static_cast<int>(dimensions) & (dim == 2 ? 1 : 2)) != 0;
}

/// Table of a law. It is plain data of standard layout, because a law from outside the program hands over its
/// own table (plugin/plugin.hpp).
struct LawTable {
  const char* name;
  const char* meaning;
  std::span<const PropertyInfo> properties;
  std::span<const ChoiceInfo> choices;
  std::array<std::span<const InternalInfo>, 2> internals_of;  ///< internal variables in 2D and 3D
  std::span<const LossInfo> losses;
  std::size_t constants_size;  ///< size of the constants, bytes
  int constant_count;          ///< count of numbers among the constants
  /// True where the result of sliding at a steady opening does not depend on its cuts into steps.
  bool exact_in_shear;

  /// Makes the constants, in memory that is aligned for doubles.
  void (*derive)(const double* properties, const int* choices, void* constants);
  /// Writes the numbers of the constants, each `stride` places after the one before.
  void (*numbers_of)(const void* constants, double* numbers, int stride);
  Objection (*check)(const double* properties, const int* choices);
  ContactStiffness<double> (*stiffness)(const void* constants);
  /// Takes a point to a jump (opening, tangential components) and adds to the losses. One function for 2D and
  /// one for 3D; null where the law is not made for the dimension.
  std::array<PointResponse (*)(const void* constants, const double* jump, double* internals, double* losses),
             2>
      update_of;
  const CompiledForSets* compiled;  ///< functions of the step; null where none are part of the program

  std::span<const InternalInfo> internals(int dim) const { return internals_of[dim - 2]; }
  auto update(int dim) const { return update_of[dim - 2]; }
};

namespace law_table {

/// Calls `f(info, number)` for the numbers of a list, or for its choices.
template <class Info, class F, class List>
constexpr void for_each(F f, List& list) {
  if constexpr (std::is_same_v<Info, ChoiceInfo>)
    List::each_choice(f, list);
  else
    List::each(f, list);
}

/// Returns the infos of a list's numbers, or of its choices, one after the other.
template <class Info, class List>
constexpr auto infos() {
  constexpr auto kCount = [] {
    List list{};
    std::size_t count = 0;
    for_each<Info>([&](const auto&, auto&) { ++count; }, list);
    return count;
  }();
  std::array<Info, kCount> all{};
  List list{};
  std::size_t i = 0;
  for_each<Info>([&](const auto& info, auto&) { all[i++] = info; }, list);
  return all;
}

template <class Law>
typename Law::template Properties<double> properties(const double* numbers, const int* choices) {
  typename Law::template Properties<double> p;
  take(p, numbers);
  take_choices(p, choices);
  return p;
}

template <class Law, int Dim>
PointResponse update(const void* constants, const double* jump, double* internals, double* losses) {
  const auto& c = *static_cast<const typename Law::template Constants<double>*>(constants);
  typename Law::template Internals<Dim, double> h;
  take(h, internals);
  typename Law::template Losses<double> l;
  take(l, losses);
  Tangential<Dim> tangential;
  for (int i = 0; i + 1 < Dim; ++i) tangential[i] = jump[i + 1];
  const auto r = Law::template update<Dim, double>(c, jump[0], tangential, h, l);
  put(h, internals);
  put(l, losses);
  PointResponse response{r.normal_traction, {}, r.stored};
  for (int i = 0; i + 1 < Dim; ++i) response.shear_traction[i] = r.shear_traction[i];
  return response;
}

template <class Law>
constexpr bool exact_in_shear() {
  if constexpr (requires { Law::exact_in_shear; })
    return Law::exact_in_shear;
  else
    return true;
}

template <class Law, int Dim, Dimensions kDimensions>
constexpr auto internals() {
  if constexpr (includes(kDimensions, Dim))
    return infos<InternalInfo, typename Law::template Internals<Dim, double>>();
  else
    return std::array<InternalInfo, 0>{};
}

template <class Law, int Dim, Dimensions kDimensions>
constexpr auto update_or_null() {
  if constexpr (includes(kDimensions, Dim))
    return update<Law, Dim>;
  else
    return nullptr;
}
/// Returns `Law::compiled` of a law that is part of the program; null for any other law.
template <class Law>
constexpr const CompiledForSets* functions_of() {
  // a law that derives from another one inherits its `compiled`, but these functions are not its own
  if constexpr (requires {
                  requires std::is_same_v<typename Law::template Properties<double>::Law, Law>;
                  &Law::compiled;
                })
    return &Law::compiled;
  else
    return nullptr;
}

}  // namespace law_table

template <class Law, Dimensions kDimensions = Dimensions::both>
const LawTable& table_of() {
  using Properties = typename Law::template Properties<double>;
  using Constants = typename Law::template Constants<double>;
  static_assert(std::is_trivially_copyable_v<Constants>);
  static constexpr auto kProperties = law_table::infos<PropertyInfo, Properties>();
  static constexpr auto kChoices = law_table::infos<ChoiceInfo, Properties>();
  static constexpr auto kInternals2 = law_table::internals<Law, 2, kDimensions>();
  static constexpr auto kInternals3 = law_table::internals<Law, 3, kDimensions>();
  static constexpr auto kLosses = law_table::infos<LossInfo, typename Law::template Losses<double>>();
  static constexpr LawTable table{
      Law::name,
      Law::meaning,
      kProperties,
      kChoices,
      {kInternals2, kInternals3},
      kLosses,
      sizeof(Constants),
      count_of<Constants>(),
      law_table::exact_in_shear<Law>(),
      [](const double* numbers, const int* choices, void* constants) {
        new (constants) Constants(Law::derive(law_table::properties<Law>(numbers, choices)));
      },
      [](const void* constants, double* numbers, int stride) {
        put(*static_cast<const Constants*>(constants), numbers, stride);
      },
      [](const double* numbers, const int* choices) {
        return Law::check(law_table::properties<Law>(numbers, choices));
      },
      [](const void* constants) { return Law::stiffness(*static_cast<const Constants*>(constants)); },
      {law_table::update_or_null<Law, 2, kDimensions>(), law_table::update_or_null<Law, 3, kDimensions>()},
      law_table::functions_of<Law>()};
  static_assert(std::is_standard_layout_v<LawTable> && std::is_trivially_copyable_v<LawTable>);
  return table;
}

}  // namespace pyroclast
