#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "pyroclast/deck/deck.hpp"
#include "pyroclast/experiment/heat_case.hpp"
#include "pyroclast/experiment/heat_run.hpp"
#include "pyroclast/experiment/probe.hpp"
#include "pyroclast/experiment/stage.hpp"
#include "pyroclast/material/concrete.hpp"
#include "pyroclast/material/curve_reader.hpp"
#include "pyroclast/material/thermal_strain.hpp"
#include "pyroclast/mechanics/mechanics.hpp"
#include "pyroclast/specimen/specimen.hpp"

namespace pyroclast {

/// All that a deck says, in SI. Heat conduction alone has no platens, contacts, mechanics and stages.
struct Case {
  std::string title;
  specimen::SpecimenParameters specimen;
  double thickness = 0.0;                  ///< out of plane, m
  std::optional<double> platen_thickness;  ///< m
  std::array<SolidMaterial, 3> solids;
  ExpansionReading expansion_reading = ExpansionReading::secant;
  ContactParameters contacts;
  std::vector<ReadCurve> curves;  ///< properties over the temperature, as the deck gave them
  Interval temperatures;          ///< that the run may come to, °C; its curves are checked for these
  MechanicsParameters<2> mechanics;
  HeatCase heat;  ///< uniform at the reference temperature where the deck has no [heat]
  std::vector<Stage> stages;
  SamplingParameters sampling;
  std::optional<HeatRun> conduct;  ///< heat conduction alone
  std::vector<ProbeCase> probes;   ///< of heat conduction alone
};

/// Reads a deck. A relative file name in it is taken from `folder`.
/// Throws DeckError with every error of the deck.
Case read_case(const Deck& deck, const std::filesystem::path& folder);

/// Block size that the deck foresees, m; where the tessellation is read from a file, the one at which t_b
/// holds.
double expected_block_size(const Case& c);

/// Lower estimate of Young's modulus of the model in the vertical direction, Pa: the same vertical stress
/// everywhere, compliances of zones and contacts added up (Reuss). Platens left out.
double estimate_modulus(const ConcreteModel& body, const ConcreteMaterials& materials);

}  // namespace pyroclast
