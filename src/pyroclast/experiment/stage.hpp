#pragma once

#include <cstdint>
#include <optional>
#include <variant>

namespace pyroclast {

/// Lets the body come to rest under its weight, the upper platen lying on it.
struct SettleStage {
  double unbalanced_ratio = 0.0;  ///< at rest when below
  std::int64_t most_steps = 0;    ///< gives up, and says so, after as many
};

/// Brings the force on the upper platen to a value and lets the body come to rest under it. The platen does
/// not tilt; its force is held from then on until a stage drives or fixes it.
struct LoadStage {
  double stress = 0.0;            ///< force over the specimen's area, Pa, compression positive
  std::optional<double> level;    ///< stress over f_c, where the deck gives it so
  double ramp_time = 0.0;         ///< time over which the force is brought up, s
  double unbalanced_ratio = 0.0;  ///< at rest when below
  std::int64_t most_steps = 0;    ///< after the ramp; gives up, and says so, after as many
};

/// A platen velocity as high as three measures of inertia and one of cracking allow.
struct VelocityControl {
  double fastest = 0.0;              ///< m/s; the stage's velocity is the lowest
  double unbalanced_ratio = 0.0;     ///< tolerance
  double kinetic_over_strain = 0.0;  ///< tolerance of kinetic over elastic energy
  /// Tolerance of the difference between the stresses on the platens, over the largest stress so far.
  double platen_difference = 0.0;
  double dissipation_rate = 0.0;  ///< tolerance of the power that contacts dissipate over elastic energy, 1/s
};

/// Drives the upper platen down, the lower one fixed.
struct CompressStage {
  double velocity = 0.0;  ///< m/s
  /// Time over which the velocity is brought up, s. A controlled velocity then rises by no more than a factor
  /// e in as much time.
  double ramp_time = 0.0;
  std::optional<VelocityControl> control = {};
  double stop_strain = 0.0;    ///< ends at this axial strain, from the beginning of the stage
  double stop_fraction = 0.0;  ///< ends when the stress has fallen below this fraction of the peak; 0: never
};

/// What the upper platen does while the temperature changes.
enum class PlatenControl : std::uint8_t {
  force,  ///< its force stays (none but its weight where no load was applied)
  fixed   ///< its height stays
};

/// Staggered one-way coupling (paper, Fig. 2): heat to the next exchange, then mechanics at that temperature
/// field, stepped until it rests.
struct Coupling {
  double increment = 0.0;  ///< change of temperature between two exchanges, K
  // The mechanics is at rest when both are below these. The ratio does not see a small force that acts on all
  // gridpoints alike, such as the inertia of a specimen that expands; the platens do.
  double unbalanced_ratio = 0.0;
  double platen_difference = 0.0;  ///< between the stresses on the platens, Pa
  /// Steps for one exchange at least: a force out of balance needs time to move a body of that size.
  std::int64_t least_cycles = 0;
  /// And at most; an exchange that did not come to rest by then is flagged.
  std::int64_t most_cycles = 0;
  bool predictor = false;  ///< moves the body to where its last exchange foretells it to rest; uniform fields
  PlatenControl platen = PlatenControl::force;
  /// The specimen has failed when the platen sinks by this share of the height at one temperature.
  double failure_strain = 0.0;
};

/// Changes the temperature of the whole specimen evenly (paper, section 4).
struct HeatStage {
  double to = 0.0;    ///< °C
  double rate = 0.0;  ///< K/s, positive; heating or cooling follows from `to`
  Coupling coupling;
};

/// Lets heat flow through the specimen by its boundary conditions.
struct ExposeStage {
  double duration = 0.0;  ///< s
  Coupling coupling;
};

using Stage = std::variant<SettleStage, LoadStage, CompressStage, HeatStage, ExposeStage>;

/// How often things are looked at.
struct SamplingParameters {
  double history_strain = 0.0;     ///< axial strain between two rows of the history, while compressing
  double frame_strain = 0.0;       ///< axial strain between two frames of the fields, while compressing
  double frame_temperature = 0.0;  ///< frames at its multiples, of the mean temperature, K
};

}  // namespace pyroclast
