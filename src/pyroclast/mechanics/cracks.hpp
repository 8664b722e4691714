#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "pyroclast/mechanics/body.hpp"

namespace pyroclast {

/// Cracks of one interface by one mode, counted at contact points.
struct CrackCount {
  std::int64_t damaged = 0;    ///< points with D > 0, the broken ones included
  std::int64_t broken = 0;     ///< points with D = 1: no bond is left
  double extent = 0.0;         ///< extent of all damaged contact points, see Model::extent
  double broken_extent = 0.0;  ///< that of the broken ones

  /// Counts a contact point that has damage.
  void add(bool is_broken, double extent_of_point);
  void operator+=(const CrackCount& other);
};

/// Internal variables by which a law may keep a crack.
inline constexpr Remembers kCrackModes[] = {Remembers::tension_damage, Remembers::shear_damage,
                                            Remembers::mixed_damage};

/// Returns the name of a mode, "tension".
const char* name_of_mode(Remembers damage);

/// Kind of cracks that are counted apart.
struct CrackKind {
  Remembers damage;  ///< mode: tension_damage, shear_damage or mixed_damage
  int interface;     ///< index into Model::interface_names
  std::string name;  ///< mode and interface, "tension_aggregate_mortar"
};

/// Returns, by mode and then by interface, the kinds of cracks that the laws of a body's interfaces allow.
template <int Dim>
std::vector<CrackKind> crack_kinds(const Body<Dim>& body);

/// Cracks of a body.
struct Cracks {
  std::vector<CrackCount> of_kind;  ///< counts in the order of crack_kinds
  /// Mean opening of contacts with damage in tension or mixed mode, weighted by extent, m.
  double mean_opening = 0.0;
};

/// Counts the present cracks of a body.
/// \param kinds  result of crack_kinds
template <int Dim>
Cracks count_cracks(const Body<Dim>& body, const std::vector<CrackKind>& kinds);

/// Damage above which a contact point counts as a crack of some age.
inline constexpr double kCracked = 0.5;

/// Notes the present step for each contact point whose damage by some mode is above kCracked for the first
/// time.
template <int Dim>
void note_cracks(Body<Dim>& body);

}  // namespace pyroclast
