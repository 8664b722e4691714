#pragma once

#include <optional>
#include <string>

#include "pyroclast/setup/setup.hpp"
#include "pyroclast/simulation/simulation.hpp"

namespace pyroclast {

/// Course of the hottest temperature of a specimen, by heat alone: the body rests, and its cracks are those
/// of the start.
struct ForetoldHeat {
  double hottest = 0.0;             ///< highest temperature, °C
  double hottest_at = 0.0;          ///< time of heating when it was reached, s
  double followed = 0.0;            ///< time of heating to which it was followed, s
  double exposure = 0.0;            ///< time for which boundaries act, s
  std::optional<double> leaves_at;  ///< time when a temperature leaves the run's range, s; empty: never
  Interval range;                   ///< temperatures to which the run may come, °C
};

/// Conducts the heat of a deck through the model of its simulation, which stays as it is. Ends after some
/// seconds of wall time. Returns none where no heat is conducted.
std::optional<ForetoldHeat> foretell_heat(const Setup& setup, const Simulation& simulation);

/// Tells whether boundaries may take a temperature out of the run's range, as far as is known without solving
/// for the heat.
bool may_leave_range(const Setup& setup, const Simulation& simulation);

/// Describes how hot the specimen gets, in a line.
std::string describe(const ForetoldHeat& heat);

/// Describes that the specimen leaves the run's temperatures, and what can be done; empty where it does not.
std::string warning_of(const ForetoldHeat& heat, const Setup& setup);

}  // namespace pyroclast
