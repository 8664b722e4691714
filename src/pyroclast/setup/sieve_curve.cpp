#include "pyroclast/setup/sieve_curve.hpp"

#include <algorithm>
#include <array>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "pyroclast/base/characters.hpp"
#include "pyroclast/base/error.hpp"

namespace pyroclast {
namespace {

/// Largest difference from 1 of the last share of a sieve analysis, as percents leave it.
constexpr double kAllPass = 1e-9;
constexpr double kHundred = 100.0;  // shares as a column without a unit counts them in percent

const ColumnMeanings& names() {
  static const ColumnMeanings all{&meaning::index, &meaning::sieve, &meaning::passing, &meaning::retained,
                                  &meaning::radius};
  return all;
}

bool says(const ColumnHeader& column, const ColumnMeaning& what) {
  return meanings_of_name(column.name, names()) == ColumnMeanings{&what};
}

/// Tells whether a column has the shares that its sieve and all larger ones retain.
bool is_sum_retained(const ColumnHeader& column) {
  if (!says(column, meaning::retained)) return false;
  const std::string name = lower_case(column.written);
  return std::ranges::any_of(std::array<std::string_view, 6>{"cum", "kum", "total", "summe", "gesamt", "Σ"},
                             [&](std::string_view word) { return name.find(word) != name.npos; });
}

/// Returns the one column of a kind; none where there are none or several.
template <class Is>
std::optional<std::size_t> only(const MeasuredTable& table, const Is& is_it) {
  const auto& columns = table.columns();
  if (std::ranges::count_if(columns, is_it) != 1) return std::nullopt;
  return static_cast<std::size_t>(std::ranges::find_if(columns, is_it) - columns.begin());
}

/// Chooses the columns of a table with more than two by their names, where these tell them.
void choose_by_names(const MeasuredTable& table, ColumnChoice& choice) {
  const auto sieve = only(table, [](const auto& one) { return says(one, meaning::sieve); });
  auto share = only(table, [](const auto& one) { return says(one, meaning::passing); });
  if (!share) share = only(table, is_sum_retained);
  if (sieve && share) choice.columns = {{"", *sieve + 1}, {"", *share + 1}};
}

}  // namespace

specimen::GradingCurve checked_curve(specimen::GradingCurve curve) {
  auto& [sizes, shares] = curve;
  if (!sizes.empty() && sizes.front() > sizes.back()) {  // laboratories list sieves so
    std::ranges::reverse(sizes);
    std::ranges::reverse(shares);
  }
  if (sizes.size() < 2 || sizes.front() < 0.0 ||
      std::ranges::adjacent_find(sizes, std::ranges::greater_equal()) != sizes.end())
    throw Error("must have two sizes or more, which ascend or descend, none below 0");
  if (shares.back() > 1.0 + kAllPass)
    throw Error(fmt::format(
        "reaches {:.6g}, but where all passes the share is 1, or 100 %: the unit is missing", shares.back()));
  if (!std::ranges::is_sorted(shares) || shares.front() < 0.0 || shares.back() < 1.0 - kAllPass)
    throw Error("must ascend with the size, from 0 % or more to 100 % at the largest");
  const auto all_pass =
      std::ranges::find_if(shares, [](double share) { return share >= 1.0 - kAllPass; }) - shares.begin();
  const auto count = static_cast<std::size_t>(std::max<std::ptrdiff_t>(all_pass, 1)) + 1;
  sizes.resize(count);
  shares.resize(count);
  shares.back() = 1.0;
  return curve;
}

specimen::GradingCurve sieve_curve(const MeasuredTable& table, ColumnChoice choice) {
  std::array<AskedColumn, kSieveColumns> asked{
      {{"size", unit::length, {{&meaning::sieve}}},
       {"passing", unit::dimensionless, {{&meaning::passing}}, false, /*is_known_by_size=*/true}}};
  if (std::ranges::any_of(table.columns(), is_sum_retained)) asked[1].names.push_back({&meaning::retained});
  if (choice.columns.empty() && table.columns().size() > kSieveColumns) choose_by_names(table, choice);
  const auto columns = table.choose(choice, asked, {&meaning::retained, &meaning::radius});
  specimen::GradingCurve curve{table.values(columns[0], unit::length),
                               table.values(columns[1], unit::dimensionless)};
  const double largest = std::ranges::max(curve.shares);
  if (columns[1].unit == "1" && largest == kHundred)
    for (double& share : curve.shares) share /= kHundred;  // no share of all is beyond 1
  if (says(table.columns()[columns[1].index], meaning::retained))
    for (double& share : curve.shares) share = 1.0 - share;
  try {
    return checked_curve(std::move(curve));
  } catch (const Error& error) {
    throw Error(fmt::format("{}: the share that passes {}", table.path().string(), error.what()));
  }
}

}  // namespace pyroclast
