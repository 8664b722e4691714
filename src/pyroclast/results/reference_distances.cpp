#include "pyroclast/results/reference_distances.hpp"

#include <algorithm>
#include <cmath>
#include <string_view>

#include <fmt/format.h>

namespace pyroclast {

namespace {

/// Ratio of the greatest sizes of run and reference beyond which their units most likely differ.
constexpr double kOtherUnit = 100.0;

PlainCurve advancing(const PlainCurve& curve) {
  PlainCurve line;
  for (std::size_t i = 0; i < curve.x.size(); ++i) {
    if (!line.x.empty() && !(curve.x[i] > line.x.back())) continue;
    line.x.push_back(curve.x[i]);
    line.y.push_back(curve.y[i]);
  }
  return line;
}

/// Returns the value of a line at a place within its range.
double value_at(const PlainCurve& line, double x) {
  const auto after = std::ranges::upper_bound(line.x, x) - line.x.begin();
  if (after == std::ssize(line.x)) return line.y.back();
  const double share = (x - line.x[after - 1]) / (line.x[after] - line.x[after - 1]);
  return line.y[after - 1] + share * (line.y[after] - line.y[after - 1]);
}

/// Integrals of a difference that is straight between places.
struct Integrals {
  double of_square = 0.0, of_size = 0.0;

  void add(double width, double a, double b) {
    of_square += width * (a * a + a * b + b * b) / 3.0;
    const double sizes = std::abs(a) + std::abs(b);
    if (a * b < 0.0)
      of_size += 0.5 * width * (a * a + b * b) / sizes;  // two triangles
    else
      of_size += 0.5 * width * sizes;
  }
};

double of_greatest_size(const std::vector<double>& values) {
  return *std::ranges::max_element(values, {}, [](double value) { return std::abs(value); });
}

/// Returns the greatest value in a direction, that of the reference's peak, of points within a range; none
/// without such points.
std::optional<double> peak_in_range(const PlainCurve& curve, double from, double to, double direction) {
  std::optional<double> peak;
  for (std::size_t i = 0; i < curve.x.size(); ++i)
    if (curve.x[i] >= from && curve.x[i] <= to && (!peak || direction * (curve.y[i] - *peak) > 0.0))
      peak = curve.y[i];
  return peak;
}

bool is_exchange(const History& history, std::size_t row) {
  return history.cell(row, "exchange").value_or(0.0) > 0.0;
}

std::vector<std::size_t> rows_from(std::size_t first, const Run& run) {
  std::vector<std::size_t> rows;
  for (std::size_t row = first; row < run.history().row_count(); ++row) rows.push_back(row);
  return rows;
}

std::vector<std::size_t> rows_from_zero(const Run& run) {
  std::size_t first = 0;
  for (std::size_t i = 0; i < run.courses().size(); ++i) {
    const std::size_t end = run.courses()[i].rows.last;
    const bool settled = run.stages()[i]->kind() == std::string_view("settle") &&
                         run.courses()[i].outcome == Outcome::completed;
    if (settled && end < run.history().row_count()) first = end;
  }
  return rows_from(first, run);
}

std::vector<std::size_t> heated_rows(const Run& run) {
  std::vector<std::size_t> rows;
  for (std::size_t i = 0; i < run.courses().size(); ++i) {
    const StageCourse& record = run.courses()[i];
    for (std::size_t row = record.rows.first; row < record.rows.last; ++row) {
      const bool fails = record.outcome == Outcome::ran_away && row + 1 == record.rows.last;
      if (!is_exchange(run.history(), row) || fails) continue;
      if (rows.empty()) rows.push_back(row - 1);
      rows.push_back(row);
    }
  }
  return rows;
}

/// Returns the stress over the strain from rest, or from where heat left the body.
PlainCurve compressed(const Run& run) {
  const History& history = run.history();
  std::optional<std::size_t> test;
  for (std::size_t i = 0; i < run.courses().size(); ++i)
    if (const RowRange rows = run.courses()[i].rows;
        !rows.empty() && history.cell(rows.last - 1, "stress_MPa"))
      test = i;
  if (!test) return {};
  const RowRange of_test = run.courses()[*test].rows;
  std::size_t since = 0;  // first row after heat last changed the body
  for (std::size_t row = 0; row < of_test.first; ++row)
    if (is_exchange(history, row)) since = row + 1;
  const double before = since > 0 ? history.cell(of_test.first - 1, "strain").value_or(0.0) : 0.0;
  PlainCurve curve;
  const auto add = [&](RowRange rows) {
    for (std::size_t row = rows.first; row < rows.last; ++row)
      if (const auto x = history.cell(row, "strain"), y = history.cell(row, "stress_MPa"); x && y) {
        curve.x.push_back(*x - before);
        curve.y.push_back(*y);
      }
  };
  if (since == 0) {
    curve.x.push_back(0.0);
    curve.y.push_back(0.0);
  }
  for (std::size_t i = 0; i < *test; ++i)
    if (const RowRange rows = run.courses()[i].rows;
        rows.first >= since && run.stages()[i]->kind() == std::string_view("compress"))
      add(rows);
  add(of_test);
  return curve;
}

std::string unit_in_names(const DrawnQuantity& of) {
  const std::string unit = of.column.substr(of.column.find_last_of('_') + 1);
  return *of.unit == unit::dimensionless ? "" : unit == "degC" ? "K" : unit;
}

/// Returns the unit of an area in names: "N_m"; "m2" where both units are the same.
std::string area_unit(const Reference& reference) {
  const std::string y = unit_in_names(reference.of), x = unit_in_names(reference.over);
  if (y == x && !y.empty()) return y + "2";
  return y + (y.empty() || x.empty() ? "" : "_") + x;
}

std::vector<std::string> doubts(const Reference& reference, const PlainCurve& curve, const PlainCurve& held) {
  if (curve.y.empty()) return {};
  const double of_run = of_greatest_size(curve.y), of_reference = of_greatest_size(held.y);
  const double ratio = of_reference / of_run;
  const auto say = [&](std::string_view what) {
    return std::vector<std::string>{
        fmt::format("reference \"{}\": {} of greatest size is {:.4g} there and {:.4g} in the run; {}",
                    reference.name, reference.of.name, of_reference, of_run, what)};
  };
  if (!std::isfinite(ratio) || ratio == 0.0) return {};
  if (std::abs(ratio) > kOtherUnit || std::abs(ratio) * kOtherUnit < 1.0)
    return say("the column is most likely in another unit than its header says");
  if (ratio < 0.0) return say("where the file's positive values are negative in the run, state its sign");
  return {};
}

}  // namespace

CurveDistances distances(const PlainCurve& curve, const PlainCurve& reference) {
  CurveDistances result;
  const PlainCurve line = advancing(curve), held = advancing(reference);
  if (held.x.size() < 2) return result;
  const double peak = of_greatest_size(reference.y);
  if (peak != 0.0)
    if (const auto own = peak_in_range(curve, held.x.front(), held.x.back(), peak))
      result.at_peak = *own / peak - 1.0;
  if (line.x.size() < 2) return result;
  const double from = std::max(line.x.front(), held.x.front());
  const double to = std::min(line.x.back(), held.x.back());
  result.covered = std::max(0.0, to - from) / (held.x.back() - held.x.front());
  if (!(to > from)) return result;
  std::vector<double> places{from, to};
  for (const PlainCurve* each : {&line, &held})
    std::ranges::copy_if(each->x, std::back_inserter(places), [&](double x) { return x > from && x < to; });
  std::ranges::sort(places);
  Integrals integrals;
  const auto difference = [&](double x) { return value_at(line, x) - value_at(held, x); };
  for (std::size_t i = 1; i < places.size(); ++i)
    integrals.add(places[i] - places[i - 1], difference(places[i - 1]), difference(places[i]));
  result.area = integrals.of_size;
  if (peak != 0.0) result.rms = std::sqrt(integrals.of_square / (to - from)) / std::abs(peak);
  return result;
}

PlainCurve curve_beside(const Reference& reference, const Run& run) {
  if (reference.rows == DrawnRows::compressed) return compressed(run);
  const auto rows = reference.rows == DrawnRows::heated      ? heated_rows(run)
                    : reference.rows == DrawnRows::from_zero ? rows_from_zero(run)
                                                             : rows_from(0, run);
  PlainCurve curve;
  for (const std::size_t row : rows) {
    const auto x = run.history().cell(row, reference.over.column);
    const auto y = run.history().cell(row, reference.of.column);
    if (!x || !y) continue;
    curve.x.push_back(reference.over.sign * *x);
    curve.y.push_back(reference.of.sign * *y);
  }
  return curve;
}

PlainCurve curve_of(const Reference& reference) {
  PlainCurve curve{reference.x, {}};
  for (std::size_t i = 0; i < reference.x.size(); ++i)
    curve.y.push_back(0.5 * (reference.low[i] + reference.high[i]));
  return curve;
}

std::vector<ReferenceDistances> reference_distances(std::span<const Reference> references, const Run& run) {
  std::vector<ReferenceDistances> all;
  for (const Reference& reference : references) {
    if (reference.is_builtin) continue;
    const PlainCurve curve = curve_beside(reference, run), held = curve_of(reference);
    all.push_back({reference.name, area_unit(reference), distances(curve, held), {}});
    if (!run.has_ended()) continue;
    all.back().warnings = doubts(reference, curve, held);
    if (all.back().distances.covered.value_or(0.0) == 0.0)
      all.back().warnings.push_back(fmt::format(
          "reference \"{}\": the run has no {} in its range, {:.4g} to {:.4g}, so that nothing tells "
          "how far they are apart",
          reference.name, reference.over.name, std::ranges::min(held.x), std::ranges::max(held.x)));
  }
  return all;
}

}  // namespace pyroclast
