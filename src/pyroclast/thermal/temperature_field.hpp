#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <vector>

#include "pyroclast/base/state_visitor.hpp"
#include "pyroclast/model/model.hpp"
#include "pyroclast/thermal/heat_solver.hpp"

namespace pyroclast {

/// Returns the two gridpoints of each contact point between whose temperatures its own lies; at a bearing
/// both are the specimen's.
std::vector<std::array<int, 2>> contact_gridpoints(const Model& model);

/// Returns the mean of a value of the gridpoints over those of a zone.
double mean_of_zone(const Model& model, int zone, const std::vector<double>& gridpoints);

/// Temperatures of a specimen during a run: one for the whole specimen, or the computed field. The platens
/// are at the reference temperature throughout.
class TemperatureField {
 public:
  /// Sets one temperature for the whole specimen, °C. `model` must outlive the field.
  TemperatureField(const Model& model, double temperature);
  /// Takes the field that conduction computes, see make_conduction. `model` must outlive the field.
  TemperatureField(const Model& model, std::unique_ptr<HeatSolver> conduction);

  bool is_uniform() const { return !conduction_; }

  /// Sets the specimen's temperature, °C. Throws Error for a computed field.
  void set_uniform(double temperature);

  /// Widens the range of temperatures, °C, to those that the specimen may reach by the end of the next
  /// exposure; the ranges of earlier exposures stay, and before the first one the specimen stays at its
  /// initial temperature. So no result depends on a later, hotter exposure. Throws Error for a uniform field.
  void begin_exposure(const Interval& temperatures);

  /// Sets the gap of each contact for heat, see Conduction::set_gaps. Throws Error for a uniform field and
  /// while an advance is under way.
  void set_gaps(std::vector<ContactGap> gaps);

  /// Takes blocks out of the specimen for good, see HeatSolver::remove. Throws Error while an advance is
  /// under way.
  void remove(const std::vector<int>& blocks);

  /// Conducts heat until some gridpoint of the specimen has changed by `largest_change`, K, since the call,
  /// or to the time `until`, s, or until the rate (Conduction::rate) is below `steady_rate`, K/s. Returns the
  /// time reached.
  ///
  /// The solver is stopped where the rates of its last step foresee the change, and asked after every step:
  /// the change ends between 95 % of the wanted one and the wanted one plus one step's largest change
  /// (HeatConditions::largest_change). It ends beyond only where a prescribed temperature jumps, or where
  /// less than one stable step brings more. Throws Error for a uniform field.
  double advance(double largest_change, double until, double steady_rate = 0.0);

  /// Begins an advance in batches; then call `advance` until it returns true. Until then all values that can
  /// be read here are those of the beginning; where batches end changes no bit.
  void begin_advance(double largest_change, double until, double steady_rate = 0.0);
  /// Goes on by at most `stages` stages of the solver (Conduction::stages_per_batch), 1 or more. Returns
  /// whether the advance is over.
  bool advance(std::int64_t stages);
  /// Ends an advance that is under way after the last step that the solver completed.
  void end_advance();

  /// Returns the temperature of each gridpoint, °C; `zones` and `contacts` return the means over the
  /// gridpoints of each zone and contact point, at a platen the temperature of the specimen's gridpoint.
  /// Gridpoints of blocks that have left have none (NaN); their zones and contacts are at the reference
  /// temperature.
  const std::vector<double>& gridpoints() const { return gridpoints_; }
  const std::vector<double>& zones() const { return zones_; }
  const std::vector<double>& contacts() const { return contacts_; }

  /// Returns the mean over the specimen's volume, °C; `minimum` and `maximum` return the extremes.
  double mean() const { return mean_; }
  double minimum() const { return minimum_; }
  double maximum() const { return maximum_; }

  /// Returns the time of these temperatures from the start of heating, s; 0 for a uniform field, which knows
  /// no time.
  double time() const { return time_; }

  /// Returns the solver, with its ledger and rates; null for a uniform field.
  const HeatSolver* conduction() const { return conduction_.get(); }

  void visit_state(StateVisitor& visitor);

 private:
  /// Progress of an advance.
  struct Advance {
    bool under_way = false;
    double largest_change = 0.0, until = 0.0, steady_rate = 0.0;  ///< limits as asked for, K, s, K/s
    double change = 0.0;                                          ///< change so far, K
    /// Temperatures of the nodes at the beginning, °C.
    std::vector<double> begin;
  };

  explicit TemperatureField(const Model& model);

  void read_conduction();
  void follow_gridpoints();
  void update();
  bool is_gone(int block) const { return !gone_.empty() && gone_[block]; }
  template <class F>
  void for_gone_gridpoints(F f) const;

  const Model& model_;
  std::unique_ptr<HeatSolver> conduction_;
  std::vector<int> specimen_gridpoints_;
  /// Gridpoints of each contact; at a platen twice the specimen's.
  std::vector<std::array<int, 2>> contact_gridpoints_;
  std::vector<double> specimen_volume_;  ///< volume of each zone, m³; 0 in the platens and where it is gone
  std::vector<bool> gone_;               ///< by block; empty as long as none has left
  ChunkList zone_chunks_;
  double volume_ = 0.0;  ///< volume of the specimen, m³

  Advance advance_;
  double fastest_ = 0.0;  ///< fastest rate of any temperature in the last step, K/s

  double time_ = 0.0;
  std::vector<double> gridpoints_, zones_, contacts_;
  double mean_ = 0.0, minimum_ = 0.0, maximum_ = 0.0;
};

}  // namespace pyroclast
