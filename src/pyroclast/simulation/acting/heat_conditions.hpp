#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "pyroclast/material/concrete.hpp"
#include "pyroclast/simulation/acting/boundary_faces.hpp"
#include "pyroclast/simulation/acting/moisture_conditions.hpp"
#include "pyroclast/simulation/contact_gaps.hpp"
#include "pyroclast/thermal/heat_solver.hpp"
#include "pyroclast/thermal/time_stages.hpp"

namespace pyroclast {

/// Condition that holds the temperature of faces.
struct PrescribedTemperature {
  Curve temperature;  ///< temperature, °C, over the time in s
};

/// Condition that lets no heat cross the faces, as where nothing is stated.
struct Adiabatic {};

using HeatCondition = std::variant<PrescribedTemperature, HeatFlux, Convection, Radiation, Adiabatic>;

/// One boundary condition of a deck.
struct HeatBoundaryCondition {
  BoundaryFaces faces;
  HeatCondition condition;
  std::string place;  ///< file, line and key, for messages
};

/// Hindrance of heat by cracks.
struct CrackHeat {
  GapHeat law;
  /// True while law.split_below is still to be computed, see with_specimen.
  bool splits_by_block_size = false;
  std::vector<StatedGap> gaps;  ///< gaps that are there from the start
};

/// Statements of a deck on heat. Times count from the start of heating.
struct HeatConditions {
  /// True where the whole specimen has one temperature (paper, section 4).
  bool uniform = true;
  double initial = kReferenceTemperature;  ///< initial temperature, °C
  // The members from here on are for conduction only.
  HeatScheme scheme = HeatScheme::super_time_stepping;
  double safety = 0.0;  ///< fraction of the stable step, see HeatParameters
  /// Largest change of any temperature in one step of the solver, K.
  double largest_change = 0.0;
  double largest_step = 0.0;                  ///< s
  std::optional<Interval> temperature_range;  ///< range that the user states, °C
  std::vector<HeatBoundaryCondition> boundaries;
  std::optional<CrackHeat> cracks;             ///< cracks that hinder heat; empty where none do
  std::optional<MoistureConditions> moisture;  ///< water in the pores, which heat drives; empty: none
};

/// Fills in values that depend on the specimen. Where cracks split temperatures by the block size l, they do
/// so below 20 lambda / l, with the mean conductivity of the specimen's area at 20 °C. The resistances left
/// out are less than 5 % of a block's.
HeatConditions with_specimen(HeatConditions heat, const std::vector<BlockMaterial>& block_materials,
                             const std::vector<double>& fraction, double mean_size);

/// Tells whether two conditions on one face contradict each other: a prescribed temperature and an adiabatic
/// face allow nothing beside them, and no kind may act twice.
bool contradict(const HeatCondition& a, const HeatCondition& b);

/// Returns the name of the condition in decks.
const char* kind_name(const HeatCondition& condition);

/// Returns bounds of the temperatures that conduction may reach within `duration` s from the start: the
/// stated ones, else the extremes of the initial, the prescribed and the gas temperatures. Throws Error when
/// a given flux, which has no such bound, acts and no range is stated.
Interval temperature_range(const HeatConditions& heat, double duration);

/// Tells whether a boundary takes any temperature away from its value at the start within `duration` s.
bool heats_or_cools(const HeatConditions& heat, double duration);

/// Returns the time from which no boundary value changes any more up to `duration`, s; `duration` when there
/// is no such time.
double constant_from(const HeatConditions& heat, double duration);

/// Tells for each boundary whether it is a fire: it gives heat, or warms at least half as far above the
/// initial temperature as the hottest one. A boundary that keeps or takes heat is none.
std::vector<bool> are_fires(const HeatConditions& heat);

/// Side of the box around a body.
struct BoxSide {
  int axis = 0;
  bool is_upper = false;  ///< true for the side with the larger coordinate
};

/// Returns the side of the specimen on which boundaries act most within `duration` s: that with the largest
/// difference to the initial temperature, where several have it the one with the largest faces. A flux into
/// the specimen counts above all temperatures. Sides are compared in the order left, right, bottom, top,
/// front, back. A collective.
BoxSide most_heated_side(const Model& model, const std::vector<BlockMaterial>& block_materials,
                         const HeatConditions& heat, double duration);

/// Makes the heat solver of a specimen; the platens conduct no heat. `model` must outlive the solver.
/// \param range  range of temperatures for the solver until it is widened, °C, see temperature_range; the
///               materials' curves must cover it
/// \param team   threads of the run; without a team the calling thread works alone
/// \param loses_blocks  true where blocks may leave the specimen
///
/// Throws Error when a material has no conductivity or specific heat, a boundary condition meets no face, or
/// two contradict each other on one face.
std::unique_ptr<HeatSolver> make_conduction(const Model& model,
                                            const std::vector<BlockMaterial>& block_materials,
                                            const HeatConditions& heat, const Interval& range,
                                            std::shared_ptr<Team> team = nullptr, bool loses_blocks = false);

}  // namespace pyroclast
