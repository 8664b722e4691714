#pragma once

#include <cstdint>
#include <vector>

#include "pyroclast/experiment/simulation.hpp"
#include "pyroclast/experiment/stage.hpp"

namespace pyroclast {

/// Cracks of one interface by one mode, counted at contact points.
struct CrackCount {
  std::int64_t softening = 0;  ///< damage began
  std::int64_t broken = 0;     ///< nothing left: D = 1
  double length = 0.0;         ///< of all cracked contact points, tributary, m (3D: area, m²)
};

/// Cracks by mode and interface.
struct Cracks {
  CrackCount tension_am, tension_mm, shear_am, shear_mm;
  double mean_opening = 0.0;  ///< of contacts with tension damage, weighted by length, m

  std::int64_t broken_tension() const { return tension_am.broken + tension_mm.broken; }
  std::int64_t broken_shear() const { return shear_am.broken + shear_mm.broken; }
};

/// Temperatures at a look, and what the exchange before it took.
struct HeatSample {
  double time = 0.0;                                ///< since heating began, s
  double mean = 0.0, minimum = 0.0, maximum = 0.0;  ///< over the specimen, °C
  int exchange = 0;         ///< counted from 1; 0 where no temperature was handed over
  std::int64_t cycles = 0;  ///< steps of the mechanics
  bool converged = true;    ///< came to rest within the stated cycles
};

/// One row of the history. Stress and strain of the test are positive in compression; lateral strain is
/// positive in expansion.
struct Sample {
  int stage = 0;
  std::int64_t step = 0;
  double time = 0.0;  ///< of the mechanics, s
  HeatSample heat;
  double strain = 0.0;           ///< approach of the platens' inner faces since settling, over the height
  double stage_strain = 0.0;     ///< the same since the stage began
  double specimen_strain = 0.0;  ///< approach of the specimen's own ends since settling, over the height
  double stress_top = 0.0;       ///< reaction of the upper platen over the specimen's area, Pa
  double stress_bottom = 0.0;    ///< of the lower one, Pa
  double lateral_strain = 0.0;   ///< mean widening over the width
  double unbalanced_ratio = 0.0;
  double kinetic_over_strain = 0.0;  ///< kinetic over elastic energy
  double largest_jump = 0.0;         ///< over the length of its face
  Cracks cracks;
  EnergyLedger energy;

  double stress() const { return 0.5 * (stress_top + stress_bottom); }
};

/// Why an experiment ended.
enum class Outcome : std::uint8_t { completed, stress_fallen, ran_away, interrupted, not_settled, unstable };

const char* describe(Outcome outcome);

class Experiment;

/// Is told what happens; writes results, shows progress, asks for a stop.
class Observer {
 public:
  virtual ~Observer() = default;
  virtual void sample(const Experiment&, const Sample&) {}
  /// The fields are worth keeping now.
  virtual void frame(const Experiment&, const Sample&) {}
  /// Asked after every batch of steps; true ends the experiment as it stands.
  virtual bool stop_requested() { return false; }
};

/// A specimen between platens, taken through a list of stages.
class Experiment {
 public:
  /// \param simulation, observer  kept by reference; must outlive this
  Experiment(Simulation& simulation, std::vector<Stage> stages, const SamplingParameters& sampling,
             Observer& observer);

  /// The main loop: for each stage, load, move, look, until the stage is over.
  Outcome run();

  const Mechanics<2>& mechanics() const { return mechanics_; }
  const ConcreteModel& body() const { return body_; }
  const TemperatureField& field() const { return field_; }
  const std::vector<Stage>& stages() const { return stages_; }
  const std::vector<Sample>& history() const { return history_; }
  /// Share of the present stage that is done, 0 to 1, as far as it can be foreseen.
  double progress() const { return progress_; }

 private:
  /// Of the whole specimen, expansion positive.
  struct MeanStrain {
    double axial = 0.0, lateral = 0.0;
  };

  struct Verdict {
    bool over = false;
    bool last = false;  ///< the experiment ends with this stage
    Outcome outcome = Outcome::completed;
  };

  void begin(const SettleStage&);
  void begin(const LoadStage&);
  void begin(const CompressStage&);
  void begin(const HeatStage&);
  void begin(const ExposeStage&);
  /// Changes what acts on the body.
  void load(const SettleStage&) {}
  void load(const LoadStage&);
  void load(const CompressStage&);
  void load(const HeatStage&);
  void load(const ExposeStage&);
  /// Lets it move until the next look.
  void move(const SettleStage&);
  void move(const LoadStage&);
  void move(const CompressStage&);
  void move(const HeatStage& stage) { cycle(stage.coupling); }
  void move(const ExposeStage& stage) { cycle(stage.coupling); }
  Verdict judge(const SettleStage&, const Sample&);
  Verdict judge(const LoadStage&, const Sample&);
  Verdict judge(const CompressStage&, const Sample&);
  Verdict judge(const HeatStage&, const Sample&);
  Verdict judge(const ExposeStage&, const Sample&);

  void begin_heating(const Coupling&);
  double temperature_interval(double temperature) const;
  void exchange();
  Interval free_strain_change(double from, double to) const;
  void strain_evenly(const MeanStrain& strain, bool platen_follows);
  void cycle(const Coupling&);
  bool stop_asked();
  void control_by_force();
  void control_by_motion(double velocity);
  void hold_force(double stress);
  void close_gap(double velocity);
  Verdict judge_coupling(const Sample&);
  int steps_to_next_look(const SettleStage&) const;
  int steps_to_next_look(const CompressStage&) const;
  void move_controlled(const CompressStage&);
  double excess(const VelocityControl&, double time);
  double ramp_share(double ramp_time) const;
  double axial_strain() const;
  double specimen_strain() const;
  double lateral_strain() const;
  double stress_top() const;
  double stress_bottom() const;
  bool at_rest(const Coupling&) const;

  Sample measure() const;
  void look();

  const ConcreteModel& body_;
  const ConcreteMaterials& materials_;
  const HeatCase& heating_;
  double width_, height_;
  Mechanics<2>& mechanics_;
  TemperatureField& field_;
  std::vector<Stage> stages_;
  SamplingParameters sampling_;
  Observer& observer_;

  int stage_ = 0;
  std::int64_t stage_first_step_ = 0;
  double stage_first_strain_ = 0.0;
  double stage_first_stress_ = 0.0;           ///< held by the force on the upper platen, Pa
  double shortening_at_rest_ = 0.0;           ///< of the gap between the platens, m
  double specimen_shortening_at_rest_ = 0.0;  ///< m
  double widening_at_rest_ = 0.0;             ///< m
  double peak_stress_ = 0.0;                  ///< of the stage, Pa
  double dissipated_ = 0.0;                   ///< at the last change of the controlled velocity, J
  double velocity_ = 0.0;                     ///< of the upper platen, where it is controlled, m/s
  double next_frame_ = 0.0;                   ///< strain
  double last_interval_ = 0.0;                ///< of temperature, in which the last row lay
  double stress_held_ = 0.0;                  ///< by the force on the upper platen, Pa
  double stage_first_temperature_ = 0.0;      ///< mean, °C
  double exposure_began_ = 0.0;               ///< heating time, s
  MeanStrain last_strain_;                    ///< at the end of the last exchange but one
  double last_change_ = 0.0;                  ///< of temperature at the last exchange, K; 0 at none yet
  int exchanges_ = 0;
  HeatSample heat_;
  bool ran_away_ = false, stop_asked_ = false;
  double progress_ = 0.0;
  std::vector<Sample> history_;
};

/// Cracks of a body now.
Cracks count_cracks(const Mechanics<2>& mechanics);

}  // namespace pyroclast
