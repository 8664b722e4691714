#pragma once

#include <filesystem>
#include <vector>

#include "pyroclast/results/text_file.hpp"
#include "pyroclast/simulation/watching/heated_line.hpp"

namespace pyroclast {

/// Temperatures on a heated line at times of the heat solver. A time is kept where a temperature has changed
/// enough since the last one.
struct ProfileRows {
  std::vector<double> time;         ///< time of heating, s
  std::vector<double> temperature;  ///< temperature of each point of the line, °C, row by row

  void visit_state(StateVisitor& visitor);
};

/// Files `temperature_profile.csv`, temperatures over the depth below the heated side, and `isotherm.csv`,
/// the depth to which all of the line has 500 °C or more. The rows of the latter begin when the side comes to
/// 500 °C and end when the side falls below, both linear between two rows.
class ProfileFiles {
 public:
  /// Writes the headers, and the present rows. Throws Error where the rows are those of another line.
  /// \param duration  time for which boundaries act, s
  ProfileFiles(const std::filesystem::path& folder, const Simulation& simulation, double duration,
               const ProfileRows& rows);
  /// Takes and writes the present temperatures where time has passed since the last row, and they have
  /// changed. \param is_wanted  true where they are taken, however little they have changed
  void write(const Simulation& simulation, bool is_wanted, ProfileRows& rows);

  const HeatedLine& line() const { return line_; }

 private:
  HeatedLine line_;
  LineFile profile_, isotherm_;
};

}  // namespace pyroclast
