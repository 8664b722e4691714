#include "pyroclast/setup/read_references.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

#include "pyroclast/base/error.hpp"
#include "pyroclast/base/nearest.hpp"
#include "pyroclast/setup/setup.hpp"
#include "pyroclast/tables/measured_table.hpp"
#include "pyroclast/tables/read_choice.hpp"

namespace pyroclast {

namespace {

constexpr double kMega = 1e6;
constexpr double kMostStrain = 0.1;  ///< largest strain; a number beyond it is most likely in another unit
constexpr double kMostStress = 1e9;  ///< largest stress likewise, Pa
constexpr std::size_t kLeastRows = 2;
constexpr std::size_t kCurveColumns = 2, kRangeColumns = 3;

/// Quantity that figures of a run draw, and the quantities over which they draw it. The first of these stands
/// where the deck names none.
struct Drawn {
  DrawnQuantity of;
  std::vector<DrawnQuantity> over;
  DrawnRows rows;
};

const DrawnQuantity& mean_temperature() {
  static const DrawnQuantity it{"temperature", "temperature_degC", &unit::temperature};
  return it;
}

const DrawnQuantity& heating_time() {
  static const DrawnQuantity it{"heating_time", "heating_time_s", &unit::time};
  return it;
}

DrawnQuantity quantity_of(const RecordParameters& record) {
  return {record.name, column_of(record).name, &unit_of(record.kind), column_over_si(record.kind)};
}

/// Returns the record over which others are drawn: the first opening, else the first displacement, else null,
/// which stands for time.
const RecordParameters* abscissa(const std::vector<RecordParameters>& records) {
  for (const RecordKind kind : {RecordKind::opening, RecordKind::displacement})
    if (const auto found = std::ranges::find(records, kind, &RecordParameters::kind); found != records.end())
      return &*found;
  return nullptr;
}

void add_records(const Setup& setup, bool heats, std::vector<Drawn>& drawn) {
  const DrawnQuantity time{"time", "time_s", &unit::time};
  const RecordParameters* first = abscissa(setup.records);
  for (const RecordParameters& record : setup.records) {
    Drawn one{quantity_of(record), {}, DrawnRows::from_zero};
    const auto add = [&](const DrawnQuantity& over) {
      const auto has = std::ranges::find(one.over, over.name, &DrawnQuantity::name) != one.over.end();
      if (!has && over.name != record.name) one.over.push_back(over);
    };
    if (record.kind == RecordKind::temperature && heats) add(heating_time());
    if (setup.moving) {
      if (first != nullptr) add(quantity_of(*first));
      add(time);
      for (const RecordParameters& other : setup.records) add(quantity_of(other));
      if (heats) add(heating_time());
    }
    drawn.push_back(std::move(one));
  }
}

/// Returns the curves that figures draw, by the rules of figures.py.
std::vector<Drawn> drawn_by_figures(const Setup& setup) {
  if (setup.stages.empty()) return {};  // an error of the deck, which is told at its place
  const auto needs = [](const auto& stage) { return stage->needs().exchanges; };
  const auto heated = std::ranges::find_if(setup.stages, needs);
  const bool exchanges = heated != setup.stages.end();
  const bool has_platens =
      setup.moving && std::ranges::any_of(setup.moving->bearings, [](const Bearing& bearing) {
        return bearing.name == "top_platen";
      });
  const DrawnQuantity stress{"stress", "stress_MPa", &unit::stress, 1.0 / kMega};
  std::vector<Drawn> drawn;
  if (has_platens && !needs(setup.stages.back()))
    drawn.push_back({stress, {{"strain", "strain"}}, DrawnRows::compressed});
  if (has_platens && exchanges) {
    const DrawnQuantity over = setup.heat.uniform ? mean_temperature() : heating_time();
    if ((*heated)->heating().is_restrained)
      drawn.push_back({stress, {over}, DrawnRows::heated});
    else
      drawn.push_back(
          {{"total_strain", "specimen_strain", &unit::dimensionless, 1.0, -1.0}, {over}, DrawnRows::heated});
  }
  if (!setup.heat.uniform) {
    drawn.push_back({mean_temperature(), {heating_time()}, DrawnRows::all});
    for (const ProbePosition& probe : setup.probes)
      drawn.push_back({{probe.name, fmt::format("probe_{}_degC", probe.name), &unit::temperature},
                       {heating_time()},
                       DrawnRows::all});
  }
  add_records(setup, exchanges || !setup.heat.uniform, drawn);
  return drawn;
}

std::string list_of(const std::vector<Drawn>& drawn) {
  std::vector<std::string> list;
  for (const Drawn& one : drawn)
    list.push_back(fmt::format("\"{}\" over {}", one.of.name, one.over.front().name));
  return list.empty() ? "the figures of this run draw no reference"
                      : fmt::format("the figures of this run draw {}", fmt::join(list, ", "));
}

/// Returns the curves that have an abscissa.
std::vector<Drawn> with_abscissa(std::vector<Drawn> drawn) {
  std::erase_if(drawn, [](const Drawn& one) { return one.over.empty(); });
  return drawn;
}

/// Finds the curve that a deck names. Throws Error where a word names nothing that is drawn, or two things.
Drawn find_drawn(const std::string& of, const std::string& over, const std::vector<Drawn>& drawn) {
  std::vector<std::string> names;
  std::vector<Drawn> found;
  for (const Drawn& one : drawn) {
    names.push_back(one.of.name);
    if (one.of.name == of) found.push_back(one);
  }
  if (found.empty())
    throw Error(fmt::format("has no effect: no figure of this run draws it; {}{}", list_of(drawn),
                            did_you_mean(of, names, "; ")));
  if (std::ranges::any_of(found, [&](const Drawn& one) { return one.of.column != found[0].of.column; }))
    throw Error("is the name of two quantities of this run: give the record or the probe another name");
  if (over.empty()) return found.front();
  std::vector<std::string> allowed;
  for (Drawn& one : found)
    for (const DrawnQuantity& each : one.over) {
      allowed.push_back(each.name);
      if (each.name == over) return {one.of, {each}, one.rows};
    }
  throw Error(fmt::format("\"{}\" has no effect: no figure of this run draws \"{}\" over it, but over {}",
                          over, of, quoted_list(allowed)));
}

/// Reads the signs, 1 or -1 for each column; empty where the deck states none.
std::vector<double> read_signs(const Section& s) {
  const auto list = nlohmann::json::parse(
      s.json("sign", "list of 1 and -1", "[]",
             "sign of each column: -1 where the file's positive values are negative in the run"));
  std::vector<double> signs;
  for (const auto& item : list.is_array() ? list : nlohmann::json::array())
    if (item.is_number() && std::abs(item.get<double>()) == 1.0) signs.push_back(item.get<double>());
  if (!list.is_array() || signs.size() != list.size())
    s.error("sign", "must be a list of numbers, one for each column, each 1 or -1");
  return signs;
}

/// Returns the quantities that names of columns may say of one that is drawn.
ColumnMeanings meanings_of(const Unit& unit) {
  if (unit == unit::length) return {&meaning::displacement, &meaning::opening};
  for (const ColumnMeaning* one :
       {&meaning::strain, &meaning::stress, &meaning::time, &meaning::temperature, &meaning::force})
    if (one->unit == unit) return {one};
  return {};
}

/// Columns of a reference, whose names may be those of the deck too.
class AskedReference {
 public:
  AskedReference(const DrawnQuantity& over, const DrawnQuantity& of, std::size_t count)
      : own_{{{over.name, *over.unit, {over.name}}, {of.name, *of.unit, {of.name}}}},
        least_(fmt::format("least {}", of.name)),
        greatest_(fmt::format("greatest {}", of.name)) {
    columns_.push_back(asked(own_[0], own_[0].name));
    columns_.push_back(asked(own_[1], count == kCurveColumns ? own_[1].name : std::string_view(least_)));
    if (count == kRangeColumns) columns_.push_back(asked(own_[1], greatest_));
  }
  AskedReference(const AskedReference&) = delete;
  AskedReference& operator=(const AskedReference&) = delete;

  const std::vector<AskedColumn>& columns() const { return columns_; }
  static ColumnMeanings others() {
    return {&meaning::strain,           &meaning::stress, &meaning::time,         &meaning::temperature,
            &meaning::temperature_rise, &meaning::force,  &meaning::displacement, &meaning::opening};
  }

 private:
  static AskedColumn asked(const ColumnMeaning& own, std::string_view name) {
    AskedColumn column{name, own.unit, {{&own}}};
    for (const ColumnMeaning* one : meanings_of(own.unit)) column.names.push_back({one});
    return column;
  }

  std::array<ColumnMeaning, 2> own_;
  std::string least_, greatest_;
  std::vector<AskedColumn> columns_;
};

std::size_t count_of(const ColumnChoice& choice, const MeasuredTable& table, const Reference& reference) {
  if (!choice.columns.empty()) return choice.columns.size();
  if (!choice.units.empty()) return choice.units.size();
  const AskedReference range(reference.over, reference.of, kRangeColumns);
  const bool has_index = table.columns().size() == kRangeColumns && table.is_index(0);
  return !has_index && table.names_suit(range.columns(), AskedReference::others()) ? kRangeColumns
                                                                                   : kCurveColumns;
}

void warn_of_magnitude(const Section& s, std::string_view key, const DrawnQuantity& of,
                       const std::vector<double>& values, std::string_view sign_to_write) {
  const auto [least, greatest] = std::ranges::minmax(values);
  const bool is_stress = *of.unit == unit::stress;
  const auto say = [&](double value, std::string_view what) {
    s.warn(key, fmt::format("the {} reaches {:.6g}{}; {}", of.name, value * of.written,
                            is_stress ? " MPa" : " (no unit)", what));
  };
  const double size = std::max(std::abs(least), std::abs(greatest));
  if (of.column == "stress_MPa" && -least > greatest)
    say(least, fmt::format("figures draw compression as positive, so the curve hardly shows; where "
                           "the file counts it as negative, write sign = {}",
                           sign_to_write));
  else if ((is_stress && size > kMostStress) || (*of.unit == unit::dimensionless && size > kMostStrain))
    say(size, "the column is most likely in another unit, which its header must say");
}

/// Reads the values of a reference from a table. Throws Error where the table does not have them.
/// \param key  key that names the file
void read_table(const Section& s, std::string_view key, const MeasuredTable& table,
                const ColumnChoice& choice, std::vector<double> signs, Reference& reference) {
  const std::size_t count = count_of(choice, table, reference);
  const AskedReference asked(reference.over, reference.of, count);
  if (signs.empty()) signs.assign(count, 1.0);
  if (signs.size() != count)
    s.error("sign", fmt::format("must be a list of {} numbers, one for each column, each 1 or -1", count));
  if (!s.ok()) return;
  const std::vector<ChosenColumn> columns = table.choose(choice, asked.columns(), AskedReference::others());
  const std::vector<double> over = table.values(columns[0], *reference.over.unit);
  if (over.size() < kLeastRows)
    throw Error(fmt::format("{}: has {} rows of numbers; {} or more are needed", table.path().string(),
                            over.size(), kLeastRows));
  if (*reference.over.unit == unit::time)
    require_ascending(table, columns[0], over, reference.over.name, unit::time, true);
  if (const std::string start = table.start_of(columns[0]);
      choice.start.empty() && !start.empty() && !moment_of(start)->has_date())
    s.warn(key,
           fmt::format("times of {} count from its first row, {}, as of a clock: write start = \"first row\" "
                       "where that is meant, or start = \"0:00:00\" where they count from the start already",
                       table.path().filename().string(), start));
  const bool has_negative_strain =
      reference.over.name == "strain" && signs[0] > 0.0 && std::ranges::min(over) < 0.0;
  for (std::size_t i = 0; i < count; ++i) {
    const DrawnQuantity& of = i == 0 ? reference.over : reference.of;
    std::vector<double> values = table.values(columns[i], *of.unit);
    for (double& value : values) value *= signs[i];
    warn_of_magnitude(s, key, of, values, has_negative_strain ? "[-1, -1]" : "[1, -1]");
    // A quotient gives 20 MPa for 2e7 Pa, where a product with 1e-6 is off by its last bit.
    for (double& value : values) value /= 1.0 / of.written;
    (i == 0 ? reference.x : i == 1 ? reference.low : reference.high) = std::move(values);
  }
  if (count == kCurveColumns) reference.high = reference.low;
  for (std::size_t i = 0; i < reference.low.size(); ++i)
    if (reference.low[i] > reference.high[i]) std::swap(reference.low[i], reference.high[i]);
}

using Builtin = std::array<const char*, 3>;  ///< name, of and over of a builtin reference

const std::vector<Choice<Builtin>>& builtins() {
  static const std::vector<Choice<Builtin>> all{
      {"compression",
       {"compression", "stress", "strain"},
       "compression at 20 °C: Anderberg and Thelandersson's law, and the peaks and moduli of the paper's "
       "Table 3"},
      {"transient_strain",
       {"transient_strain", "total_strain", "temperature"},
       "total strain while heated under load: the range of models that were calibrated on Anderberg and "
       "Thelandersson's tests, for the load levels 0, 0.225, 0.445 and 0.675"}};
  return all;
}

Reference builtin(const Section& s, std::string_view key, const Builtin& chosen,
                  const std::vector<Drawn>& drawn) {
  Reference reference;
  reference.is_builtin = true;
  const auto [name, of, over] = chosen;
  reference.name = name;
  try {
    find_drawn(of, over, drawn);
  } catch (const Error& error) {
    if (s.ok()) s.error(key, error.what());
  }
  return reference;
}

/// Returns the file's stem with _ for each dot: a name becomes a part of the path of a result, which dots
/// divide.
std::string name_of_file(const std::filesystem::path& file) {
  std::string stem = file.stem().string();
  std::ranges::replace(stem, '.', '_');
  return stem;
}

std::string read_reference_name(const Section& s, const std::filesystem::path& file) {
  std::string name = s.text("name", "",
                            "in the legend, and of its distances in summary.json; without one "
                            "the file's");
  if (name.find_first_of(".\"\n") != name.npos) s.error("name", "may hold no dot, quote or end of line");
  return name.empty() ? name_of_file(file) : name;
}

Reference read_reference(const Section& s, const std::filesystem::path& folder,
                         const std::vector<Drawn>& drawn) {
  s.know({"file", "columns", "units", "start", "of", "over", "sign", "name"});
  if (s.has("builtin"))
    return builtin(
        s, "builtin",
        s.choice<Builtin>("builtin", builtins(), "a reference that the program has, in the place of a file"),
        drawn);
  Reference reference;
  const std::string file =
      s.text("file",
             "a [measured table](measured-tables.md) beside the deck, in any units: the columns "
             "of `over` and `of`, or of `over` and the least and greatest of `of`");
  const std::string of = s.text("of",
                                "quantity of the curve: `stress`, `total_strain`, `temperature`, or the name "
                                "of a [[record]] or a probe");
  const std::string over =
      s.text("over", "",
             "quantity below the curve: `strain`, `temperature`, `heating_time`, `time` or the name of a "
             "[[record]]; by default as in the figure of `of`");
  reference.name = read_reference_name(s, file);
  ColumnChoice choice = read_column_choice(s, file, kCurveColumns, kRangeColumns);
  choice.key = "file";
  choice.start = read_start(s);
  const std::vector<double> signs = read_signs(s);
  if (!s.ok()) return reference;
  const char* wrong = "of";
  try {
    Drawn found = find_drawn(of, "", drawn);
    wrong = over.empty() ? "of" : "over";
    found = find_drawn(of, over, drawn);
    reference.of = found.of;
    reference.over = found.over.front();
    reference.rows = found.rows;
    wrong = "start";
    if (!choice.start.empty() && *reference.over.unit != unit::time)
      throw Error(fmt::format("has no meaning: \"{}\" is no time", reference.over.name));
    wrong = "file";
    read_table(s, "file", MeasuredTable::open(folder / file, kCurveColumns), choice, signs, reference);
    s.names_file("file", folder / file);
  } catch (const Error& error) {
    s.error(wrong, error.what());
  }
  return reference;
}

/// Finds the first curve that figures draw whose quantities fit the units of a table's columns. Throws Error
/// where there is none.
Drawn told_by_units(const MeasuredTable& table, const std::vector<Drawn>& drawn) {
  for (const Drawn& one : drawn)
    for (const DrawnQuantity& over : one.over)
      for (const std::size_t count : {kCurveColumns, kRangeColumns})
        if (table.suits(AskedReference(over, one.of, count).columns(), AskedReference::others()))
          return {one.of, {over}, one.rows};
  throw Error(fmt::format("has no effect: no figure of this run draws the columns {} of {}; {}",
                          table.list_of_columns(), table.path().string(), list_of(drawn)));
}

/// Reads the short form: a word, or a file whose columns tell by their units which curve it holds.
Reference read_short(const Section& output, const std::filesystem::path& folder,
                     const std::vector<Drawn>& drawn) {
  const std::string name = output.text("reference",
                                       "one of [[output.references]] in short: the name of a builtin one, or "
                                       "a file whose units tell the quantities of its columns");
  const auto& words = builtins();
  if (const auto word = std::ranges::find(words, name, &Choice<Builtin>::word); word != words.end())
    return builtin(output, "reference", word->value, drawn);
  Reference reference;
  reference.name = name_of_file(name);
  if (!output.ok()) return reference;
  if (!name.ends_with(".csv")) {
    std::vector<std::string> known;
    for (const auto& word : words) known.emplace_back(word.word);
    output.error("reference", fmt::format("is none of {}, and no file whose name ends in .csv{}",
                                          quoted_list(known), did_you_mean(name, known, "; ")));
    return reference;
  }
  try {
    const MeasuredTable table = MeasuredTable::open(folder / name, kCurveColumns);
    const Drawn found = told_by_units(table, drawn);
    reference.of = found.of;
    reference.over = found.over.front();
    reference.rows = found.rows;
    read_table(output, "reference", table, {name, {}, {}, "reference"}, {}, reference);
    output.names_file("reference", folder / name);
  } catch (const Error& error) {
    output.error("reference", error.what());
  }
  return reference;
}

}  // namespace

std::vector<Reference> read_references(const Section& output, const std::filesystem::path& folder,
                                       const Setup& setup) {
  const auto sections = output.optional_sections("references",
                                                 "curves that figures draw beside the results, any number; "
                                                 "see [References in figures]"
                                                 "(../do/references.md)");
  output.know({"reference"});
  if (sections.empty() && !output.has("reference")) return {};
  const std::vector<Drawn> drawn = with_abscissa(drawn_by_figures(setup));
  std::vector<Reference> references;
  if (output.has("reference")) references.push_back(read_short(output, folder, drawn));
  for (const Section& s : sections) {
    Reference reference = read_reference(s, folder, drawn);
    const auto same = std::ranges::find(references, reference.name, &Reference::name);
    if (s.ok() && same != references.end())
      s.error("name", fmt::format("\"{}\" is the name of another reference: choose another", reference.name));
    references.push_back(std::move(reference));
  }
  return references;
}

std::string json_of(const std::vector<Reference>& references) {
  if (references.empty()) return {};
  auto json = nlohmann::ordered_json::array();
  for (const Reference& reference : references) {
    if (reference.is_builtin) {
      json.push_back({{"builtin", reference.name}});
      continue;
    }
    json.push_back({{"name", reference.name},
                    {"of", reference.of.name},
                    {"of_column", reference.of.column},
                    {"over", reference.over.name},
                    {"over_column", reference.over.column},
                    {"x", reference.x},
                    {"low", reference.low},
                    {"high", reference.high}});
  }
  return json.dump(1) + "\n";
}

}  // namespace pyroclast
