#include "pyroclast/results/specimen_files.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <variant>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "pyroclast/results/text_file.hpp"
#include "pyroclast/specimen/gradation.hpp"
#include "pyroclast/specimen/stone.hpp"
#include "pyroclast/specimen/stone_fit.hpp"
#include "pyroclast/specimen/stones_file.hpp"

namespace pyroclast {

namespace {

using Files = std::map<std::string, std::string>;

constexpr int kGradationPoints = 60;
constexpr double kSideOfCircle = 0.05;  ///< side of the polygon for a circle, as a share of the diameter

/// Returns the rows of one kind of stones.
/// \param kind    number of the kind, from 0
/// \param placed  stones of the kind, at least one
template <int Dim>
std::string gradation_rows(int kind, const std::vector<specimen::Stone<Dim>>& placed,
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

template <int Dim>
std::string gradation_csv(const std::vector<specimen::Stone<Dim>>& stones,
                          const specimen::SpecimenParameters& asked) {
  std::string csv = "kind,d_m,asked_percent,placed_percent\n";
  const auto kinds = specimen::stone_kinds(asked);
  for (int kind = 0; kind < static_cast<int>(kinds.size()); ++kind) {
    std::vector<specimen::Stone<Dim>> placed;
    std::ranges::copy_if(stones, std::back_inserter(placed),
                         [&](const auto& stone) { return stone.kind == kind; });
    if (!placed.empty()) csv += gradation_rows(kind, placed, *kinds[kind]);
  }
  return csv;
}

/// Returns the outlines of all stones; circles among them as polygons of their area.
std::string outlines_csv(const std::vector<specimen::Stone<2>>& stones) {
  std::string csv = "grain,x_m,y_m,phase\n";
  for (std::size_t i = 0; i < stones.size(); ++i) {
    const auto& [centre, diameter, phase, kind, shape] = stones[i];
    for (const Vec<2>& corner : shape ? specimen::corners_of(stones[i])
                                      : specimen::circle_corners(centre, diameter, kSideOfCircle * diameter))
      csv += fmt::format("{},{:.9g},{:.9g},{}\n", i, corner[0], corner[1], phase);
  }
  return csv;
}

/// Returns the fit of each stone: how well its blocks have its shape.
template <int Dim>
std::string grain_fit_csv(const specimen::Specimen<Dim>& s) {
  std::string csv =
      Dim == 2 ? "diameter_m,area_m2,perimeter_m,blocks,area_of_blocks_m2,interface_m,deviation_m\n"
               : "diameter_m,volume_m3,surface_m2,blocks,volume_of_blocks_m3,interface_m2,deviation_m\n";
  const auto fits = specimen::fits_of(s);
  for (std::size_t i = 0; i < fits.size(); ++i)
    csv += fmt::format("{:.9g},{:.9g},{:.9g},{},{:.9g},{:.9g},{:.9g}\n", s.stones[i].diameter, fits[i].extent,
                       fits[i].size, fits[i].blocks, fits[i].extent_of_blocks, fits[i].interface,
                       fits[i].deviation);
  return csv;
}

/// Adds the stones as they were placed, and their gradation.
template <int Dim>
void add_stones(Files& files, const std::vector<specimen::Stone<Dim>>& stones,
                [[maybe_unused]] const std::vector<std::string>& phases,
                const specimen::SpecimenParameters& asked) {
  std::string csv = Dim == 2 ? "x_m,y_m,diameter_m,phase\n" : "x_m,y_m,z_m,diameter_m,phase\n";
  for (const auto& stone : stones) {
    for (const double x : stone.centre.c) csv += fmt::format("{:.9g},", x);
    csv += fmt::format("{:.9g},{}\n", stone.diameter, stone.phase);
  }
  files["aggregates.csv"] = csv;
  if (std::ranges::any_of(stones, [](const auto& stone) { return stone.shape != nullptr; })) {
    if constexpr (Dim == 2)
      files["outlines.csv"] = outlines_csv(stones);
    else
      files["stones.obj"] = specimen::stones_obj(stones, phases);
  }
  if (!stones.empty()) files["gradation.csv"] = gradation_csv(stones, asked);
}

/// Adds the numbers that specimens of the plane and of space have.
template <int Dim>
void add_common(nlohmann::ordered_json& json, const specimen::Specimen<Dim>& s) {
  json["blocks"] = s.phase.size();
  json["aggregates"] = s.stones.size();
  json["fraction_asked"] = s.fraction_asked;
  json["fraction_placed"] = s.fraction_placed;
  json["fraction_superposed"] = s.fraction_superposed;
  json["covered_fraction"] = s.covered_fraction;
  for (std::size_t i = 0; i < s.phases.size(); ++i) json["fraction"][s.phases[i]] = s.fraction[i];
  json["mean_block_size_m"] = s.metrics.mean_size;
  if (s.size.empty()) return;
  const auto [smallest, largest] = std::ranges::minmax(s.size);
  json["smallest_block_size_m"] = smallest;
  json["largest_block_size_m"] = largest;
}

template <int Dim>
void add_made(Files& files, const specimen::Specimen<Dim>& s, const specimen::SpecimenParameters& asked) {
  nlohmann::ordered_json json;
  const Vec<Dim> size = s.outline.high() - s.outline.low();
  json["width_m"] = size[0];
  json["height_m"] = size[1];
  if constexpr (Dim == 3) {
    json["depth_m"] = size[2];
    json["volume_m3"] = s.outline.extent();
  }
  add_common(json, s);
  const auto& m = s.metrics;
  if constexpr (Dim == 2) {
    json["mean_edge_m"] = m.mean_edge;
    json["shortest_edge_m"] = m.shortest_edge;
    json["edges_removed"] = m.vertices_merged;
    json["edges_left_short"] = m.edges_left_short;
    json["seeds_redrawn"] = m.seeds_redrawn;
    json["smallest_zone_angle_deg"] = m.smallest_angle;
  } else {
    json["zones_per_block"] = m.zones_per_block;
    json["most_corners_of_a_face"] = m.most_corners;
    json["shortest_edge_m"] = m.shortest_edge;
    json["lowest_zone_m"] = m.lowest_zone;
    json["vertices_merged"] = m.vertices_merged;
    json["edges_left_short"] = m.edges_left_short;
    json["largest_bend_deg"] = m.largest_bend;
    json["seeds_redrawn"] = m.seeds_redrawn;
  }
  for (const specimen::SizeClass& c : s.classes)
    json["size_classes"].push_back({{"kind", c.kind},
                                    {"from_m", c.from},
                                    {"to_m", c.to},
                                    {"asked", c.asked},
                                    {"placed", c.placed},
                                    {"superposed", c.superposed},
                                    {"stones", c.stones},
                                    {"without_a_block", c.without_a_block}});
  files["specimen.json"] = json.dump(2) + "\n";
  add_stones(files, s.stones, s.phases, asked);
  if (!s.stone.empty() && !s.stones.empty()) files["grain_fit.csv"] = grain_fit_csv(s);
}

}  // namespace

nlohmann::ordered_json specimen_facts(const MadeSpecimen& made) {
  nlohmann::ordered_json json;
  std::visit([&](const auto& s) { add_common(json, s); }, made);
  return json;
}

Files specimen_files(const MadeSpecimen& made, const specimen::SpecimenParameters& asked) {
  Files files;
  std::visit([&](const auto& s) { add_made(files, s, asked); }, made);
  return files;
}

void write_specimen_files(const std::filesystem::path& folder, const Files& files) {
  std::filesystem::create_directories(folder);
  for (const auto& [name, text] : files) write_text_file(folder / name, text);
}

}  // namespace pyroclast
