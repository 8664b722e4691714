#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "pyroclast/simulation/simulation.hpp"
#include "pyroclast/stages/drive_keys.hpp"
#include "pyroclast/stages/peak.hpp"

namespace pyroclast {

/// Watch over the records of a drive: their peaks, the conditions of which the first that is met ends the
/// stage, and the noise in which no peak counts.
class RecordWatch {
 public:
  /// \param drive  keys of the drive, kept by reference; must outlive this object
  explicit RecordWatch(const DriveKeys& drive);

  void begin(const Simulation& simulation);
  /// Takes the values of the records into their peaks. An unloading by command is no fall from a peak:
  /// nothing counts until the body is driven farther than ever.
  /// \param driven     time for which the body was driven on, s
  /// \param is_driven  true while the body is driven on
  void take_peaks(const Simulation& simulation, double driven, bool is_driven);
  /// Takes what `judge` and `has_fallen` ask of the body, see Stage::look.
  void look(const Simulation& simulation) { seen_ = read(simulation); }
  /// Judges the conditions at a look. Returns whether one of them is met.
  /// \param time  time of the stage, s
  /// \param lost  name of a record that ran away from its control, and so passes any value; may be empty
  bool judge(double time, std::string_view lost);
  /// Tells whether the leading record has just come down from a peak that has no frame yet.
  bool has_fallen();
  /// Tells whether there is a leading record: the first force, else stress.
  bool has_leading() const { return leading_.has_value(); }

  const std::vector<RecordPeak>& peaks() const { return kept_.record_peaks; }
  /// Returns the work of the loads when the stage began, J.
  double first_work() const { return kept_.first_work; }
  /// Describes each condition, none of which was met, and where its record stood at the end.
  std::vector<std::string> describe_unmet() const;
  void visit_state(StateVisitor& visitor);

 private:
  /// What the watch asks of the body.
  struct Seen {
    std::vector<double> values;  ///< values of the records
    EnergyLedger energy;
  };
  Seen read(const Simulation& simulation) const;
  double value(const Seen& seen, std::string_view record) const;
  bool is_beyond_noise(double share, const EnergyLedger& energy);
  bool is_met(std::size_t condition, double time, std::string_view lost);
  std::string describe_unmet(std::size_t condition) const;

  const DriveKeys& drive_;
  std::optional<std::string> leading_;  ///< record that the test is about
  /// All that lasts from one batch to the next.
  struct Kept {
    std::vector<RecordPeak> record_peaks;  ///< peak of each record
    std::vector<Peak> peaks;               ///< peaks of the records of `until`
    std::vector<double> last;              ///< value of each record of `until` at the last look
    double last_look = 0.0;                ///< time of the last look, s
    /// Greatest size of the leading record, and the greatest at a frame, SI.
    double leading_peak = 0.0, framed_peak = 0.0;
    double first_work = 0.0;       ///< work of the loads when the stage began, J
    double most_kinetic = 0.0;     ///< largest kinetic energy while peaks do not count yet, J
    bool is_beyond_noise = false;  ///< true once the motion is no noise, so that peaks count
  } kept_;
  Seen seen_;  ///< seen at the last look
};

}  // namespace pyroclast
