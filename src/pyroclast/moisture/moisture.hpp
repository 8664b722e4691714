#pragma once

#include <cstdint>
#include <optional>
#include <variant>
#include <vector>

#include "pyroclast/material/curve.hpp"
#include "pyroclast/moisture/crack_network.hpp"
#include "pyroclast/moisture/moisture_mesh.hpp"
#include "pyroclast/moisture/pore_material.hpp"
#include "pyroclast/moisture/sparse_solver.hpp"

namespace pyroclast {

struct MoistureParameters {
  double largest_step = 10.0;             ///< s
  double largest_temperature_step = 5.0;  ///< largest change of a temperature in a step, K
  double roughness = 1.0;                 ///< of the walls of cracks, see crack_network
};

/// Air that takes vapour up: a flow of coefficient (density at the surface - density of the air), in series
/// with the half of the cell behind the surface. Cracks that open into it have its vapour pressure at their
/// mouths.
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
  double removed = 0.0;   ///< gone with blocks
};

/// State at the end of the last step; with it and its parameters a field goes on bitwise as before.
struct MoistureState {
  double time = 0.0;                        ///< s
  double next_step = 0.0;                   ///< step to try next, s
  std::vector<double> content;              ///< of each cell, kg/m3
  std::vector<double> pressure;             ///< of vapour, Pa
  std::vector<double> temperature;          ///< degC
  std::vector<double> highest_temperature;  ///< so far, degC
  std::vector<OpenFace> cracks;             ///< by ascending face
  std::vector<double> crack_water;          ///< of each crack, kg
  std::vector<double> crack_pressure;       ///< of vapour, Pa
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
/// is conserved to rounding. A face that stands open is a crack with a pressure of its own, between the two
/// cells, and passes vapour to the cracks that it meets. Air has no pressure of its own here: above 100 degC
/// vapour has swept it out. Where temperatures pass 370 degC, liquid keeps the properties that it has there.
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

  /// Goes on with fewer cells, whose water leaves with the others.
  /// \param mesh   the same model without some of its blocks
  /// \param outer  for each outer face of this mesh the present one whose condition it takes over; -1: sealed
  void reduce_to(MoistureMesh mesh, const std::vector<int>& outer);

  /// Opens, widens, narrows and closes cracks. A new crack gets its vapour from the cells beside it, and one
  /// that closes gives them its water back.
  /// \param cracks  all cracks from now on, by ascending face
  void set_cracks(std::vector<OpenFace> cracks);

  /// Goes on by a duration, s, while the temperatures of cells change evenly to the given ones, degC.
  /// Throws Error naming the block where no step converges.
  void advance(double duration, const std::vector<double>& temperature);

  const MoistureMesh& mesh() const { return mesh_; }
  /// Tells whether water passes through an outer face.
  bool opens(int outer_face) const;
  const MoistureState& state() const { return state_; }
  /// Goes on from a state of the same body under the same conditions.
  void go_on_from(MoistureState state);

  double stored() const;              ///< Returns the water in all cells and cracks, kg.
  double imbalance() const;           ///< Returns the water that the ledger misses, kg.
  double saturation(int cell) const;  ///< Returns the share of the pores of a cell that liquid fills.
  /// Returns the vapour pressure over that of saturation, of each cell.
  std::vector<double> pressure_ratio() const;
  /// Returns the vapour pressure at a face of the mesh, Pa: that of the crack there, or of steady flow
  /// through the face.
  double face_pressure(int face) const;

 private:
  // Cells and, behind them, cracks are the nodes of the balance.

  /// Way of water from one node to another.
  struct Link {
    std::array<int, 2> nodes;
    double area;                    ///< m2; of a conduit its conductance, m3
    std::array<double, 2> lengths;  ///< through the material of each node, m; of a conduit none
    bool is_conduit = false;
    /// Entries of the matrix: (0,0), (1,1), and of each node's column in the other's row.
    std::array<int, 2> own = {}, other = {};
  };

  MoistureMesh mesh_;
  std::vector<std::optional<PoreMaterial>> materials_;
  MoistureParameters parameters_;
  std::vector<std::optional<MoistureCondition>> conditions_;  ///< by outer face
  std::vector<Link> links_;
  std::vector<CrackMouth> mouths_;
  std::vector<int> crack_at_;          ///< by face, index into the state's cracks; -1: none
  std::vector<double> volume_;         ///< by node, m3
  std::vector<double> measured_over_;  ///< volume over which a node's balance is measured, m3
  std::vector<int> diagonal_;          ///< by node
  std::size_t entry_count_ = 0;
  std::optional<SparseSolver> solver_;
  MoistureState state_;

  // Of the trial under way.
  std::vector<PoreConditions> at_;
  std::vector<PoreWater<WithSlope>> water_;
  std::vector<double> target_, pressure_, outflow_, entries_, step_;
  double left_ = 0.0;                     ///< flow out of the body, kg/s
  std::vector<double> surface_mobility_;  ///< by outer face, of the beginning of the trial

  const PoreMaterial& pores(int cell) const { return *materials_[mesh_.material[cell]]; }
  int node_count() const { return static_cast<int>(volume_.size()); }
  PoreConditions conditions(int cell) const;
  double crack_temperature(int face, const std::vector<double>& temperature) const;
  PoreConditions crack_conditions(int face, const std::vector<double>& temperature) const;
  void add_to_cell(int cell, double water);
  double share_of_side(int face, int side) const;
  void start(double temperature);
  void make_links();
  void make_pattern();
  bool try_step(double step, const std::vector<double>& temperature);
  void begin_trial(const std::vector<double>& temperature);
  double flow_out(double time);
  double flow_out_of_mouths(double time);
  double balance(double step);
  bool leaves_water_in_cracks(double step) const;
  void change_pressures();
  void end_step(double step, const std::vector<double>& temperature);
};

}  // namespace pyroclast
