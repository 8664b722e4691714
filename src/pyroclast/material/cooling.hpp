#pragma once

#include <optional>

#include "pyroclast/material/curve.hpp"

namespace pyroclast {

/// Returns the share of a property's value at the highest temperature so far, T_max, that is left at a lower
/// one. At 20 °C it is the residual ratio of T_max; in between it changes linearly with the temperature, as
/// EN 1994-1-2:2005, Annex C, interpolates the strength of concrete that cools. On heating again it rises by
/// the same line.
///
/// \param residual  ratio over T_max, °C; without it the share is 1
inline double share_left(const std::optional<Curve>& residual, double temperature, double hottest) {
  if (!residual || temperature >= hottest || hottest <= kReferenceTemperature) return 1.0;
  const double way = (hottest - temperature) / (hottest - kReferenceTemperature);
  return 1.0 - (1.0 - (*residual)(hottest)) * (way < 1.0 ? way : 1.0);
}

}  // namespace pyroclast
