#include "pyroclast/material/rocks.hpp"

#include <algorithm>
#include <array>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "pyroclast/base/error.hpp"
#include "pyroclast/base/nearest.hpp"

namespace pyroclast {

namespace {

// Intact rock of any soundness; its means are low for the sound rock that aggregates are crushed from.
constexpr std::string_view kAashto =
    "mean of intact rock, AASHTO HB-17 2002, after Wang, Mechanics of Asphalt, Tables 2.1 and 2.2";
constexpr std::string_view kCarmichael = "Carmichael, Rock, Encyclopaedia Britannica, Table 41";
constexpr std::string_view kGlasgow = "as in cases/hot_strength.toml, whose fit belongs to it";
constexpr std::string_view kNoRatio = "guess: rock expands as its concrete";

constexpr std::array<Rock, 6> kRocks{{
    {"limestone",
     {60.0, "guess for dense rock: intact 39 with sd 26 (AASHTO HB-17 2002), building stone 10 to 85 (NBS)"},
     {0.23, kAashto},
     {2700.0, "of 2600 to 2900 of dense limestone, DIN 52100"},
     {8.0, kCarmichael},
     {1.0, kNoRatio},
     "en1992_calcareous_elongation",
     "EN 1992-1-2:2004 3.3.1(1), calcareous"},
    {"dolomite",
     {60.0, "guess for dense rock: intact 29 with sd 24, at most 79 (AASHTO HB-17 2002)"},
     {0.29, kAashto},
     {2750.0, "of 2600 to 2900, DIN 52100"},
     {7.7, "Cardarelli, Materials Handbook, 2018"},
     {1.0, kNoRatio},
     "en1992_calcareous_elongation",
     "EN 1992-1-2:2004 3.3.1(1), calcareous"},
    {"granite",
     {53.0, kAashto},
     {0.2, kAashto},
     {2680.0, "Sousa 2013, granites of Portugal"},
     {8.0, kCarmichael},
     {1.0, kNoRatio},
     "glasgow_free_thermal_strain",
     kGlasgow},
    {"quartzite",
     {66.0, kAashto},
     {0.14, kAashto},
     {2650.0, "of 2600 to 2700, DIN 52100"},
     {12.0, "guess: one stone had 13.1 (ABNT NBR 15845-3)"},
     {1.55, "guess: the upper end that was studied, docs/validation/hot_concrete.md"},
     "glasgow_free_thermal_strain",
     kGlasgow},
    {"basalt",
     {78.0, "intact basalt, sd 19, Schultz 1995"},
     {0.25, "intact basalt, sd 0.05, Schultz 1995"},
     {2950.0, "of 2900 to 3000, DIN 52100"},
     {5.4, kCarmichael},
     {1.0, kNoRatio},
     "glasgow_free_thermal_strain",
     "guess: no curve of a basalt concrete was found"},
    {"sandstone",
     {30.0, "guess: intact 15 with sd 8 (AASHTO HB-17 2002), building stone 13 to 53 (NBS)"},
     {0.2, kAashto},
     {2500.0, "guess"},
     {10.0, kCarmichael},
     {1.25, "rough mean of a sandstone's dilatometer table, docs/validation/hot_concrete.md"},
     "glasgow_free_thermal_strain",
     kGlasgow},
}};

}  // namespace

std::span<const Rock> rocks() {
  return kRocks;
}

const Rock& rock(std::string_view name) {
  const auto found = std::ranges::find(kRocks, name, &Rock::name);
  if (found != kRocks.end()) return *found;
  std::vector<std::string> names;
  for (const Rock& each : kRocks) names.emplace_back(each.name);
  throw Error(fmt::format("\"{}\" is no rock that is known{}; rocks: {}", name,
                          did_you_mean(std::string(name), names, "; "), quoted_list(names)));
}

}  // namespace pyroclast
