#include "pyroclast/setup/read_aggregates.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <functional>
#include <numbers>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>

#include <fmt/format.h>

#include "pyroclast/base/error.hpp"
#include "pyroclast/setup/sieve_curve.hpp"
#include "pyroclast/specimen/gradation.hpp"
#include "pyroclast/specimen/grading_curve.hpp"
#include "pyroclast/specimen/outline.hpp"
#include "pyroclast/specimen/stone.hpp"
#include "pyroclast/specimen/stones_file.hpp"
#include "pyroclast/tables/measured_table.hpp"
#include "pyroclast/tables/read_choice.hpp"

namespace pyroclast {

namespace {

/// Number of random places that are tried for one aggregate or fibre, where the deck states none.
constexpr int kPlacementAttempts = 100'000;

/// Smallest side of a test specimen over the largest aggregate (EN 12390-1 asks for 3.5).
constexpr double kFewestAggregatesAcross = 3.0;

constexpr Meaning kPhase = "their material, a table of [materials]";

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
/// \param others  quantities that a column may say but none of those asked for
std::optional<NamedTable> read_named_table(const Section& s, const std::filesystem::path& folder,
                                           std::span<const AskedColumn> asked, const ColumnMeanings& others) {
  const auto least = static_cast<std::size_t>(std::ranges::count(asked, false, &AskedColumn::is_optional));
  const std::string file = s.text("csv", "[measured table](measured-tables.md) beside the deck");
  const ColumnChoice choice = read_column_choice(s, file, least, asked.size());
  if (!s.ok() || !s.has("csv")) return std::nullopt;
  try {
    MeasuredTable table = MeasuredTable::open(folder / file, least);
    auto columns = table.choose(choice, asked, others);
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
  const char* wrong = "csv";
  const Section* at = &s;
  std::optional<Section> named;
  try {
    if (s.is_table("passing")) {
      named = s.section("passing", "a sieve analysis: sizes, and the shares that pass");
      at = &*named;
      const std::string file = named->text("csv", "[measured table](measured-tables.md) beside the deck");
      const ColumnChoice choice = read_column_choice(*named, file, kSieveColumns, kSieveColumns);
      if (!named->ok() || file.empty()) return std::nullopt;
      const auto curve = sieve_curve(MeasuredTable::open(folder / file, kSieveColumns), choice);
      named->names_file("csv", folder / file);
      return curve;
    }
    wrong = "passing";
    specimen::GradingCurve curve;
    for (const auto& [size, share] : s.points("passing", unit::length, unit::dimensionless, "")) {
      curve.sizes.push_back(size);
      curve.shares.push_back(share);
    }
    if (!s.ok() || curve.sizes.empty()) return std::nullopt;
    return checked_curve(std::move(curve));
  } catch (const Error& error) {
    at->error(wrong, error.what());
    return std::nullopt;
  }
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
  a.fuller_exponent = s.number("fuller_exponent",
                               Range{.lower = 0.0, .upper = 1.0, .lower_inclusive = false}.usually(0.2, 1.0),
                               "of Fuller's curve");
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

template <int Dim>
double extent_of(const specimen::KnownStone<Dim>& stone) {
  return stone.shape ? stone.shape->extent() : specimen::extent_of_round<Dim>(stone.diameter);
}

/// Sets the gradation to that of stones that are known, and keeps these.
template <int Dim>
void set_known(std::vector<specimen::KnownStone<Dim>> stones, specimen::AggregateParameters& a) {
  std::vector<std::pair<double, double>> sizes;  // diameter and extent
  for (const auto& stone : stones) sizes.emplace_back(stone.diameter, extent_of(stone));
  std::ranges::stable_sort(sizes, {}, &std::pair<double, double>::first);
  double passed = 0.0;
  for (const auto& [size, extent] : sizes) {
    passed += extent;
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
  a.stones = std::move(stones);
}

/// Columns of a table of stones, the last for the number of the phase, which may be missing.
using StoneColumns = std::vector<AskedColumn>;

/// Function that returns the place of a row in its file.
using PlaceOfRow = std::function<std::string(std::size_t row)>;

AskedColumn phase_column() {
  return {"phase", unit::dimensionless, {{&meaning::phase}}, true};
}

/// Reads stones that are known, from a table as a run writes it.
/// \param add  function of the values by column, the first row of a stone, and a function that returns the
///             place of a row; returns the stone without its phase, and the row behind the stone
template <int Dim, class Add>
void read_known_stones(const Section& s, const std::filesystem::path& folder, const StoneColumns& asked,
                       specimen::AggregateParameters& a, Add add) {
  const std::size_t without_phase = asked.size() - 1;
  const auto read = read_named_table(
      s, folder, asked,
      Dim == 2
          ? ColumnMeanings{&meaning::z, &meaning::diameter, &meaning::radius, &meaning::area, &meaning::grain}
          : ColumnMeanings{&meaning::diameter, &meaning::radius, &meaning::area, &meaning::grain});
  auto phases = s.optional_texts("phases",
                                 "names of the phases, by their numbers from 0; without them all stones "
                                 "are of number 0, and of `phase`");
  if (phases.empty()) phases = {a.phase};
  if (!read || !s.ok()) return;
  a.place = fmt::format("{}: {}", s.where("csv"), s.path());
  std::vector<specimen::KnownStone<Dim>> stones;
  try {
    std::vector<std::vector<double>> values;  // by column
    for (std::size_t i = 0; i < read->columns.size(); ++i)
      values.push_back(read->table.values(read->columns[i], asked[i].unit));
    const PlaceOfRow place_of = [&table = read->table](std::size_t row) {
      return fmt::format("{}:{}", table.path().string(), table.line(row));
    };
    for (std::size_t row = 0; row < values[0].size();) {
      const std::string place = place_of(row);
      const double phase = values.size() > without_phase ? values[without_phase][row] : 0.0;
      auto [stone, end] = add(values, row, place_of);
      if (!(phase >= 0.0 && phase < static_cast<double>(phases.size()) && phase == std::floor(phase)))
        throw Error(fmt::format("{}: the phase {:.6g} has no name: `phases` names 0 to {}", place, phase,
                                phases.size() - 1));
      stone.phase = phases[static_cast<std::size_t>(phase)];
      stone.place = place;
      stones.push_back(std::move(stone));
      row = end;
    }
  } catch (const Error& error) {
    s.error("csv", error.what());
    return;
  }
  set_known(std::move(stones), a);
}

using Columns = std::vector<std::vector<double>>;
template <int Dim>
using StoneAndEnd = std::pair<specimen::KnownStone<Dim>, std::size_t>;

template <int Dim>
void read_stones(const Section& s, const std::filesystem::path& folder, specimen::AggregateParameters& a) {
  const Section own = s.section("stones",
                                "places and diameters of all circles, in a solid of balls, in the place of a "
                                "grading: `specimen/aggregates.csv` of a run, or a table of x, y, in a solid "
                                "z, diameter or radius, and the number of a phase or none");
  StoneColumns asked{{"x", unit::length, {{&meaning::x}}}, {"y", unit::length, {{&meaning::y}}}};
  if (Dim == 3) asked.push_back({"z", unit::length, {{&meaning::z}}});
  asked.push_back({"diameter", unit::length, {{&meaning::diameter}, {&meaning::radius, 2.0}}});
  asked.push_back(phase_column());
  read_known_stones<Dim>(
      own, folder, asked, a, [](const Columns& values, std::size_t row, const PlaceOfRow& place_of) {
        if (!(values[Dim][row] > 0.0))
          throw Error(fmt::format("{}: the diameter must be greater than 0", place_of(row)));
        Vec<Dim> centre;
        for (int d = 0; d < Dim; ++d) centre[d] = values[d][row];
        return StoneAndEnd<Dim>{{centre, values[Dim][row], {}, {}}, row + 1};
      });
}

/// Reads the surfaces of stones in space that are known.
void read_surfaces(const Section& s, const std::filesystem::path& folder, specimen::AggregateParameters& a) {
  const Section own = s.section(
      "surfaces",
      "surfaces of all stones of a solid, in the place of a grading: `specimen/stones.obj` of a run, or a "
      "file "
      "in the Wavefront format; each object (line o) is a stone of the phase that its line usemtl names");
  const std::string file = own.text("obj", "file beside the deck");
  const double length = own.quantity("unit", unit::length, Range::positive().usually(1e-6, 1.0), 1.0,
                                     "length of 1 in the file, \"1 m\" without this key");
  if (!own.ok() || !own.has("obj")) return;
  a.place = fmt::format("{}: {}", own.where("obj"), own.path());
  try {
    auto stones = specimen::read_stones_obj(folder / file, length, a.phase);
    own.names_file("obj", folder / file);
    set_known(std::move(stones), a);
  } catch (const Error& error) {
    own.error("obj", error.what());
  }
}

/// Reads outlines that are known: points of the outline of each stone, in turn.
void read_outlines(const Section& s, const std::filesystem::path& folder, specimen::AggregateParameters& a) {
  const Section own =
      s.section("outlines",
                "outlines of all stones, in the place of a grading: `specimen/outlines.csv` of a "
                "run, or a table of the number of the stone, x, y of a point of its outline, and "
                "the number of a phase or none; points of a stone follow each other, and the last may repeat "
                "the first");
  const StoneColumns asked{{"grain", unit::dimensionless, {{&meaning::grain}, {&meaning::index}}},
                           {"x", unit::length, {{&meaning::x}}},
                           {"y", unit::length, {{&meaning::y}}},
                           phase_column()};
  read_known_stones<2>(own, folder, asked, a,
                       [](const Columns& values, std::size_t row, const PlaceOfRow& place_of) {
                         std::vector<Vec<2>> points;
                         std::size_t end = row;
                         for (; end < values[0].size() && values[0][end] == values[0][row]; ++end)
                           points.push_back({{values[1][end], values[2][end]}});
                         if (const auto repeated = specimen::repeated_corner(points))
                           throw Error(fmt::format("{}: the point repeats the one before: leave the row out",
                                                   place_of(row + *repeated)));
                         try {
                           const auto [outline, centre] = specimen::outline_around(points);
                           return StoneAndEnd<2>{{centre, outline->width(), {}, {}, outline}, end};
                         } catch (const Error& error) {
                           throw Error(fmt::format("{}: {}", place_of(row), error.what()));
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
  using specimen::StoneShape;
  specimen::ShapeParameters p;
  p.kind = s.choice<StoneShape>(
      "kind",
      {{"ellipse", StoneShape::ellipse, "an ellipse, in a solid an ellipsoid"},
       {"polygon", StoneShape::polygon,
        "a convex polygon with corners at random on an ellipse, in a solid a polyhedron with corners on an "
        "ellipsoid"},
       {"harmonics", StoneShape::harmonics,
        "r = 1 + sum D_n cos(n angle + phase_n) with n from 3 to 12, drawn out to its elongation; in a solid "
        "with spherical harmonics of these degrees"}},
      "shape of the stones; without this table they are circles, in a solid balls");
  p.elongation = spread_of(s, "elongation",
                           s.numbers("elongation", Range::between(1.0, 5.0).usually(1.0, 2.5),
                                     "least and largest length over width of the ellipse, or ellipsoid"));
  if (s.has("flatness")) {
    if (!space.is_solid())
      s.error("flatness", "is width over thickness of stones of a solid; those of a plane have elongation");
    p.flatness = spread_of(s, "flatness",
                           s.numbers("flatness", Range::between(1.0, 5.0).usually(1.0, 2.5),
                                     "least and largest width over thickness in a solid; without this key "
                                     "stones are as thick as wide"));
  }
  s.know({"flatness"});
  const double turn = 2.0 * std::numbers::pi;
  const auto angles = s.optional_quantities(
      "orientation", unit::angle, Range::between(-turn, turn),
      "least and largest angle of the length from the x axis; without this key all angles are as likely, and "
      "stones of a solid are always turned at random");
  if (!angles.empty() && space.is_solid())
    s.error("orientation", "stones of a solid are turned at random: leave the key out");
  if (!angles.empty()) p.orientation = spread_of(s, "orientation", angles);
  if (p.kind == StoneShape::polygon)
    p.corners = spread_of(s, "corners",
                          s.numbers("corners", Range::between(space.is_solid() ? 4.0 : 3.0, 24.0),
                                    "least and largest number of corners; in a solid from 4 on"));
  else
    s.know({"corners"});
  if (p.kind == StoneShape::harmonics) {
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

}  // namespace

specimen::AggregateParameters read_aggregates(const Section& s, const std::filesystem::path& folder,
                                              const DeckSpace& space) {
  specimen::AggregateParameters a;
  a.phase = s.text("phase", "aggregate", kPhase);
  s.know({"stones", "outlines", "surfaces", "grain_shape", "fraction", "minimum_gap", "attempts", "passing",
          "passing_by", "d_min", "d_max", "fuller_exponent", "sieves"});
  if (s.has("stones")) {
    if (space.is_solid())
      read_stones<3>(s, folder, a);
    else
      read_stones<2>(s, folder, a);
    return a;
  }
  if (s.has("surfaces")) {
    if (!space.is_solid()) s.error("surfaces", "are of stones in space; a plane takes outlines");
    read_surfaces(s, folder, a);
    return a;
  }
  if (s.has("outlines")) {
    if (space.is_solid()) s.error("outlines", "are lines in a plane; a solid takes surfaces");
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
          "grain_shape", "shapes of the stones; their size is the sieve that they pass, their width"))
    a.shape = read_shape(*shape, space);
  a.minimum_gap = s.quantity("minimum_gap", unit::length, Range::non_negative(),
                             "between two aggregates, and between an aggregate and the outline");
  a.attempts = read_attempts(s);
  return a;
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
    if (kind == Kind::circle)
      list.emplace_back(read_aggregates(s, folder, space));
    else
      list.emplace_back(read_fibres(s));
  }
  return list;
}

void set_fraction(double extent_of_specimen, specimen::AggregateParameters& a) {
  if (!a.are_known()) return;
  double extent = 0.0;
  std::visit(
      [&](const auto& list) {
        for (const auto& stone : list) extent += extent_of(stone);
      },
      a.stones);
  a.fraction = extent / extent_of_specimen;
}

void check_size(const Section& s, const specimen::SpecimenParameters& p) {
  const Vec<3> size = p.high() - p.low();
  double narrowest = size[0];
  for (int i = 1; i < p.dimension(); ++i) narrowest = std::min(narrowest, size[i]);
  const double largest = p.aggregates.d_max;
  if (p.aggregates.fraction == 0.0 || p.aggregates.are_known()) return;
  if (largest + 2.0 * p.aggregates.minimum_gap > narrowest)
    s.error("d_max", fmt::format("with minimum_gap on both sides must be less than the specimen, {:.6g} m",
                                 narrowest));
  else if (kFewestAggregatesAcross * largest > (1.0 + 1e-9) * narrowest)  // 3 x 25 mm are in 75 mm
    s.warn("d_max", fmt::format("the specimen is only {:.1f} times as wide, but usually at least {} times",
                                narrowest / largest, kFewestAggregatesAcross));
}

}  // namespace pyroclast
