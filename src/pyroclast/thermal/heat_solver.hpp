#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "pyroclast/base/ledger.hpp"
#include "pyroclast/base/state_visitor.hpp"
#include "pyroclast/thermal/gap_heat.hpp"
#include "pyroclast/thermal/heat_boundary.hpp"
#include "pyroclast/thermal/thermal_mesh.hpp"

namespace pyroclast {

/// Range of the temperatures of a state, °C: with room for rounding, and hotter than any concrete. Tables of
/// properties are as wide.
inline constexpr StateRule kTemperatures = state::within(absolute_zero - 1.0, 1e5);

/// Heat of a body since the start, J. The heat that came in equals the heat stored and the heat that left
/// with blocks; the remainder is the ledger's error.
struct HeatLedger {
  HeatByKind boundary;
  double prescribed = 0.0;  ///< heat needed to hold the prescribed temperatures
  double stored = 0.0;
  double removed = 0.0;       ///< gone with blocks, over that at the start
  bool loses_blocks = false;  ///< true for a body that blocks may leave

  double heat_in() const { return boundary.total() + prescribed; }
  double error() const { return heat_in() - stored - removed; }
  bool operator==(const HeatLedger&) const = default;
};

/// Entries in the order of the history's columns.
inline constexpr auto kHeats = std::to_array<LedgerEntry<HeatLedger>>({
    {"stored", "heat_stored_J", LedgerSide::held, "stored", "in the body",
     [](const HeatLedger& h) { return h.stored; }},
    {"prescribed", "heat_prescribed_J", LedgerSide::put_in, "prescribed temperatures",
     "to hold prescribed temperatures", [](const HeatLedger& h) { return h.prescribed; }},
    {"flux", "heat_flux_J", LedgerSide::put_in, "given fluxes", "by given fluxes",
     [](const HeatLedger& h) { return h.boundary.flux; }},
    {"convection", "heat_convection_J", LedgerSide::put_in, "convection", "by convection",
     [](const HeatLedger& h) { return h.boundary.convection; }},
    {"radiation", "heat_radiation_J", LedgerSide::put_in, "radiation", "by radiation",
     [](const HeatLedger& h) { return h.boundary.radiation; }},
    {"removed", "heat_removed_J", LedgerSide::lost, "gone with pieces", "in blocks that have left the body",
     [](const HeatLedger& h) { return h.removed; }, [](const HeatLedger& h) { return h.loses_blocks; }},
    {"error", "heat_error_J", LedgerSide::error, "error", "heat that came in, less heat stored and gone",
     [](const HeatLedger& h) { return h.error(); }},
});

/// Stable step of forward Euler and the node that sets it.
struct HeatStepLimit {
  double step = 0.0;  ///< s
  int node = 0;       ///< -1 where another rank has it
};

/// Work of a heat solver so far.
struct HeatWork {
  std::int64_t steps = 0;          ///< steps completed
  std::int64_t retries = 0;        ///< steps taken back because a temperature changed too much
  std::int64_t stages = 0;         ///< evaluations of Eq. (1), the cost of a run
  std::int64_t limited_steps = 0;  ///< steps whose flows were limited
  /// Farthest that heat would have taken a node beyond the temperature range had the node not been held
  /// there, K.
  double largest_overshoot = 0.0;
};

/// Conduction in a body in the plane or in space, for code that need not know which; see Conduction.
class HeatSolver {
 public:
  virtual ~HeatSolver() = default;

  virtual void widen_temperature_range(const Interval& range) = 0;
  virtual void set_gaps(std::vector<ContactGap> gaps) = 0;
  /// Takes blocks out of the body for good, with their heat. Faces that they bare get the conditions of the
  /// nearest faces that leave with them.
  virtual void remove(const std::vector<int>& blocks) = 0;
  /// Returns the law of heat through gaps; null where heat crosses all contacts without resistance. The next
  /// two functions are for solvers that have one.
  virtual const GapHeat* gap_law() const = 0;
  virtual double gap_area() const = 0;  ///< Returns the area of the contacts between two nodes, m².
  /// Returns the conductance of each contact, see GapConduction::conductances.
  virtual std::vector<double> conductances(const std::vector<double>& temperature) const = 0;

  virtual bool advance_step(double end, std::int64_t& stages, const std::vector<double>* begin = nullptr) = 0;
  virtual void drop_trial() = 0;
  virtual std::int64_t stages_per_batch() const = 0;
  virtual void visit_state(StateVisitor& visitor) = 0;
  /// Shows numbers of nodes to a visitor, those of own nodes: a collective.
  virtual void visit_nodes(StateVisitor& visitor, std::string_view name, std::vector<double>& of_nodes,
                           const StateRule& rule) const = 0;

  virtual double time() const = 0;
  virtual const ThermalNodes& nodes() const = 0;
  virtual const std::vector<double>& temperature() const = 0;
  virtual std::vector<double> gridpoint_temperatures(double elsewhere) const = 0;
  virtual HeatLedger ledger() const = 0;
  virtual double rate() const = 0;
  /// Returns the temperature of the hottest gas that heat flows from or to now, °C; none without gases.
  virtual std::optional<double> hottest_gas() const = 0;
  virtual double largest_change() const = 0;
  virtual double change_since_begin() const = 0;
  virtual HeatStepLimit step_limit() const = 0;
  virtual HeatWork work() const = 0;
};

}  // namespace pyroclast
