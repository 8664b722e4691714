#pragma once

#include <cstdint>
#include <vector>

#include "pyroclast/simulation/press.hpp"
#include "pyroclast/simulation/stage.hpp"

namespace pyroclast {

/// What the upper platen does while the temperature changes.
enum class PlatenControl : std::uint8_t {
  force,  ///< its force stays (none but its weight where no load was applied)
  fixed   ///< its height stays
};

const char* name(PlatenControl control);

/// Staggered coupling (paper, Fig. 2): heat to the next exchange, then mechanics at that temperature field,
/// stepped until it rests. Where cracks hinder heat, it is two-way: the heat of the next exchange meets the
/// cracks that this one left.
struct Coupling {
  double increment = 0.0;  ///< change of temperature between two exchanges, K
  // The mechanics is at rest when both are below these. The ratio does not see a small force that acts on all
  // gridpoints alike, such as the inertia of a specimen that expands; the platens do.
  double unbalanced_ratio = 0.0;
  /// Between the stresses on the platens; without platens the sum of weight, loads and reactions over the
  /// section of a square body of the same area, Pa.
  double platen_difference = 0.0;
  // Both do not see weight, which is small beside loads: the lower platen must carry what rests on it.
  /// Steps for one exchange at least: a force out of balance needs time to move a body of that size.
  std::int64_t least_cycles = 0;
  /// And at most; an exchange that did not come to rest by then is flagged.
  std::int64_t most_cycles = 0;
  bool predictor = false;  ///< moves the body to where its last exchange foretells it to rest; uniform fields
  PlatenControl platen = PlatenControl::force;
  /// The specimen has failed when the platen sinks by this share of the height at one temperature; without
  /// platens when what is loaded gives way by this share of the body's size, the square root of its area.
  double failure_strain = 0.0;
};

/// Hands temperatures over to the mechanics and lets the body come to rest at them.
class Exchange {
 public:
  explicit Exchange(const Coupling& coupling) : coupling_(coupling) {}

  const Coupling& coupling() const { return coupling_; }

  /// Controls the platen as the coupling says.
  void begin(Simulation& simulation) const;
  /// Hands the field's temperatures over; `advance` does the rest.
  void hand_over(Simulation& simulation);
  /// Then moves the body first to where it will probably rest. Takes two steps and leaves the body at rest:
  /// without this it would have to push itself to its new size, and its inertia would press on the lower
  /// platen.
  void move_evenly_first(const Press<2>::EvenMotion& motion);
  /// One batch of steps; true when the body rests, has failed, or has used up its cycles. A specimen that is
  /// being crushed then gets more of them, until it stops or the platen has run away. The specimen's own ends
  /// tell, for a platen without load may have left them. A body without load that hovers, for it shrank away
  /// from the lower platen, is set down: its weight would take long to move the mass that is scaled.
  bool advance(Simulation& simulation, int most_steps);

  bool ran_away() const { return kept_.ran_away; }

  /// `exchange`, counted over the run from 1; `cycles` in steps; `converged`, 1 where the body came to rest.
  static std::vector<Column> columns();
  std::vector<double> values() const;
  /// Steps that one exchange will probably take.
  double expected_cycles() const;

  void visit_state(StateVisitor& visitor);

 private:
  bool move_evenly(Simulation& simulation);
  void set_down(const Press<2>& press);
  bool is_still(const Simulation& simulation) const;
  bool platen_follows() const { return coupling_.platen == PlatenControl::force; }

  Coupling coupling_;
  /// All that lasts from one batch to the next.
  struct Kept {
    std::int64_t number = 0;
    std::int64_t cycles = 0;
    bool converged = true;
    bool ran_away = false;
    bool is_handed_over = false;             ///< and not a step done since
    std::int64_t even_steps_left = 0;        ///< of moving evenly, and of the halt
    Press<2>::EvenMotion even_motion;        ///< to come
    double strain_before = 0.0, last = 0.0;  ///< of the specimen: at the exchange; when cycles were added
  } kept_;
};

}  // namespace pyroclast
