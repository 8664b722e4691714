#pragma once

#include <cstdint>
#include <limits>
#include <optional>

#include "pyroclast/experiment/heat_case.hpp"
#include "pyroclast/experiment/temperature_field.hpp"

namespace pyroclast {

/// Heat conduction on its own, from the field's present time on.
struct HeatRun {
  double duration = 0.0;  ///< ends at this time from the start of heating, s
  /// Looks come when a temperature has changed by so much since the last one, K, and at multiples of the
  /// interval, s. No interval is missed for the sake of a change.
  double change = std::numeric_limits<double>::infinity();
  double interval = std::numeric_limits<double>::infinity();
  /// Time between two frames, s; there is a look at each.
  double frame_interval = std::numeric_limits<double>::infinity();
  /// Ends when the L2 norm of the temperature's rate (Conduction::rate) falls below, K/s. Not before the
  /// boundary values have become constant, because a fire that starts slowly is no steady state.
  std::optional<double> steady_rate{};
};

enum class HeatOutcome : std::uint8_t { completed, steady, interrupted };

/// Why the run ended, for people.
const char* describe(HeatOutcome outcome);

/// Is told what happens; writes results, shows progress, asks for a stop.
class HeatObserver {
 public:
  virtual ~HeatObserver() = default;
  virtual void look(const TemperatureField&) {}
  /// The field is worth keeping now; follows a look.
  virtual void frame(const TemperatureField&) {}
  /// Asked after every look; true ends the run as it stands.
  virtual bool stop_requested() { return false; }
};

/// Conducts heat and looks: at the start, in between as asked for, and at the end. With a steady rate there
/// is one more look when the boundary values become constant. There is a frame at the start, at multiples of
/// the frame interval, and at the end.
///
/// Throws Error for a uniform field, and when a temperature leaves its range.
HeatOutcome run_heat(TemperatureField& field, const HeatCase& heat, const HeatRun& run,
                     HeatObserver& observer);

}  // namespace pyroclast
