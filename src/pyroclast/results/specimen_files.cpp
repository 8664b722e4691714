#include "pyroclast/results/specimen_files.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <variant>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "pyroclast/results/text_file.hpp"
#include "pyroclast/specimen/gradation.hpp"

namespace pyroclast {

namespace {

constexpr int kGradationPoints = 60;

/// Returns the rows of one kind of circles.
/// \param kind    number of the kind, from 0
/// \param placed  circles of the kind, at least one
std::string gradation_rows(int kind, const std::vector<specimen::Aggregate>& placed,
                           const specimen::AggregateParameters& asked) {
  std::vector<double> sizes;
  for (int i = 0; i <= kGradationPoints; ++i)
    sizes.push_back(i == kGradationPoints
                        ? asked.d_max
                        : asked.d_min *
                              std::pow(asked.d_max / asked.d_min, static_cast<double>(i) / kGradationPoints));
  std::string rows;
  for (const auto& p : specimen::gradation(asked, placed, sizes))
    rows += fmt::format("{},{:.9g},{:.9g},{:.9g}\n", kind, p.size, p.passing_asked, p.passing_realised);
  return rows;
}

/// Returns the kinds of circles: the aggregates, and inclusions of that shape.
std::vector<const specimen::AggregateParameters*> kinds_of(const specimen::SpecimenParameters& asked) {
  std::vector<const specimen::AggregateParameters*> kinds{&asked.aggregates};
  for (const auto& inclusions : asked.inclusions)
    if (const auto* circles = std::get_if<specimen::AggregateParameters>(&inclusions))
      kinds.push_back(circles);
  return kinds;
}

std::string gradation_csv(const specimen::Specimen& s, const specimen::SpecimenParameters& asked) {
  std::string csv = "kind,d_m,asked_percent,placed_percent\n";
  const auto kinds = kinds_of(asked);
  for (int kind = 0; kind < static_cast<int>(kinds.size()); ++kind) {
    std::vector<specimen::Aggregate> placed;
    std::ranges::copy_if(s.aggregates, std::back_inserter(placed),
                         [&](const specimen::Aggregate& a) { return a.kind == kind; });
    if (!placed.empty()) csv += gradation_rows(kind, placed, *kinds[kind]);
  }
  return csv;
}

}  // namespace

void write_specimen_files(const std::filesystem::path& folder, const specimen::Specimen& s,
                          const specimen::SpecimenParameters& asked) {
  std::filesystem::create_directories(folder);
  nlohmann::ordered_json json;
  json["width_m"] = s.region.box().width();
  json["height_m"] = s.region.box().height();
  json["blocks"] = s.tessellation.cells.size();
  json["aggregates"] = s.aggregates.size();
  json["fraction_asked"] = s.fraction_asked;
  json["fraction_placed"] = s.fraction_placed;
  json["fraction_superposed"] = s.fraction_superposed;
  json["covered_fraction"] = s.covered_fraction;
  for (std::size_t i = 0; i < s.phases.size(); ++i) json["fraction"][s.phases[i]] = s.fraction[i];
  json["mean_block_size_m"] = s.metrics.mean_size;
  json["mean_edge_m"] = s.metrics.mean_edge;
  json["shortest_edge_m"] = s.metrics.shortest_edge;
  json["edges_removed"] = s.metrics.edges_removed;
  json["edges_left_short"] = s.metrics.edges_left_short;
  json["seeds_redrawn"] = s.metrics.seeds_redrawn;
  json["smallest_zone_angle_deg"] = s.metrics.smallest_angle;
  write_text_file(folder / "specimen.json", json.dump(2) + "\n");

  std::string csv = "x_m,y_m,diameter_m,phase\n";
  for (const auto& a : s.aggregates)
    csv += fmt::format("{:.9g},{:.9g},{:.9g},{}\n", a.centre[0], a.centre[1], a.diameter, a.phase);
  write_text_file(folder / "aggregates.csv", csv);
  if (!s.aggregates.empty()) write_text_file(folder / "gradation.csv", gradation_csv(s, asked));
}

}  // namespace pyroclast
