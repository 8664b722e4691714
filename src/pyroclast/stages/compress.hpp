#pragma once

#include "pyroclast/stages/compression_response.hpp"
#include "pyroclast/stages/registry.hpp"

namespace pyroclast {

/// A platen velocity as high as three measures of inertia and one of cracking allow.
struct VelocityControl {
  double fastest = 0.0;              ///< m/s; the stage's velocity is the lowest
  double unbalanced_ratio = 0.0;     ///< tolerance
  double kinetic_over_strain = 0.0;  ///< tolerance of kinetic over elastic energy
  /// Tolerance of the difference between the stresses on the platens, over the largest stress so far.
  double platen_difference = 0.0;
  double dissipation_rate = 0.0;  ///< tolerance of the power that contacts dissipate over elastic energy, 1/s
};

/// Where a compression stage ends.
enum class CompressUntil : std::uint8_t {
  stop_strain,  ///< at a strain since its beginning
  strain,       ///< at a strain of the test, up or down
  stress        ///< at a stress on the upper platen, up or down
};

/// Drives the upper platen, the lower one fixed: down, or up to unload. First brings it back to ends that it
/// left, or that left it, while the temperature changed.
class Compress : public Stage {
 public:
  struct Keys {
    double velocity = 0.0;  ///< m/s
    /// Time over which the velocity is brought up, s. A controlled velocity then rises by no more than a
    /// factor e in as much time.
    double ramp_time = 0.0;
    std::optional<VelocityControl> control = {};
    CompressUntil until = CompressUntil::stop_strain;
    double to = 0.0;              ///< strain, or stress in Pa, where the stage ends by one of these
    double stop_strain = 0.0;     ///< ends at this axial strain up or down, from the beginning of the stage
    double stop_fraction = 0.0;   ///< ends when the stress has fallen below this fraction of f_c; 0: never
    double history_strain = 0.0;  ///< see OutputIntervals
    double frame_strain = 0.0;    ///< see OutputIntervals
  };

  explicit Compress(const Keys& keys) : keys_(keys) {}

  const char* kind() const override { return "compress"; }
  StageNeeds needs() const override { return {.press = true}; }
  std::string doing() const override { return kept_.is_loading ? "" : "moving the platen to the specimen"; }
  void begin(Simulation& simulation) override;
  bool advance(Simulation& simulation, int most_steps) override;
  Verdict judge(Simulation& simulation) override;
  double progress(const Simulation& simulation) const override;
  StageReport report(const History& history, RowRange rows, Outcome outcome) const override;
  Forecast forecast(const Simulation& simulation, Foreseen& foreseen) const override;
  void visit_state(StateVisitor& visitor) override;

  double velocity() const { return keys_.velocity; }  ///< m/s

 private:
  void begin_loading(Simulation& simulation);
  void close_gap(Simulation& simulation, int most_steps);
  bool move_at_velocity(Simulation& simulation, int most_steps);
  bool move_controlled(Simulation& simulation, int most_steps);
  void choose_velocity(const Simulation& simulation);
  double excess(const Simulation& simulation, double time);
  double foreseen_strain() const;
  void take_point(Simulation& simulation);
  std::optional<std::size_t> row_of_peak(const History& history, RowRange rows) const;
  double left(const Simulation& simulation) const;
  double direction() const { return kept_.is_upwards ? -1.0 : 1.0; }
  std::int64_t steps_in(const Simulation& simulation, double strain) const;

  Keys keys_;
  /// All that lasts from one batch to the next.
  struct Kept {
    std::int64_t gap_steps_left = 0;
    bool is_loading = false;          ///< the gap is closed
    bool is_upwards = false;          ///< unloads
    double first_left = 0.0;          ///< from where it began to where it ends, strain or Pa
    double wave_time = 0.0;           ///< in which a stress wave runs through the specimen once, s
    std::int64_t steps = 0;           ///< since loading began
    std::int64_t steps_left = 0;      ///< to the next look, or to the next choice of a controlled velocity
    std::int64_t steps_to_point = 0;  ///< of the curve
    double velocity = 0.0;            ///< where it is controlled, m/s
    double way = 0.0;                 ///< since the last look, where the velocity is controlled, m
    double way_to_point = 0.0;        ///< since the last point of the curve, likewise, m
    double dissipated = 0.0;          ///< at the last choice of the velocity, J
    CompressionCurve curve;
    Peak peak;                    ///< of the curve behind the first wave
    double largest_stress = 0.0;  ///< likewise, Pa
    double next_frame = 0.0;      ///< strain of the stage
  } kept_;
};

StageKind compress_kind();

}  // namespace pyroclast
