#include <algorithm>
#include <cmath>
#include <filesystem>
#include <map>
#include <memory>
#include <numbers>
#include <optional>
#include <sstream>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "pyroclast/app/commands.hpp"
#include "pyroclast/app/concrete_fire.hpp"
#include "pyroclast/app/concrete_template.hpp"
#include "pyroclast/app/written_decks.hpp"
#include "pyroclast/base/error.hpp"
#include "pyroclast/base/read_file.hpp"
#include "pyroclast/base/shell_words.hpp"
#include "pyroclast/deck/deck.hpp"
#include "pyroclast/material/first_guess.hpp"
#include "pyroclast/material/rocks.hpp"
#include "pyroclast/setup/setup.hpp"
#include "pyroclast/setup/sieve_curve.hpp"
#include "pyroclast/simulation/simulation.hpp"
#include "pyroclast/specimen/grading_curve.hpp"
#include "pyroclast/units/units.hpp"

namespace pyroclast::app {

namespace {

/// Blocks in the diameter of the largest aggregate, where that gives a usual number of blocks.
constexpr double kBlocksInAggregate = 5.0;
/// The same where a load is held in a fire: coarser ones scatter critical temperatures by 100 K.
constexpr double kBlocksInHeatedAggregate = 6.1;
/// Blocks across the smallest stone of a body in space; smaller stones would be a block or two, whatever
/// their shape.
constexpr double kBlocksInStone = 3.0;
/// Least size of the largest stone, over the smallest.
constexpr double kLeastRange = 1.1;
constexpr const char *kWidth = "150 mm", *kHeight = "300 mm";  // of a specimen where nothing is said
constexpr int kFewestBlocks = 1000, kMostBlocks = 5000;
constexpr int kLeastCount = 100, kMostCount = 1000000;  // of blocks that can be stated
/// Diameter of a cylinder over its largest stone, its height over its diameter, and its blocks, of which a
/// stone of two thirds of the largest then has three across.
constexpr double kDiameterOverStone = 4.0, kSlenderness = 2.0;
constexpr int kBlocksInSpace = 10000;
/// Most blocks of a body in space by which its modulus is estimated: with 2,000 in place of 10,000 it moves
/// by 0.4 %.
constexpr int kBlocksOfEstimate = 2000;
/// Block size, m, and time step, s, that go together in cases/.
constexpr double kSizeOfCases = 3e-3, kStepOfCases = 10e-6;
constexpr double kRateInSpace = 5e-3;                      ///< 1/s, as in cases/starter_3d.toml
constexpr std::string_view kModeTwoEnergy = "block size";  ///< of bodies in space
constexpr double kDegrees = 180.0 / std::numbers::pi;
constexpr const char* kControlled =
    "velocity = \"0.2 mm/s\"\nfastest_velocity = \"8 mm/s\"\nunbalanced_ratio = 1e-4\n"
    "kinetic_over_strain = 5e-3\nplaten_difference = 0.01\ndissipation_rate = \"1 1/s\"\nramp_time = \"20 "
    "ms\"\nstop_strain = 0.015";

/// Exponent of Fuller's curve P(d) = (d / d_max)^exponent.
constexpr double kFuller = 0.45;

/// Largest relative difference of two numbers that count as one, of a deck's digits.
constexpr double kAlike = 2e-3;

bool are_alike(double a, double b) {
  return std::abs(a - b) <= kAlike * std::max(std::abs(a), std::abs(b));
}

/// Numbers of mortar and contacts that are guessed or taken from a deck, SI.
struct Found {
  double mortar_modulus = 0.0;
  MortarContacts contacts{};
  int blocks = 0;
  double factor = 1.0;      ///< over the strengths of the first guess's deck
  bool is_resized = false;  ///< true where the specimen has another size than the one that was calibrated
};

/// Concrete as it is asked for, SI.
struct Asked {
  bool is_solid = false;  ///< true for a cylinder in space, whose width is its diameter
  double strength = 0.0, modulus = 0.0, fraction = 0.0, width = 0.0, height = 0.0, d_min = 0.0, d_max = 0.0;
  double coarse = 1.0;  ///< share of the stones that is larger than d_min
  const Rock* rock = nullptr;
  specimen::GradingCurve passing;  ///< empty: Fuller's curve
  std::optional<double> hot;       ///< °C
  std::optional<AskedFire> fire;

  int dimension() const { return is_solid ? 3 : 2; }
  /// Returns the area of the specimen, m², of a cylinder its volume, m³.
  double extent() const { return (is_solid ? 0.25 * std::numbers::pi * width : 1.0) * width * height; }
  /// Returns the size of so many blocks, m: the root of their mean area, of a solid of their mean volume.
  double block_size(double blocks) const { return std::pow(extent() / blocks, 1.0 / dimension()); }
  /// Returns the share of the stones, from d_min on, that is larger than a size.
  double share_above(double size) const {
    const auto passing_at = [&](double d) {
      return passing.sizes.empty() ? std::pow(d / d_max, kFuller) : specimen::share_at(passing, d);
    };
    return (1.0 - passing_at(size)) / (1.0 - passing_at(d_min));
  }
};

std::string in(double value, double scale, const char* unit) {
  return fmt::format("{:.10g} {}", value * scale, unit);
}

double quantity_of(const char* option, const std::string& text, const Unit& unit, double least, double most) {
  double value = 0.0;
  try {
    value = parse_quantity(text, unit);
  } catch (const QuantityError& error) {
    throw Error(fmt::format("{}: {}", option, error.what()));
  }
  if (!(value >= least && value <= most))
    throw Error(
        unit == unit::dimensionless
            ? fmt::format("{} \"{}\": must be between {:g} and {:g}, or {:g} % and {:g} %", option, text,
                          least, most, 100.0 * least, 100.0 * most)
            : fmt::format("{} \"{}\": must be between {:g} and {:g} {}", option, text, least, most, unit.si));
  return value;
}

/// Reads points of a grading such as "8 mm=45 %", or the name of a file with a sieve analysis.
specimen::GradingCurve passing_of(const std::vector<std::string>& texts) {
  if (texts.size() == 1 && texts[0].find('=') == std::string::npos) {
    if (!std::filesystem::exists(texts[0]))
      throw Error(fmt::format(
          "--passing \"{}\": there is no such file; state one, or sizes and shares such as '8 mm=45 %'",
          texts[0]));
    return sieve_curve(MeasuredTable::open(texts[0], kSieveColumns), {texts[0], {}, {}});
  }
  std::vector<std::pair<double, double>> points;
  for (const std::string& text : texts) {
    const auto equals = text.find('=');
    if (equals == std::string::npos)
      throw Error(fmt::format("--passing \"{}\": must be a size and a share, such as '8 mm=45 %'", text));
    points.emplace_back(quantity_of("--passing", text.substr(0, equals), unit::length, 1e-5, 0.2),
                        quantity_of("--passing", text.substr(equals + 1), unit::dimensionless, 0.0, 1.0));
  }
  std::ranges::sort(points);
  for (std::size_t i = 1; i < points.size(); ++i)
    if (points[i].second < points[i - 1].second || points[i].first == points[i - 1].first)
      throw Error("--passing: a larger sieve must let through as much or more, and each size stands once");
  if (!points.empty() && points.back().second < 1.0)
    throw Error("--passing: all must pass the largest sieve: its share must be 100 %");
  specimen::GradingCurve curve;
  for (const auto& [size, share] : points) {
    curve.sizes.push_back(size);
    curve.shares.push_back(share);
  }
  return points.size() < 2 ? curve : checked_curve(std::move(curve));
}

Asked asked_of(const ConcreteOptions& o) {
  Asked a;
  a.rock = &rock(o.rock);
  a.strength = quantity_of("--f_c", o.strength, unit::stress, 5e6, 150e6);
  a.modulus = quantity_of("--E", o.modulus, unit::stress, 5e9, 80e9);
  a.is_solid = o.cylinder;
  a.d_min = quantity_of("--d_min", o.d_min, unit::length, 5e-4, 0.1);
  a.passing = passing_of(o.passing);
  if (a.passing.sizes.empty() && o.d_max.empty())
    throw Error(
        "--d_max is needed: the largest aggregate, such as --d_max '20 mm', or --passing for each sieve");
  if (!a.passing.sizes.empty() && !o.d_max.empty())
    throw Error("--d_max has no meaning beside --passing: all passes the largest sieve");
  a.d_max = a.passing.sizes.empty() ? quantity_of("--d_max", o.d_max, unit::length, 1e-3, 0.15)
                                    : a.passing.sizes.back();
  const auto size_of = [](const char* option, const std::string& stated, const std::string& usual) {
    return quantity_of(option, stated.empty() ? usual : stated, unit::length, 0.02, 2.0);
  };
  a.width = size_of("--width", o.width,
                    a.is_solid ? in(std::ceil(kDiameterOverStone * 1e3 * a.d_max), 1.0, "mm") : kWidth);
  a.height = size_of("--height", o.height, a.is_solid ? in(kSlenderness * a.width, 1e3, "mm") : kHeight);
  if (a.d_max <= a.d_min)
    throw Error(fmt::format("the largest aggregate, {:g} mm, must be larger than --d_min, {:g} mm",
                            1e3 * a.d_max, 1e3 * a.d_min));
  if (o.fraction.empty() == o.stones.empty())
    throw Error(
        "either --fraction (area of coarse aggregate over the area of a section) or --stones (its mass in "
        "the "
        "mix, such as '1100 kg/m3') is needed");
  if (o.stones.empty()) {
    a.fraction = quantity_of("--fraction", o.fraction, unit::dimensionless, 0.0, 0.6);
  } else {
    const double mass = quantity_of("--stones", o.stones, unit::density, 0.0, 3000.0);
    if (!a.passing.sizes.empty()) a.coarse = 1.0 - specimen::share_at(a.passing, a.d_min);
    a.fraction = mass / a.rock->density.value * a.coarse;
    if (a.fraction > 0.6)
      throw Error(
          fmt::format("--stones \"{}\": {:.2f} of the volume would be coarse aggregate; at most 0.6 can be "
                      "placed. Finer aggregate belongs to the mortar: state --passing, or a larger --d_min",
                      o.stones, a.fraction));
  }
  if (!o.fire.empty()) a.fire = asked_fire(o, o.out.parent_path());
  if (!o.hot.empty()) a.hot = quantity_of("--hot", o.hot, unit::temperature, 20.0, 800.0);
  return a;
}

/// Returns a positive number with so many significant digits.
double rounded(double value, int digits) {
  const double last = std::pow(10.0, std::floor(std::log10(value)) - (digits - 1));
  return std::round(value / last) * last;
}

/// Returns the number of blocks, two digits of it.
int block_count(const Asked& asked, std::int64_t stated) {
  if (stated > 0) return static_cast<int>(stated);
  if (asked.is_solid) return kBlocksInSpace;
  const double size = asked.d_max / (asked.fire ? kBlocksInHeatedAggregate : kBlocksInAggregate);
  const double count = std::clamp(asked.extent() / (size * size), static_cast<double>(kFewestBlocks),
                                  static_cast<double>(kMostBlocks));
  return static_cast<int>(std::round(rounded(count, 2)));
}

/// Leaves to the mortar of a body in space those stones that its blocks cannot resolve.
void leave_small_stones(Asked& a, int blocks) {
  const double size = a.block_size(blocks);
  const double least = std::ceil(1e4 * kBlocksInStone * size) / 1e4;
  if (!a.is_solid || least <= a.d_min) return;
  if (kLeastRange * least > a.d_max) {
    const double needed = a.extent() / std::pow(a.d_max / (kLeastRange * kBlocksInStone), 3);
    throw Error(fmt::format(
        "--cylinder: the largest stone has {:g} mm, and {} blocks are {:.2g} mm wide: the smallest stone, of "
        "{:g} blocks, would have {:g} mm; state --blocks {:.0f} or more, or a smaller --width and --height",
        1e3 * a.d_max, blocks, 1e3 * size, kBlocksInStone, 1e3 * least, 100.0 * std::ceil(needed / 100.0)));
  }
  a.fraction *= a.share_above(least);
  a.d_min = least;
}

std::string grading(const Asked& a) {
  if (a.passing.sizes.empty()) {
    std::vector<std::string> sieves;
    for (const double size : {8.0, 12.5, 16.0, 20.0, 25.0, 31.5, 40.0})
      if (size > 1.05e3 * a.d_min && size < 0.95e3 * a.d_max)
        sieves.push_back(fmt::format("\"{:g} mm\"", size));
    return fmt::format(
        "d_min = \"{}\"            # smaller grains belong to the mortar\nd_max = \"{}\"\n"
        "fuller_exponent = {:g}       # guess: Fuller's curve P(d) = (d / d_max)^fuller_exponent, or state "
        "`passing`\n"
        "sieves = [{}]  # bounds of the size intervals between d_min and d_max",
        in(a.d_min, 1e3, "mm"), in(a.d_max, 1e3, "mm"), kFuller, fmt::join(sieves, ", "));
  }
  std::vector<std::string> points;
  for (std::size_t i = 0; i < a.passing.sizes.size(); ++i)
    points.push_back(fmt::format("[\"{}\", \"{}\"]", in(a.passing.sizes[i], 1e3, "mm"),
                                 in(a.passing.shares[i], 100.0, "%")));
  return fmt::format(
      "d_min = \"{}\"            # smaller grains belong to the mortar\npassing = [{}]\n"
      "passing_by = \"volume\"        # of the stones, or their mass",
      in(a.d_min, 1e3, "mm"), fmt::join(points, ", "));
}

/// Returns a text whose comments behind values stand in one column.
std::string aligned(const std::string& text) {
  std::istringstream lines(text);
  std::string result;
  for (std::string line; std::getline(lines, line);) {
    const auto comment = line.find("  #");
    if (comment == std::string::npos) {
      result += line + "\n";
      continue;
    }
    const auto value = line.substr(0, line.find_last_not_of(' ', comment) + 1);
    result += fmt::format("{:<28} {}\n", value, line.substr(line.find('#', comment)));
  }
  return result;
}

/// Returns the template with its places filled.
std::string filled(const std::map<std::string, std::string>& values) {
  std::string text;
  std::string_view left = kConcreteTemplate;
  for (auto at = left.find('@'); at != std::string_view::npos; at = left.find('@')) {
    const auto end = left.find('@', at + 1);
    text += left.substr(0, at);
    text += values.at(std::string(left.substr(at + 1, end - at - 1)));
    left.remove_prefix(end + 1);
  }
  return aligned(text.append(left));
}

/// Adds what the law of the contacts needs beside strengths, energies and friction.
void add_law(std::map<std::string, std::string>& v, const Asked& a, const MortarContacts& contacts) {
  for (const char* key : {"MODE_2_ENERGY", "LAW", "C_RES", "PHI_RES", "DILATION"}) v[key] = "";
  if (a.is_solid) {
    v["MODE_2_ENERGY"] = fmt::format(
        "mode_2_energy = \"{}\" # G_f2 holds at t_b_block_size and goes with the size\n", kModeTwoEnergy);
    v["LAW"] =
        fmt::format("law = \"{}\"           # one damage for tension and shear\nsoftening = \"linear\"\n",
                    first_guess(3).law);
    v["DILATION"] =
        "psi = \"0 deg\"  # broken faces do not dilate ...\nu_r = \"0.1 mm\"  # ... over this slip\n";
  } else {
    v["C_RES"] =
        fmt::format("c_res = \"{}\"            # residual cohesion\n", in(contacts.c_res, 1e-6, "MPa"));
    v["PHI_RES"] = fmt::format("phi_res = \"{}\"           # residual friction angle\n",
                               in(contacts.phi_res, kDegrees, "deg"));
  }
}

/// Adds the parts of a deck that is heated; empty ones for a cold deck.
void add_hot_parts(std::map<std::string, std::string>& v, const Asked& a, bool is_hot) {
  for (const char* key :
       {"HOT_CONCRETE", "HOT_CREEP", "HOT_STRENGTH", "HOT_HEAT", "HOT_STAGES", "HOT_COUPLING", "HOT_OUTPUT"})
    v[key] = "";
  if (!is_hot) return;
  const auto over_temperature = [](std::string& value, std::string_view curve, const char* share) {
    value =
        fmt::format("{{ value = {}, times = \"{}\"{} }}", value.substr(0, value.find("  #")), curve, share);
  };
  over_temperature(v["ROCK_E"], "glasgow_modulus", ", share = 0.3");
  v["ROCK_E"] =
      fmt::format("{}\n# {}; the share of the loss is a choice", v["ROCK_E"], a.rock->modulus.source);
  over_temperature(v["MORTAR_E"], "glasgow_modulus", ", share = 0.87");
  v["MORTAR_E"] +=
      "\n# The share of the loss was fitted to a siliceous concrete (docs/validation/hot_concrete.md).";
  for (const char* key : {"G_F1", "G_F2"}) {
    over_temperature(v[key], "glasgow_fracture_energy", "");
    v[key] += "  # literature, on concrete as a whole";
  }
  v["HOT_CONCRETE"] = fmt::format(
      "[concrete]                   # strains of the phases follow from the strain of the concrete\n"
      "thermal_strain = {{ builtin = \"{}\" }}  # {}\n"
      "inclusion_ratio = {:g}         # expansion of the rock over expansion of its concrete; {}\n\n",
      a.rock->concrete_curve, a.rock->curve_source, a.rock->expansion_ratio.value,
      a.rock->expansion_ratio.source);
  v["HOT_CREEP"] = fmt::format(
      "[materials.mortar.creep]     # load-induced thermal strain: heating under stress shortens the mortar "
      "for "
      "good\n"
      "k2 = 2.5                     # fitted to a siliceous concrete (docs/validation/hot_concrete.md)\n"
      "f_c = \"{}\"\nnu = 0.3\ntension = 1                  # as much under tension as under compression\n\n",
      in(a.strength, 1e-6, "MPa"));
  v["HOT_STRENGTH"] =
      "# Of f_t, f_cm and c; fitted to a siliceous concrete (docs/validation/hot_concrete.md).\n"
      "temperature_ratio = { expression = \"max(1 - 0.01784*((T-20)/100)^2, 0.01)\", range = [\"20 degC\", "
      "\"800 degC\"] }\n";
  v["HOT_HEAT"] = "[heat]\nfield = \"uniform\"            # the whole specimen has one temperature\n\n";
  v["HOT_STAGES"] = fmt::format(
      "[[stages]]                   # ... is loaded, or not, ...\nkind = \"load\"\nlevel = 0\n"
      "f_c = \"{}\"               # or {{ run = \"runs/...\" }}: that of the same specimen, crushed cold\n"
      "ramp_time = \"200 ms\"\nunbalanced_ratio = 1e-4\nmost_steps = 100000\n\n"
      "[[stages]]                   # ... is heated evenly, with its load held ...\nkind = \"heat\"\nto = "
      "\"{:g} degC\"\n"
      "rate = \"5 K/min\"\nplaten = \"force\"\n\n",
      in(a.strength, 1e-6, "MPa"), a.hot.value_or(0.0));
  v["HOT_COUPLING"] =
      "[coupling]                   # temperatures are handed over in steps\nexchange_increment = \"4 K\"\n"
      "unbalanced_ratio = 1e-3      # each ends when the body rests: unbalanced over applied forces,\n"
      "platen_difference = \"0.2 MPa\"  # and no more between the stresses on the platens,\n"
      "least_cycles = 1000          # after so many steps;\nmost_cycles = 9000           # or, flagged, for "
      "so many\n"
      "predictor = true             # each first moves the body to where the last one foretells it to rest\n"
      "failure_strain = 0.002       # failed when the platen sinks by this at one temperature\n\n";
  v["HOT_OUTPUT"] = "frame_temperature = \"50 K\"   # frames while heating: at its multiples\n";
}

/// Returns the comment behind the share of aggregate.
std::string source_of_fraction(const Asked& a, const ConcreteOptions& o) {
  if (a.is_solid)
    return fmt::format(
        "  # volume of stones of {:g} mm and more, {:g} blocks, over that of the specimen; smaller ones "
        "belong to the mortar",
        1e3 * a.d_min, kBlocksInStone);
  if (o.stones.empty()) return "              # area of coarse aggregate over area of the specimen";
  return fmt::format(
      "  # {:.3g} of {} of stones, {:g} kg/m3 their density; a section has the share of the volume "
      "(Delesse)",
      a.coarse, o.stones, a.rock->density.value);
}

std::string deck_text(const Asked& a, const Found& found, const ConcreteOptions& o, bool is_hot) {
  const double size = a.block_size(found.blocks);
  const MortarContacts& contacts = found.contacts;
  const bool is_guess = o.from.empty();
  const auto sourced = [](std::string value, const SourcedNumber& of) {
    return fmt::format("{}  # {}", value, of.source);
  };
  const auto quoted = [](std::string text) { return fmt::format("\"{}\"", text); };
  const std::string calibrate = fmt::format("{}-calibrate.toml", o.out.stem().string());
  std::map<std::string, std::string> v{
      {"SCHEMA", std::string(kSchemaLine)},
      {"ADVICE",
       is_guess
           ? fmt::format(
                 "# Calibrate it before you use it: `pyroclast study run {}` finds the two first guesses, "
                 "E of the\n# mortar and one factor on all strengths, and writes the deck with them.\n",
                 shell_path(calibrate))
           : fmt::format("# E of the mortar and the numbers of the contacts come from {}.\n",
                         o.from.string())},
      {"COMMAND", shell_command(o.typed)},
      {"TITLE", fmt::format("{}{} concrete, {:g} MPa",
                            is_hot && a.fire ? ""
                            : is_hot         ? "Hot strength of "
                                             : "Compression of ",
                            a.rock->name, a.strength * 1e-6)},
      {"ROCK", std::string(a.rock->name)},
      {"F_C", in(a.strength, 1e-6, "MPa")},
      {"YOUNG", in(a.modulus, 1e-9, "GPa")},
      {"BODY", a.is_solid
                   ? fmt::format("shape = \"cylinder\"           # it stands around the y axis\n"
                                 "diameter = \"{}\"\nheight = \"{}\"",
                                 in(a.width, 1e3, "mm"), in(a.height, 1e3, "mm"))
                   : fmt::format("width = \"{}\"\nheight = \"{}\"\nthickness = \"1 m\"            # out of "
                                 "plane; forces and energies are for this thickness",
                                 in(a.width, 1e3, "mm"), in(a.height, 1e3, "mm"))},
      {"EXTENT", a.is_solid ? "volume" : "area"},
      {"SUPERPOSITION",
       a.is_solid
           ? "rule = \"each\"                # one for each ball, then blocks that balls cover most, up "
             "to the balls' volume"
           : "rule = \"fit\"                 # the blocks that circles cover most, until they take "
             "their area"},
      {"FRACTION", fmt::format("{:.3g}", a.fraction)},
      {"FRACTION_SOURCE", source_of_fraction(a, o)},
      {"GRADING", grading(a)},
      {"BLOCKS", std::to_string(found.blocks)},
      {"SIZE", fmt::format("{:.2g}", 1e3 * size)},
      {"COUNT_SOURCE", found.is_resized ? "so many have the size that was calibrated, on which f_c depends"
                                        : "f_c depends on the block size: calibrate again for another count"},
      {"ROCK_E", sourced(quoted(in(a.rock->modulus.value, 1.0, "GPa")), a.rock->modulus)},
      {"ROCK_NU", sourced(fmt::format("{:g}", a.rock->poisson.value), a.rock->poisson)},
      {"ROCK_DENSITY", sourced(quoted(in(a.rock->density.value, 1.0, "kg/m3")), a.rock->density)},
      {"MORTAR_E", quoted(in(found.mortar_modulus, 1e-9, "GPa")) + (is_guess ? "  # first guess" : "")},
      {"FACTOR", fmt::format("{:.3g}", found.factor)},
      {"FACTOR_SOURCE", is_guess ? ": first guess" : ""},
      {"NUMBERS", std::string(first_guess(a.dimension()).source)},
      {"F_T", in(contacts.f_t, 1e-6, "MPa")},
      {"F_CM", in(contacts.f_cm, 1e-6, "MPa")},
      {"C_O", in(contacts.c_o, 1e-6, "MPa")},
      {"PHI", in(contacts.phi, kDegrees, "deg")},
      {"G_F1", quoted(in(contacts.G_f1, 1.0, "N/m"))},
      {"G_F2", quoted(in(contacts.G_f2, 1.0, "N/m"))},
      {"TIME_STEP", in(std::round(1e8 * (a.is_solid ? kStepOfCases * size / first_guess(3).block_size
                                                    : kStepOfCases * size / kSizeOfCases)) /
                           100.0,
                       1.0, "us")},
      {"CELLS",
       a.is_solid ? "radius_spread = 0.3          # seeds differ in weight, so that blocks differ in size\n"
                    "shortest_edge = 0.35         # shorter edges are merged: fewer zones, less moving mass"
                  : "shortest_edge = 0.2          # edges shorter than this fraction of the mean edge are "
                    "removed\nrelaxation = 0               # Lloyd iterations; 0 leaves the seeds at random"},
      {"REST", a.is_solid ? "1e-3" : "1e-4"},
      {"LOADING", a.is_solid
                      ? fmt::format("velocity = \"{:.3g} mm/s\"\nramp_time = \"50 ms\"\nstop_strain = 0.006",
                                    1e3 * kRateInSpace * a.height)
                      : kControlled},
      {"FRAMES", a.is_solid ? "5e-4" : "1e-4"},
  };
  add_law(v, a, contacts);
  add_hot_parts(v, a, is_hot);
  if (!is_hot || !a.fire) return filled(v);
  add_fire_parts(v, *a.fire, in(a.strength, 1e-6, "MPa"));
  return without_compression(filled(v));
}

/// Estimates E of a deck, Pa, as `check` does.
double estimate(const std::string& text, const std::string& name) {
  const Deck deck = Deck::parse(text, name);
  const Setup setup = read_setup(deck, {});
  const auto simulation = make_simulation(setup);
  return estimate_modulus(simulation->model(), simulation->materials());
}

/// Guesses mortar and contacts. The estimate adds compliances up, so that its reciprocal is straight over
/// that of the mortar's modulus.
Found guess(const Asked& a, const ConcreteOptions& o, int blocks) {
  const FirstGuess& known = first_guess(a.dimension());
  Found found{.mortar_modulus = known.mortar_modulus, .contacts = known.contacts, .blocks = blocks};
  const auto compliance = [&](double modulus) {
    Found tried = found;
    tried.mortar_modulus = modulus;
    if (a.is_solid) tried.blocks = std::min(blocks, kBlocksOfEstimate);
    return 1.0 / (known.modulus_over_estimate * estimate(deck_text(a, tried, o, false), o.out.string()));
  };
  const double soft = 0.5 * known.mortar_modulus, stiff = 2.0 * known.mortar_modulus;
  const double at_soft = compliance(soft), at_stiff = compliance(stiff);
  const double slope = (at_soft - at_stiff) / (1.0 / soft - 1.0 / stiff);
  const double of_rock = at_stiff - slope / stiff;
  const double least = 3e9, most = 200e9;  // a mortar's modulus here
  const double wanted = 1.0 / a.modulus - of_rock;
  if (!(wanted > slope / most && wanted < slope / least))
    throw Error(fmt::format(
        "--E \"{}\": with {:.2g} of {} of {:g} GPa a mortar of {:g} to {:g} GPa gives {:.3g} to {:.3g} "
        "GPa; choose E between these, another fraction, or another rock",
        o.modulus, a.fraction, a.rock->name, a.rock->modulus.value, 1e-9 * least, 1e-9 * most,
        1e-9 / (of_rock + slope / least), 1e-9 / (of_rock + slope / most)));
  found.mortar_modulus = rounded(slope / wanted, 3);
  const double strength = known.strength_with(found.mortar_modulus, a.block_size(blocks), 1.0);
  found.factor = rounded(std::pow(a.strength / strength, 1.0 / known.of_factor), 3);
  MortarContacts& c = found.contacts;
  for (double* number : {&c.f_t, &c.f_cm, &c.c_o, &c.c_res, &c.G_f1, &c.G_f2}) *number *= found.factor;
  return found;
}

/// Reads mortar and contacts from a deck, and takes the size of its specimen. Throws Error where the deck is
/// not of the concrete that is asked for.
Found read(const std::filesystem::path& file, const ConcreteOptions& o, Asked& a) {
  const Deck deck = Deck::open(file);
  const Setup setup = read_setup(deck, file.parent_path());  // refuses what is no deck
  const Section root = deck.root();
  const auto value_of = [](const Section& s, const char* key, const Unit& unit) {
    return s.is_table(key) ? s.section(key).quantity("value", unit, Range::any(), "")
                           : s.quantity(key, unit, Range::any(), "");
  };
  const auto require = [&](const char* what, double there, double asked, const char* option) {
    if (!are_alike(there, asked))
      throw Error(fmt::format(
          "--from \"{}\": its {} is {:.3g}, but {} asks for {:.3g}; mortar and contacts are taken "
          "from a deck of the same concrete",
          file.string(), what, there, option, asked));
  };
  const bool is_solid = setup.specimen.dimension() == 3;
  if (o.cylinder && !is_solid)
    throw Error(fmt::format("--from \"{}\": is no deck of a body in space, but --cylinder asks for one",
                            file.string()));
  a.is_solid = is_solid;
  const Section body = root.section("specimen");
  a.width = value_of(body, is_solid ? "diameter" : "width", unit::length);
  a.height = value_of(body, "height", unit::length);
  Found found{.blocks = setup.specimen.blocks.count};
  leave_small_stones(a, found.blocks);
  require("share of aggregate", setup.specimen.aggregates.fraction, a.fraction, "--fraction or --stones");
  require("E of aggregate, in GPa,",
          1e-9 * value_of(root.section("materials").section("aggregate"), "E", unit::stress),
          a.rock->modulus.value, "--aggregate");
  const Section contacts = root.section("contacts").section("mortar_mortar");
  const FirstGuess& known = first_guess(a.dimension());
  const std::string law = contacts.text("law", std::string(first_guess(2).law), "");
  if (law != known.law ||
      (is_solid && root.section("contacts").text("mode_2_energy", "", "") != kModeTwoEnergy))
    throw Error(
        fmt::format("--from \"{}\": its contacts have the law {}, but this program writes {}{}; write its "
                    "deck and calibrate it anew",
                    file.string(), law, known.law,
                    is_solid ? fmt::format(" with mode_2_energy = \"{}\"", kModeTwoEnergy) : ""));
  found.mortar_modulus = value_of(root.section("materials").section("mortar"), "E", unit::stress);
  found.contacts = {.f_t = value_of(contacts, "f_t", unit::stress),
                    .G_f1 = value_of(contacts, "G_f1", unit::fracture_energy),
                    .f_cm = value_of(contacts, "f_cm", unit::stress),
                    .c_o = value_of(contacts, "c_o", unit::stress),
                    .G_f2 = value_of(contacts, "G_f2", unit::fracture_energy),
                    .phi = value_of(contacts, "phi", unit::angle)};
  if (!is_solid) {
    found.contacts.c_res = value_of(contacts, "c_res", unit::stress);
    found.contacts.phi_res = value_of(contacts, "phi_res", unit::angle);
  }
  found.factor = found.contacts.f_t / known.contacts.f_t;
  return found;
}

/// Gives a specimen the size that is asked for, of blocks as large as those that were calibrated.
void resize(Asked& a, Found& found, double width, double height) {
  if (are_alike(width, a.width) && are_alike(height, a.height)) return;
  const double block = a.extent() / found.blocks;
  a.width = width;
  a.height = height;
  const double blocks = std::round(a.extent() / block);
  if (!(blocks >= kLeastCount && blocks <= kMostCount))
    throw Error(fmt::format(
        "--width, --height: blocks of {:.3g} mm, as the calibrated deck has them, would be {:.0f}; choose a "
        "size with {} to {} of them",
        1e3 * std::pow(block, 1.0 / a.dimension()), blocks, kLeastCount, kMostCount));
  found.blocks = static_cast<int>(blocks);
  found.is_resized = true;
}

/// Returns the line of a deck that begins so; empty where there is none.
std::string line_of(const std::filesystem::path& file, std::string_view beginning) {
  std::istringstream text(read_file(file));
  for (std::string line; std::getline(text, line);)
    if (line.starts_with(beginning)) return line;
  return {};
}

// Lines of the deck of a study's best point, see study/driver.py.
constexpr std::string_view kBestPoint = "# Best point of the study", kMissed = "# The targets are not met";

/// Tells whether mortar and contacts of a deck are those that `guess` gives for this concrete, and no
/// calibration found them to be right.
bool is_first_guess(const Found& found, const Asked& a, const ConcreteOptions& o) {
  const Found first = guess(a, o, found.blocks);
  return are_alike(found.mortar_modulus, first.mortar_modulus) &&
         are_alike(found.contacts.f_t, first.contacts.f_t) && line_of(o.from, kBestPoint).empty();
}

/// Returns the folder of the calibration, taken from the place of its file.
std::string folder_of_calibration(const ConcreteOptions& o) {
  return fmt::format("runs/{}-calibrate", o.out.stem().string());
}

std::string study_text(const Asked& a, const ConcreteOptions& o) {
  return fmt::format(
      R"(# Finds E of the mortar and one factor on all strengths and fracture energies, so that E and f_c of the concrete are
# met: pyroclast study run {0}
# One compression test fixes no more than these two: f_cm, beta, c_o and G_f2 keep the ratios of the deck.
title = "Calibration of {1} concrete: {2:g} GPa, {3:g} MPa"

[study]
deck = {4}
seeds = 3                    # means over three specimens are met
folder = {7}

[method]
kind = "secant"

[parameters.stiffness]
key = "materials.mortar.E"
vary = "scale"
log_uniform = [0.4, 2.5]

[parameters.strength]
keys = {{ "contacts.mortar_mortar.f_t" = 1, "contacts.mortar_mortar.f_cm" = 1, "contacts.mortar_mortar.c_o" = 1, {8}"contacts.mortar_mortar.G_f1" = 1, "contacts.mortar_mortar.G_f2" = 1 }}
vary = "scale"
log_uniform = [0.32, 3.125]

[outputs]
E = "E_GPa"
f_c = "f_c_MPa"

[targets.E]
value = "{2:g} GPa"
sd = "{5:.3g} GPa"               # 0.5 %
by = "stiffness"

[targets.f_c]
value = "{3:g} MPa"
sd = "{6:.3g} MPa"               # 1 %
by = "strength"
)",
      shell_path(fmt::format("{}-calibrate.toml", o.out.stem().string())), a.rock->name, a.modulus * 1e-9,
      a.strength * 1e-6, in_toml(o.out.filename().string()), 0.005 * a.modulus * 1e-9,
      0.01 * a.strength * 1e-6, in_toml(folder_of_calibration(o)),
      a.is_solid ? "" : "\"contacts.mortar_mortar.c_res\" = 1, ");
}

/// Returns the command that writes the deck of a hot test or of a fire again, from the calibrated deck: that
/// which was typed, without its number of blocks.
std::string heated_again(const ConcreteOptions& o, const std::filesystem::path& out) {
  std::vector<std::string> words;
  for (std::size_t i = 0; i < o.typed.size(); ++i) {
    const std::string& word = o.typed[i];
    const bool is_replaced =
        word.starts_with("-o") || word.starts_with("--out") || word.starts_with("--blocks");
    if (!is_replaced)
      words.push_back(word);
    else if (word == "-o" || word == "--out" || word == "--blocks")
      ++i;  // its value
  }
  const auto best = o.out.parent_path() / folder_of_calibration(o) / "best.toml";
  words.insert(words.end(), {"--from", best.string(), "-o", out.string()});
  return shell_command(words);
}

/// Writes the deck of a concrete with first guesses, a study that calibrates it, and a deck of a hot
/// test or of a fire.
int write_concrete(const ConcreteOptions& options) {
  ConcreteOptions o = options;
  if (o.out.extension() != ".toml") o.out += ".toml";
  Asked asked = asked_of(o);
  const auto beside = [&](const char* ending) {
    return o.out.parent_path() / fmt::format("{}-{}.toml", o.out.stem().string(), ending);
  };
  const bool is_guess = o.from.empty(), is_heated = asked.hot || asked.fire;
  if (!is_guess && !is_heated)
    throw Error(
        "--from takes mortar and contacts for a hot test or a fire: state --hot, such as --hot '400 degC', "
        "or "
        "--fire, such as --fire iso834 --minutes 90");
  if (!is_guess && o.blocks > 0)
    throw Error("--blocks has no meaning beside --from, whose size of a block is kept");
  const int blocks = block_count(asked, o.blocks);
  if (is_guess) leave_small_stones(asked, blocks);
  const double width = asked.width, height = asked.height;
  Found found = is_guess ? guess(asked, o, blocks) : read(o.from, o, asked);
  const bool has_first_guesses = !is_guess && is_first_guess(found, asked, o);
  if (!is_guess)
    resize(asked, found, o.width.empty() ? asked.width : width, o.height.empty() ? asked.height : height);
  if (asked.fire && asked.is_solid)
    throw Error("--fire burns plane specimens alone: a cylinder has no sides left and right");
  std::vector<TextFile> files;
  if (is_guess) {
    files.push_back({o.out, deck_text(asked, found, o, false)});
    files.push_back({beside("calibrate"), study_text(asked, o)});
  }
  const std::string missed = is_guess ? std::string() : line_of(o.from, kMissed);
  const std::filesystem::path heated = is_guess ? beside(asked.fire ? "fire" : "hot") : o.out;
  if (is_heated)
    files.push_back({heated, (missed.empty() ? "" : missed + "\n") + deck_text(asked, found, o, true)});
  if (asked.fire) read_setup(Deck::parse(files.back().text, heated.string()), o.out.parent_path());
  std::error_code no_such_file;
  if (!is_guess && std::filesystem::equivalent(o.from, o.out, no_such_file))
    throw Error(fmt::format("--from \"{}\": would be replaced by the new deck; choose another name for it",
                            o.from.string()));
  write_decks(files, o.overwrite);
  if (asked.is_solid)
    fmt::print(
        "coarse          {:.3g} of the volume: stones from {:.3g} mm on, {:g} blocks; smaller ones belong to "
        "the mortar\n",
        asked.fraction, 1e3 * asked.d_min, kBlocksInStone);
  else if (!o.stones.empty() || !asked.passing.sizes.empty())
    fmt::print(
        "coarse          {:.3g} of a section: all stones larger than --d_min {:g} mm; finer ones belong to "
        "the mortar\n",
        asked.fraction, 1e3 * asked.d_min);
  if (!is_guess) {
    if (found.is_resized)
      fmt::print("blocks          {} of {:.3g} mm, the size that was calibrated\n", found.blocks,
                 1e3 * asked.block_size(found.blocks));
    if (has_first_guesses)
      fmt::print(
          "warning         {} has the first guesses: run its calibration, and take the deck of its best "
          "point\n",
          o.from.string());
    if (!missed.empty())
      fmt::print("warning         {} is of a calibration that failed{}\n", o.from.string(),
                 missed.substr(missed.find(':')));
    if (asked.fire)
      fmt::print("Next:\n  pyroclast check {0}\n  pyroclast run {0}\n", shell_path(o.out));
    else
      fmt::print("Next:\n  pyroclast run {} --seeds 3\n", shell_path(o.out));
    return 0;
  }
  fmt::print("first guesses   E of the mortar {:.4g} GPa, strengths {:.4g} times {}; {} blocks\nNext:\n",
             1e-9 * found.mortar_modulus, found.factor, first_guess(asked.dimension()).source, found.blocks);
  const std::string study = shell_path(beside("calibrate"));
  if (asked.is_solid) fmt::print("  pyroclast study check {}  # tells how many hours it takes\n", study);
  fmt::print("  pyroclast study run {}\n", study);
  if (is_heated)
    fmt::print("  {}\n", heated_again(o, beside(asked.fire ? "calibrated-fire" : "calibrated-hot")));
  return 0;
}

}  // namespace

Command add_concrete(CLI::App& cli) {
  const auto options = std::make_shared<ConcreteOptions>();
  auto* concrete = cli.add_subcommand(
      "concrete",
      "Write a deck for your concrete from its strength and stiffness, and a study that calibrates the deck");
  concrete->add_option("--f_c", options->strength, "Mean compressive strength: --f_c '45 MPa'")->required();
  concrete->add_option("--E", options->modulus, "Young's modulus: --E '32 GPa'")->required();
  concrete->add_option("--aggregate", options->rock, "Rock of the aggregate, see `pyroclast list rocks`")
      ->required();
  concrete->add_option("--fraction", options->fraction,
                       "Area of coarse aggregate over the area of a section");
  concrete->add_option("--stones", options->stones,
                       "Mass of coarse aggregate in the mix, in the place of --fraction: '1100 kg/m3'; with "
                       "--passing, of all aggregate");
  concrete->add_option("--d_max", options->d_max, "Largest aggregate, graded by Fuller's curve");
  concrete
      ->add_option("--passing", options->passing,
                   "Share that passes each sieve, by mass, in the place of --d_max: --passing '4 mm=38 %' '8 "
                   "mm=55 %' '20 mm=100 %', or a file with two columns: --passing sieves.csv")
      ->take_all();
  concrete
      ->add_option("--d_min", options->d_min,
                   "Smallest coarse aggregate; smaller grains belong to the mortar, also those of --passing")
      ->capture_default_str();
  concrete->add_option(
      "--width", options->width,
      "Width of the specimen (default: 150 mm), diameter of a cylinder (default: 4 times its "
      "largest aggregate); with --from as in its deck, or another one with blocks of the same size");
  concrete->add_option("--height", options->height,
                       "Height of the specimen (default: 300 mm, of a cylinder twice its diameter); with "
                       "--from likewise");
  concrete->add_flag(
      "--cylinder", options->cylinder,
      "Make a body in space: stones of three blocks across and more; smaller ones belong to the "
      "mortar");
  concrete
      ->add_option(
          "--blocks", options->blocks,
          "Number of blocks (default: 5 across the largest aggregate, 6.1 with --fire, but between 1000 and "
          "5000 blocks; 10000 of a cylinder)")
      ->check(whole_number(kLeastCount, kMostCount));
  concrete->add_option("--hot", options->hot,
                       "Also write a deck of a test at this temperature: --hot '400 degC'");
  auto* fire = concrete->add_option("--fire", options->fire,
                                    "Also write a deck of a fire: iso834, hydrocarbon, another one of "
                                    "`pyroclast list fires`, or the file of a furnace record");
  concrete->add_option("--minutes", options->minutes, "Minutes of fire: --minutes 90")->needs(fire);
  concrete->add_option("--faces", options->faces, "Sides in the fire: left, right, or both")
      ->capture_default_str()
      ->needs(fire);
  concrete
      ->add_option("--level", options->level,
                   "Load that is held in the fire, as a share of --f_c: 0.3 of 38 MPa is 11.4 MPa")
      ->capture_default_str()
      ->needs(fire);
  concrete
      ->add_option("--columns", options->columns,
                   "Columns of a furnace record with more than two: --columns time 'Furnace mean'")
      ->expected(2)
      ->needs(fire);
  concrete->add_option(
      "--from", options->from,
      "Take mortar and contacts of the hot test or the fire from this deck, such as the calibrated "
      "one");
  concrete->add_option("-o,--out", options->out, "File for the deck")->required();
  concrete->add_flag("--overwrite", options->overwrite, kOverwriteDecks);
  return {concrete, [options](std::vector<std::string> typed) {
            typed[0] = "pyroclast";
            std::erase(typed, "--overwrite");  // a deck names how it is made, whatever was there before
            options->typed = std::move(typed);
            return write_concrete(*options);
          }};
}

}  // namespace pyroclast::app
