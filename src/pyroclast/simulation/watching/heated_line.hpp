#pragma once

#include <string>
#include <vector>

#include "pyroclast/simulation/simulation.hpp"
#include "pyroclast/simulation/watching/probe.hpp"

namespace pyroclast {

/// Line that crosses the middle of a body from the side on which heat acts most, see most_heated_side, to the
/// side across.
class HeatedLine {
 public:
  /// Makes the line: a collective.
  /// \param duration  time for which boundaries act, s
  HeatedLine(const Simulation& simulation, double duration);

  /// Returns the name of the side at which the line begins: "left".
  const std::string& face() const { return face_; }
  /// Returns the depth of each point below the first one, m. Points outside of the body are left out.
  const std::vector<double>& depths() const { return depths_; }
  /// Returns the temperature of each point, °C.
  std::vector<double> read(const TemperatureField& field) const;

 private:
  std::string face_;
  std::vector<double> depths_;
  std::vector<Probe> probes_;
};

}  // namespace pyroclast
