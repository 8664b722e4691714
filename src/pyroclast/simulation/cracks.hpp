#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "pyroclast/mechanics/mechanics.hpp"

namespace pyroclast {

/// Cracks of one interface by one mode, counted at contact points.
struct CrackCount {
  std::int64_t damaged = 0;  ///< D > 0, the broken ones included
  std::int64_t broken = 0;   ///< D = 1: nothing left
  double length = 0.0;       ///< of all damaged contact points, tributary, m

  /// Counts a contact point that has damage.
  void add(bool is_broken, double of_length);
  void operator+=(const CrackCount& other);
};

/// What a law may remember of a crack.
inline constexpr Remembers kCrackModes[] = {Remembers::tension_damage, Remembers::shear_damage,
                                            Remembers::mixed_damage};

/// Cracks that are counted apart.
struct CrackKind {
  Remembers damage;  ///< mode: tension_damage, shear_damage or mixed_damage
  int interface;     ///< index into Model::interface_names
  std::string name;  ///< mode and interface, "tension_aggregate_mortar"
};

/// By mode, then interface, what the laws of a body's interfaces can break by.
std::vector<CrackKind> crack_kinds(const Mechanics<2>& mechanics);

/// Cracks of a body.
struct Cracks {
  std::vector<CrackCount> of_kind;  ///< by crack_kinds
  /// Of contacts with damage in tension or mixed mode, weighted by length, m.
  double mean_opening = 0.0;
};

/// Cracks of a body now.
/// \param kinds  of crack_kinds
Cracks count_cracks(const Mechanics<2>& mechanics, const std::vector<CrackKind>& kinds);

}  // namespace pyroclast
