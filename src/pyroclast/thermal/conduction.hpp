#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "pyroclast/base/state_visitor.hpp"
#include "pyroclast/base/team.hpp"
#include "pyroclast/thermal/gap_conduction.hpp"
#include "pyroclast/thermal/heat_boundary.hpp"
#include "pyroclast/thermal/heat_material.hpp"
#include "pyroclast/thermal/heat_solver.hpp"
#include "pyroclast/thermal/node_halo.hpp"
#include "pyroclast/thermal/prescriptions.hpp"
#include "pyroclast/thermal/thermal_mesh.hpp"
#include "pyroclast/thermal/time_stages.hpp"
#include "pyroclast/thermal/zone_conduction.hpp"

namespace pyroclast {

struct HeatParameters {
  Interval temperature_range;        ///< range for the temperatures of the run until it is widened, °C
  double initial_temperature = 0.0;  ///< °C
  HeatScheme scheme = HeatScheme::super_time_stepping;
  double safety = 0.0;          ///< fraction of the stable step that is taken, in (0, 1]
  double largest_change = 0.0;  ///< largest change of any temperature in one step, K
  double largest_step = 0.0;    ///< s
  /// Resistance of contacts; empty: heat crosses all contacts without resistance.
  std::optional<GapHeat> gaps{};
  bool always_limits = false;  ///< true: limits flows in every step, needed or not, for tests
  bool loses_blocks = false;   ///< true where blocks may leave the body
};

/// State of a conduction at the end of its last completed step. The state and the parameters of the
/// conduction are all that it needs to go on bitwise as before.
struct HeatState {
  Interval temperature_range;      ///< range as widened so far, °C
  double time = 0.0;               ///< s
  double next_step = 0.0;          ///< step to try next, s
  double rate = 0.0;               ///< K/s, see Conduction::rate
  double largest_change = 0.0;     ///< K, see Conduction::largest_change
  double largest_overshoot = 0.0;  ///< K
  Interval bounds;                 ///< °C, see Conduction::bounds
  bool limits = false;             ///< true where the next step begins with limited flows
  std::int64_t steps = 0, retries = 0, stages = 0, limited_steps = 0;
  HeatLedger ledger;                          ///< ledger without `stored`
  double stored_at_start = 0.0;               ///< J
  std::vector<double> temperature, enthalpy;  ///< temperature, °C, and enthalpy, J, of each node

  bool operator==(const HeatState&) const = default;
};

/// Transient conduction of heat in a body of blocks, paper Eqs. (1) and (2).
///
/// Zones are linear with lumped capacity; gridpoints that contacts join are one node. Contacts that conduct
/// badly may part them, see GapConduction. The method advances the enthalpy of the nodes, and temperatures
/// follow from it, so heat is conserved to rounding whatever the curves. A step is explicit and has as many
/// stages as it needs to be stable. Stability rests on bounds of the properties that hold while no
/// temperature changes by more than `largest_change`. A step in which a temperature changes by more is taken
/// back and halved, down to the step that is stable whatever the temperatures.
///
/// **Bounds.** Heat flows from hot to cold. So no temperature leaves those that the body had, that are
/// prescribed and that the gases have (`bounds`), unless a given flux takes it there. Zones with
/// obtuse angles conduct some heat from cold to hot; next to a sharp front this takes a temperature beyond
/// its neighbours. Such a step is done again with limited flows: flows from cold to hot are cut so that they
/// bring no node beyond its neighbours (flux correction: Zalesak 1979; Kuzmin 2012). Any other step is
/// linear, of second order, and the same to the bit as if there were no limits.
///
/// At an end of the temperature range the temperature stays there while the node's heat waits, see
/// `largest_overshoot`; so no curve is ever read outside the range. Where a given flux or a gas
/// beyond the range could truly take the body out of that end, an excess of more than 1 % of the range is an
/// Error.
///
/// Each node gathers the heat that flows to it, and every sum has one order, so results are bitwise the same
/// for any number of threads.
template <int Dim>
class Conduction final : public HeatSolver {
 public:
  /// \param model      model, kept by reference; must outlive this object
  /// \param materials  by material of the model; blocks of a material without entry conduct no heat and are
  ///                   left out
  /// \param team       threads of the run; without a team the calling thread works alone
  ///
  /// Throws Error naming the parameter, material or curve that is out of range.
  Conduction(const ModelOf<Dim>& model, const std::vector<std::optional<HeatMaterial>>& materials,
             const HeatParameters& parameters, std::shared_ptr<Team> team = nullptr);

  Conduction(const Conduction&) = delete;
  Conduction& operator=(const Conduction&) = delete;

  /// Returns the outline of the conducting body, adiabatic unless something else is applied.
  const std::vector<OutlineFace<Dim>>& outline() const { return outline_; }
  /// Returns the indices of the outline's faces that a predicate chooses, such as on_plane or in_box.
  template <class Predicate>
  std::vector<int> faces(Predicate predicate) const {
    std::vector<int> chosen;
    for (std::size_t i = 0; i < outline_.size(); ++i)
      if (predicate(outline_[i])) chosen.push_back(static_cast<int>(i));
    return chosen;
  }

  /// Lets heat in through faces of the outline, in addition to conditions that act there already.
  void apply(const std::vector<int>& faces, const BoundaryCondition& condition);
  /// Prescribes the temperature (°C, over the time in s) of the nodes of faces; where two prescriptions meet,
  /// the later one holds.
  void prescribe_temperature(const std::vector<int>& faces, const Curve& temperature);

  /// Lets temperatures from now on come to the given range, °C, as well as to the present one. Earlier
  /// results do not depend on it. Throws Error when a material's curve does not cover the range.
  void widen_temperature_range(const Interval& range) override;

  /// Sets the gap of each contact; needs HeatParameters::gaps. Where contacts come to part or to join
  /// gridpoints, nodes are numbered anew, and no heat is lost: a part takes its share along, and joined parts
  /// have one temperature, the mean by capacity. Throws Error as GapConduction::set_gaps does.
  void set_gaps(std::vector<ContactGap> gaps) override;
  void remove(const std::vector<int>& blocks) override;
  /// Returns the conduction through gaps; null where heat crosses all contacts without resistance.
  const GapConduction<Dim>* gaps() const { return gaps_ ? &*gaps_ : nullptr; }
  const GapHeat* gap_law() const override { return gaps_ ? &gaps_->law() : nullptr; }
  double gap_area() const override { return gaps_->area(); }
  std::vector<double> conductances(const std::vector<double>& temperature) const override {
    return gaps_->conductances(temperature);
  }

  /// Sets the temperature of every node, °C, and starts the ledger anew.
  void set_temperature(const std::vector<double>& temperature);

  /// Sets the same temperature everywhere, °C.
  void set_uniform_temperature(double temperature);

  /// Takes one step towards a time, s, or goes on with the step that was begun, by at most `stages` stages,
  /// which it counts down. Returns whether the step is completed; until then `state` is as it was when the
  /// step began. Where a call breaks a step off changes no bit. Throws Error when a temperature leaves the
  /// range, naming the place, and when a step towards another time is under way.
  /// \param begin  temperatures by node, °C, for change_since_begin; may be null
  bool advance_step(double end, std::int64_t& stages, const std::vector<double>* begin = nullptr) override;
  /// Forgets the stages done of a step that is not completed; the next step does them again.
  void drop_trial() override;
  /// Returns the stages that take some tenths of a second on one thread, by the number of zones.
  std::int64_t stages_per_batch() const override;

  HeatState state() const;
  /// Shows `state` to a visitor. A new state must come from the same body under the same conditions. The
  /// conduction goes on from it as if nothing had been replaced; a step under way is done again from its
  /// beginning.
  void visit_state(StateVisitor& visitor) override;
  void visit_nodes(StateVisitor& visitor, std::string_view name, std::vector<double>& of_nodes,
                   const StateRule& rule) const override;
  double time() const override { return state_.time; }
  const ThermalNodes& nodes() const override { return nodes_; }
  /// Returns the temperature of each node, °C.
  const std::vector<double>& temperature() const override { return state_.temperature; }
  /// Returns the temperature of each gridpoint, °C; `elsewhere` for gridpoints of blocks that are left out.
  std::vector<double> gridpoint_temperatures(double elsewhere) const override;

  HeatLedger ledger() const override;
  /// Returns the L2 norm of the temperature's change per time in the last step, sqrt(mean over the volume of
  /// (dT/dt)²), K/s.
  double rate() const override { return state_.rate; }
  std::optional<double> hottest_gas() const override;
  /// Returns the largest change of any temperature in the last step, with the jumps of prescribed ones at its
  /// beginning, K.
  double largest_change() const override { return state_.largest_change; }
  /// Returns the largest change of any temperature from `begin` to the end of the last step, see
  /// advance_step, K.
  double change_since_begin() const override { return change_since_begin_; }
  /// Returns the stable step of forward Euler at the present temperatures, safety included.
  HeatStepLimit step_limit() const override;
  /// Returns the range of the temperatures that the body had at first, that were prescribed since then and
  /// that the gases had, °C; an end is infinite where a given flux could take the body beyond it.
  /// Temperatures stay within the range to `kAllowedBeyond`.
  const Interval& bounds() const { return state_.bounds; }

  HeatWork work() const override {
    return {state_.steps, state_.retries, state_.stages, state_.limited_steps, state_.largest_overshoot};
  }

  /// Bound of how far a temperature comes beyond the bounds, and beyond its neighbours in a step, K.
  static constexpr double kAllowedBeyond = 0.1;

 private:
  /// Limits that keep a step within the bounds of heat.
  enum class Limits : std::uint8_t {
    none,
    flows,   ///< flows from cold to hot are limited; the scheme of time may still overshoot a little
    strict,  ///< the same flows are limited, by forward Euler, which does not overshoot
  };
  /// Step that is being tried. The state stays at its start until the step is accepted.
  struct Trial {
    bool under_way = false;
    double end = 0.0;    ///< time towards which it leads, s
    double step = 0.0;   ///< s
    double limit = 0.0;  ///< stable step of Euler while no temperature changes by more than is allowed, s
    Limits limits = Limits::none;
    double left_out = 0.0;  ///< fastest change of a temperature by the flows that limits took away, K/s
    TimeStages stages;
    std::int64_t next_stage = 0;
    std::int64_t stages_done = 0, retries = 0;  ///< counts, with longer steps that were tried before
    /// Largest change of any temperature at any stage, held or not, K.
    double change = 0.0;
    /// Largest excess beyond the temperature range at the end, K.
    double below = 0.0, above = 0.0;
    HeatLedger heat;                  ///< ledger without `stored`
    KeptSums inflows;                 ///< inflows of the stages that are not in the ledger yet, W
    std::int64_t booked = 0;          ///< stages whose inflows are there
    std::vector<double> temperature;  ///< °C
    std::vector<double> increment, before, first_rate;  ///< terms of a stage, see TimeStage
  };
  /// Values of the state that the beginning of a run changed, until its first step is completed.
  struct BeforeRun {
    bool holds = false;
    double next_step = 0.0;   ///< s
    double prescribed = 0.0;  ///< entry in the ledger, J
    Interval bounds;          ///< °C
    /// Temperature, °C, and enthalpy, J, of the prescribed nodes, in the order of `prescriptions_`.
    std::vector<double> temperature, enthalpy;
  };

  /// Boundary condition on faces of the outline.
  struct Applied {
    std::vector<int> faces;
    BoundaryCondition condition;
  };
  /// Faces of the outline whose temperature is prescribed.
  struct Prescribed {
    std::vector<int> faces;
    Curve temperature;
  };

  void set_nodes(ThermalNodes nodes);
  template <class Before>
  void move_heat_to(ThermalNodes nodes, Before before_set);
  std::vector<int> table_of_blocks() const;
  void hold(const std::vector<int>& faces, const Curve& temperature);
  std::vector<std::vector<NodeShare>> gridpoint_shares() const;
  void add_to_boundary(const Applied& applied);
  void begin_run(double end);
  void begin_step(double end, const KeptSums& heat_of_jump);
  bool continue_step(double end, std::int64_t& stages, const std::vector<double>* begin);
  void begin_trial(double step, Limits limits);
  /// What all ranks find of a trial, beside what stands in `trial_`.
  struct Found {
    double change = 0.0, below = 0.0, above = 0.0, left_out = 0.0;  ///< as in Trial
    bool oversteps = false;
    double prescribed = 0.0;      ///< heat that prescribed nodes took in, J
    double squares = 0.0;         ///< volume times the square of the temperature's rate, m³ K²/s²
    double largest_change = 0.0;  ///< see largest_change
    double since_begin = 0.0;     ///< see change_since_begin
    std::vector<double> inflows;  ///< W
  };
  Found judge_trial(const std::vector<double>* begin);
  bool is_too_large() const;
  bool oversteps();
  void book_inflows(const std::vector<double>& inflows);
  void limit_flows(double time);
  HeatScheme trial_scheme(Limits limits, double ratio) const;
  void run_stage(const TimeStage& stage);
  void accept_trial(const Found& found);
  double trial_change() const;
  void adapt_step();
  void compute_inflow(double time);
  void update_nodes(const TimeStage& stage);
  double total_enthalpy() const;
  double excess(int node, double temperature, double enthalpy) const;
  double inflow(int node) const {
    const double heat = zones_.inflow(node) + boundary_heat_[node];
    return gaps_ ? heat + gaps_->inflow(node) : heat;
  }
  KeptSums hold_prescribed();
  void undo_begin(HeatState& state) const;
  Interval extremes() const;
  HeatStepLimit own_limit(double step, double weight_of_boundary, const Interval& extremes) const;
  HeatStepLimit own_range_limit(double end) const;
  HeatStepLimit present_limit(double step, double weight_of_boundary = 1.0) const;
  [[noreturn]] void refuse_excess();

  const ModelOf<Dim>& model_;
  HeatParameters parameters_;
  std::shared_ptr<Team> team_;
  TemperatureGrid grid_;
  std::vector<int> table_of_material_;  ///< -1: does not conduct
  std::vector<bool> conducts_;          ///< true for a block that conducts
  std::vector<HeatTable> tables_;
  ZoneGeometry<Dim> geometry_;
  std::vector<OutlineFace<Dim>> outline_;
  ZoneConduction<Dim> zones_;
  std::optional<GapConduction<Dim>> gaps_;

  // The next members depend on which gridpoints share a node, see set_nodes.
  ThermalNodes nodes_;
  NodeEnthalpy store_;
  std::vector<double> volume_;  ///< volume of each node, m³
  ChunkList node_chunks_;
  ItemHalo halo_;
  double total_volume_ = 0.0;  ///< m³

  HeatBoundary boundary_;
  Prescriptions prescriptions_;

  std::vector<Applied> applied_;
  std::vector<Prescribed> prescribed_;

  HeatState state_;
  Trial trial_;
  BeforeRun before_run_;
  double change_since_begin_ = 0.0;  ///< K
  double safe_step_ = 0.0;           ///< step that is stable in this run whatever the temperatures, s
  /// Allowed excess of this run beyond the temperature range, K.
  double allowed_below_ = 0.0, allowed_above_ = 0.0;
  /// Range of each node to which something may take it beyond its neighbours.
  std::vector<Interval> reach_;
  std::vector<typename ZoneConduction<Dim>::Uphill> shares_;
  std::vector<double> boundary_heat_;  ///< heat into each node, W
};

extern template class Conduction<2>;
extern template class Conduction<3>;

}  // namespace pyroclast
