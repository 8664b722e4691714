#pragma once

#include <optional>
#include <vector>

#include "pyroclast/base/state_visitor.hpp"
#include "pyroclast/material/concrete.hpp"
#include "pyroclast/model/model.hpp"
#include "pyroclast/simulation/acting/moisture_conditions.hpp"
#include "pyroclast/simulation/specimen_body.hpp"
#include "pyroclast/thermal/temperature_field.hpp"

namespace pyroclast {

/// Throws Error where water would flow in a body that several ranks hold.
void require_one_process(int ranks);

/// Water in the pores of a specimen during a run. It follows the temperatures; nothing follows it yet.
class MoistureField {
 public:
  /// `model` must outlive the field. Throws Error where a boundary condition meets no face, several act on
  /// one, or a phase cannot hold the pores that are stated of the concrete.
  MoistureField(const Model& model, const std::vector<BlockMaterial>& block_materials,
                const SpecimenNumbers& numbers, const MoistureConditions& conditions, double temperature);

  /// Lets water flow until the time of these temperatures, which change evenly until then. Throws Error, see
  /// Moisture::advance.
  void follow(const TemperatureField& temperatures);

  const Moisture& water() const { return *moisture_; }
  /// Returns the pressure of the vapour in a block less that of the atmosphere, at least 0, Pa; 0 in
  /// bearings.
  double pore_pressure(int block) const;
  /// Returns the share of the pores of a block that liquid fills; 0 in bearings.
  double saturation(int block) const { return of_block(saturation_, block); }
  /// Returns the water in a block, kg/m3; 0 in bearings.
  double content(int block) const { return of_block(water().state().content, block); }

  double largest_pore_pressure() const;   ///< Returns that of all blocks, Pa.
  double largest_pressure_ratio() const;  ///< Returns the largest vapour pressure over that of saturation.

  void visit_state(StateVisitor& visitor);

 private:
  double of_block(const std::vector<double>& values, int block) const {
    const int cell = moisture_->mesh().cell_of_block[block];
    return cell < 0 ? 0.0 : values[cell];
  }
  std::vector<double> temperatures_of_cells(const TemperatureField& temperatures) const;
  void start(const MoistureConditions& conditions, const std::vector<BlockMaterial>& block_materials,
             const std::vector<double>& fraction, double temperature);

  const Model& model_;
  std::vector<double> zone_volumes_;
  std::optional<Moisture> moisture_;
  std::vector<double> saturation_;  ///< of each cell
};

}  // namespace pyroclast
