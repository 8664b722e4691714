#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "pyroclast/material/concrete.hpp"
#include "pyroclast/model/concrete_model.hpp"
#include "pyroclast/simulation/contact_gaps.hpp"
#include "pyroclast/thermal/conduction.hpp"

namespace pyroclast {

/// Faces of the specimen's outline, those under bearings included.
struct HeatedFaces {
  static constexpr const char *kOutline = "outline", *kBox = "box";

  std::string part = kOutline;   ///< all of it, those in a box, or else the name of a side or patch
  Vec<2> box_low{}, box_high{};  ///< faces whose centres lie in it, bounds included, m
};

/// Holds the temperature of faces.
struct PrescribedTemperature {
  Curve temperature;  ///< °C, of the time in s
};

/// Says that no heat crosses the faces, as is so where nothing is said.
struct Adiabatic {};

using HeatCondition = std::variant<PrescribedTemperature, HeatFlux, Convection, Radiation, Adiabatic>;

/// One boundary condition of a deck.
struct HeatBoundaryCondition {
  HeatedFaces faces;
  HeatCondition condition;
  std::string place;  ///< file, line and key, for messages
};

/// How cracks hinder heat.
struct CrackHeat {
  GapHeat law;
  bool splits_by_block_size = false;  ///< law.split_below is still to come, see with_specimen
  std::vector<StatedGap> gaps;        ///< that are there from the start
};

/// What a deck says of heat. Times run from the start of heating.
struct HeatConditions {
  bool uniform = true;                     ///< the whole specimen has one temperature (paper, section 4)
  double initial = kReferenceTemperature;  ///< °C
  // conduction only
  HeatScheme scheme = HeatScheme::super_time_stepping;
  double safety = 0.0;                        ///< see HeatParameters
  double largest_change = 0.0;                ///< of any temperature in one step of the solver, K
  double largest_step = 0.0;                  ///< s
  std::optional<Interval> temperature_range;  ///< that the user states, °C
  std::vector<HeatBoundaryCondition> boundaries;
  std::optional<CrackHeat> cracks;  ///< empty: they do not hinder heat
};

/// Fills in what follows from the specimen: where cracks split by the block size l, they do so below 20
/// lambda / l, with the mean conductivity of its area at 20 °C. What that leaves out is less than 5 % of a
/// block's resistance.
HeatConditions with_specimen(HeatConditions heat, const std::vector<SolidMaterial>& solids,
                             const specimen::Specimen& specimen);

/// Whether two conditions on one face contradict each other: a prescribed temperature and an adiabatic face
/// allow nothing beside them, and no kind acts twice.
bool contradict(const HeatCondition& a, const HeatCondition& b);

/// What a deck calls the condition.
const char* kind_name(const HeatCondition& condition);

/// Bounds of the temperatures that conduction may reach within `duration` s from the start: those stated,
/// else the extremes of the initial, the prescribed and the gas temperatures. Throws Error when there is a
/// given flux, which has no such bound, and no range is stated.
Interval temperature_range(const HeatConditions& heat, double duration);

/// Whether a boundary makes any temperature another than that at the start within `duration` s.
bool heats_or_cools(const HeatConditions& heat, double duration);

/// Time from which no boundary value changes any more up to `duration`, s; `duration` when there is none.
double constant_from(const HeatConditions& heat, double duration);

/// The heat solver of a specimen; the platens conduct no heat. `model` must outlive it.
/// \param range  of temperatures that it stays within until it is widened, °C, see temperature_range; the
///               materials' curves must cover it
/// \param team   the threads of the run; one alone where there is none
///
/// Throws Error when a material has no conductivity or specific heat, a boundary condition meets no face, or
/// two contradict each other on one.
std::unique_ptr<Conduction<2>> make_conduction(const Model<2>& model,
                                               const std::vector<SolidMaterial>& solids,
                                               const HeatConditions& heat, const Interval& range,
                                               std::shared_ptr<Team> team = nullptr);

}  // namespace pyroclast
