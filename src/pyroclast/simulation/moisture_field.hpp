#pragma once

#include <limits>
#include <optional>
#include <vector>

#include "pyroclast/base/state_visitor.hpp"
#include "pyroclast/material/concrete.hpp"
#include "pyroclast/mechanics/motion.hpp"
#include "pyroclast/model/model.hpp"
#include "pyroclast/simulation/acting/moisture_conditions.hpp"
#include "pyroclast/simulation/coupling.hpp"
#include "pyroclast/simulation/specimen_body.hpp"
#include "pyroclast/thermal/temperature_field.hpp"

namespace pyroclast {

/// Throws Error where water would flow in a body that several ranks hold.
void require_one_process(int ranks);

/// Water in the pores of a specimen during a run. It follows the temperatures and drains through cracks; the
/// body bears its pressure.
class MoistureField {
 public:
  /// `model` must outlive the field. Throws Error where a boundary condition meets no face, several act on
  /// one, or a phase cannot hold the pores that are stated of the concrete.
  MoistureField(const Model& model, const std::vector<BlockMaterial>& block_materials,
                const SpecimenNumbers& numbers, const MoistureConditions& conditions, double temperature);

  /// Takes blocks out of the body for good, with their water. Faces that they bare get the conditions of the
  /// nearest faces that leave with them.
  void remove(const std::vector<int>& blocks);
  /// Lets water flow until the time of these temperatures, which change evenly until then. Throws Error, see
  /// Moisture::advance.
  void follow(const TemperatureField& temperatures);
  /// Hands the present cracks of the body over to the water. A crack that is there already changes its width
  /// by at most a factor of 2 at once, for pressures and openings hang on each other.
  void show_cracks(const Motion& motion);
  /// Returns the pressures that the body bears; none where they do not act.
  /// \param motion  its contacts; null: they are intact
  std::optional<PorePressures> pressures(const Motion* motion) const;

  /// Tells whether a crack under pressure stands more than twice as wide as when the water last saw it: then
  /// the exchange ends, and the next one comes soon.
  bool is_outrun_by_cracks(const Motion& motion) const;
  /// Lets the next exchange come after a short time.
  void hurry();
  /// Returns the time of the next exchange that the water asks for, s: infinite where it asks for none.
  double next_exchange() const { return water().state().time + interval_; }

  const Moisture& water() const { return *moisture_; }
  /// Returns the pressure of the vapour in a block less that of the atmosphere, at least 0, Pa; 0 in
  /// bearings.
  double pore_pressure(int block) const;
  /// Returns the share of the pores of a block that liquid fills; 0 in bearings.
  double saturation(int block) const {
    const int cell = mesh().cell_of_block[block];
    return cell < 0 ? 0.0 : water().saturation(cell);
  }
  /// Returns the water in a block, kg/m3; 0 in bearings.
  double content(int block) const { return of_block(water().state().content, block); }

  /// Returns the pressure of the vapour at a contact less that of the atmosphere, at least 0, Pa; 0 at
  /// bearings.
  double contact_pressure(int contact) const;
  /// Tells whether contacts bear the pressure.
  bool acts_on_contacts() const { return coupling_.acts == PressureActs::all; }
  /// Returns the part of the pressure at a contact that the contact bears where it acts, Pa.
  /// \param motion  its contacts; null: they are intact
  double borne_pressure(const Motion* motion, int contact) const;
  /// Returns how many blocks of phases with the concrete's pores have no way to a face that is not sealed but
  /// through other phases.
  int pocket_blocks() const;
  double largest_pore_pressure() const;   ///< Returns that of all blocks, Pa.
  double largest_pressure_ratio() const;  ///< Returns the largest vapour pressure over that of saturation.

  void visit_state(StateVisitor& visitor);

 private:
  const MoistureMesh& mesh() const { return moisture_->mesh(); }
  void visit_cracks(StateVisitor& visitor, MoistureState& state) const;
  double of_block(const std::vector<double>& values, int block) const {
    const int cell = mesh().cell_of_block[block];
    return cell < 0 ? 0.0 : values[cell];
  }
  std::vector<double> temperatures_of_cells(const TemperatureField& temperatures) const;
  void start(const MoistureConditions& conditions, const std::vector<BlockMaterial>& block_materials,
             const std::vector<double>& fraction, double temperature);

  double gauge(double pressure) const { return std::max(0.0, pressure - water::kAtmosphere); }
  double opening(const Motion& motion, int face, std::vector<double>* of_contacts = nullptr) const;
  void list_faces();
  void see_state();

  const Model& model_;
  PoreCoupling coupling_;
  std::vector<bool> is_matrix_;   ///< by material: true where the pores are stated of the concrete
  std::vector<bool> takes_part_;  ///< by block: true where it has pores and is there
  std::vector<double> zone_volumes_;
  std::vector<int> face_contacts_;  ///< first contact of each face of the model, and of one more
  std::vector<int> face_of_;        ///< face of the model of each face of the mesh
  std::optional<Moisture> moisture_;
  std::vector<double> face_pressure_;  ///< of each face of the mesh, over that of the atmosphere, Pa
  std::vector<double> seen_opening_;   ///< of each face of the mesh when the water last saw the cracks, m
  double interval_ = std::numeric_limits<double>::infinity();  ///< to the next exchange, s
};

}  // namespace pyroclast
