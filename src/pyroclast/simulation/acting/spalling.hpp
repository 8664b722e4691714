#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "pyroclast/base/state_visitor.hpp"
#include "pyroclast/material/concrete.hpp"
#include "pyroclast/mechanics/motion.hpp"
#include "pyroclast/model/model.hpp"
#include "pyroclast/simulation/acting/heat_conditions.hpp"
#include "pyroclast/thermal/temperature_field.hpp"

namespace pyroclast {

class MoistureField;

/// Rule by which pieces leave a body, and what is told of them.
struct SpallingRule {
  double bond = 0.05;           ///< share of its strength up to which a contact holds nothing any more
  double rim_opening = 0.2e-3;  ///< m, see Spalling::find
  std::string bars_place;       ///< in the deck, for messages
  std::vector<double> bars;     ///< depths of bars below the faces that fire acts on, ascending, m
};

/// What tells that a loose piece moves away.
enum class SpallSign : std::uint8_t {
  opening,  ///< its rim stands open
  flight,   ///< it has gone as far along its rim
};

/// Returns the name of a bar at a depth, m: "25mm".
std::string name_of_bar(double depth);

/// Piece that left the body.
struct Spall {
  std::vector<int> blocks;     ///< ascending
  double heating_time = 0.0;   ///< s; whoever lets the piece go sets it
  double area = 0.0;           ///< area of its back, seen across the faces that fire acts on, m2
  double volume = 0.0;         ///< m3
  double mass = 0.0;           ///< at 20 degC, without its water, kg
  double mean_depth = 0.0;     ///< of its back below the faces of the start that fire acts on, m
  double largest_depth = 0.0;  ///< of the piece, m
  double pressure = 0.0;       ///< largest pore pressure of the blocks behind it, Pa
  double temperature = 0.0;    ///< mean at its back, degC
  SpallSign sign = SpallSign::opening;
};

/// Pieces that leave a body, and those that have left.
class Spalling {
 public:
  /// \param model  kept by reference
  /// Throws Error where a condition of heat meets no face.
  Spalling(const Model& model, const std::vector<BlockMaterial>& block_materials, const HeatConditions& heat,
           const SpallingRule& rule);

  const SpallingRule& rule() const { return rule_; }

  /// Finds the pieces that move away. A contact holds its blocks together as long as a point of it has more
  /// of its strength than `bond`, or is pressed and has not slid off. What such contacts join to a bearing,
  /// or to a gridpoint that is held or driven, stays, and so does the largest part. Any other part is loose.
  /// A loose part at the outside leaves once the mean opening of its rim, or the mean way that its rim has
  /// gone, is more than `rim_opening` or than 5 % of the rim's edges. One that others enclose leaves once it
  /// has gone an edge: contacts of the start let it pass through them.
  std::vector<Spall> find(const Motion& motion, const TemperatureField& field,
                          const MoistureField* moisture) const;
  /// Tells whether any does: cheaper than to find them.
  bool any_fly(const Motion& motion) const { return !leaving(motion).empty(); }

  /// Notes a piece that has left.
  void note(Spall spall);
  const std::vector<Spall>& spalls() const { return spalls_; }
  bool is_gone(int block) const { return is_gone_[block]; }
  std::int64_t blocks_gone() const;
  double mass_gone() const;      ///< kg
  double mean_depth() const;     ///< volume that left over the area of the faces that fire acts on, m
  double largest_depth() const;  ///< m
  double lost_section() const;   ///< volume that left over that of the specimen
  /// Returns the mean temperature of what is left at the depth of a bar, degC; NaN where nothing is.
  double temperature_at(std::size_t bar, const TemperatureField& field) const;
  /// Returns when a piece first reached to the depth of a bar, s of heating; empty where none did.
  std::optional<double> bare_from(std::size_t bar) const;
  /// Returns the depth of a place below the faces of the start that fire acts on, m.
  double depth(const Vec<3>& place) const;

  /// Shows the pieces that have left to a visitor.
  void visit_state(StateVisitor& visitor);

 private:
  /// Face of the start that fire acts on.
  struct HotFace {
    Vec<3> centre, normal;
    double area;
  };
  struct Leaving {
    std::vector<int> blocks;
    SpallSign sign;
  };
  bool is_held(const Motion& motion, int block) const;
  bool is_mirrored(int gridpoint, int component) const;
  const HotFace& nearest(const Vec<3>& place) const;
  std::vector<Leaving> leaving(const Motion& motion) const;
  Spall describe(Leaving piece, const TemperatureField& field, const MoistureField* moisture) const;

  const Model& model_;
  SpallingRule rule_;
  std::vector<HotFace> hot_faces_;
  std::vector<double> block_volume_;   ///< m3; 0 of bearings
  std::vector<double> block_density_;  ///< kg/m3
  std::vector<int> block_of_;          ///< by gridpoint
  double volume_ = 0.0, hot_area_ = 0.0;
  std::vector<std::vector<int>> at_bar_;  ///< gridpoints at the depth of each bar
  std::vector<bool> is_outside_;          ///< by block: true where a face of it is free
  std::vector<bool> is_gone_;             ///< by block
  std::vector<Spall> spalls_;
};

}  // namespace pyroclast
