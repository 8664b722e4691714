#include "pyroclast/setup/read_heat.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <string_view>
#include <utility>

#include <fmt/format.h>

#include "pyroclast/material/builtin_curves.hpp"
#include "pyroclast/setup/read_faces.hpp"

namespace pyroclast {

namespace {

// Defaults of numerical parameters. A specimen of 150 x 300 mm is heated at one side at 5 K/min to 800 degC:
// changes of 0.5, 2 and 5 K per step give the same least, mean and greatest temperature to 0.001 K.
constexpr double kSafety = 0.9;
constexpr double kLargestChange = 2.0;  // K
constexpr double kLargestStep = 60.0;   // s

// Defaults for cracks, see docs/understand/heat.md.
constexpr double kBridges = 5e4;        // W/(m2 K)
constexpr double kJumpDistance = 2e-7;  // m
constexpr double kEmissivity = 0.9;
constexpr const char* kAir = "air_conductivity";

/// Range of temperatures. A record of the rise in K, read as a temperature, begins near -273 degC.
constexpr Range kTemperature = Range::at_least(absolute_zero).usually(-60.0, 1400.0);

/// Reads a factor of the heat that flows through a boundary. Records an error for a factor that is 0 all the
/// time, for it lets no heat through.
Curve read_factor(const Section& s, std::string_view key, const Unit& unit, const Range& range,
                  Meaning meaning, CurveReader& curves) {
  Curve factor = curves.read(s, key, unit, range, meaning);
  const auto [begin, end] = curves.needed();
  if (s.ok() && factor.minimum(begin, end) == 0.0 && factor.maximum(begin, end) == 0.0)
    s.error(key, "lets no heat through, so that the boundary has no effect; kind = \"adiabatic\" says so");
  return factor;
}

HeatCondition read_condition(const Section& s, CurveReader& curves) {
  enum class Kind { temperature, flux, convection, radiation, adiabatic };
  s.know({"temperature", "flux", "coefficient", "emissivity", "gas_temperature"});
  const auto gas = [&] {
    return curves.read(s, "gas_temperature", unit::temperature, kTemperature, "gas temperature T_gas");
  };
  switch (s.choice<Kind>(
      "kind",
      {{"temperature", Kind::temperature, "the faces have a given temperature"},
       {"flux", Kind::flux, "a given heat flows in"},
       {"convection", Kind::convection, "heat h (T_gas − T) flows in, Eq. (2)"},
       {"radiation", Kind::radiation, "heat ε σ (T_gas⁴ − T⁴) flows in, of absolute temperatures"},
       {"adiabatic", Kind::adiabatic, "no heat flows; holds for all faces of which nothing is said"}},
      "condition on the faces")) {
    case Kind::temperature:
      return PrescribedTemperature{
          curves.read(s, "temperature", unit::temperature, kTemperature, "of the faces")};
    case Kind::flux:
      return HeatFlux{
          read_factor(s, "flux", unit::heat_flux, Range::any(), "positive into the specimen", curves)};
    case Kind::convection:
      return Convection{read_factor(s, "coefficient", unit::heat_transfer, Range::non_negative(),
                                    "coefficient h of heat transfer", curves),
                        gas()};
    case Kind::radiation:
      return Radiation{read_factor(s, "emissivity", unit::dimensionless, Range::fraction(),
                                   "resultant emissivity ε", curves),
                       gas()};
    case Kind::adiabatic:
      break;
  }
  return Adiabatic{};
}

std::vector<HeatBoundaryCondition> read_boundaries(const Section& heat, CurveReader& curves,
                                                   const DeckSpace& space) {
  std::vector<HeatBoundaryCondition> boundaries;
  for (const Section& s :
       heat.sections("boundaries", "heat on faces of the specimen; see [Heat](../understand/heat.md)")) {
    HeatBoundaryCondition boundary{read_faces(s, space), read_condition(s, curves),
                                   fmt::format("{}: {}", s.where("faces"), s.path())};
    if (!s.ok()) continue;  // a value that stands in for an error contradicts nothing
    for (const auto& other : boundaries)
      if (overlap(other.faces, boundary.faces) && contradict(other.condition, boundary.condition))
        s.error("faces", fmt::format("\"{}\" acts on faces that have \"{}\" already ({})",
                                     kind_name(boundary.condition), kind_name(other.condition), other.place));
    boundaries.push_back(std::move(boundary));
  }
  return boundaries;
}

/// Reads the temperatures within which the run stays. Returns none after an error, or where none are stated
/// and none are needed.
std::optional<Interval> read_range(const Section& s, const HeatConditions& heat) {
  if (!s.has("temperature_range")) {
    const bool needed = std::any_of(heat.boundaries.begin(), heat.boundaries.end(),
                                    [](const HeatBoundaryCondition& boundary) {
                                      return std::holds_alternative<HeatFlux>(boundary.condition);
                                    });
    if (needed)
      s.error("temperature_range",
              "missing; a given flux does not say how hot the specimen gets, so the temperatures that the "
              "run stays within are needed, e.g. [\"20 degC\", \"900 degC\"]");
    return std::nullopt;
  }
  const auto ends = s.quantities(
      "temperature_range", unit::temperature, kTemperature,
      "two temperatures between which the run stays; needed with a flux; see [Heat](../understand/heat.md)");
  if (ends.empty()) return std::nullopt;
  if (ends.size() != 2 || !(ends[0] < ends[1])) {
    s.error("temperature_range", "two temperatures are needed, the lower one first");
    return std::nullopt;
  }
  if (Interval{ends[0], ends[1]}.holds(heat.initial, absolute_zero))
    return Interval{std::min(ends[0], heat.initial), std::max(ends[1], heat.initial)};
  s.error("temperature_range", fmt::format("must hold the initial temperature of {} degC", heat.initial));
  return std::nullopt;
}

void require_heat_properties(const Section& root) {
  const auto materials = root.optional_section("materials");
  for (const auto name : {"aggregate", "mortar"}) {
    const auto material = materials ? materials->optional_section(name) : std::nullopt;
    if (!material) continue;  // the reader of the materials records this error
    for (const auto key : {"conductivity", "specific_heat"})
      if (!material->has(key)) material->error(key, "missing; [heat] with field = \"conduction\" needs it");
  }
}

void read_conduction(const Section& s, CurveReader& time_curves, const DeckSpace& space,
                     HeatConditions& heat) {
  heat.scheme = s.choice<HeatScheme>(
      "scheme",
      {{"rkl2", HeatScheme::super_time_stepping, "Runge-Kutta-Legendre super-time-stepping, second order"},
       {"euler", HeatScheme::euler, "forward Euler, first order"}},
      HeatScheme::super_time_stepping, "how time is advanced; see [Heat](../understand/heat.md)");
  heat.safety = s.number("safety", {.lower = 0.0, .upper = 1.0, .lower_inclusive = false}, kSafety,
                         "fraction of the stable step that is taken");
  heat.largest_change = s.quantity("largest_change", unit::temperature_difference, Range::positive(),
                                   kLargestChange, "of any temperature in one step of the solver");
  heat.largest_step =
      s.quantity("largest_step", unit::time, Range::positive(), kLargestStep, "of the solver");
  heat.boundaries = read_boundaries(s, time_curves, space);
  heat.temperature_range = read_range(s, heat);
  // This range stands in, so that the deck's reader can go on and find every error.
  if (!s.ok()) heat.temperature_range = Interval{heat.initial, heat.initial + 1.0};
}

GapHeat read_gap_heat(const Section& s, CurveReader& curves) {
  GapHeat law{
      .bridges = s.quantity("bridges", unit::heat_transfer, Range::non_negative().usually(1e3, 1e6), kBridges,
                            "conductance of the solid bridges of an intact contact; damage in tension "
                            "leaves 1 − D_t of it"),
      .gas_conductivity = builtin_curves().at(kAir).curve,
      .jump_distance =
          s.quantity("jump_distance", unit::length, Range::positive().usually(1e-8, 1e-5), kJumpDistance,
                     "length by which the gas seems wider than the opening, for the jumps of "
                     "temperature at the faces"),
      .emissivity = s.quantity("emissivity", unit::dimensionless, Range::fraction(), kEmissivity,
                               "ε of each face; 1 / (2/ε − 1) acts between the two"),
      .split_below = 0.0};
  if (s.has("split_below"))
    law.split_below = s.quantity(
        "split_below", unit::heat_transfer, Range::positive().usually(1e3, 1e5),
        "conductance below which a contact parts the temperatures of its sides; above twice that it "
        "joins them; without this key 20 λ / ℓ of the specimen; see [Cracks](../understand/heat.md#cracks)");
  const Interval needed = curves.needed();
  if (s.has("gas_conductivity"))
    law.gas_conductivity =
        curves.read(s, "gas_conductivity", unit::conductivity, Range::positive(),
                    "of the gas in cracks; without this key air, the builtin air_conductivity");
  else if (!law.gas_conductivity.holds(needed))
    s.error(
        "gas_conductivity",
        fmt::format(
            "is needed: without this key the gas is air, whose curve reaches from {:.6g} to {:.6g} degC, but "
            "the run may come to {:.6g} to {:.6g} degC",
            law.gas_conductivity.range().lower, law.gas_conductivity.range().upper, needed.lower,
            needed.upper));
  return law;
}

}  // namespace

std::optional<CrackHeat> read_crack_heat(const Section& root, CurveReader& curves) {
  const auto heat = root.optional_section("heat");
  const auto s = heat ? heat->optional_section("cracks",
                                               "lets cracks hinder heat; without this table heat crosses "
                                               "cracks freely; see [Cracks](../understand/heat.md#cracks)")
                      : std::nullopt;
  if (!s) return std::nullopt;
  CrackHeat cracks{
      .law = read_gap_heat(*s, curves), .splits_by_block_size = !s->has("split_below"), .gaps = {}};
  for (const Section& gap :
       s->optional_sections("gaps", "contacts that stand apart from the start, for heat; any number"))
    cracks.gaps.push_back({gap.text("contacts",
                                    "a set of contacts: the name of a notch without width, or of a set; see "
                                    "[Sets](../do/bodies.md#sets)"),
                           gap.quantity("width", unit::length, Range::positive().usually(1e-6, 0.02),
                                        "between the faces at the start; openings by the motion add to it"),
                           fmt::format("{}: {}", gap.where("contacts"), gap.path())});
  return cracks;
}

std::optional<HeatConditions> read_heat(const Section& root, CurveReader& time_curves,
                                        const DeckSpace& space) {
  const auto s = root.optional_section(
      "heat", "how the specimen is heated; without this table the specimen stays at 20 °C");
  if (!s) return std::nullopt;
  s->know(
      {"scheme", "safety", "largest_change", "largest_step", "temperature_range", "boundaries", "cracks"});
  HeatConditions heat;
  heat.uniform = s->choice<bool>(
      "field",
      {{"conduction", false, "temperatures follow from the boundaries"},
       {"uniform", true, "the whole specimen has one temperature, which stages of kind heat change"}},
      "temperatures in the specimen");
  heat.initial = s->quantity("initial", unit::temperature, kTemperature, kReferenceTemperature,
                             "temperature of the specimen at the start of heating");
  if (heat.uniform) return heat;
  read_conduction(*s, time_curves, space, heat);
  require_heat_properties(root);
  return heat;
}

}  // namespace pyroclast
