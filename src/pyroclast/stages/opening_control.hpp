#pragma once

#include <cstdint>
#include <vector>

#include "pyroclast/simulation/simulation.hpp"
#include "pyroclast/simulation/watching/column.hpp"
#include "pyroclast/stages/drive_loads.hpp"

namespace pyroclast {

/// Control that makes an opening grow at a rate, whatever load this needs: also where the load, and
/// everything it drives, must go back. A pair of forces across the opening keeps it at its prescribed
/// value; the pair is stiffer than the body softens there. The loads of the stage follow so that the pair
/// has nothing left to do.
class OpeningControl {
 public:
  /// \param drive  keys of a drive with a control, kept by reference; must outlive this object
  explicit OpeningControl(const DriveKeys& drive) : drive_(drive) {}

  /// Throws Error where the pair is so stiff that it shakes its sets without bound.
  void check(const Simulation& simulation) const;
  void begin(const Simulation& simulation);
  /// Returns the number of steps between two adjustments of the pair.
  std::int64_t steps_per_adjustment(const Simulation& simulation) const;
  /// Reads the opening by which the next call of `steer` goes.
  void read(const Simulation& simulation);
  /// Sets the pair of forces that holds the opening on its course, and changes the factor of the loads until
  /// the pair has nothing left to do.
  /// \param time      time of the stage, s, for which the opening is prescribed
  /// \param interval  steps for which the pair stays the same
  /// \param loads     gets the loads of the pair
  void steer(const Simulation& simulation, double time, std::int64_t interval, const LoadBefore& before,
             LoadsBySet& loads);
  /// Takes a look at the pair.
  void look();
  /// Removes the pair at the end of the stage.
  /// \param loads  gets no load for the sets of the pair
  void remove_pair(const Simulation& simulation, LoadsBySet& loads) const;

  bool is_lost() const { return kept_.is_lost; }
  double load_factor() const { return kept_.load_factor; }
  const ControlKeys& keys() const { return *drive_.control; }

  /// Returns the columns of a drive with a control.
  static std::vector<Column> columns();
  std::vector<double> values() const { return {kept_.load_factor, kept_.pair_force}; }
  /// Reports the pair's part of the test. The largest load and the largest of load and pair together bound
  /// the strength: where a part fails under both, its own peak may come before that of the load. Where single
  /// contacts give way at once the pair catches the body, for moments.
  /// \param work  work of the stage's loads, J
  void add_to(StageReport& report, double work) const;
  void visit_state(StateVisitor& visitor);

 private:
  double largest_stiffness(const Simulation& simulation) const;
  double total_load(const LoadBefore& before) const;
  double unit_force() const;

  const DriveKeys& drive_;
  /// All that lasts from one batch to the next.
  struct Kept {
    double first_opening = 0.0,
           last_opening = 0.0;  ///< opening when the stage began, and at the last look, m
    /// Factor of the loads; force of the pair, N, positive where it opens.
    double load_factor = 0.0, pair_force = 0.0;
    double largest_pair = 0.0, largest_factor = 0.0;  ///< largest values at looks
    /// Largest sum of the loads and the pair beside them, N.
    double largest_with_pair = 0.0;
    double largest_load = 0.0;  ///< largest load without the pair, N
    double pair_work = 0.0;     ///< work of the pair, J
    bool is_lost = false;       ///< true where the opening left its prescribed value
  } kept_;
  double opening_ = 0.0;  ///< opening before the batch, m
  /// Steps of an interval, which follow from the masses of the sets; 0 until they are asked for.
  mutable std::int64_t steps_per_adjustment_ = 0;
};

}  // namespace pyroclast
