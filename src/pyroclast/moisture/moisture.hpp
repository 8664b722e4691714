#pragma once

#include <cstdint>
#include <optional>
#include <variant>
#include <vector>

#include "pyroclast/material/curve.hpp"
#include "pyroclast/moisture/moisture_mesh.hpp"
#include "pyroclast/moisture/pore_material.hpp"
#include "pyroclast/moisture/sparse_solver.hpp"

namespace pyroclast {

struct MoistureParameters {
  double largest_step = 10.0;             ///< s
  double largest_temperature_step = 4.0;  ///< largest change of a temperature in a step, K
};

/// Air that takes vapour up: a flow of coefficient (density at the surface - density of the air), in series
/// with the half of the cell behind the surface.
struct MoistAir {
  double coefficient = 0.0;                     ///< m/s
  Curve vapour_density = Curve::constant(0.0);  ///< kg/m3, over the time, s
};

/// Surface where the vapour pressure is given.
struct GivenPressure {
  Curve pressure = Curve::constant(0.0);  ///< Pa, over the time, s
};

/// Outer faces without a condition are sealed.
using MoistureCondition = std::variant<MoistAir, GivenPressure>;

/// Water of a body since its start, kg.
struct MoistureLedger {
  double at_start = 0.0;
  double released = 0.0;  ///< given back by hydrates
  double left = 0.0;      ///< went out through outer faces, less what came in
};

/// State at the end of the last step; with it and its parameters a field goes on bitwise as before.
struct MoistureState {
  double time = 0.0;                        ///< s
  double next_step = 0.0;                   ///< step to try next, s
  std::vector<double> content;              ///< of each cell, kg/m3
  std::vector<double> pressure;             ///< of vapour, Pa
  std::vector<double> temperature;          ///< degC
  std::vector<double> highest_temperature;  ///< so far, degC
  MoistureLedger ledger;
  std::int64_t steps = 0, retries = 0, iterations = 0;
};

/// Liquid water and vapour in the pores of a body that is heated, with one unknown of each cell: the vapour
/// pressure p, with which the liquid is in equilibrium.
///
/// d(content)/dt + div J = d(released)/dt,
/// J = -K (k_l rho_l/mu_l grad p_l + k_v rho_v/mu_v grad p) - D grad p,  p_l = p - suction(p).
///
/// Finite volumes centred in blocks; each phase is taken upwind, the density of vapour as the mean of both
/// sides, so that p^2 is linear in steady flow of an ideal gas. Backward Euler; Newton's method in ln p, from
/// the old share of the saturation pressure. The content of cells is the state, and p follows from it: water
/// is conserved to rounding. Air has no pressure of its own here: above 100 degC vapour has swept it out.
/// Where temperatures pass 370 degC, liquid keeps the properties that it has there.
class Moisture {
 public:
  /// \param materials  pores by material of the model; needed for the materials of all cells
  /// Throws Error naming the parameter that is out of range.
  Moisture(MoistureMesh mesh, std::vector<std::optional<PoreMaterial>> materials,
           const MoistureParameters& parameters);

  /// Sets a condition at outer faces, in the place of an earlier one.
  void apply(const std::vector<int>& outer_faces, const MoistureCondition& condition);

  /// Starts at a temperature (degC), with pores of all materials so full: above 0, at most 1. Throws Error
  /// for another share.
  void start_with_saturation(double saturation, double temperature);
  /// Starts at a temperature (degC), with the same vapour pressure everywhere, Pa.
  void start_with_pressure(double pressure, double temperature);

  /// Goes on by a duration, s, while the temperatures of cells change evenly to the given ones, degC.
  /// Throws Error naming the block where no step converges.
  void advance(double duration, const std::vector<double>& temperature);

  const MoistureMesh& mesh() const { return mesh_; }
  const MoistureState& state() const { return state_; }
  /// Goes on from a state of the same body under the same conditions.
  void go_on_from(MoistureState state) { state_ = std::move(state); }

  double stored() const;     ///< Returns the water in all cells, kg.
  double imbalance() const;  ///< Returns the water that the ledger misses, kg.
  /// Returns the share of the pores that liquid fills, of each cell.
  std::vector<double> saturation() const;
  /// Returns the vapour pressure over that of saturation, of each cell.
  std::vector<double> pressure_ratio() const;

 private:
  struct Slots {
    int own[2],
        other[2];  ///< entries of the matrix: (0,0), (1,1), and of each cell's column in the other's row
  };

  MoistureMesh mesh_;
  std::vector<std::optional<PoreMaterial>> materials_;
  MoistureParameters parameters_;
  std::vector<std::optional<MoistureCondition>> conditions_;  ///< by outer face
  std::vector<Slots> slots_;                                  ///< by face
  std::vector<int> diagonal_;                                 ///< by cell
  std::size_t entry_count_ = 0;
  std::optional<SparseSolver> solver_;
  MoistureState state_;

  // Of the trial under way.
  std::vector<PoreConditions> at_;
  std::vector<PoreWater<WithSlope>> water_;
  std::vector<double> target_, pressure_, outflow_, entries_, step_;
  std::vector<double> surface_mobility_;  ///< by outer face, of the beginning of the trial

  const PoreMaterial& pores(int cell) const { return *materials_[mesh_.material[cell]]; }
  PoreConditions conditions(int cell) const;
  void start(double temperature);
  void make_pattern();
  bool try_step(double step, const std::vector<double>& temperature);
  void begin_trial(const std::vector<double>& temperature);
  double flow_out(double time);
};

}  // namespace pyroclast
