#pragma once

#include <optional>

#include "pyroclast/material/curve.hpp"

namespace pyroclast {

/// Share of a property's value at the highest temperature that was there, T_max, that is left at a lower one.
/// At 20 °C it is the residual ratio of T_max; it falls evenly between the two, as EN 1994-1-2:2005, Annex C,
/// interpolates the strength of concrete that cools. On heating again it rises by the same line.
///
/// \param residual  the ratio over T_max, °C; without one all is left
inline double share_left(const std::optional<Curve>& residual, double temperature, double hottest) {
  if (!residual || temperature >= hottest || hottest <= kReferenceTemperature) return 1.0;
  const double way = (hottest - temperature) / (hottest - kReferenceTemperature);
  return 1.0 - (1.0 - (*residual)(hottest)) * (way < 1.0 ? way : 1.0);
}

}  // namespace pyroclast
