#pragma once

#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "pyroclast/moisture/moisture.hpp"
#include "pyroclast/simulation/acting/boundary_faces.hpp"

namespace pyroclast {

/// Pores of a phase as a deck states them.
struct StatedPores {
  PoreMaterial material;
  /// True where porosity, permeability and cement are those of the concrete, whose matrix the phase is.
  bool of_concrete = false;
};

/// What a deck states of the water at the start.
enum class FirstWater : std::uint8_t {
  saturation,  ///< share of all pores that liquid fills
  humidity,    ///< vapour pressure over that of saturation
  content      ///< water over the dry mass of the concrete, in equilibrium everywhere
};

/// Choice of the parts of a body on which the pressure of pore water acts.
enum class PressureActs : std::uint8_t { no, zones, all };

/// Action of pore water on the body, and of cracks on the water.
struct PoreCoupling {
  PressureActs acts = PressureActs::all;
  /// Biot's coefficient b of zones and of intact contacts; a contact with damage D bears b + (1 - b) D of the
  /// pressure.
  double biot = 0.5;
  double crack_width = 5e-6;  ///< mean opening of a face from which it is a crack that drains, m
  /// Further opening within an exchange that halves the pressure of a contact, m; infinite where none lowers
  /// it.
  double reserve = std::numeric_limits<double>::infinity();
  double exchange_pressure = 2e5;  ///< change of a pore pressure between two exchanges, about, Pa
};

/// Boundary condition of a deck on water; none: sealed.
struct MoistureBoundaryCondition {
  BoundaryFaces faces;
  std::optional<MoistureCondition> condition;
  std::string place;  ///< file, line and key, for messages
};

/// Statements of a deck on the water in the pores. Times count from the start of heating.
struct MoistureConditions {
  std::vector<StatedPores> pores;  ///< by phase of the specimen
  FirstWater first = FirstWater::saturation;
  double first_amount = 0.0;  ///< its share
  MoistureParameters parameters;
  std::vector<MoistureBoundaryCondition> boundaries;
  PoreCoupling coupling = {};
};

/// Returns the pores of a matrix, where the concrete's are stated, with a share f of inclusions that neither
/// store nor pass water: porosity and cement over 1 - f, and the permeability of Maxwell's estimate, times
/// (1 + f) / (1 - f) in the plane and (2 + f) / (2 (1 - f)) in space.
PoreMaterial pores_of_matrix(PoreMaterial concrete, double inclusions, int dimension);

}  // namespace pyroclast
