#include "pyroclast/setup/read_specimen.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numbers>
#include <optional>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "pyroclast/base/error.hpp"
#include "pyroclast/base/nearest.hpp"
#include "pyroclast/base/overloaded.hpp"
#include "pyroclast/setup/cells_in_metres.hpp"
#include "pyroclast/specimen/from_cells.hpp"
#include "pyroclast/specimen/gradation.hpp"
#include "pyroclast/specimen/grading_curve.hpp"
#include "pyroclast/specimen/grain.hpp"
#include "pyroclast/specimen/neper_tess.hpp"
#include "pyroclast/specimen/outline.hpp"
#include "pyroclast/specimen/outline_seeds.hpp"
#include "pyroclast/tables/measured_table.hpp"
#include "pyroclast/tables/read_choice.hpp"

namespace pyroclast {

namespace {

/// Number of random places that are tried for one aggregate or fibre, where the deck states none.
constexpr int kPlacementAttempts = 100'000;

/// Smallest side of a test specimen over the largest aggregate (EN 12390-1 asks for 3.5).
constexpr double kFewestAggregatesAcross = 3.0;

/// Numbers of blocks that a specimen may have.
constexpr Range kBlockCount = Range::between(4, 100e6);

/// Largest difference from 1 of the last share of a sieve analysis, as percents leave it.
constexpr double kAllPass = 1e-9;

constexpr Meaning kPhase = "their material, a table of [materials]";
constexpr Meaning kSuperposition =
    "which blocks are of which phase; needed where there is more than the matrix";
constexpr Meaning kMatrix = "phase of the blocks that nothing else covers";

int read_attempts(const Section& s) {
  return static_cast<int>(
      s.integer("attempts", Range::between(1, 1e9), kPlacementAttempts,
                "random places that are tried for one of them before placing is given up"));
}

/// File of measurements that a table names by `csv`.
struct NamedTable {
  MeasuredTable table;
  std::vector<ChosenColumn> columns;
};

/// Reads the file of measurements that `csv` names; returns none after an error.
/// \param asked  columns asked for; the last of them may be missing in the file, down to `least`
std::optional<NamedTable> read_named_table(const Section& s, const std::filesystem::path& folder,
                                           std::span<const AskedColumn> asked, std::size_t least) {
  const std::string file = s.text("csv", "[measured table](measured-tables.md) beside the deck");
  const ColumnChoice choice = read_column_choice(s, file, least, asked.size());
  if (!s.ok() || !s.has("csv")) return std::nullopt;
  try {
    MeasuredTable table = MeasuredTable::open(folder / file, least);
    const std::size_t stated = choice.columns.empty() ? table.columns().size() : choice.columns.size();
    auto columns = table.choose(choice, asked.first(std::clamp(stated, least, asked.size())));
    s.names_file("csv", folder / file);
    return NamedTable{std::move(table), std::move(columns)};
  } catch (const Error& error) {
    s.error("csv", error.what());
    return std::nullopt;
  }
}

/// Reads a sieve analysis, by ascending size; returns none after an error.
std::optional<specimen::GradingCurve> read_passing(const Section& s, const std::filesystem::path& folder) {
  s.describe(
      "passing", {.value = "list of points [size, share], or { csv = file }", .name = "passing"},
      "grading that was measured, in the place of Fuller's curve: the share that passes each sieve, 100 % "
      "the largest; straight between sieves, and rescaled to the stones larger than d_min");
  specimen::GradingCurve curve;
  const auto complain = [&](const std::string& what) {
    s.error("passing", what);
    return std::nullopt;
  };
  if (s.is_table("passing")) {
    const std::array<AskedColumn, 2> asked{{{"size", unit::length}, {"passing", unit::dimensionless}}};
    const auto read =
        read_named_table(s.section("passing", "a sieve analysis: sizes, and the shares that pass"), folder,
                         asked, asked.size());
    if (!read) return std::nullopt;
    try {
      curve.sizes = read->table.values(read->columns[0], unit::length);
      curve.shares = read->table.values(read->columns[1], unit::dimensionless);
    } catch (const Error& error) {
      return complain(error.what());
    }
  } else {
    for (const auto& [size, share] : s.points("passing", unit::length, unit::dimensionless, "")) {
      curve.sizes.push_back(size);
      curve.shares.push_back(share);
    }
  }
  if (!s.ok() || curve.sizes.empty()) return std::nullopt;
  if (curve.sizes.front() > curve.sizes.back()) {  // laboratories list sieves so
    std::ranges::reverse(curve.sizes);
    std::ranges::reverse(curve.shares);
  }
  if (curve.sizes.size() < 2 || curve.sizes.front() < 0.0 ||
      std::ranges::adjacent_find(curve.sizes, std::ranges::greater_equal()) != curve.sizes.end())
    return complain("must have two sizes or more, which ascend or descend, none below 0");
  if (curve.shares.back() > 1.0 + kAllPass)
    return complain(
        fmt::format("reaches {:.6g}, but where all passes the share is 1, or 100 %: the unit is "
                    "missing",
                    curve.shares.back()));
  if (!std::ranges::is_sorted(curve.shares) || curve.shares.front() < 0.0 ||
      curve.shares.back() < 1.0 - kAllPass)
    return complain("must ascend with the size, from 0 % or more to 100 % at the largest");
  curve.shares.back() = 1.0;
  return curve;
}

void read_measured_grading(const Section& s, const std::filesystem::path& folder, const DeckSpace& space,
                           specimen::AggregateParameters& a) {
  enum class By { area, volume };
  const auto curve = read_passing(s, folder);
  const By by = s.choice<By>(
      "passing_by",
      {{"area", By::area, "shares are of the area of the circles"},
       {"volume", By::volume,
        "shares are of the volume of the stones, or their mass: a plane cuts the circles from spheres, see "
        "[Specimen](../understand/theory.md#specimen); in a solid the balls have these shares"}},
      "quantity of which `passing` states shares");
  if (space.is_solid() && s.ok() && by == By::area)
    s.error("passing_by", "shares of areas belong to a section; a solid takes passing_by = \"volume\"");
  const bool has_d_min = s.has("d_min");
  const double d_min =
      has_d_min ? s.quantity("d_min", unit::length, Range::positive().usually(5e-4, 0.1), "smallest diameter")
                : 0.0;
  if (!curve || !s.ok()) return;
  const double least = has_d_min ? d_min : curve->sizes.front();
  if (least <= 0.0) {
    s.error("d_min", "is needed where the smallest size of `passing` is 0");
    return;
  }
  try {
    const auto cut =
        specimen::above(by == By::volume && !space.is_solid() ? specimen::of_section(*curve) : *curve, least);
    a.sieves = cut.sizes;
    a.passing = cut.shares;
    a.d_min = cut.sizes.front();
    a.d_max = cut.sizes.back();
    a.fuller_exponent = 1.0;
  } catch (const Error& error) {
    s.error(has_d_min ? "d_min" : "passing", error.what());
  }
}

void read_fuller_grading(const Section& s, specimen::AggregateParameters& a) {
  a.d_min = s.quantity("d_min", unit::length, Range::positive().usually(5e-4, 0.1), "smallest diameter");
  a.d_max = s.quantity("d_max", unit::length, Range::positive().usually(5e-4, 0.15), "largest diameter");
  a.fuller_exponent = s.number("fuller_exponent", Range::positive().usually(0.2, 1.0), "of Fuller's curve");
  const auto between = s.optional_quantities(
      "sieves", unit::length, Range::positive(),
      "bounds of the size intervals between d_min and d_max, ascending; without any there is one interval");
  if (!s.ok()) return;
  if (a.d_max <= a.d_min) s.error("d_max", "must be greater than d_min");
  a.sieves = {a.d_min};
  for (double sieve : between) {
    if (sieve <= a.sieves.back() || sieve >= a.d_max) {
      s.error("sieves", "must ascend and lie between d_min and d_max, both excluded");
      return;
    }
    a.sieves.push_back(sieve);
  }
  a.sieves.push_back(a.d_max);
}

double area_of(const specimen::Stone& stone) {
  return stone.shape ? stone.shape->extent() : specimen::circle_area(stone.diameter);
}

/// Sets the gradation to that of the stones, which are known.
void set_gradation_of_stones(specimen::AggregateParameters& a) {
  std::vector<std::pair<double, double>> sizes;  // diameter and area
  for (const specimen::Stone& stone : a.stones) sizes.emplace_back(stone.diameter, area_of(stone));
  std::ranges::stable_sort(sizes, {}, &std::pair<double, double>::first);
  double passed = 0.0;
  for (const auto& [size, area] : sizes) {
    passed += area;
    if (!a.sieves.empty() && a.sieves.back() == size) {
      a.passing.back() = passed;
      continue;
    }
    a.sieves.push_back(size);
    a.passing.push_back(passed);
  }
  for (double& share : a.passing) share /= passed;
  a.d_min = sizes.front().first;
  a.d_max = sizes.back().first;
}

/// Columns of a table of stones: three, and the number of the phase, which may be missing.
using StoneColumns = std::array<AskedColumn, 4>;

/// Reads stones that are known, from a table as a run writes it.
/// \param add  function of the values by column and the first row of a stone with its place, which returns
/// the
///             stone without its phase, and the row behind the stone
template <class Add>
void read_known_stones(const Section& s, const std::filesystem::path& folder, const StoneColumns& asked,
                       specimen::AggregateParameters& a, Add add) {
  constexpr std::size_t kWithoutPhase = 3;
  const auto read = read_named_table(s, folder, asked, kWithoutPhase);
  auto phases = s.optional_texts("phases",
                                 "names of the phases, by their numbers from 0; without them all stones "
                                 "are of number 0, and of `phase`");
  if (phases.empty()) phases = {a.phase};
  if (!read || !s.ok()) return;
  a.place = fmt::format("{}: {}", s.where("csv"), s.path());
  try {
    std::vector<std::vector<double>> values;  // by column
    for (std::size_t i = 0; i < read->columns.size(); ++i)
      values.push_back(read->table.values(read->columns[i], asked[i].unit));
    for (std::size_t row = 0; row < read->table.rows();) {
      const auto place = fmt::format("{}:{}", read->table.path().string(), read->table.line(row));
      const double phase = values.size() > kWithoutPhase ? values[kWithoutPhase][row] : 0.0;
      auto [stone, end] = add(values, row, place);
      if (!(phase >= 0.0 && phase < static_cast<double>(phases.size()) && phase == std::floor(phase)))
        throw Error(fmt::format("{}: the phase {:.6g} has no name: `phases` names 0 to {}", place, phase,
                                phases.size() - 1));
      stone.phase = phases[static_cast<std::size_t>(phase)];
      stone.place = place;
      a.stones.push_back(std::move(stone));
      row = end;
    }
  } catch (const Error& error) {
    s.error("csv", error.what());
    return;
  }
  set_gradation_of_stones(a);
}

using Columns = std::vector<std::vector<double>>;
using StoneAndEnd = std::pair<specimen::Stone, std::size_t>;

void read_stones(const Section& s, const std::filesystem::path& folder, specimen::AggregateParameters& a) {
  const Section own = s.section("stones",
                                "places and diameters of all circles, in the place of a grading: "
                                "`specimen/aggregates.csv` of a run, or "
                                "a table of x, y, diameter, and the number of a phase or none");
  const StoneColumns asked{
      {{"x", unit::length}, {"y", unit::length}, {"diameter", unit::length}, {"phase", unit::dimensionless}}};
  read_known_stones(
      own, folder, asked, a, [](const Columns& values, std::size_t row, const std::string& place) {
        if (!(values[2][row] > 0.0))
          throw Error(fmt::format("{}: the diameter must be greater than 0", place));
        return StoneAndEnd{{{{values[0][row], values[1][row]}}, values[2][row], {}, {}}, row + 1};
      });
}

/// Reads outlines that are known: points of the outline of each grain, in turn.
void read_outlines(const Section& s, const std::filesystem::path& folder, specimen::AggregateParameters& a) {
  const Section own =
      s.section("outlines",
                "outlines of all grains, in the place of a grading: `specimen/outlines.csv` of a "
                "run, or a table of the number of the grain, x, y of a point of its outline, and "
                "the number of a phase or none; points of a grain follow each other");
  const StoneColumns asked{{{"grain", unit::dimensionless},
                            {"x", unit::length},
                            {"y", unit::length},
                            {"phase", unit::dimensionless}}};
  read_known_stones(own, folder, asked, a,
                    [](const Columns& values, std::size_t row, const std::string& place) {
                      std::vector<Vec<2>> points;
                      std::size_t end = row;
                      for (; end < values[0].size() && values[0][end] == values[0][row]; ++end)
                        points.push_back({{values[1][end], values[2][end]}});
                      try {
                        const auto [outline, centre] = specimen::outline_around(points);
                        return StoneAndEnd{{centre, outline->width(), {}, {}, outline}, end};
                      } catch (const Error& error) {
                        throw Error(fmt::format("{}: {}", place, error.what()));
                      }
                    });
}

/// Reads the least and the largest of numbers that are drawn.
specimen::Spread spread_of(const Section& s, std::string_view key, const std::vector<double>& bounds) {
  if (bounds.empty()) return {1.0, 1.0};
  if (bounds.size() == 2 && bounds[0] <= bounds[1]) return {bounds[0], bounds[1]};
  s.error(key, "must be two numbers, the least and the largest");
  return {1.0, 1.0};
}

specimen::ShapeParameters read_shape(const Section& s, const DeckSpace& space) {
  using specimen::GrainShape;
  specimen::ShapeParameters p;
  p.kind = s.choice<GrainShape>(
      "kind",
      {{"ellipse", GrainShape::ellipse, "an ellipse"},
       {"polygon", GrainShape::polygon, "a convex polygon with corners at random on an ellipse"},
       {"harmonics", GrainShape::harmonics,
        "r = 1 + sum D_n cos(n angle + phase_n) with n from 3 to 12, drawn out to its elongation"}},
      "shape of the grains; without this table they are circles, in a solid balls");
  if (space.is_solid())
    s.error("kind", "grains of a solid are balls: other shapes are for bodies of the plane");
  p.elongation = spread_of(s, "elongation",
                           s.numbers("elongation", Range::between(1.0, 5.0).usually(1.0, 2.5),
                                     "least and largest length over width of the ellipse"));
  const double turn = 2.0 * std::numbers::pi;
  const auto angles = s.optional_quantities(
      "orientation", unit::angle, Range::between(-turn, turn),
      "least and largest angle of the length from the x axis; without this key all angles are as likely");
  if (!angles.empty()) p.orientation = spread_of(s, "orientation", angles);
  if (p.kind == GrainShape::polygon)
    p.corners = spread_of(
        s, "corners", s.numbers("corners", Range::between(3.0, 24.0), "least and largest number of corners"));
  else
    s.know({"corners"});
  if (p.kind == GrainShape::harmonics) {
    p.roughness = spread_of(
        s, "roughness",
        s.numbers("roughness", Range::between(0.0, 0.2).usually(0.0, 0.1), "least and largest D_3"));
    p.decay =
        s.number("decay", Range::between(1.0, 4.0), p.decay,
                 "exponent by which D_n = D_3 (n / 3)^-decay falls; 5/3 was measured on sands (Barclay and "
                 "Buckingham 2009)");
  } else {
    s.know({"roughness", "decay"});
  }
  return p;
}

specimen::AggregateParameters read_aggregates(const Section& s, const std::filesystem::path& folder,
                                              const DeckSpace& space) {
  specimen::AggregateParameters a;
  a.phase = s.text("phase", "aggregate", kPhase);
  s.know({"stones", "outlines", "grain_shape", "fraction", "minimum_gap", "attempts", "passing", "passing_by",
          "d_min", "d_max", "fuller_exponent", "sieves"});
  if (s.has("stones")) {
    if (space.is_solid())
      s.error("stones", "are circles of a plane; a solid cannot take stones from a list yet");
    read_stones(s, folder, a);
    return a;
  }
  if (s.has("outlines")) {
    if (space.is_solid()) s.error("outlines", "are lines in a plane; a solid cannot take them");
    read_outlines(s, folder, a);
    return a;
  }
  a.fraction =
      s.number("fraction", Range{.lower = 0.0, .upper = 1.0, .upper_inclusive = false}.usually(0.0, 0.5),
               "area of coarse aggregate over area of the specimen, in a solid volume over volume");
  a.place = fmt::format("{}: {}", s.where("fraction"), s.path());
  if (s.has("passing"))
    read_measured_grading(s, folder, space, a);
  else
    read_fuller_grading(s, a);
  if (const auto shape = s.optional_section(
          "grain_shape", "shapes of the grains; their size is the sieve that they pass, their width"))
    a.shape = read_shape(*shape, space);
  a.minimum_gap = s.quantity("minimum_gap", unit::length, Range::non_negative(),
                             "between two aggregates, and between an aggregate and the outline");
  a.attempts = read_attempts(s);
  return a;
}

/// Sets the fraction to the share of the specimen that known stones take.
void set_fraction(double area_of_specimen, specimen::AggregateParameters& a) {
  if (a.stones.empty()) return;
  double area = 0.0;
  for (const specimen::Stone& stone : a.stones) area += area_of(stone);
  a.fraction = area / area_of_specimen;
}

specimen::FibreParameters read_fibres(const Section& s) {
  specimen::FibreParameters f;
  f.phase = s.text("phase", "fibre", kPhase);
  f.count = static_cast<int>(s.integer("count", Range::between(0, 1e6), "number of fibres"));
  f.length = s.quantity("length", unit::length, Range::positive(), "of each fibre");
  f.minimum_gap = s.quantity("minimum_gap", unit::length, Range::non_negative(),
                             "between a fibre and aggregates, and between a fibre and the outline");
  f.attempts = read_attempts(s);
  f.place = fmt::format("{}: {}", s.where("count"), s.path());
  return f;
}

/// Records an error where the largest aggregate has no place, and warns where the specimen is only a few of
/// them wide.
void check_size(const Section& s, const AskedSpecimen& p) {
  const Vec<3> size = p.high() - p.low();
  double narrowest = size[0];
  for (int i = 1; i < p.dimension(); ++i) narrowest = std::min(narrowest, size[i]);
  const double largest = p.aggregates.d_max;
  if (p.aggregates.fraction == 0.0 || !p.aggregates.stones.empty()) return;
  if (largest + 2.0 * p.aggregates.minimum_gap > narrowest)
    s.error("d_max", fmt::format("with minimum_gap on both sides must be less than the specimen, {:.6g} m",
                                 narrowest));
  else if (kFewestAggregatesAcross * largest > narrowest)
    s.warn("d_max", fmt::format("the specimen is only {:.1f} times as wide, but usually at least {} times",
                                narrowest / largest, kFewestAggregatesAcross));
}

/// Statements of a deck on the outline, before the size of the blocks is known.
struct Outline {
  Shape shape;
  double width = 0.0, height = 0.0, diameter = 0.0, inner_diameter = 0.0;  ///< m
  double unit = 0.0;            ///< unit of the coordinates of a file, m
  std::vector<Vec<2>> corners;  ///< m
  struct Hole {
    std::string name;
    Vec<2> centre{};
    double diameter = 0.0;
    std::vector<Vec<2>> corners;
  };
  std::vector<Hole> holes;
  std::vector<specimen::Notch> notches;
  std::optional<specimen::Cells> cells;
  std::optional<solid::Polyhedra> polyhedra;
};

std::vector<Vec<2>> vecs(const std::vector<std::pair<double, double>>& places) {
  std::vector<Vec<2>> result;
  for (const auto& [x, y] : places) result.push_back({{x, y}});
  return result;
}

Vec<2> read_place(const Section& s, std::string_view key, Meaning meaning) {
  const auto [x, y] = s.place(key, unit::length, meaning).value_or(std::pair{0.0, 0.0});
  return {{x, y}};
}

/// Usual range of a specimen's lengths, m.
constexpr Range kSize = Range::positive().usually(0.01, 10.0);

/// Reads the file that holds all of a specimen; returns none after an error.
/// \param read  function that reads a file; throws Error
template <class Read>
auto read_blocks_file(const Section& s, const std::filesystem::path& folder, Read read)
    -> std::optional<decltype(read(folder))> {
  const std::string name = s.text("file",
                                  "of shape \"cells\" or \"polyhedra\": JSON with the blocks, see "
                                  "[Blocks made elsewhere](../do/bodies.md#blocks-made-elsewhere)");
  if (!s.has("file")) return std::nullopt;
  s.names_file("file", folder / name);
  try {
    return read(folder / name);
  } catch (const Error& error) {
    s.error("file", error.what());
    return std::nullopt;
  }
}

/// Reads all of a specimen of the plane from a file; returns none after an error.
std::optional<specimen::Cells> read_cells(const Section& s, const std::filesystem::path& folder) {
  const double join = s.quantity(
      "join", unit::length, Range::non_negative(), 0.0,
      "vertices of the file nearer to each other than this become one, and those nearer to an edge of "
      "a cell a corner of it; 0: cells share the vertices that the file says");
  return read_blocks_file(s, folder,
                          [join](const std::filesystem::path& file) { return cells_in_metres(file, join); });
}

/// Reads the unit of a file's coordinates, m; returns 0 after an error.
double read_unit(const Section& s) {
  const std::string name = s.text(
      "unit", "of length, of the coordinates in `blocks.file`: the specimen is as large as the file says");
  try {
    return metres_of(name);
  } catch (const Error& error) {
    s.error("unit", error.what());
    return 0.0;
  }
}

/// Records an error for each hole and notch of a solid.
void refuse_cuts(const Section& s) {
  for (const char* const cuts : {"holes", "notches"})
    if (s.has(cuts)) s.error(cuts, "cannot be made in a solid yet: its section must be convex and whole");
}

Outline read_outline(const Section& s, const std::filesystem::path& folder, const DeckSpace& space) {
  Outline o;
  o.shape = space.shape;
  if (o.shape == Shape::rectangle) {
    o.width = s.quantity("width", unit::length, kSize, "of the specimen");
    o.height = s.quantity("height", unit::length, kSize, "of the specimen");
  } else if (o.shape == Shape::polygon) {
    o.corners = vecs(s.places("corners", unit::length, 3, "of the specimen, in either sense"));
  } else if (o.shape == Shape::tessellation) {
    if (s.has("unit")) {
      o.unit = read_unit(s);
      s.know({"width"});
    } else {
      o.width = s.quantity("width", unit::length, kSize, "of the specimen; the height follows from the file");
    }
    s.know({"holes", "notches"});
  } else if (o.shape == Shape::cells) {
    o.cells = read_cells(s, folder);
    s.know({"seed", "holes", "notches"});
  } else if (o.shape == Shape::polyhedra) {
    o.polyhedra = read_blocks_file(
        s, folder, [](const std::filesystem::path& file) { return solid::read_polyhedra(file); });
    if (s.has("join")) s.error("join", "has no meaning here: faces share the vertices that the file says");
    s.know({"seed", "holes", "notches"});
  } else if (o.shape == Shape::cylinder) {
    o.diameter = s.quantity("diameter", unit::length, kSize, "of the specimen");
    o.height = s.quantity("height", unit::length, kSize, "of the specimen");
  } else {
    o.diameter = s.quantity("diameter", unit::length, kSize, "of the specimen");
    if (o.shape == Shape::ring) {
      o.inner_diameter = s.quantity("inner_diameter", unit::length, kSize, "of the bore");
      if (s.ok() && o.inner_diameter >= o.diameter) s.error("inner_diameter", "must be less than diameter");
    }
  }
  s.know({"width", "height", "corners", "diameter", "inner_diameter", "file", "join", "unit"});
  if (o.shape == Shape::cells || o.shape == Shape::polyhedra || o.shape == Shape::tessellation) return o;
  if (space.is_solid()) {
    refuse_cuts(s);
    return o;
  }
  int number = 0;
  for (const Section& h : s.optional_sections("holes", "holes in the specimen, any number")) {
    Outline::Hole hole;
    hole.name = h.text("name", fmt::format("hole_{}", ++number), "of its side");
    if (h.has("corners")) {
      hole.corners =
          vecs(h.places("corners", unit::length, 3, "of a hole that is not round, in either sense"));
      h.know({"centre", "diameter"});
    } else {
      hole.centre = read_place(h, "centre", "of a round hole");
      hole.diameter = h.quantity("diameter", unit::length, Range::positive(), "of a round hole");
    }
    o.holes.push_back(std::move(hole));
  }
  number = 0;
  for (const Section& n : s.optional_sections("notches", "straight cuts from the outline, any number")) {
    specimen::Notch notch;
    notch.place = fmt::format("{}: {}", n.where("width"), n.path());
    notch.name = n.text("name", fmt::format("notch_{}", ++number), "of its side");
    notch.mouth = read_place(n, "mouth", "where the notch begins, on the outline");
    notch.tip = read_place(n, "tip", "where the notch ends, in the specimen; a corner of blocks");
    notch.width =
        n.quantity("width", unit::length, Range::non_negative(), 0.0,
                   "of a slot, which ends in a point at the tip; 0: the blocks on both sides touch, and "
                   "nothing holds them together");
    o.notches.push_back(std::move(notch));
  }
  return o;
}

/// Circle of the outline.
struct Circle {
  Vec<2> centre{};
  double diameter = 0.0;
};

/// Largest distance of a seat from the circle on which it lies, in diameters.
constexpr double kOnCircle = 1e-3;
/// Largest distance of a corner of blocks from the side on which it lies, over that of a seat.
constexpr double kOnSide = 1e-6;

/// Returns half of the angle that a bearing covers on a circle, radians; none where the bearing lies
/// elsewhere.
std::optional<double> half_angle(const ReadBearing& b, const Circle& circle) {
  if (!b.at || std::abs(norm(*b.at - circle.centre) - 0.5 * circle.diameter) > kOnCircle * circle.diameter)
    return std::nullopt;
  return std::asin(std::min(1.0, b.width / circle.diameter));
}

double angle_on(const ReadBearing& b, const Circle& circle) {
  const Vec<2> from_centre = *b.at - circle.centre;
  return std::atan2(from_centre[1], from_centre[0]);
}

/// Returns the angles at which a circle must have corners, the ends of bearings, radians; one at least.
std::vector<double> angles_of(const Circle& circle, std::span<const ReadBearing> bearings) {
  std::vector<double> angles;
  for (const ReadBearing& b : bearings)
    if (const auto half = half_angle(b, circle))
      for (const double angle : {angle_on(b, circle) - *half, angle_on(b, circle) + *half})
        angles.push_back(angle < 0.0 ? angle + 2.0 * std::numbers::pi : angle);
  if (angles.empty()) angles.push_back(0.0);
  return angles;
}

/// Returns the ends of a bearing on a straight side, with the body on the left. Throws Error where the
/// bearing's middle is not on the outline.
/// \param corners  corners of blocks that are there already, of which the ends are the nearest; empty: the
///                 ends may be anywhere
std::array<Vec<2>, 2> ends_on_side(const specimen::Region& region, const ReadBearing& b,
                                   std::span<const Vec<2>> corners) {
  const auto& box = region.box();
  const double near = kOnCircle * std::max(box.width(), box.height());
  for (const specimen::Piece& piece : region.pieces()) {
    if (region.sides()[piece.side].is_round ||
        specimen::distance_from_segment(*b.at, piece.from, piece.to) > near)
      continue;
    const Vec<2> along = (piece.to - piece.from) * (1.0 / norm(piece.to - piece.from));
    const Vec<2> middle = piece.from + dot(*b.at - piece.from, along) * along;
    std::array<Vec<2>, 2> ends{middle - 0.5 * b.width * along, middle + 0.5 * b.width * along};
    if (!corners.empty())
      for (Vec<2>& end : ends)
        end = *std::ranges::min_element(corners, {}, [&](const Vec<2>& corner) {
          const bool is_on = specimen::distance_from_segment(corner, piece.from, piece.to) <= kOnSide * near;
          return is_on ? norm(corner - end) : std::numeric_limits<double>::infinity();
        });
    return ends;
  }
  throw Error(fmt::format("its middle ({:.6g}, {:.6g}) m is not on the outline", (*b.at)[0], (*b.at)[1]));
}

/// Returns the ends of a bearing on a circle: two of its corners.
std::array<Vec<2>, 2> ends_on_circle(const specimen::Region& region, const Circle& circle,
                                     const ReadBearing& b, double half) {
  std::array<Vec<2>, 2> ends;
  const double middle = angle_on(b, circle);
  const bool is_hole = region.distance(circle.centre) > 0.0;
  for (const int end : {0, 1}) {
    const double angle = middle + (end == 0 ? -half : half) * (is_hole ? -1.0 : 1.0);
    const Vec<2> at = circle.centre + 0.5 * circle.diameter * Vec<2>{{std::cos(angle), std::sin(angle)}};
    ends[end] = std::ranges::min_element(region.pieces(), {}, [&](const specimen::Piece& piece) {
                  return norm(piece.from - at);
                })->from;
  }
  return ends;
}

/// Returns the region with the seats of bearings as patches.
specimen::Region with_seats(const specimen::Region& region, std::span<const Circle> circles,
                            std::span<const ReadBearing> bearings, std::span<const Vec<2>> corners = {}) {
  std::vector<specimen::Patch> patches;
  for (const ReadBearing& b : bearings) {
    if (!b.at) continue;
    try {
      const auto circle =
          std::ranges::find_if(circles, [&](const Circle& c) { return half_angle(b, c).has_value(); });
      const auto [from, to] = circle == circles.end()
                                  ? ends_on_side(region, b, corners)
                                  : ends_on_circle(region, *circle, b, *half_angle(b, *circle));
      std::vector<specimen::Patch> more = patches;
      more.push_back({b.bearing.side, from, to});
      region.with_patches(more);
      patches = std::move(more);
    } catch (const Error& error) {
      b.section.error("at", error.what());
    }
  }
  return region.with_patches(patches);
}

/// Finer blocks as a deck asks for them: near a part that has a name, or near a place.
struct ReadFiner {
  Section section;
  specimen::FinerPart part;
};

/// Blocks as a deck asks for them: by their number, or by their size.
struct ReadBlocks {
  specimen::BlockParameters parameters;
  double size = 0.0;  ///< m; 0: their number is stated
  std::vector<ReadFiner> finer;

  /// Returns the size of a block in a specimen of this area, m.
  double size_in(double area) const {
    return size > 0.0 ? size : std::sqrt(area / std::max(1, parameters.count));
  }
  /// Returns the size of a block in a solid of this volume, m.
  double size_in_solid(double volume) const {
    return size > 0.0 ? size : std::cbrt(volume / std::max(1, parameters.count));
  }
};

/// Least number of sides of the polygon by which a solid has a circle.
constexpr double kFewestSides = 24.0;

/// Returns the corners of a circle, with sides about a block long.
/// \param sizes  sizes of blocks where they are finer in parts; else they are of `size`
template <class SizeAt>
std::vector<Vec<2>> corners_of(const Circle& circle, double size, const specimen::BlockSizes* sizes,
                               std::span<const ReadBearing> bearings, SizeAt size_at) {
  const auto angles = angles_of(circle, bearings);
  if (!sizes) return specimen::circle_corners(circle.centre, circle.diameter, size, angles);
  return specimen::circle_corners(circle.centre, circle.diameter, size_at, angles);
}

/// Round body of space.
struct RoundBody {
  Circle circle;
  solid::Prism::Axis axis;
  double length;  ///< m
};

/// Number of places along a round body at which it is asked for the size of blocks.
constexpr int kPlacesAlong = 64;

/// Returns a polygon of a circle's area, with the seats of bearings. Its sides are about as long as the
/// largest blocks along them: narrow strips of surface would make flat blocks.
specimen::Region round_section(const RoundBody& body, const ReadBlocks& read,
                               const specimen::BlockSizes* sizes, std::span<const ReadBearing> bearings) {
  const double diameter = body.circle.diameter, area = 0.25 * std::numbers::pi * diameter * diameter,
               longest = std::numbers::pi * diameter / kFewestSides;
  const auto side = [&](const Vec<2>& place) {
    double largest = 0.0;
    for (int i = 0; i < kPlacesAlong; ++i) {
      const double along = (i + 0.5) / kPlacesAlong * body.length;
      largest = std::max(largest, sizes->at(solid::in_space(place, body.axis, along)));
    }
    return std::min(largest, longest);
  };
  const double even = std::min(read.size_in_solid(area * body.length), longest);
  const auto rim =
      specimen::Region::polygon(corners_of(body.circle, even, sizes, bearings, side), {"rim"}, true);
  return with_seats(rim, std::array{body.circle}, bearings);
}

/// Returns the body of blocks that were made before. A disc has the seats of bearings, whose ends are corners
/// of its outline that are there already.
solid::Prism body_of(const solid::Polyhedra& polyhedra, std::span<const ReadBearing> bearings) {
  const solid::Prism& body = polyhedra.body;
  const specimen::Region& section = body.section();
  if (body.axis() != solid::Prism::Axis::z || !section.sides().front().is_round) return body;
  const Circle circle{0.5 * (section.box().low + section.box().high),
                      2.0 * std::sqrt(section.area() / std::numbers::pi)};
  return {with_seats(section, std::array{circle}, bearings), body.axis(), body.length()};
}

std::vector<std::string> side_names(std::size_t count) {
  std::vector<std::string> names;
  for (std::size_t i = 0; i < count; ++i) names.push_back(fmt::format("side_{}", i + 1));
  return names;
}

/// Returns the solid of a deck; a cube stands in for an error.
/// \param sizes  sizes of blocks where they are finer in parts
solid::Prism make_prism(const Section& s, const Outline& o, const DeckSpace& space, const ReadBlocks& read,
                        std::span<const ReadBearing> bearings, const specimen::BlockSizes* sizes = nullptr) {
  using enum solid::Prism::Axis;
  const solid::Prism stand_in(specimen::Region::rectangle(1.0, 1.0), z, 1.0);
  if (!s.ok()) return stand_in;
  try {
    if (o.polyhedra) return body_of(*o.polyhedra, bearings);
    if (o.shape == Shape::cylinder)
      return {round_section({{{}, o.diameter}, y, o.height}, read, sizes, {}), y, o.height};
    const double depth = *space.depth;
    if (o.shape == Shape::rectangle) return {specimen::Region::rectangle(o.width, o.height), z, depth};
    if (o.shape == Shape::polygon)
      return {specimen::Region::polygon(o.corners, side_names(o.corners.size())), z, depth};
    return {round_section({{{}, o.diameter}, z, depth}, read, sizes, bearings), z, depth};
  } catch (const Error& error) {
    if (o.shape == Shape::polygon)
      s.error("corners", error.what());
    else if (o.polyhedra)
      s.error("file", error.what());
    else
      s.error(error.what());
    return stand_in;
  }
}

/// Returns the region of a deck in the plane; a square stands in for an error.
/// \param sizes  sizes of blocks where they are finer in parts: circles have their sides about as long
specimen::Region make_region(const Section& s, const Outline& o, const ReadBlocks& read,
                             std::span<const ReadBearing> bearings,
                             const specimen::BlockSizes* sizes = nullptr) {
  const specimen::BlockParameters& blocks = read.parameters;
  const bool is_missing = o.shape == Shape::tessellation && !blocks.tessellation;  // an error already
  if (!s.ok() || is_missing) return specimen::Region::rectangle(1.0, 1.0);
  try {
    if (o.cells)
      return with_seats(specimen::outline_of(o.cells->tessellation), {}, bearings,
                        o.cells->tessellation.vertices);
    if (o.shape == Shape::tessellation)
      return with_seats(specimen::outline_of(*blocks.tessellation), {}, bearings,
                        blocks.tessellation->vertices);
    std::vector<Circle> circles;
    const auto round = [&](const Circle& circle, double size) {
      circles.push_back(circle);
      return corners_of(circle, size, sizes, bearings, [&](const Vec<2>& place) { return sizes->at(place); });
    };
    const double area =
        std::numbers::pi / 4.0 * (o.diameter * o.diameter - o.inner_diameter * o.inner_diameter);
    double size = read.size_in(area);
    specimen::Region region;
    if (o.shape == Shape::rectangle) {
      region = specimen::Region::rectangle(o.width, o.height);
    } else if (o.shape == Shape::polygon) {
      region = specimen::Region::polygon(o.corners, side_names(o.corners.size()));
    } else {
      region = specimen::Region::polygon(round({{}, o.diameter}, size), {"rim"}, true);
      if (o.shape == Shape::ring)
        region =
            region.with_holes(std::array{specimen::Hole{"bore", round({{}, o.inner_diameter}, size), true}});
    }
    size = read.size_in(region.area());
    std::vector<specimen::Hole> holes;
    for (const auto& hole : o.holes)
      holes.push_back(hole.corners.empty()
                          ? specimen::Hole{hole.name, round({hole.centre, hole.diameter}, size), true}
                          : specimen::Hole{hole.name, hole.corners, false});
    std::vector<specimen::Notch> notches = o.notches;
    for (specimen::Notch& n : notches)
      n.point = specimen::slot_point(n.length(), n.width, sizes ? sizes->at(n.tip) : size);
    region = with_seats(region.with_holes(holes).with_notches(notches), circles, bearings);
    if (blocks.count == 0 && read.size == 0.0 && !region.is_rectangle())
      s.error("shape",
              "with blocks.file must be \"rectangle\" or \"tessellation\", which is the outline of the file");
    return region;
  } catch (const Error& error) {
    if (o.cells)
      s.error("file", error.what());
    else
      s.error(error.what());
    return specimen::Region::rectangle(1.0, 1.0);
  }
}

/// Records an error for each bearing on a side that the specimen does not have.
void check_bearings(const AskedSpecimen& specimen, std::span<const ReadBearing> bearings) {
  const std::vector<std::string> sides = specimen.sides();
  std::vector<std::string> names = sides;
  if (specimen.prism)
    for (const specimen::Side& side : specimen.prism->section().sides())
      if (side.is_round) std::erase(names, side.name);  // no bearing of a solid lies on a bent side yet
  const auto has_seat = [&](const ReadBearing& b) {
    return std::ranges::find(sides, b.bearing.side) != sides.end();
  };
  for (const ReadBearing& b : bearings)
    if (b.at && specimen.prism && b.section.ok() && !has_seat(b))
      b.section.error("at",
                      fmt::format("a bearing on a part of a side can be made in a solid only on the rim of "
                                  "a disc yet; side = ... lays one on all of {}",
                                  fmt::join(names, ", ")));
  for (const ReadBearing& b : bearings) {
    if (!b.z || !specimen.prism || !b.section.ok()) continue;
    const double middle = 0.5 * (specimen.low()[2] + specimen.high()[2]);
    if (std::abs(*b.z - middle) > kOnCircle * (specimen.high()[2] - specimen.low()[2]))
      b.section.error("at",
                      fmt::format("a seat lies over all of the depth, so the z of its middle is {:g} m; got "
                                  "{:g} m",
                                  middle, *b.z));
  }
  for (std::size_t i = 0; i < bearings.size(); ++i)
    for (std::size_t j = 0; j < i; ++j)
      if (!bearings[i].at && !bearings[j].at && bearings[i].section.ok() &&
          bearings[i].bearing.side == bearings[j].bearing.side)
        bearings[i].section.error("side", fmt::format("the bearing \"{}\" lies on \"{}\" already",
                                                      bearings[j].bearing.name, bearings[j].bearing.side));
  for (const ReadBearing& b : bearings)
    if (!b.at && b.section.ok() && std::ranges::find(names, b.bearing.side) == names.end())
      b.section.error("side",
                      fmt::format("must be a{} side of the specimen, one of {}; got \"{}\"",
                                  specimen.prism ? " plane" : "", fmt::join(names, ", "), b.bearing.side));
}

std::vector<specimen::Inclusions> read_inclusions(const Section& root, const std::filesystem::path& folder,
                                                  const DeckSpace& space) {
  std::vector<specimen::Inclusions> list;
  for (const Section& s : root.optional_sections(
           "inclusions",
           "circles and fibres in the matrix beside [aggregates]; placed after these, in turn")) {
    enum class Kind { circle, fibre };
    const auto kind = s.choice<Kind>(
        "shape",
        {{"circle", Kind::circle,
          "circles, in a solid balls, with a gradation of their own: another aggregate, or pores"},
         {"fibre", Kind::fibre, "straight fibres: the blocks that one crosses are of its phase"}},
        "shape of the inclusions");
    if (kind == Kind::fibre && space.is_solid())
      s.error("shape", "fibres cannot be placed in a solid yet; \"circle\" makes balls");
    if (kind == Kind::circle)
      list.emplace_back(read_aggregates(s, folder, space));
    else
      list.emplace_back(read_fibres(s));
  }
  return list;
}

/// Reads the blocks of a Neper file; returns none after an error, or where the outline takes no such file.
std::optional<specimen::NeperTess> read_tessellation(const Section& blocks, const std::filesystem::path& file,
                                                     const Outline& outline) {
  try {
    if (outline.shape == Shape::rectangle && outline.width > 0.0 && outline.height > 0.0)
      return specimen::read_neper_tess(file, outline.width, outline.height);
    if (outline.shape == Shape::tessellation && (outline.width > 0.0 || outline.unit > 0.0))
      return specimen::read_neper_tess(file, {.width = outline.width, .unit = outline.unit});
  } catch (const Error& error) {
    blocks.error("file", error.what());
  }
  return std::nullopt;
}

/// Reads the groups of a Neper file as phases.
/// \param names       names of the phases, in the ascending order of the groups
/// \param is_covered  true where aggregates or inclusions say of which phase blocks are
void read_groups(const Section& s, const specimen::NeperTess& tess, const std::vector<std::string>& names,
                 bool is_covered, specimen::BlockParameters& b) {
  std::vector<int> groups = tess.group;
  std::ranges::sort(groups);
  groups.erase(std::unique(groups.begin(), groups.end()), groups.end());
  const std::string found =
      fmt::format("line {} of the file (*group) puts its cells into the group{} {}", tess.group_line,
                  groups.size() == 1 ? "" : "s", fmt::join(groups, ", "));
  if (!s.has("groups")) {
    if (groups.size() > 1 && is_covered)
      s.warn(
          "file",
          fmt::format("{}; they have no effect, as [aggregates] or [[inclusions]] give blocks their phases",
                      found));
    else if (groups.size() > 1)
      s.error("file", fmt::format("{}: groups = [...] must say which phase each is, with {} names", found,
                                  groups.size()));
    return;
  }
  if (groups.empty())
    s.error("groups", "has no meaning here: the file puts its cells into no groups (*group)");
  else if (is_covered)
    s.error("groups", "has no meaning beside [aggregates] or [[inclusions]], which give blocks their phases");
  else if (names.size() != groups.size())
    s.error("groups", fmt::format("{}, so {} name{} are needed, got {}", found, groups.size(),
                                  groups.size() == 1 ? "" : "s", names.size()));
  if (!s.ok()) return;
  for (const std::string& name : names)
    if (std::ranges::find(b.phases, name) == b.phases.end()) b.phases.push_back(name);
  for (const int group : tess.group) {
    const auto& name = names[std::ranges::lower_bound(groups, group) - groups.begin()];
    b.phase.push_back(static_cast<int>(std::ranges::find(b.phases, name) - b.phases.begin()));
  }
}

/// Reads which edges are removed, and how far that may bend the faces of a solid.
void read_regularity(const Section& s, const DeckSpace& space, specimen::BlockParameters& b) {
  constexpr Meaning kMeaning =
      "shorter edges are removed where the blocks allow it; as a fraction of the mean edge. In a solid it "
      "may "
      "be left out: 0 keeps all edges there";
  constexpr double kBend = std::numbers::pi / 9.0;
  constexpr std::string_view kKey = "largest_bend";
  const Range range = Range::between(0.0, 0.5);
  if (!space.is_solid()) {
    b.shortest_edge = s.number("shortest_edge", range, kMeaning);
    if (s.has(kKey)) s.error(kKey, "is for solids: blocks of the plane have straight edges");
    return;
  }
  b.shortest_edge = s.number("shortest_edge", range, 0.0, kMeaning);
  b.largest_bend = s.quantity(kKey, unit::angle, Range::between(0.0, specimen::kMostBend), kBend,
                              "of a solid: the removal of short edges bends no face between blocks by more, "
                              "so that no triangle of a face leaves the mean plane by a larger angle");
  if (s.has(kKey) && b.shortest_edge == 0.0)
    s.warn(kKey, "has no effect without shortest_edge: faces stay plane");
}

/// End of the name of a notch's tip.
constexpr const char* kTip = "_tip";

/// Reads [[blocks.finer]].
std::vector<ReadFiner> read_finer(const Section& blocks, const DeckSpace& space) {
  std::vector<ReadFiner> all;
  for (const Section& s : blocks.optional_sections("finer",
                                                   "parts near which blocks are finer, any number; see "
                                                   "[Finer blocks](../do/bodies.md#finer-blocks)")) {
    ReadFiner finer{s, {}};
    int stated = 0;
    for (const char* const key : {"near", "box", "line", "at"}) stated += s.has(key) ? 1 : 0;
    if (stated > 1) s.error("one of near, box, line and at; not several");
    s.know({"box", "line", "at"});
    if (s.has("box")) {
      const TwoPlaces box = read_two_places(s, "box", space,
                                            "lower left and upper right corner of a place near which blocks "
                                            "are finer; in a solid the lower one "
                                            "is in front, and pairs stand for all z");
      finer.part.box = box.places;
      finer.part.is_along_z = box.is_along_z;
      require_upright(s, "box", box);
    } else if (s.has("line")) {
      const TwoPlaces line = read_two_places(
          s, "line", space,
          "ends of a straight line near which blocks are finer; in a solid pairs stand for the plane through "
          "it along z");
      finer.part.pieces.push_back({line.places[0], line.places[1]});
      finer.part.is_along_z = line.is_along_z;
    } else if (s.has("at")) {
      const auto at = s.place("at", unit::length, space.of_extrusion(),
                              "a point near which blocks are finer; in a solid a pair stands for the line "
                              "through it along z");
      finer.part.pieces.push_back({vec_of(at.value_or(StatedPlace{}))});
      finer.part.is_along_z = space.is_solid() && at && !at->z;
    } else {
      finer.part.name = s.text(
          "near",
          "part near which blocks are finer: a side, hole, notch or bearing, the tip of a notch (its name "
          "and `_tip`), `outline`, or a set of the deck");
    }
    finer.part.size = s.quantity("size", unit::length, Range::positive(),
                                 "size of blocks there, the root of their area, in a solid of their volume; "
                                 "less than elsewhere");
    finer.part.distance = s.quantity(
        "distance", unit::length, Range::positive(),
        "distance up to which blocks have this size; beyond, each is larger than the one before by "
        "a fifth at most");
    all.push_back(std::move(finer));
  }
  return all;
}

ReadBlocks read_blocks(const Section& s, const std::filesystem::path& folder, const Outline& outline,
                       const DeckSpace& space, bool is_covered) {
  ReadBlocks read;
  specimen::BlockParameters& b = read.parameters;
  read_regularity(s, space, b);
  if (s.has("file") && space.is_solid())
    s.error("file", "holds cells of a plane; a solid makes its own blocks: count or size says how many");
  if (s.has("file")) {
    const std::filesystem::path file =
        folder /
        s.text("file", "Neper tessellation (.tess), beside the deck, that is read instead of making one");
    s.names_file("file", file);
    for (const char* const key : {"count", "size", "finer"})
      if (s.has(key)) s.error(key, "has no meaning beside file: the tessellation is read, not made");
    const std::vector<std::string> names = s.optional_texts(
        "groups",
        "phases of the groups that the file puts its cells into (`*group`), in the ascending "
        "order of their numbers; then nothing else gives blocks their phases");
    if (auto tess = read_tessellation(s, file, outline)) {
      read_groups(s, *tess, names, is_covered, b);
      b.tessellation = std::move(tess->tessellation);
    }
    return read;
  }
  s.know({"groups"});
  if (outline.shape == Shape::tessellation)
    s.error("file", "is needed where specimen.shape is \"tessellation\"");
  b.place = fmt::format("{}: {}", s.where(s.has("size") ? "size" : "count"), s.path());
  if (s.has("size")) {
    if (s.has("count"))
      s.error("count", "has no meaning beside size, from which the number of blocks follows");
    read.size = s.quantity(
        "size", unit::length, Range::positive(),
        "mean size of a block, the root of its area, in a solid of its volume, instead of `count`; far from "
        "finer blocks");
  } else {
    b.count = static_cast<int>(s.integer("count", kBlockCount, "number of blocks, with the finer ones"));
    const auto calibrated = s.integer("calibrated_count", Range::between(0.0, 1e8), 0,
                                      "number of blocks for which the strengths were calibrated, 0 where "
                                      "this is not known: `check` warns where `count` is another");
    if (calibrated > 0 && calibrated != b.count)
      s.warn("count",
             fmt::format("the strengths of this deck were calibrated for {} blocks; f_c depends on the "
                         "number of blocks (docs/validation/block_size.md): calibrate again",
                         calibrated));
  }
  b.relaxation =
      static_cast<int>(s.integer("relaxation", Range::between(0, 1000), 0,
                                 "iterations of Lloyd's relaxation; 0 leaves the seeds at random"));
  if (b.relaxation > 0 && space.is_solid())
    s.error("relaxation", "blocks of a solid cannot be relaxed yet: relaxation = 0");
  b.radius_spread = s.number("radius_spread", {.lower = 0.0, .upper = 1.0, .upper_inclusive = false}, 0.0,
                             "Laguerre radii are uniform within 1 ± radius_spread times half the mean "
                             "spacing; 0 makes a Voronoi tessellation");
  read.finer = read_finer(s, space);
  return read;
}

/// Returns a number of blocks that follows from their size. Records an error where it is out of range.
int count_in_range(const Section& blocks, double count) {
  count = std::round(count);
  if (kBlockCount.contains(count)) return static_cast<int>(count);
  blocks.error(
      "size", fmt::format("gives {:.6g} blocks, but their number must be {}", count, kBlockCount.describe()));
  return 0;
}

/// Returns the names of all parts near which blocks may be finer.
std::vector<std::string> parts_of(const AskedSpecimen& specimen, std::span<const ReadBearing> bearings,
                                  std::span<const SetParameters> sets) {
  std::vector<std::string> names{"outline"};
  const auto add = [&](const std::string& name) {
    if (std::ranges::find(names, name) == names.end()) names.push_back(name);
  };
  for (const std::string& side : specimen.sides()) add(side);
  for (const specimen::Notch& notch : specimen.region.notches()) {
    add(notch.name);
    add(notch.name + kTip);
  }
  for (const ReadBearing& b : bearings) add(b.bearing.name);
  for (const SetParameters& set : sets) add(set.name);
  return names;
}

/// Returns a piece of the plane, of one place or two.
specimen::FinerPiece piece_of(const Vec<2>& from, const Vec<2>& to) {
  return {resized<3>(from), resized<3>(to)};
}

/// Adds the pieces of a body's surface that are of a side, or the whole surface, "outline".
void add_side(const AskedSpecimen& specimen, const std::string& name, specimen::FinerPart& part) {
  const bool is_all = name == "outline";
  if (specimen.prism) {
    const solid::Prism& prism = *specimen.prism;
    for (std::size_t plane = 0; plane < prism.planes().size(); ++plane)
      for (int side = prism.planes()[plane].side; side >= 0; side = prism.whole_of(side))
        if (is_all || prism.sides()[side] == name) {
          part.pieces.push_back(prism.corners_on(plane));
          break;
        }
    return;
  }
  const auto& sides = specimen.region.sides();
  for (const specimen::Piece& piece : specimen.region.pieces())
    for (int side = piece.side; side >= 0; side = sides[side].part_of)
      if (is_all || sides[side].name == name) {
        part.pieces.push_back(piece_of(piece.from, piece.to));
        break;
      }
}

/// Gives finer blocks the place of a part by its name. A set without a place has that of the set that it lies
/// within. Records an error where there is none.
void find_part(const AskedSpecimen& specimen, std::span<const ReadBearing> bearings,
               std::span<const SetParameters> sets, std::string name, ReadFiner& finer) {
  specimen::FinerPart& part = finer.part;
  if (const auto set = std::ranges::find(sets, name, &SetParameters::name); set != sets.end()) {
    const auto before = sets.first(static_cast<std::size_t>(set - sets.begin()));
    bool has_place = true;
    part.is_along_z = set->is_along_z;
    std::visit(Overloaded{[&](const InBox& in) {
                            part.box = {in.low, in.high};
                          },
                          [&](const InBall& in) {
                            part.pieces.push_back({in.centre});
                            part.distance += in.radius;
                          },
                          [&](const OnLine& on) {
                            part.pieces.push_back({on.from, on.to});
                          },
                          [&](const NearestTo& to) { part.pieces.push_back({to.point}); },
                          [&](const Everywhere&) { has_place = false; }},
               set->place);
    if (!has_place) find_part(specimen, bearings, before, set->within, finer);
    return;
  }
  if (const auto b = std::ranges::find(bearings, name, [](const ReadBearing& r) { return r.bearing.name; });
      b != bearings.end())
    name = b->bearing.side;
  add_side(specimen, name, part);
  for (const specimen::Notch& notch : specimen.region.notches()) {
    if (notch.name == name) part.pieces.push_back(piece_of(notch.mouth, notch.tip));
    if (notch.name + kTip == name) part.pieces.push_back({resized<3>(notch.tip)});
  }
  if (!part.pieces.empty()) return;
  const std::vector<std::string> names = parts_of(specimen, bearings, sets);
  finer.section.error("near", fmt::format("must be one of {}; got \"{}\"{}", quoted_list(names), part.name,
                                          did_you_mean(part.name, names, "; ")));
}

/// Finds the number of all blocks, or the size of those far from finer ones. Records an error where blocks
/// are too few.
template <int Dim>
void find_sizes(const Section& blocks, const specimen::Room<Dim>& body, double size,
                specimen::BlockParameters& b) {
  const specimen::SizedExtent<Dim> extent(body, b.finer);
  if (size > 0.0) {
    b.largest_size = size;
    b.count = count_in_range(blocks, extent.blocks(size));
    return;
  }
  const auto largest = extent.largest_for(b.count);
  if (!largest)
    blocks.error("count",
                 fmt::format("the finer blocks, and those that grow from them by a fifth from block to "
                             "block, are {:.0f} already: take more, or a smaller distance",
                             extent.blocks(std::numeric_limits<double>::infinity())));
  b.largest_size = largest.value_or(0.0);
}

/// Makes blocks finer in parts: finds the places of these, and the number of all blocks, or the size of those
/// far from them. Tells whether it could; records an error where blocks do not become finer, or are too few.
bool make_finer(const Section& blocks, ReadBlocks& read, std::span<const ReadBearing> bearings,
                std::span<const SetParameters> sets, const AskedSpecimen& p) {
  specimen::BlockParameters& b = read.parameters;
  for (ReadFiner& finer : read.finer) {
    if (!finer.part.name.empty()) find_part(p, bearings, sets, finer.part.name, finer);
    b.finer.push_back(finer.part);
  }
  const auto all_ok = [&] {
    return blocks.ok() &&
           std::ranges::all_of(read.finer, [](const ReadFiner& finer) { return finer.section.ok(); });
  };
  if (!all_ok()) return false;
  if (p.prism)
    find_sizes(blocks, solid::room_in(*p.prism), read.size, b);
  else
    find_sizes(blocks, specimen::room_of_blocks(p.region), read.size, b);
  for (const ReadFiner& finer : read.finer)
    if (blocks.ok() && finer.part.size >= b.largest_size)
      finer.section.error(
          "size",
          fmt::format("must be less than the size of the other blocks, {:.4g} mm{}; got {:.4g} mm",
                      1e3 * b.largest_size, read.size > 0.0 ? "" : ", which follows from blocks.count",
                      1e3 * finer.part.size));
  return all_ok();
}

/// Returns the number of blocks of a size. Records an error where it is out of range.
int count_of(const Section& blocks, const AskedSpecimen& specimen, double size) {
  return count_in_range(blocks, specimen.extent() / std::pow(size, specimen.dimension()));
}

/// Reads [superposition] where nothing is superposed. Tells whether the deck has this table.
bool read_matrix_alone(const Section& root, specimen::SpecimenParameters& p) {
  const auto superposition = root.optional_section("superposition", kSuperposition);
  if (!superposition) return false;
  superposition->know({"rule", "covered_fraction"});
  p.matrix = superposition->text("matrix", p.matrix, kMatrix);
  return true;
}

/// Records an error unless the matrix is one of the phases that cells have. A phase that is the only one
/// becomes the matrix where the deck has no [superposition].
void check_matrix(const Section& s, std::string_view key, const std::vector<std::string>& phases,
                  bool has_matrix, specimen::SpecimenParameters& p) {
  if (phases.size() == 1 && !has_matrix) p.matrix = phases.front();
  if (std::ranges::find(phases, p.matrix) == phases.end())
    s.error(key, fmt::format("its phases are {}, and none is the matrix, \"{}\": [superposition] matrix "
                             "says which is",
                             fmt::join(phases, ", "), p.matrix));
}

/// Warns of an outline that is not as large as specimens usually are, unless a key has warned already.
void check_outline(const Section& s, const Outline& outline, const AskedSpecimen& specimen) {
  if (!s.ok()) return;
  const auto key = [&]() -> std::string_view {
    switch (outline.shape) {
      case Shape::polygon:
        return "corners";
      case Shape::tessellation:
        return outline.unit > 0.0 ? "unit" : "width";
      case Shape::cells:
      case Shape::polyhedra:
        return "file";
      default:
        return {};
    }
  }();
  const Vec<3> size = specimen.high() - specimen.low();
  const double width = size[0], height = size[1];
  const bool is_told =
      outline.shape == Shape::tessellation && !kSize.is_usual(outline.width) && outline.unit == 0.0;
  if (key.empty() || is_told || (kSize.is_usual(width) && kSize.is_usual(height))) return;
  s.warn(key, fmt::format("the outline is {:.6g} m wide and {:.6g} m high, but usual are {}{}", width, height,
                          kSize.describe_usual("m"),
                          outline.shape == Shape::cells
                              ? "; are the coordinates in another unit? `vertices_mm` in the file says so"
                              : ""));
}

/// Reads the rest of a specimen whose cells are given. The tables from which cells are made otherwise have no
/// effect.
void read_beside_cells(const Section& root, const Section& s, const DeckSpace& space,
                       std::span<const ReadBearing> bearings, Outline outline, AskedSpecimen& p) {
  root.know({"aggregates", "inclusions", "blocks"});
  if (space.is_solid())
    p.prism = make_prism(s, outline, space, {}, bearings);
  else
    p.region = make_region(s, outline, {}, bearings);
  const bool has_matrix = read_matrix_alone(root, p);
  if (outline.polyhedra && s.ok()) {
    p.blocks.count = static_cast<int>(outline.polyhedra->complex.cells.size());
    p.blocks.phases = outline.polyhedra->phases;
    check_outline(s, outline, p);
    check_matrix(s, "file", p.blocks.phases, has_matrix, p);
    p.polyhedra = std::move(outline.polyhedra);
  }
  if (!outline.cells || !s.ok()) return;
  p.blocks.count = static_cast<int>(outline.cells->tessellation.cells.size());
  check_outline(s, outline, p);
  check_matrix(s, "file", outline.cells->phases, has_matrix, p);
  p.cells = std::move(outline.cells);
}

/// Records an error where a phase has the name of a bearing's solid.
void check_phases(const Section& s, const specimen::SpecimenParameters& p,
                  std::span<const ReadBearing> bearings) {
  for (const auto& phase : specimen::phases(p))
    if (phase == "platen" ||
        std::ranges::any_of(bearings, [&](const ReadBearing& b) { return b.bearing.material == phase; }))
      s.error(fmt::format("\"{}\" is the material of a bearing; a phase needs another name", phase));
}

/// Returns the phase of the first of these inclusions.
std::string first_phase(const specimen::Inclusions& inclusions) {
  if (const auto* fibres = std::get_if<specimen::FibreParameters>(&inclusions)) return fibres->phase;
  const auto& circles = std::get<specimen::AggregateParameters>(inclusions);
  return circles.stones.empty() ? circles.phase : circles.stones.front().phase;
}

}  // namespace

AskedSpecimen read_specimen(const Section& root, const std::filesystem::path& folder, const DeckSpace& space,
                            std::span<const SetParameters> sets, std::span<const ReadBearing> bearings) {
  AskedSpecimen p;
  const Section s = root.section("specimen");
  Outline outline = read_outline(s, folder, space);
  if (outline.shape == Shape::cells || outline.shape == Shape::polyhedra) {
    read_beside_cells(root, s, space, bearings, std::move(outline), p);
    if (s.ok()) check_bearings(p, bearings);
    check_phases(s, p, bearings);
    return p;
  }
  p.seed = static_cast<std::uint64_t>(
      s.integer("seed", Range::between(0, static_cast<double>(specimen::kLargestSeed)),
                "of the random numbers; the same seed gives the same specimen"));
  const auto aggregates = root.optional_section(
      "aggregates",
      "coarse aggregates, placed as circles, in a solid as balls, with diameters after "
      "Fuller's curve P(d) = (d / d_max)^fuller_exponent, Eq. (16); without this table there are none");
  if (aggregates) p.aggregates = read_aggregates(*aggregates, folder, space);
  p.inclusions = read_inclusions(root, folder, space);
  const Section blocks = root.section("blocks", "the tessellation into blocks");
  ReadBlocks read = read_blocks(blocks, folder, outline, space, aggregates || !p.inclusions.empty());
  const auto make_body = [&](const specimen::BlockSizes* sizes) {
    if (space.is_solid())
      p.prism = make_prism(s, outline, space, read, bearings, sizes);
    else
      p.region = make_region(s, outline, read, bearings, sizes);
  };
  make_body(nullptr);
  if (!read.finer.empty() && s.ok() && blocks.ok()) {
    if (make_finer(blocks, read, bearings, sets, p)) {
      const auto& [count, finer, largest] =
          std::tie(read.parameters.count, read.parameters.finer, read.parameters.largest_size);
      const specimen::BlockSizes sizes(std::pow(p.extent() / count, 1.0 / p.dimension()), largest, finer);
      make_body(&sizes);
    } else {
      read.parameters.finer.clear();
    }
  }
  p.blocks = std::move(read.parameters);
  if (read.size > 0.0 && p.blocks.count == 0 && s.ok() && blocks.ok())
    p.blocks.count = count_of(blocks, p, read.size);
  check_outline(s, outline, p);
  set_fraction(p.extent(), p.aggregates);
  for (specimen::Inclusions& kind : p.inclusions)
    if (auto* circles = std::get_if<specimen::AggregateParameters>(&kind)) set_fraction(p.extent(), *circles);
  if (s.ok()) check_bearings(p, bearings);
  if (s.ok() && aggregates && aggregates->ok()) check_size(*aggregates, p);
  if (!aggregates && p.inclusions.empty()) {
    const bool has_matrix = read_matrix_alone(root, p);
    if (!p.blocks.phases.empty()) check_matrix(blocks, "groups", p.blocks.phases, has_matrix, p);
    p.aggregates.phase = p.matrix;
    check_phases(s, p, bearings);
    return p;
  }
  const Section superposition = root.section("superposition", kSuperposition);
  if (!aggregates) p.aggregates.phase = first_phase(p.inclusions.front());
  p.matrix = superposition.text("matrix", p.matrix, kMatrix);
  check_phases(superposition, p, bearings);
  p.superposition = superposition.choice<specimen::Superposition>(
      "rule",
      {{"area", specimen::Superposition::area,
        "circles, or balls, cover more than covered_fraction of the block"},
       {"fit", specimen::Superposition::fit,
        "the same with the fraction by which the blocks take the area of the circles; in a solid each ball "
        "has a block first"},
       {"centroid", specimen::Superposition::centroid, "the block's centroid lies in a circle"},
       {"follow", specimen::Superposition::follow,
        "nothing is superposed: edges of blocks follow the surfaces of the grains, "
        "see [Grains](../do/bodies.md#grains)"}},
      "when a block is aggregate");
  if (p.superposition == specimen::Superposition::follow) {
    if (space.is_solid())
      superposition.error(
          "rule", "\"follow\" is for bodies of the plane: blocks of a solid cannot follow grains yet");
    if (p.blocks.tessellation)
      superposition.error("rule", "\"follow\" has no meaning beside blocks.file: those blocks are made");
  }
  if (p.superposition == specimen::Superposition::area)
    p.covered_fraction =
        superposition.number("covered_fraction", {.lower = 0.0, .upper = 1.0, .upper_inclusive = false},
                             "share of a block above which circles make it aggregate");
  else
    superposition.know({"covered_fraction"});
  return p;
}

}  // namespace pyroclast
