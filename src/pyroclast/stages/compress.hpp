#pragma once

#include "pyroclast/stages/compression_response.hpp"
#include "pyroclast/stages/registry.hpp"

namespace pyroclast {

/// Control that keeps the platen's velocity as high as three measures of inertia and one of cracking allow.
struct VelocityControl {
  double fastest = 0.0;              ///< fastest velocity, m/s; the stage's velocity is the slowest
  double unbalanced_ratio = 0.0;     ///< tolerance of the unbalanced ratio
  double kinetic_over_strain = 0.0;  ///< tolerance of kinetic over elastic energy
  /// Tolerance of the difference between the stresses on the platens, over the largest stress so far.
  double platen_difference = 0.0;
  double dissipation_rate = 0.0;  ///< tolerance of the power that contacts dissipate over elastic energy, 1/s
};

/// Condition that ends a compression stage.
enum class CompressUntil : std::uint8_t {
  stop_strain,  ///< strain since the beginning of the stage
  strain,       ///< strain of the test, up or down
  stress        ///< stress on the upper platen, up or down
};

/// Stage that drives the upper platen, with the lower one fixed: down, or up to unload. The stage first
/// brings the upper platen back to the specimen's end where the two parted while the temperature changed.
class Compress : public Stage {
 public:
  struct Keys {
    double velocity = 0.0;  ///< m/s
    /// Time over which the velocity is brought up, s. A controlled velocity then rises by a factor of at most
    /// e in this time.
    double ramp_time = 0.0;
    std::optional<VelocityControl> control = {};
    CompressUntil until = CompressUntil::stop_strain;
    double to = 0.0;  ///< strain, or stress in Pa, at which the stage ends by `until`
    /// Axial strain up or down, from the beginning of the stage, at which the stage ends.
    double stop_strain = 0.0;
    /// Share of f_c below which the stress must fall to end the stage; 0: never.
    double stop_fraction = 0.0;
    /// Difference of the platens' stresses with which exchanges of temperature leave the body, Pa: no fall of
    /// the stress up to this is of the strength.
    double rest = 0.0;
    double history_strain = 0.0;  ///< strain between looks, see OutputIntervals
    double frame_strain = 0.0;    ///< strain between frames, see OutputIntervals
  };

  explicit Compress(const Keys& keys) : keys_(keys) {}

  const char* kind() const override { return "compress"; }
  StageNeeds needs() const override { return {.press = true}; }
  std::string doing() const override { return kept_.is_loading ? "" : "moving the platen to the specimen"; }
  void begin(Simulation& simulation) override;
  bool advance(Simulation& simulation, int most_steps) override;
  void look(const Simulation& simulation) override;
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
  double excess(const CompressionPoint& point, double time);
  double foreseen_strain() const;
  double foreseen_steps(const Simulation& simulation, double way) const;
  void take_point(const Simulation& simulation, const CompressionPoint& point);
  std::optional<std::size_t> row_of_peak(const History& history, RowRange rows) const;
  double left(const Simulation& simulation) const;
  double direction() const { return kept_.is_upwards ? -1.0 : 1.0; }
  std::int64_t steps_in(const Simulation& simulation, double strain) const;

  Keys keys_;
  /// All that lasts from one batch to the next.
  struct Kept {
    std::int64_t gap_steps_left = 0;
    bool is_loading = false;  ///< true once the gap is closed
    bool is_upwards = false;  ///< true while the stage unloads
    double first_left = 0.0;  ///< distance from the beginning to the end of the stage, strain or Pa
    double wave_time = 0.0;   ///< time in which a stress wave runs through the specimen once, s
    std::int64_t steps = 0;   ///< steps since loading began
    /// Steps to the next look, or to the next choice of a controlled velocity.
    std::int64_t steps_left = 0;
    std::int64_t steps_to_point = 0;  ///< steps to the next point of the curve
    double velocity = 0.0;            ///< controlled velocity, m/s
    double way = 0.0;                 ///< way since the last look, where the velocity is controlled, m
    /// Way since the last point of the curve, where the velocity is controlled, m.
    double way_to_point = 0.0;
    double dissipated = 0.0;  ///< energy dissipated at the last choice of the velocity, J
    CompressionCurve curve;
    Peak peak;                    ///< peak of the curve after the first wave
    double largest_stress = 0.0;  ///< largest stress after the first wave, Pa
    double next_frame = 0.0;      ///< strain of the stage at the next frame
  } kept_;
  /// Point after the last steps of a controlled velocity, until the next velocity is chosen.
  std::optional<CompressionPoint> point_;
  /// Strain of the stage, and stress, at the last look.
  double strain_seen_ = 0.0, stress_seen_ = 0.0;
  std::optional<double> left_seen_;  ///< distance to the end at the last look; none where the state is new
};

StageKind compress_kind();

}  // namespace pyroclast
