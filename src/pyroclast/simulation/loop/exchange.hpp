#pragma once

#include <cstdint>
#include <vector>

#include "pyroclast/simulation/acting/press.hpp"
#include "pyroclast/simulation/loop/stage.hpp"
#include "pyroclast/simulation/watching/column.hpp"

namespace pyroclast {

/// Control of the upper platen while the temperature changes.
enum class PlatenControl : std::uint8_t {
  force,  ///< force of the platen stays (none but its weight where no load was applied)
  fixed   ///< height of the platen stays
};

const char* name(PlatenControl control);

/// Staggered coupling (paper, Fig. 2): heat flows to the next exchange, then the mechanics takes steps at
/// that temperature field until the body rests. Where cracks hinder heat, the coupling is two-way: the heat
/// of the next exchange meets the cracks that this one left.
struct Coupling {
  double increment = 0.0;  ///< change of temperature between two exchanges, K
  // The body is at rest when both measures are below these limits. The ratio does not see a small force that
  // acts on all gridpoints alike, such as the inertia of a specimen that expands; the platens do.
  double unbalanced_ratio = 0.0;
  /// Difference of the stresses on the platens, Pa; without platens the sum of weight, loads and reactions
  /// over the section of a square body of the same area.
  double platen_difference = 0.0;
  // Neither measure sees the weight, which is small beside loads: so the lower platen must also carry what
  // rests on it.
  /// Least steps for one exchange: a force out of balance needs time to move a body of that size.
  std::int64_t least_cycles = 0;
  /// Most steps for one exchange; an exchange that did not come to rest by then is flagged.
  std::int64_t most_cycles = 0;
  /// Choice to move the body first to where its last exchange foretells it to rest; uniform fields only.
  bool predictor = false;
  PlatenControl platen = PlatenControl::force;
  /// Share of the height by which the platen sinks at one temperature when the specimen has failed. Without
  /// platens it is the share of the body's size, the square root of its area, by which loaded sets give way.
  double failure_strain = 0.0;
};

/// Exchange of temperatures: hands them over to the mechanics and lets the body come to rest at them.
class Exchange {
 public:
  explicit Exchange(const Coupling& coupling) : coupling_(coupling) {}

  const Coupling& coupling() const { return coupling_; }

  /// Controls the platen as the coupling says.
  void begin(Simulation& simulation) const;
  /// Hands the field's temperatures over; `advance` does the rest.
  void hand_over(Simulation& simulation);
  /// Lets `advance` first move the body to where it will probably rest. This takes two steps and leaves the
  /// body at rest. Otherwise the body would have to push itself to its new size, and its inertia would press
  /// on the lower platen.
  void move_evenly_first(const Press::EvenMotion& motion);
  /// Reads where the body stands before its first step at new temperatures, see Stage::read; comes before each
  /// `advance`.
  void read_start(const Simulation& simulation);
  /// Takes one batch of steps; returns true when the body rests, has failed, or has used up its cycles. A
  /// specimen that is being crushed then gets more cycles, until it stops or the platen has run away. The
  /// specimen's own ends tell this, for a platen without load may have left them. A body without load hovers
  /// where it shrank away from the lower platen. It is then set down: its weight would take long to move the
  /// scaled mass. Pieces that fly end the exchange, and leave the body.
  bool advance(Simulation& simulation, int most_steps);

  bool ran_away() const { return kept_.ran_away; }

  static std::vector<Column> columns();
  std::vector<double> values() const;
  /// Returns the steps that one exchange will probably take.
  double expected_cycles() const;

  void visit_state(StateVisitor& visitor);

 private:
  /// Tells whether the body has not moved at these temperatures yet, but evenly.
  bool begins() const;
  bool go_on(Simulation& simulation, int most_steps);
  bool move_evenly(Simulation& simulation);
  void set_down(const Press& press);
  /// What an exchange asks of the body between its steps.
  struct Seen {
    double shortening = 0.0;  ///< how far the body has given way to its loads, as a strain
    bool is_supported = true;
    bool is_still = false;
  };
  Seen read(const Simulation& simulation) const;
  bool is_still(const Simulation& simulation) const;
  bool platen_follows() const { return coupling_.platen == PlatenControl::force; }

  Coupling coupling_;
  /// All that lasts from one batch to the next.
  struct Kept {
    std::int64_t number = 0;
    std::int64_t cycles = 0;
    bool converged = true;
    bool ran_away = false;
    bool is_handed_over = false;  ///< true from handing over to the first step after it
    /// True from an exchange that pore water ended to the first step after it: a platen sinks on from where
    /// that exchange began.
    bool is_cut_short = false;
    std::int64_t even_steps_left = 0;  ///< steps left of moving evenly and of the halt after it
    Press::EvenMotion even_motion;     ///< motion to come
    /// Strains of the specimen: at the exchange, and when cycles were last added.
    double strain_before = 0.0, last_strain = 0.0;
  } kept_;
  // What `read_start` read: each batch reads it anew.
  double strain_at_start_ = 0.0;
  std::vector<double> ways_at_start_;
};

}  // namespace pyroclast
