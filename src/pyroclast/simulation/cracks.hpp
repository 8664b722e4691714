#pragma once

#include <cstdint>

#include "pyroclast/mechanics/mechanics.hpp"

namespace pyroclast {

/// Cracks of one interface by one mode, counted at contact points.
struct CrackCount {
  std::int64_t damaged = 0;  ///< D > 0, the broken ones included
  std::int64_t broken = 0;   ///< D = 1: nothing left
  double length = 0.0;       ///< of all damaged contact points, tributary, m

  /// Counts a contact point.
  void add(double damage, double of_length);
  void operator+=(const CrackCount& other);
};

/// Cracks by mode and interface: aggregate-mortar (am), mortar-mortar (mm).
struct Cracks {
  CrackCount tension_am, tension_mm, shear_am, shear_mm;
  double mean_opening = 0.0;  ///< of contacts with tension damage, weighted by length, m
};

/// Cracks of a body now.
Cracks count_cracks(const Mechanics<2>& mechanics);

}  // namespace pyroclast
