#include "pyroclast/setup/read_moisture.hpp"

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "pyroclast/base/log.hpp"
#include "pyroclast/material/curve_catalogue.hpp"
#include "pyroclast/setup/read_faces.hpp"

namespace pyroclast {

namespace {

// Air above a specimen, as Tenchev, Li and Purkiss (2001) have it: 0.018 m/s, and 0.0138 kg/m3 of vapour,
// which is a humidity of 0.8 at 20 degC.
constexpr double kAirCoefficient = 0.018;  // m/s
constexpr double kAirHumidity = 0.8;

// A pressure that falls is a spring of its own beside the contact: with less it would need a smaller step.
constexpr double kLeastReserve = 5e-6;  // m

// Growth of the permeability with the highest temperature so far (Gawin, Majorana and Schrefler 1999, their
// form).
constexpr double kDecades = 0.008;  // 1/K
constexpr double kLargestGrowth = 1e4;
constexpr double kHottest = 1200.0;  // end of that curve where the run stays colder, degC

/// Peak of a specific heat that stands for evaporation, over its value before.
constexpr double kLeastPeak = 1.2;
constexpr double kBoils = 100.0, kBeforeBoiling = 90.0, kDry = 200.0;  // degC

/// Classes of pores, whose numbers stand in for those that a deck does not state.
enum class PoreClass : std::uint8_t { ordinary, high_strength, rock };

PoreMaterial pores_of(PoreClass of) {
  PoreMaterial m;
  m.entry_pressure = 18.6e6;  // Baroghel-Bouny, Mainguy, Lassabatere and Coussy 1999, ordinary concrete
  m.exponent = 2.27;
  switch (of) {
    case PoreClass::ordinary:
      m.porosity = 0.14;
      m.permeability = 1e-18;
      m.cement = 350.0;
      break;
    case PoreClass::high_strength:
      m.porosity = 0.12;
      m.permeability = 5e-20;
      m.cement = 415.0;
      break;
    case PoreClass::rock:
      m.porosity = 0.01;
      m.permeability = 1e-20;
      break;
  }
  return m;
}

Curve growing_permeability(const Interval& range) {
  return Curve::function(
      "10^(0.008 (T - 20 degC)), at most 1e4",
      [](double t) { return std::min(kLargestGrowth, power(10.0, kDecades * (t - kReferenceTemperature))); },
      {std::min(range.lower, kReferenceTemperature), std::max(range.upper, kHottest)}, temperature_axis(),
      {});
}

StatedPores read_pores(const Section& s, bool is_matrix, CurveReader& curves) {
  const auto of = s.choice<PoreClass>(
      "class",
      {{"ordinary", PoreClass::ordinary, "concrete with a water-cement ratio of 0.5 to 0.6"},
       {"high strength", PoreClass::high_strength, "concrete of 60 MPa and more"},
       {"rock", PoreClass::rock, "dense stones: they hold little water and hardly let it pass"}},
      "pores that stand in for the keys below that are not stated");
  StatedPores p;
  PoreMaterial& m = p.material = pores_of(of);
  p.of_concrete = s.choice<bool>(
      "of",
      {{"concrete", true,
        "porosity, permeability and cement are those of the concrete, whose matrix the phase is: it gets "
        "more, by the share of the other phases, which hold and pass none"},
       {"phase", false, "they are those of the phase"}},
      is_matrix && of != PoreClass::rock,
      "what they belong to; the matrix alone can have those of the concrete");
  if (s.ok() && p.of_concrete && !is_matrix) s.error("of", "\"concrete\" is for the matrix alone");
  if (s.has("porosity"))
    m.porosity = s.number("porosity", Range::inside(0.0, 1.0).usually(0.001, 0.3), "share of the volume");
  if (s.has("permeability"))
    m.permeability = s.quantity("permeability", unit::area, Range::positive().usually(1e-22, 1e-14),
                                "intrinsic permeability at 20 °C");
  m.permeability_ratio = of == PoreClass::rock ? Curve::constant(1.0) : growing_permeability(curves.needed());
  if (s.has("permeability_ratio"))
    m.permeability_ratio = curves.read(
        s, "permeability_ratio", unit::dimensionless, Range::positive(),
        "permeability over that at 20 °C: a curve of the highest temperature so far; without this "
        "key 10^(0.008 (T − 20 °C)), at most 1e4, and 1 in rock");
  if (s.has("entry_pressure"))
    m.entry_pressure = s.quantity("entry_pressure", unit::stress, Range::positive().usually(1e5, 1e8),
                                  "a of van Genuchten's retention at 20 °C");
  if (s.has("exponent"))
    m.exponent = s.number("exponent", Range{.lower = 1.0, .lower_inclusive = false}.usually(1.2, 4.0),
                          "n of van Genuchten's retention");
  if (s.has("cement"))
    m.cement = s.quantity("cement", unit::density, Range::non_negative().usually(0.0, 800.0),
                          "cement by volume, whose hydrates give back water when they get hot");
  return p;
}

std::vector<StatedPores> read_phases(const Section& root, const specimen::SpecimenParameters& specimen,
                                     CurveReader& curves) {
  std::vector<StatedPores> pores;
  const Section materials = root.section("materials");
  for (const std::string& phase : specimen::phases(specimen)) {
    const Section material = materials.section(phase);
    if (material.has("moisture"))
      pores.push_back(read_pores(material.section("moisture", "pores of the phase, with [moisture]"),
                                 phase == specimen.matrix, curves));
    else
      material.error("moisture", fmt::format("missing; [moisture] needs the pores of each phase, such as "
                                             "moisture = {{ class = \"{}\" }}",
                                             phase == specimen.matrix ? "ordinary" : "rock"));
  }
  return pores;
}

/// Refuses pores of phases where no water is asked for.
void refuse_pores(const Section& root, const specimen::SpecimenParameters& specimen) {
  const auto materials = root.optional_section("materials");
  if (!materials) return;
  for (const std::string& phase : specimen::phases(specimen))
    if (const auto material = materials->optional_section(phase); material && material->has("moisture"))
      material->error("moisture", "has no meaning without the table [moisture]");
}

void read_first(const Section& s, MoistureConditions& conditions) {
  const auto amount = [&](const char* key, FirstWater first, Meaning meaning) {
    conditions.first = first;
    conditions.first_amount =
        s.number(key, Range{.lower = 0.0, .upper = 1.0, .lower_inclusive = false}, meaning);
  };
  if (s.has("saturation"))
    amount("saturation", FirstWater::saturation, "share of the pores of every phase that liquid fills");
  else if (s.has("humidity"))
    amount("humidity", FirstWater::humidity, "vapour pressure over that of saturation, everywhere");
  else
    amount("content", FirstWater::content,
           "water over the dry mass of the concrete, evenly spread by its vapour pressure: \"3 %\"");
  for (const char* key : {"humidity", "content"})
    if (s.has(key) && s.has("saturation"))
      s.error(key, "has no meaning beside \"saturation\": give one of the two");
  if (s.has("content") && s.has("humidity"))
    s.error("content", "has no meaning beside \"humidity\": give one of the two");
}

std::optional<MoistureCondition> read_water_condition(const Section& s, CurveReader& time_curves) {
  enum class Kind { air, pressure, sealed };
  s.know({"coefficient", "humidity", "temperature", "pressure"});
  const Kind kind = s.choice<Kind>(
      "kind",
      {{"air", Kind::air, "vapour goes into air: a flow of coefficient (density at the face − in the air)"},
       {"pressure", Kind::pressure, "the vapour at the faces has a given pressure"},
       {"sealed", Kind::sealed, "no water flows; holds for all faces of which nothing is said"}},
      "condition on the faces");
  if (kind == Kind::sealed) return std::nullopt;
  if (kind == Kind::pressure)
    return GivenPressure{time_curves.read(s, "pressure", unit::stress, Range::positive().usually(100.0, 1e7),
                                          "of the vapour, which the atmosphere does not add to")};
  MoistAir air;
  air.coefficient = s.quantity("coefficient", unit::velocity, Range::positive().usually(1e-4, 1.0),
                               kAirCoefficient, "of the flow of vapour");
  const double humidity = s.number("humidity", Range::between(0.0, 1.0), kAirHumidity,
                                   "vapour pressure of the air over that of saturation");
  const double temperature = s.quantity("temperature", unit::temperature, Range::between(-60.0, 100.0),
                                        kReferenceTemperature, "of the air whose humidity this is");
  air.vapour_density = Curve::constant(humidity * water::saturation_pressure(temperature) /
                                       (water::kGasConstant * (temperature - absolute_zero)));
  return air;
}

std::vector<MoistureBoundaryCondition> read_water_boundaries(const Section& moisture, const DeckSpace& space,
                                                             CurveReader& time_curves) {
  std::vector<MoistureBoundaryCondition> boundaries;
  for (const Section& s : moisture.optional_sections(
           "boundaries", "water at faces of the specimen; without any the specimen is sealed")) {
    MoistureBoundaryCondition boundary{read_faces(s, space), read_water_condition(s, time_curves),
                                       fmt::format("{}: {}", s.where("faces"), s.path())};
    if (!s.ok()) continue;
    for (const auto& other : boundaries)
      if (overlap(other.faces, boundary.faces))
        s.error("faces", fmt::format("acts on faces that have a condition already ({})", other.place));
    boundaries.push_back(std::move(boundary));
  }
  return boundaries;
}

/// Reads how water and the motion of the body act on each other.
void read_coupling(const Section& s, bool moves, MoistureConditions& conditions) {
  PoreCoupling& coupling = conditions.coupling;
  coupling.acts = s.choice<PressureActs>(
      "acts",
      {{"no", PressureActs::no, "nothing bears the pressure of pore water"},
       {"zones", PressureActs::zones, "blocks do: they swell"},
       {"all", PressureActs::all, "blocks do, and contacts, whose sides it parts"}},
      coupling.acts, "what bears the pressure of pore water, where a stage moves the body");
  coupling.biot =
      s.number("biot", Range::between(0.0, 1.0), coupling.biot,
               "share of the pressure that zones and intact contacts bear; open ones bear all of it");
  coupling.exchange_pressure = s.quantity("exchange_pressure", unit::stress,
                                          Range::positive().usually(1e4, 1e6), coupling.exchange_pressure,
                                          "change of a pore pressure from one exchange to the next, about");
  coupling.crack_width =
      s.quantity("crack_width", unit::length, Range::positive().usually(1e-6, 1e-4), coupling.crack_width,
                 "mean opening of a face from which it drains as a crack");
  if (s.has("reserve"))
    coupling.reserve = s.quantity("reserve", unit::length, Range{.lower = kLeastReserve}.usually(1e-5, 1e-2),
                                  "w in the share w / (w + further opening) to which the pressure of a "
                                  "contact falls as it opens within "
                                  "an exchange; without this key it stays as it is until the next one");
  conditions.parameters.roughness =
      s.number("roughness", Range{.lower = 1.0}.usually(1.0, 5.0), conditions.parameters.roughness,
               "of the walls of cracks: they pass vapour as smooth ones do, over this number");
  if (!moves)
    for (const char* key : {"acts", "biot", "exchange_pressure", "crack_width", "reserve", "roughness"})
      if (s.has(key)) s.error(key, "has no meaning: no stage moves the body");
  if (coupling.acts != PressureActs::all && s.has("reserve"))
    s.error("reserve", "has no meaning where the pressure does not act on contacts: acts = \"all\"");
  if (coupling.acts == PressureActs::no)
    for (const char* key : {"biot", "exchange_pressure"})
      if (s.has(key)) s.error(key, "has no meaning beside acts = \"no\"");
}

}  // namespace

std::optional<MoistureConditions> read_moisture(const Section& root,
                                                const specimen::SpecimenParameters& specimen,
                                                const DeckSpace& space, const HeatConditions& heat,
                                                bool moves, CurveReader& time_curves, CurveReader& curves) {
  const auto s = root.optional_section(
      "moisture", "water in the pores, which heat drives; without this table there is none");
  if (!s) {
    refuse_pores(root, specimen);
    return std::nullopt;
  }
  if (heat.uniform)
    s->error("needs [heat] with field = \"conduction\": water flows from hot to cold parts, in time");
  MoistureConditions conditions;
  read_first(s->section("initial", "water at the start; one of the three keys"), conditions);
  conditions.parameters.largest_step =
      s->quantity("largest_step", unit::time, Range::positive().usually(0.1, 60.0),
                  conditions.parameters.largest_step, "of the water's solver");
  conditions.boundaries = read_water_boundaries(*s, space, time_curves);
  read_coupling(*s, moves, conditions);
  conditions.pores = read_phases(root, specimen, curves);
  if (s->ok() && conditions.boundaries.empty())
    s->warn("boundaries", "are none: no water leaves the specimen");
  return conditions;
}

void warn_of_free_evaporation(const Section& root, const MoistureConditions& moisture,
                              const std::vector<BlockMaterial>& block_materials) {
  for (std::size_t m = 0; m < moisture.pores.size(); ++m) {
    const std::optional<Curve>& c = block_materials[m].specific_heat;
    if (!moisture.pores[m].of_concrete || !c || !c->holds(Interval{kBeforeBoiling, kDry})) continue;
    if (c->maximum(kBoils, kDry) < kLeastPeak * (*c)(kBeforeBoiling))
      root.section("materials")
          .section(block_materials[m].name)
          .warn("specific_heat",
                "has no peak between 100 and 200 degC, so that water evaporates without heat");
  }
}

}  // namespace pyroclast
