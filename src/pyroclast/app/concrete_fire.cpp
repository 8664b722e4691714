#include "pyroclast/app/concrete_fire.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <string_view>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

#include "pyroclast/base/error.hpp"
#include "pyroclast/thermal/fire_curves.hpp"
#include "pyroclast/units/units.hpp"

namespace pyroclast::app {

namespace {

/// Where the curves of these decks end, °C.
constexpr double kCurvesEnd = 1200.0;
// Coefficients of heat transfer of EN 1991-1-2 beside radiation, W/(m² K): standard fires, 3.2.1; hydrocarbon
// fires, 3.2.3; sides that are not in the fire, radiation included, 3.1.
constexpr double kConvection = 25.0, kConvectionOfHydrocarbon = 50.0;
constexpr int kFrames = 18;
constexpr double kLongest = 360.0;  // min, the end of the standard fires

double share_of(const std::string& text) {
  try {
    const double level = parse_quantity(text, unit::dimensionless);
    if (level >= 0.0 && level < 1.0) return level;
  } catch (const QuantityError&) {
  }
  throw Error(fmt::format("--level \"{}\": must be a share of f_c from 0 to below 1, such as 0.3", text));
}

double minutes_of(const std::string& text) {
  double minutes = 0.0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), minutes);
  if (error != std::errc() || end != text.data() + text.size() || !(minutes >= 1.0 && minutes <= kLongest))
    throw Error(fmt::format("--minutes \"{}\": must be a number from 1 to {:g}, the minutes of fire", text,
                            kLongest));
  return minutes;
}

std::vector<std::string> faces_of(const std::string& text) {
  std::vector<std::string> faces;
  for (std::size_t at = 0; at <= text.size();) {
    const auto comma = std::min(text.find(',', at), text.size());
    faces.push_back(text.substr(at, comma - at));
    at = comma + 1;
    if (faces.back() != "left" && faces.back() != "right")
      throw Error(fmt::format(
          "--faces \"{}\": must be left, right, or left,right; platens lie on top and bottom", text));
  }
  if (faces.size() > 2 || (faces.size() == 2 && faces[0] == faces[1]))
    throw Error(fmt::format("--faces \"{}\": names a side twice", text));
  return faces;
}

/// Sets the gas of a fire of the catalogue, or of a furnace record.
void set_gas(AskedFire& fire, const ConcreteOptions& o, const std::filesystem::path& folder) {
  const std::string name = o.fire == "hydrocarbon" ? "en1991_hydrocarbon" : o.fire;
  if (const NamedCurve* const known = fire_curves().find(name)) {
    if (!o.columns.empty())
      throw Error("--columns has no meaning beside a standard fire: it is for a furnace record");
    fire.gas = fmt::format("{{ builtin = \"{}\" }}", name);
    fire.name = name;
    fire.convection = name.find("hydrocarbon") == std::string::npos ? kConvection : kConvectionOfHydrocarbon;
    if (!known->curve.holds({0.0, 60.0 * fire.minutes}))
      throw Error(fmt::format("--minutes {:g}: the fire {} is given for {:g} min", fire.minutes, name,
                              known->curve.range().upper / 60.0));
    fire.hottest_gas = known->curve.maximum(0.0, 60.0 * fire.minutes);
    return;
  }
  if (!std::filesystem::is_regular_file(o.fire))
    throw Error(fmt::format("--fire \"{}\": is neither a fire ({}) nor a file with a furnace record", o.fire,
                            fmt::join(fire_curves().names(), ", ")));
  const auto file = std::filesystem::proximate(o.fire, folder.empty() ? "." : folder);
  fire.gas = fmt::format("{{ csv = {}", in_toml(file.generic_string()));
  if (!o.columns.empty()) {
    std::vector<std::string> columns;
    for (const std::string& column : o.columns) columns.push_back(in_toml(column));
    fire.gas += fmt::format(", columns = [{}]", fmt::join(columns, ", "));
  }
  fire.gas += " }";
  fire.name = "furnace record";
  fire.convection = kConvection;
}

/// Returns a modulus whose loss over the temperature is a share of Glasgow's, to the end of the curves.
std::string modulus_in_fire(const std::string& was) {
  constexpr std::string_view kWas = "times = \"glasgow_modulus\"";
  const auto at = was.find(kWas);
  if (at == std::string::npos) throw Error("a deck of fire has no modulus to go on with");
  return was.substr(0, at) +
         fmt::format(
             "times = {{ expression = \"max(1 - 0.001*(T-20), 0.1)^2\", range = [\"20 degC\", \"{:g} degC\"] "
             "}}",
             kCurvesEnd) +
         was.substr(at + kWas.size()) +
         "\n# glasgow_modulus, published to 800 degC; its formula beyond, not below 0.01, is a guess.";
}

std::string boundaries(const AskedFire& fire) {
  std::string text;
  for (const char* side : {"left", "right"}) {
    if (std::ranges::find(fire.faces, side) == fire.faces.end()) {
      text += fmt::format(
          "[[heat.boundaries]]          # the air of a room; EN 1991-1-2, radiation included\n"
          "faces = \"{}\"\n"
          "kind = \"convection\"\ncoefficient = \"9 W/(m2 K)\"\ngas_temperature = \"20 degC\"\n\n",
          side);
      continue;
    }
    text += fmt::format(
        "[[heat.boundaries]]\nfaces = \"{0}\"\nkind = \"convection\"\n"
        "coefficient = \"{2:g} W/(m2 K)\"  # EN 1991-1-2\ngas_temperature = {1}\n\n"
        "[[heat.boundaries]]\nfaces = \"{0}\"\nkind = \"radiation\"\n"
        "emissivity = 0.7  # EN 1992-1-2\ngas_temperature = {1}\n\n",
        side, fire.gas, fire.convection);
  }
  return text;
}

}  // namespace

std::string in_toml(const std::string& text) {
  return nlohmann::json(text).dump();
}

AskedFire asked_fire(const ConcreteOptions& o, const std::filesystem::path& folder) {
  AskedFire fire;
  if (!o.hot.empty()) throw Error("--fire and --hot: a deck has one of them");
  if (o.minutes.empty()) throw Error("--minutes is needed beside --fire, such as --minutes 90");
  fire.minutes = minutes_of(o.minutes);
  fire.level = share_of(o.level);
  fire.faces = faces_of(o.faces);
  set_gas(fire, o, folder);
  return fire;
}

void add_fire_parts(std::map<std::string, std::string>& v, const AskedFire& fire,
                    const std::string& strength) {
  const std::string conducts =
      "conductivity = { builtin = \"en1992_conductivity_lower\" }  # concrete's: none of its parts is known "
      "better\n"
      "specific_heat = { builtin = \"en1992_specific_heat_u1_5\" }  # with 1.5 % of moisture, a guess\n";
  v["ROCK_DENSITY"] += "\n" + conducts.substr(0, conducts.size() - 1);
  v["HOT_CREEP"] = conducts + "\n" + v["HOT_CREEP"];
  v["ROCK_E"] = modulus_in_fire(v["ROCK_E"]);
  v["MORTAR_E"] = modulus_in_fire(v["MORTAR_E"]);
  v["HOT_STRENGTH"] = fmt::format(
      "# Of f_t, f_cm and c; fitted to a siliceous concrete to 600 degC (docs/validation/hot_concrete.md); "
      "0.01 from\n# 765 degC on.\n"
      "temperature_ratio = {{ expression = \"max(1 - 0.01784*((T-20)/100)^2, 0.01)\", "
      "range = [\"20 degC\", \"{:g} degC\"] }}\n",
      kCurvesEnd);
  // A furnace record may be hotter than the curves; its specimen then has to stay colder.
  const bool may_pass_curves = fire.hottest_gas == 0.0 || fire.hottest_gas > kCurvesEnd;
  v["HOT_HEAT"] = fmt::format(
      "[heat]\nfield = \"conduction\"\n{}\n{}",
      may_pass_curves
          ? fmt::format(
                "temperature_range = [\"20 degC\", \"{:g} degC\"]  # the curves end there; `pyroclast "
                "check` tells whether the specimen stays within\n",
                kCurvesEnd)
          : "",
      boundaries(fire));
  v["HOT_STAGES"] = fmt::format(
      "[[stages]]                   # ... is loaded, ...\nkind = \"load\"\nlevel = {:g}  # of f_c: the "
      "stress that is held\n"
      "f_c = \"{}\"               # or {{ run = \"runs/...\" }}: that of the same specimen, crushed cold\n"
      "ramp_time = \"200 ms\"\nunbalanced_ratio = 1e-4\nmost_steps = 100000\n\n"
      "[[stages]]                   # ... and stands in the fire, with its load held\nkind = \"expose\"\n"
      "duration = \"{:g} min\"\nplaten = \"force\"\n\n",
      fire.level, strength, fire.minutes);
  v["HOT_COUPLING"] =
      "[coupling]                   # temperatures are handed over in steps\nexchange_increment = \"5 K\"\n"
      "unbalanced_ratio = 1e-3      # each ends when the body rests: unbalanced over applied forces,\n"
      "platen_difference = \"0.2 MPa\"  # and no more between the stresses on the platens,\n"
      "least_cycles = 1000          # after so many steps;\nmost_cycles = 3000           # or, flagged, for "
      "so many\n"
      "failure_strain = 0.002       # failed when the platen sinks by this at one temperature\n\n";
  v["HOT_OUTPUT"] = fmt::format("frame_interval = \"{:g} min\"     # between two frames in the fire\n",
                                std::max(1.0, std::round(fire.minutes / kFrames)));
  v["TITLE"] =
      fmt::format("{} for {:g} min, load {:g} f_c: {}", fire.name, fire.minutes, fire.level, v["TITLE"]);
}

std::string without_compression(std::string deck) {
  constexpr std::string_view kStage = "[[stages]]";
  for (auto kind = deck.find("kind = \"compress\""); kind != std::string::npos;
       kind = deck.find("kind = \"compress\"")) {
    const auto begin = deck.rfind(kStage, kind);
    deck.erase(begin, deck.find("\n[", kind) + 1 - begin);
  }
  return deck;
}

}  // namespace pyroclast::app
