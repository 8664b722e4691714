#include "pyroclast/stages/record_results.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <optional>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "pyroclast/base/error.hpp"
#include "pyroclast/material/expression.hpp"
#include "pyroclast/model/sets.hpp"
#include "pyroclast/simulation/simulation.hpp"
#include "pyroclast/units/units.hpp"

namespace pyroclast {

namespace {

/// Time that a fall from a peak must last, over the time for which the body was driven to the peak.
constexpr double kLastingShare = 0.1;

using Kind = RecordResult::Kind;
using Values = std::map<std::string, double>;

/// Returns the figures of the body by the names that formulas use.
Values values_of(const BodyFigures& body) {
  return {{"thickness", body.thickness}, {"weight", body.weight}};
}

bool is_length(RecordKind kind) {
  return kind == RecordKind::displacement || kind == RecordKind::opening;
}

/// Reads a quantity of any kind, SI; 1 where there is an error, which is recorded.
double read_any(const Section& s, const char* key, const std::string& text) {
  try {
    return parse_any_quantity(text);
  } catch (const QuantityError& error) {
    s.error(key, error.reason());
    return 1.0;
  }
}

/// \param known  names that formulas may use so far, each with a value to try them with
RecordResult read_result(const Section& s, const std::vector<RecordParameters>& records,
                         const Values& known) {
  const auto found = [&](const char* key, Meaning meaning) {
    return find_record(s, key, meaning, records).value_or(RecordParameters{});
  };
  RecordResult r;
  r.name = s.text("name", "letters, digits and _; in summary.json its unit follows");
  r.kind = s.choice<Kind>(
      "kind",
      {{"given", Kind::given, "a quantity that is stated, for formulas"},
       {"peak", Kind::peak, "value of a record at the [peak](../understand/theory.md#peaks) of its size"},
       {"largest", Kind::largest, "value of a record where its size is largest, peak or not"},
       {"last", Kind::last, "value of a record at the end of the stage"},
       {"at_peak", Kind::at_peak, "value of a record at the peak of another"},
       {"work", Kind::work, "of a force over a displacement or opening: the area under the curve"},
       {"formula", Kind::formula, "of the results before it, in SI, and of thickness and weight"}},
      "kind of the result");
  s.know({"value", "record", "of", "over", "formula", "unit"});
  switch (r.kind) {
    case Kind::given: {
      const std::string text = s.text("value", "any quantity, with its unit");
      r.value = read_any(s, "value", text);
      if (s.ok()) r.unit = unit_of_quantity(text);
      break;
    }
    case Kind::peak:
    case Kind::largest:
    case Kind::last:
      r.record = found("record", "record whose value is taken");
      break;
    case Kind::at_peak:
      r.record = found("record", "record whose value is taken");
      r.other = found("of", "record with the peak");
      break;
    case Kind::work:
      r.record = found("record", "the force");
      r.other = found("over", "displacement or opening over which the force works");
      if (s.ok() && r.record.kind != RecordKind::force) s.error("record", "must be of kind force");
      if (s.ok() && !is_length(r.other.kind)) s.error("over", "must be of kind displacement or opening");
      r.unit = std::string(unit::energy.si);
      break;
    case Kind::formula:
      r.formula = s.text("formula", "of the names of results before it, and of thickness and weight");
      r.unit = s.text("unit", "1", "of the formula's value, which itself is in SI");
      try {
        evaluate(r.formula, known);
      } catch (const Error& error) {
        if (s.ok()) s.error("formula", error.what());
      }
      break;
  }
  if (r.kind == Kind::peak || r.kind == Kind::largest || r.kind == Kind::last || r.kind == Kind::at_peak)
    r.unit = column_of(r.record).unit;
  if (s.ok() && r.unit != "1") {
    r.unit_zero = read_any(s, "unit", fmt::format("0 {}", r.unit));
    r.unit_size = read_any(s, "unit", fmt::format("1 {}", r.unit)) - r.unit_zero;
  }
  return r;
}

/// Returns the name of a result in summary.json: with its unit, as columns of the history have it.
std::string name_with_unit(const std::string& name, std::string unit) {
  std::erase_if(unit, [](char c) { return c == '(' || c == ')'; });
  std::ranges::replace_if(
      unit, [](char c) { return c == '/' || c == ' ' || c == '*'; }, '_');
  return unit == "1" ? name : fmt::format("{}_{}", name, unit);
}

/// Values of a record in some rows, SI; none where a row has no value.
class Course {
 public:
  Course(const History& history, RowRange rows, const RecordParameters& record) {
    for (std::size_t row = rows.first; row < rows.last; ++row) {
      values_.push_back(history.cell(row, column_of(record).name));
      if (values_.back()) *values_.back() /= column_over_si(record.kind);
    }
  }

  const std::optional<double>& operator[](std::size_t i) const { return values_[i]; }
  std::size_t size() const { return values_.size(); }

 private:
  std::vector<std::optional<double>> values_;
};

/// Returns the work of a force over a way, J; between two rows both change evenly.
double work(const Course& force, const Course& way) {
  double sum = 0.0;
  for (std::size_t i = 1; i < force.size(); ++i)
    if (force[i - 1] && force[i] && way[i - 1] && way[i])
      sum += 0.5 * (*force[i - 1] + *force[i]) * (*way[i] - *way[i - 1]);
  return sum;
}

/// Returns the entry of a record in a list of one entry a record; null where the list has none.
template <class T>
const T* of_record(const std::vector<RecordParameters>& records, const std::vector<T>& all,
                   const RecordParameters& record) {
  const auto found = std::ranges::find(records, record.name, &RecordParameters::name) - records.begin();
  return found < std::ssize(all) ? &all[found] : nullptr;
}

std::optional<double> value_of(const RecordResult& asked, const std::vector<RecordParameters>& records,
                               const std::vector<RecordPeak>& peaks, const Values& known,
                               const History& history, RowRange rows) {
  const auto course = [&](const RecordParameters& record) { return Course(history, rows, record); };
  const auto at_peak = [&](const RecordParameters& of) -> std::optional<double> {
    const RecordPeak* peak = of_record(records, peaks, of);
    if (peak == nullptr || !peak->peak().is_found()) return std::nullopt;
    return *of_record(records, peak->values(), asked.record);
  };
  switch (asked.kind) {
    case Kind::given:
      return asked.value;
    case Kind::peak:
      return at_peak(asked.record);
    case Kind::largest:
      return peaks.empty() ? std::nullopt : std::optional(of_record(records, peaks, asked.record)->largest());
    case Kind::last:
      return rows.empty() ? std::nullopt : course(asked.record)[rows.last - rows.first - 1];
    case Kind::at_peak:
      return at_peak(asked.other);
    case Kind::work:
      return work(course(asked.record), course(asked.other));
    case Kind::formula:
      try {
        const double value = evaluate(asked.formula, known);
        return std::isfinite(value) ? std::optional(value) : std::nullopt;
      } catch (const Error&) {
        return std::nullopt;  // the formula uses a result that has no value
      }
  }
  return std::nullopt;
}

}  // namespace

std::optional<RecordParameters> find_record(const Section& s, std::string_view key, Meaning meaning,
                                            const std::vector<RecordParameters>& records) {
  const std::string name = s.text(key, meaning);
  const auto found = std::ranges::find(records, name, &RecordParameters::name);
  if (found != records.end()) return *found;
  std::vector<std::string> names;
  for (const auto& record : records) names.push_back(record.name);
  if (s.ok())
    s.error(key, fmt::format("is no [[record]]; there are {}",
                             names.empty() ? "none" : fmt::format("{}", fmt::join(names, ", "))));
  return std::nullopt;
}

void RecordPeak::take(std::size_t of, double driven, bool counts, double time,
                      const std::vector<double>& values) {
  const double size = std::abs(values[of]);
  if (size > std::abs(largest_)) {
    largest_ = values[of];
    largest_time_ = time;
  }
  if (!counts) return;
  const double before = peak_.size();
  peak_.take(driven, size, rule_of_records(peak_));
  if (peak_.size() == before) return;
  time_ = time;
  values_ = values;
}

void RecordPeak::visit_state(StateVisitor& visitor, std::size_t records) {
  peak_.visit_state(visitor);
  visitor.visit("time", time_);
  visitor.visit("values", values_);
  visitor.require(values_.size() == records || (values_.empty() && !peak_.is_found()), "values",
                  "does not have one for each record");
  visitor.visit("largest", largest_);
  visitor.visit("largest_time", largest_time_);
}

PeakRule rule_of_records(const Peak& so_far) {
  return {.lasting = kLastingShare * so_far.driven()};
}

BodyFigures figures_of(const Simulation& simulation) {
  const Model& model = simulation.model();
  const std::vector<int>& specimen = model.set("specimen");
  double depth = model.thickness;
  if (model.dimension() == 3) {
    double low = std::numeric_limits<double>::infinity(), high = -low;
    for (const int g : specimen) {
      low = std::min(low, model.place(g)[2]);
      high = std::max(high, model.place(g)[2]);
    }
    depth = model.ranks().largest(high) - model.ranks().least(low);
  }
  return {depth, norm(simulation.motion().totals().total_weight(gridpoint_set(model, specimen)))};
}

void BodyFigures::visit_state(StateVisitor& visitor) {
  visitor.visit("thickness", thickness);
  visitor.visit("weight", weight);
}

std::vector<RecordResult> read_record_results(const Section& stage,
                                              const std::vector<RecordParameters>& records,
                                              bool has_thickness) {
  std::vector<RecordResult> results;
  std::vector<std::string> automatic;
  for (const RecordParameters& record : records)
    for (const char* kind : {"peak", "largest"}) {
      automatic.push_back(fmt::format("{}_{}", kind, column_of(record).name));
      automatic.push_back(fmt::format("{}_{}_time_s", kind, record.name));
    }
  Values known = values_of({1.0, 1.0});
  if (!has_thickness) known.erase("thickness");
  for (const Section& s : stage.optional_sections(
           "results",
           "numbers that the stage makes of its records, and of results before them; any number")) {
    RecordResult result = read_result(s, records, known);
    const std::string in_summary = name_with_unit(result.name, result.unit);
    if (s.ok() && std::ranges::find(automatic, in_summary) != automatic.end())
      s.error("name",
              fmt::format("\"{}\" is a result that every stage with this record has: choose another name",
                          in_summary));
    if (s.ok() && !is_name_in_formulas(result.name))
      s.error("name", "must begin with a letter, and hold letters, digits and _ only");
    else if (s.ok() && !known.emplace(result.name, 1.0).second)
      s.error("name", fmt::format("\"{}\" is known to formulas already", result.name));
    results.push_back(std::move(result));
  }
  return results;
}

namespace {

/// Adds a value of a record, under a name and the unit of the record's column.
void add(std::vector<Result>& results, const std::string& label, const Column& column, Result::Value value,
         const char* meaning) {
  Result& result = results.emplace_back(fmt::format("{}_{}", label, column.unit), std::move(value));
  result.unit = column.unit;
  result.label = label;
  result.meaning = fmt::format("{} of the [[record]] {}", meaning, column.of);
}

/// Adds the time of the value that was added last.
void add_time(std::vector<Result>& results, const std::string& label, Result::Value time) {
  const std::string about = results.back().name;
  Result& result =
      results.emplace_back(fmt::format("{}_time_s", label), std::move(time), ResultOf::computation);
  result.unit = "s";
  result.meaning = fmt::format("time of {} since the stage began", about);
  result.about = about;
}

}  // namespace

std::vector<Result> record_results(const std::vector<RecordParameters>& records,
                                   const std::vector<RecordPeak>& peaks,
                                   const std::vector<RecordResult>& asked, const BodyFigures& body,
                                   const History& history, RowRange rows) {
  std::vector<Result> results;
  for (std::size_t i = 0; i < records.size(); ++i) {
    const Column column = column_of(records[i]);
    const double factor = column_over_si(records[i].kind);
    const RecordPeak known = peaks.empty() ? RecordPeak() : peaks[i];
    const bool has_peak = known.peak().is_found(), has_largest = !peaks.empty();
    const std::string& name = records[i].name;
    add(results, fmt::format("peak_{}", name), column,
        value_if(has_peak, has_peak ? factor * known.values()[i] : 0.0), "value at the peak");
    add_time(results, fmt::format("peak_{}", name), value_if(has_peak, known.time()));
    const std::string peak = results[results.size() - 2].name;
    add(results, fmt::format("largest_{}", name), column, value_if(has_largest, factor * known.largest()),
        "value where it is largest");
    results.back().about = peak;
    add_time(results, fmt::format("largest_{}", name), value_if(has_largest, known.largest_time()));
  }
  Values known = values_of(body);
  for (const RecordResult& each : asked) {
    const auto value = value_of(each, records, peaks, known, history, rows);
    if (value) known[each.name] = *value;
    Result& result = results.emplace_back(
        name_with_unit(each.name, each.unit),
        value ? Result::Value((*value - each.unit_zero) / each.unit_size) : Result::Value(),
        each.kind == RecordResult::Kind::given ? ResultOf::computation : ResultOf::test);
    result.unit = each.unit;
    result.label = each.name;
    result.meaning = "a [[stages.results]] of the deck";
  }
  return results;
}

std::vector<std::string> missing_peaks(const std::vector<RecordParameters>& records,
                                       const std::vector<RecordPeak>& peaks,
                                       const std::vector<RecordResult>& asked) {
  std::vector<std::string> lines;
  for (std::size_t i = 0; i < peaks.size(); ++i) {
    const auto is_of_peak = [&](const RecordResult& each) {
      return (each.kind == Kind::peak && each.record.name == records[i].name) ||
             (each.kind == Kind::at_peak && each.other.name == records[i].name);
    };
    if (peaks[i].peak().is_found() || std::ranges::none_of(asked, is_of_peak)) continue;
    lines.push_back(
        fmt::format("{} has no peak: while the body was driven on, its size did not fall by {:.0f} % from "
                    "its largest, {:.4g} {}, "
                    "and stay below that for a tenth of the time to there; drive the body farther",
                    records[i].name, 100.0 * PeakRule().fall,
                    column_over_si(records[i].kind) * peaks[i].largest(), column_of(records[i]).unit));
  }
  return lines;
}

std::vector<std::string> lines_of(const std::vector<RecordResult>& asked,
                                  const std::vector<Result>& results) {
  std::vector<std::string> lines;
  for (const RecordResult& each : asked) {
    if (each.kind == Kind::given) continue;
    const auto found = std::ranges::find(results, name_with_unit(each.name, each.unit), &Result::name);
    if (found == results.end()) continue;
    const auto* value = std::get_if<double>(&found->value);
    lines.push_back(value ? fmt::format("{} {:.4g}{}", each.name, *value,
                                        each.unit == "1" ? "" : fmt::format(" {}", each.unit))
                          : fmt::format("{}: none", each.name));
  }
  return lines;
}

}  // namespace pyroclast
