#pragma once

#include <cstdint>
#include <string>
#include <variant>
#include <vector>

#include "pyroclast/mechanics/mechanics.hpp"
#include "pyroclast/model/concrete_model.hpp"

namespace pyroclast {

/// Lets the body come to rest under its weight, the upper platen lying on it.
struct SettleStage {
  double unbalanced_ratio = 0.0;  ///< at rest when below
  std::int64_t most_steps = 0;    ///< gives up, and says so, after as many
};

/// Drives the upper platen down, the lower one fixed.
struct CompressStage {
  double velocity = 0.0;       ///< m/s
  double ramp_time = 0.0;      ///< time over which the velocity is brought up, s
  double stop_strain = 0.0;    ///< ends at this axial strain
  double stop_fraction = 0.0;  ///< ends when the stress has fallen below this fraction of the peak; 0: never
};

using Stage = std::variant<SettleStage, CompressStage>;

/// How often things are looked at.
struct SamplingParameters {
  double history_strain = 0.0;  ///< axial strain between two rows of the history
  double frame_strain = 0.0;    ///< axial strain between two frames of the fields
};

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

/// One row of the history. Stress and strain of the test are positive in compression; lateral strain is
/// positive in expansion.
struct Sample {
  int stage = 0;
  std::int64_t step = 0;
  double time = 0.0;            ///< s
  double strain = 0.0;          ///< approach of the platens' inner faces since settling, over the height
  double stress_top = 0.0;      ///< reaction of the upper platen over the specimen's area, Pa
  double stress_bottom = 0.0;   ///< of the lower one, Pa
  double lateral_strain = 0.0;  ///< mean widening over the width
  double unbalanced_ratio = 0.0;
  double kinetic_over_strain = 0.0;  ///< kinetic over elastic energy
  double largest_jump = 0.0;         ///< over the length of its face
  Cracks cracks;
  EnergyLedger energy;

  double stress() const { return 0.5 * (stress_top + stress_bottom); }
};

/// Why an experiment ended.
enum class Outcome : std::uint8_t { completed, stress_fallen, interrupted, not_settled, unstable };

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
  /// All by reference; they must outlive this.
  Experiment(const ConcreteModel& body, double width, double height, Mechanics<2>& mechanics,
             std::vector<Stage> stages, const SamplingParameters& sampling, Observer& observer);

  /// The main loop: for each stage, load, move, look, until the stage is over.
  Outcome run();

  const Mechanics<2>& mechanics() const { return mechanics_; }
  const ConcreteModel& body() const { return body_; }
  const std::vector<Sample>& history() const { return history_; }
  /// Share of the experiment that is done, 0 to 1, as far as it can be foreseen.
  double progress() const { return progress_; }

 private:
  struct Verdict {
    bool over = false;
    bool last = false;  ///< the experiment ends with this stage
    Outcome outcome = Outcome::completed;
  };

  void begin(const SettleStage&);
  void begin(const CompressStage&);
  void load(const SettleStage&) {}
  void load(const CompressStage&);
  int steps_to_next_look(const SettleStage&) const;
  int steps_to_next_look(const CompressStage&) const;
  Verdict judge(const SettleStage&, const Sample&);
  Verdict judge(const CompressStage&, const Sample&);

  Sample measure() const;
  void look();

  const ConcreteModel& body_;
  double width_, height_;
  Mechanics<2>& mechanics_;
  std::vector<Stage> stages_;
  SamplingParameters sampling_;
  Observer& observer_;

  int stage_ = 0;
  std::int64_t stage_first_step_ = 0;
  double shortening_at_rest_ = 0.0;  ///< m
  double widening_at_rest_ = 0.0;    ///< m
  double peak_stress_ = 0.0;
  double next_frame_ = 0.0;
  double progress_ = 0.0;
  std::vector<Sample> history_;
};

/// Cracks of a body now.
Cracks count_cracks(const Mechanics<2>& mechanics);

}  // namespace pyroclast
