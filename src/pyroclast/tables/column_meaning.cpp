#include "pyroclast/tables/column_meaning.hpp"

#include <algorithm>
#include <cstddef>

#include "pyroclast/base/characters.hpp"

namespace pyroclast {
namespace meaning {

const ColumnMeaning index{"number of the row",
                          unit::dimensionless,
                          {"id", "ids", "no", "nr", "number", "num", "index", "idx", "label", "name", "row",
                           "nummer", "lfd", "#", "№"}};
const ColumnMeaning x{
    "x",
    unit::length,
    {"x", "X", "xc", "cx", "xm", "posx", "xpos", "centerx", "centrex", "xcenter", "xcentre"}};
const ColumnMeaning y{
    "y",
    unit::length,
    {"y", "Y", "yc", "cy", "ym", "posy", "ypos", "centery", "centrey", "ycenter", "ycentre"}};
const ColumnMeaning z{"z", unit::length, {"z", "Z", "zc", "cz", "zm", "posz", "zpos"}};
const ColumnMeaning diameter{"diameter",
                             unit::length,
                             {"d", "D", "diameter", "diameters", "dia", "diam", "size", "Ø", "ø", "⌀", "Φ",
                              "φ", "ϕ", "2r", "durchmesser", "diamètre", "diametre"}};
const ColumnMeaning radius{
    "radius", unit::length, {"r", "R", "d/2", "radius", "radii", "rad", "halbmesser", "rayon"}, true};
const ColumnMeaning area{"area", unit::area, {"area", "fläche"}};
const ColumnMeaning phase{
    "phase", unit::dimensionless, {"phase", "phases", "material", "mat", "class", "type"}};
const ColumnMeaning grain{
    "grain",
    unit::dimensionless,
    {"grain", "grains", "particle", "stone", "outline", "contour", "polygon", "object", "korn"}};
const ColumnMeaning sieve{"size",
                          unit::length,
                          {"size", "sizes", "sieve", "sieves", "opening", "mesh", "aperture", "d", "D",
                           "diameter", "siebweite", "sieb", "maschenweite", "korngröße", "tamis"}};
const ColumnMeaning passing{
    "passing",
    unit::dimensionless,
    {"passing", "pass", "passes", "passed", "finer", "undersize", "durchgang", "siebdurchgang", "passant"}};
const ColumnMeaning retained{
    "retained",
    unit::dimensionless,
    {"retained", "retention", "retain", "coarser", "oversize", "rückstand", "siebrückstand", "refus"},
    true};
const ColumnMeaning time{
    "time", unit::time, {"t",        "time",     "times",        "elapsed",     "duration",
                         "clock",    "date",     "datetime",     "timestamp",   "stamp",
                         "zeit",     "uhrzeit",  "zeitpunkt",    "zeitstempel", "datum",
                         "messzeit", "prüfzeit", "versuchszeit", "laufzeit",    "dauer",
                         "temps",    "heure",    "horodatage",   "minutes",     "seconds"}};
const ColumnMeaning temperature{
    "temperature",
    unit::temperature,
    {"T", "θ", "ϑ", "Θ", "temp", "temps", "temperature", "temperatures", "temperatur", "température"}};
const ColumnMeaning temperature_rise{"temperature rise",
                                     unit::temperature,
                                     {"rise",
                                      "increase",
                                      "increment",
                                      "delta",
                                      "Δ",
                                      "ΔT",
                                      "Δθ",
                                      "dT",
                                      "deltaT",
                                      "difference",
                                      "diff",
                                      "excess",
                                      "above",
                                      "erhöhung",
                                      "anstieg",
                                      "zunahme",
                                      "temperaturerhöhung",
                                      "temperaturanstieg",
                                      "erwärmung",
                                      "übertemperatur"},
                                     true};
const ColumnMeaning strain{
    "strain",
    unit::dimensionless,
    {"strain", "strains", "eps", "epsilon", "ε", "ϵ", "dehnung", "stauchung", "déformation", "shortening"}};
const ColumnMeaning stress{
    "stress",
    unit::stress,
    {"stress", "stresses", "sigma", "sig", "σ", "spannung", "druckspannung", "contrainte"}};
const ColumnMeaning force{"force", unit::force, {"force", "load", "F", "P", "kraft", "last"}};
const ColumnMeaning displacement{
    "displacement",
    unit::length,
    {"displacement", "disp", "u", "deflection", "stroke", "weg", "verschiebung", "durchbiegung", "lvdt"}};
const ColumnMeaning opening{
    "opening", unit::length, {"opening", "cmod", "ctod", "crackopening", "w", "rissöffnung"}};

}  // namespace meaning

namespace {

bool is_small(char c) {
  return c >= 'a' && c <= 'z';
}
bool is_capital(char c) {
  return c >= 'A' && c <= 'Z';
}

/// Returns one character as it stands, a longer word in small letters.
std::string folded(std::string_view word) {
  const auto count = std::ranges::count_if(word, [](char c) { return (c & 0xC0) != 0x80; });
  return count > 1 ? lower_case(word) : std::string(word);
}

/// Splits a name into words, without digits: "xCenter_1" is x and center.
std::vector<std::string> words_of_name(std::string_view name) {
  std::vector<std::string> words;
  std::string word;
  const auto end_word = [&] {
    if (!word.empty()) words.push_back(folded(word));
    word.clear();
  };
  char before = ' ';
  for (const char c : name) {
    const bool is_letter = is_small(c) || is_capital(c) || (c & 0x80) != 0 || c == '#';
    if (!is_letter || (is_capital(c) && is_small(before)) || (is_digit(before) && is_letter)) end_word();
    if (is_letter) word += c;
    before = c;
  }
  end_word();
  return words;
}

ColumnMeanings that_have(std::string_view word, const ColumnMeanings& vocabulary) {
  ColumnMeanings found;
  for (const ColumnMeaning* one : vocabulary)
    if (std::ranges::any_of(one->words, [&](std::string_view known) { return folded(known) == word; }))
      found.push_back(one);
  return found;
}

ColumnMeanings common(const ColumnMeanings& a, const ColumnMeanings& b) {
  ColumnMeanings result;
  std::ranges::copy_if(a, std::back_inserter(result),
                       [&](const ColumnMeaning* one) { return std::ranges::find(b, one) != b.end(); });
  return result;
}

}  // namespace

ColumnMeanings meanings_of_name(std::string_view name, const ColumnMeanings& vocabulary) {
  if (const ColumnMeanings whole = that_have(folded(name), vocabulary); !whole.empty()) return whole;
  std::vector<ColumnMeanings> of_words;
  for (const std::string& word : words_of_name(name))
    if (ColumnMeanings found = that_have(word, vocabulary); !found.empty())
      of_words.push_back(std::move(found));
  for (const ColumnMeanings& one : of_words)
    if (one.size() == 1 && one[0]->rules) return {one[0]};
  const ColumnMeanings numbers{&meaning::index};
  if (std::ranges::any_of(of_words, [&](const auto& one) { return one != numbers; }))
    std::erase(of_words, numbers);  // "grain id" is a grain
  if (of_words.empty()) return {};
  ColumnMeanings result = of_words[0];
  for (const ColumnMeanings& one : of_words) result = common(result, one);
  return result;
}

}  // namespace pyroclast
