#include "pyroclast/units/spellings.hpp"

#include <algorithm>
#include <array>
#include <string>
#include <utility>
#include <vector>

#include "pyroclast/base/characters.hpp"
#include "pyroclast/base/nearest.hpp"

namespace pyroclast {
namespace {

/// Unit as this program takes it, with other texts that people write for it.
struct Spelling {
  const Unit& of;
  std::string_view unit;
  std::vector<std::string_view> others = {};
};

const std::vector<Spelling>& spellings() {
  static const std::vector<Spelling> all{
      {unit::dimensionless, "%"},
      {unit::dimensionless, "mm/m"},
      {unit::dimensionless, "um/m"},
      {unit::length, "m", {"metre"}},
      {unit::length, "cm"},
      {unit::length, "mm"},
      {unit::length, "um", {"mu", "mum", "my"}},
      {unit::length, "inch", {"\"", "inches"}},
      {unit::length, "ft"},
      {unit::area, "m2", {"sqm"}},
      {unit::area, "cm2", {"sqcm"}},
      {unit::area, "mm2", {"sqmm"}},
      {unit::angle, "deg", {"grad", "º"}},
      {unit::angle, "rad"},
      {unit::time, "s", {"sec", "secs"}},
      {unit::time, "ms", {"msec"}},
      {unit::time, "us", {"usec"}},
      {unit::time, "min", {"mins", "mn"}},
      {unit::time, "h", {"hr", "hrs", "std"}},
      {unit::time, "d", {"days"}},
      {unit::frequency, "1/s"},
      {unit::velocity, "m/s"},
      {unit::velocity, "mm/s", {"mm/sec"}},
      {unit::velocity, "mm/min"},
      {unit::velocity, "um/s"},
      {unit::acceleration, "m/s2", {"m/sec2"}},
      {unit::density, "kg/m3"},
      {unit::density, "g/cm3", {"gcc", "g/cc"}},
      {unit::density, "t/m3", {"to/m3"}},
      {unit::density, "lb/ft3", {"pcf"}},
      {unit::force, "N"},
      {unit::force, "kN"},
      {unit::force, "MN"},
      {unit::force, "lbf", {"lb", "lbs"}},
      {unit::force, "kgf", {"kg", "kp"}},
      {unit::force_rate, "kN/s", {"kN/sec"}},
      {unit::stress, "Pa"},
      {unit::stress, "kPa"},
      {unit::stress, "MPa", {"MN/m²"}},
      {unit::stress, "GPa"},
      {unit::stress, "N/mm2", {"N/sqmm"}},
      {unit::stress, "psi", {"lb/in2", "lbs/in2", "psig"}},
      {unit::stress, "ksi", {"kip/in2"}},
      {unit::stress, "Mpsi", {"Msi"}},
      {unit::stress, "lbf/ft2", {"psf"}},
      {unit::stress, "bar"},
      {unit::stress, "kgf/cm2", {"kg/cm2", "kp/cm2", "ksc", "at"}},
      {unit::stress, "kgf/mm2", {"kg/mm2", "kp/mm2"}},
      {unit::stress_rate, "MPa/s", {"MPa/sec", "N/mm2s"}},
      {unit::energy, "J", {"Nm"}},
      {unit::energy, "kJ"},
      {unit::stiffness, "N/m"},
      {unit::stiffness, "kN/mm"},
      {unit::stiffness_per_area, "GPa/m"},
      {unit::stiffness_per_area, "MPa/mm"},
      {unit::stiffness_per_area, "N/mm3", {"N/mm2/mm"}},
      {unit::fracture_energy, "J/m2"},
      {unit::fracture_energy, "N/m"},
      {unit::fracture_energy, "N/mm"},
      {unit::temperature, "degC", {"C", "°C", "ºC", "oC", "deg C", "Celsius", "grad C", "grd"}},
      {unit::temperature, "degF", {"F", "°F", "ºF", "oF", "deg F", "Fahrenheit"}},
      {unit::temperature, "K", {"°K", "oK", "deg K", "degK"}},
      {unit::temperature_difference, "K", {"C", "°C", "ºC", "oC", "degC", "deg C", "°K", "degK"}},
      {unit::heating_rate, "K/min", {"C/min", "°C/min", "ºC/min", "oC/min", "degC/min", "deg C/min"}},
      {unit::heating_rate, "K/s", {"C/s", "°C/s", "ºC/s", "oC/s", "degC/s"}},
      {unit::heating_rate, "K/h", {"C/h", "°C/h", "ºC/h", "oC/h", "degC/h", "K/hr", "C/hr"}},
      {unit::conductivity, "W/(m K)", {"W/m C", "W/m °C", "W/m degC", "W/mK"}},
      {unit::specific_heat, "J/(kg K)", {"J/kg C", "J/kg °C", "J/kg degC"}},
      {unit::specific_heat, "kJ/(kg K)", {"kJ/kg C", "kJ/kg °C"}},
      {unit::heat_transfer, "W/(m2 K)", {"W/m2 C", "W/m2 °C", "W/sqm K"}},
      {unit::heat_flux, "W/m2", {"W/sqm"}},
      {unit::heat_flux, "kW/m2", {"kW/sqm"}},
      {unit::expansion, "1/K", {"1/C", "1/°C", "/C", "/°C", "per K", "mm/mm/C", "m/m/C"}},
      {unit::expansion, "um/m/K", {"um/m/C", "um/m/°C", "ppm/C", "ppm/°C"}}};
  return all;
}

/// Unit of a share, with the texts that mean it and nothing else.
struct ShareUnit {
  std::string_view unit;
  std::vector<std::string_view> texts;
};

/// Returns shares as people write them: with small letters, one micro sign, and no blanks, points and
/// brackets.
const std::vector<ShareUnit>& shares() {
  static const std::vector<ShareUnit> all{
      {"%", {"percent", "pct",     "prozent",   "wt%",       "w%",      "w/w%",    "weight%", "gew%",
             "vol%",    "v%",      "v/v%",      "volume%",   "mass%",   "masse%",  "ma%",     "m%",
             "m/m%",    "mol%",    "at%",       "%wt",       "%vol",    "%mass",   "%w/w",    "%v/v",
             "%m/m",    "%bymass", "%byweight", "%byvolume", "%strain", "%passing"}},
      {"mm/m",
       {"‰", "permille", "permil", "promille", "o/oo", "0/00", "°/oo", "%o", "10^-3", "10**-3", "10-3", "e-3",
        "e-03", "1e-3", "1e-03"}},
      {"um/m",
       {"microstrain", "microstrains", "micro-strain", "ustrain", "µstrain", "ustrains", "µstrains", "µε",
        "uε", "µe", "ue", "10^-6", "10**-6", "10-6", "e-6", "e-06", "1e-6", "1e-06"}}};
  return all;
}

/// Returns the text of a share in the form of `shares`.
std::string plain_share(std::string_view text) {
  static constexpr std::array<std::pair<std::string_view, std::string_view>, 18> kMarks{{{"μ", "µ"},
                                                                                         {"ϵ", "ε"},
                                                                                         {"ɛ", "ε"},
                                                                                         {"⁻", "^-"},
                                                                                         {"−", "-"},
                                                                                         {"³", "3"},
                                                                                         {"⁶", "6"},
                                                                                         {"×", ""},
                                                                                         {"·", ""},
                                                                                         {"\u00A0", ""},
                                                                                         {"\u202F", ""},
                                                                                         {"\u2009", ""},
                                                                                         {" ", ""},
                                                                                         {"\t", ""},
                                                                                         {".", ""},
                                                                                         {"(", ""},
                                                                                         {")", ""},
                                                                                         {"-%", "%"}}};
  std::string plain;
  while (!text.empty()) {
    const auto mark =
        std::ranges::find_if(kMarks, [&](const auto& known) { return text.starts_with(known.first); });
    plain += mark == kMarks.end() ? text.substr(0, 1) : mark->second;
    text.remove_prefix(mark == kMarks.end() ? 1 : mark->first.size());
  }
  plain = lower_case(plain);
  return plain.starts_with("x10") || plain.starts_with("*10") ? plain.substr(1) : plain;
}

/// Returns a text without the marks that people set or leave out as they like.
std::string compact(std::string_view text) {
  static constexpr std::array<std::pair<std::string_view, std::string_view>, 8> marks{
      {{"²", "2"}, {"³", "3"}, {"·", ""}, {"⋅", ""}, {"⁻", "-"}, {"−", "-"}, {"¹", "1"}, {"×", ""}}};
  std::string result;
  while (!text.empty()) {
    const auto mark =
        std::ranges::find_if(marks, [&](const auto& known) { return text.starts_with(known.first); });
    if (mark != marks.end())
      result += mark->second;
    else if (std::string_view(" .*()^").find(text.front()) == std::string_view::npos)
      result += text.front();
    text.remove_prefix(mark != marks.end() ? mark->first.size() : 1);
  }
  return result;
}

}  // namespace

std::vector<std::string> unit_spellings() {
  std::vector<std::string> all;
  for (const Spelling& spelling : spellings()) {
    all.emplace_back(spelling.unit);
    all.insert(all.end(), spelling.others.begin(), spelling.others.end());
  }
  constexpr std::string_view kDigits = "0123456789";  // a number and "1e-3" are two numbers
  for (const ShareUnit& share : shares())
    for (const std::string_view text : share.texts)
      if (kDigits.find(text.front()) == kDigits.npos) all.emplace_back(text);
  return all;
}

std::vector<std::string_view> usual_units(const Unit& unit) {
  std::vector<std::string_view> units;
  for (const Spelling& spelling : spellings())
    if (spelling.of == unit) units.push_back(spelling.unit);
  return units;
}

std::string_view share_unit(std::string_view text) {
  constexpr std::size_t kLongest = 40;
  if (text.size() > kLongest) return "";
  const std::string plain = plain_share(text);
  for (const ShareUnit& share : shares())
    if (std::ranges::find(share.texts, plain) != share.texts.end()) return share.unit;
  return "";
}

std::string_view meant_spelling(std::string_view given, const Unit& unit) {
  const std::string written = compact(given);
  std::vector<std::string_view> units;
  std::vector<std::string> words;
  for (const Spelling& spelling : spellings()) {
    if (!(spelling.of == unit)) continue;
    units.push_back(spelling.unit);
    words.push_back(compact(spelling.unit));
    for (const std::string_view other : spelling.others) {
      units.push_back(spelling.unit);
      words.push_back(compact(other));
    }
  }
  const auto find = [&](const auto& is_it) {
    const auto found = std::ranges::find_if(words, is_it);
    return found == words.end() ? std::string_view() : units[static_cast<std::size_t>(found - words.begin())];
  };
  if (const auto same = find([&](const std::string& word) { return word == written; }); !same.empty())
    return same;
  if (const auto same =
          find([&](const std::string& word) { return lower_case(word) == lower_case(written); });
      !same.empty())
    return same;
  const auto near = nearest(written, words);
  return near ? units[*near] : std::string_view();
}

}  // namespace pyroclast
