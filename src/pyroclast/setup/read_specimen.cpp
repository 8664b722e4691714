#include "pyroclast/setup/read_specimen.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numeric>
#include <string>
#include <string_view>
#include <tuple>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "pyroclast/setup/make_body.hpp"
#include "pyroclast/setup/read_aggregates.hpp"
#include "pyroclast/setup/read_blocks.hpp"
#include "pyroclast/setup/read_outline.hpp"

namespace pyroclast {

namespace {

constexpr Meaning kSuperposition =
    "which blocks are of which phase; needed where there is more than the matrix";
constexpr Meaning kMatrix = "phase of the blocks that nothing else covers";

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

/// Gives a specimen whose file was not read the phases that [materials] has, each with stones: default phases
/// in their place would be second errors.
void let_materials_stand_in(const Section& root, std::span<const ReadBearing> bearings,
                            specimen::SpecimenParameters& p) {
  auto& cells = p.cells.emplace<specimen::GivenCells<2>>();
  const Section materials = root.section("materials");
  for (const std::string& name : materials.keys())
    if (materials.is_table(name) && name != "platen" &&
        std::ranges::none_of(bearings, [&](const ReadBearing& b) { return b.bearing.material == name; }))
      cells.phases.push_back(name);
  cells.phase.resize(cells.phases.size());
  std::iota(cells.phase.begin(), cells.phase.end(), 0);
  cells.stone = cells.phase;
  if (cells.phases.size() == 1) p.matrix = cells.phases.front();
}

/// Tells whether known stones could not be read.
bool lacks_stones(const Section& s) {
  return (s.has("stones") || s.has("outlines") || s.has("surfaces")) && !s.ok();
}

/// Reads the rest of a specimen whose cells are given. The tables from which cells are made otherwise have no
/// effect.
void read_beside_cells(const Section& root, const Section& s, const DeckSpace& space,
                       std::span<const ReadBearing> bearings, ReadOutline outline,
                       specimen::SpecimenParameters& p) {
  root.know({"aggregates", "inclusions", "blocks"});
  p.outline = make_outline(s, outline, space, {}, bearings);
  const bool has_matrix = read_matrix_alone(root, p);
  if (outline.cells) {
    check_outline(s, outline, p);
    std::visit(
        [&](auto& cells) {
          p.blocks.count = static_cast<int>(cells.cells.cells.size());
          check_matrix(s, "file", cells.phases, has_matrix, p);
          p.cells = std::move(cells);
        },
        *outline.cells);
  } else if (!s.ok()) {
    let_materials_stand_in(root, bearings, p);
  }
}

/// Records an error where a phase has the name of a bearing's material.
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
  if (!circles.are_known()) return circles.phase;
  return std::visit([](const auto& list) { return list.front().phase; }, circles.stones);
}

}  // namespace

specimen::SpecimenParameters read_specimen(const Section& root, const std::filesystem::path& folder,
                                           const DeckSpace& space, std::span<const SetParameters> sets,
                                           std::span<const ReadBearing> bearings) {
  specimen::SpecimenParameters p;
  const Section s = root.section("specimen");
  ReadOutline outline = read_outline(s, folder, space);
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
  p.outline = make_outline(s, outline, space, read, bearings);
  if (!read.finer.empty() && s.ok() && blocks.ok()) {
    if (make_finer(blocks, read, bearings, sets, p)) {
      const auto& [count, finer, largest] =
          std::tie(read.parameters.count, read.parameters.finer, read.parameters.largest_size);
      const specimen::BlockSizes sizes(std::pow(p.extent() / count, 1.0 / p.dimension()), largest, finer);
      p.outline = make_outline(s, outline, space, read, bearings, &sizes);
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
  if (s.ok() && blocks.ok()) check_bearings(p, bearings);
  if (s.ok() && aggregates && aggregates->ok()) check_size(*aggregates, p);
  if (!aggregates && p.inclusions.empty()) {
    const bool has_matrix = read_matrix_alone(root, p);
    if (!p.blocks.phases.empty()) check_matrix(blocks, "groups", p.blocks.phases, has_matrix, p);
    p.aggregates.phase = p.matrix;
    if (p.blocks.phases.empty() && (blocks.has("file") || outline.shape == Shape::tessellation) &&
        !(s.ok() && blocks.ok()))
      let_materials_stand_in(root, bearings, p);
    check_phases(s, p, bearings);
    return p;
  }
  const Section superposition = root.section("superposition", kSuperposition);
  if (!aggregates) p.aggregates.phase = first_phase(p.inclusions.front());
  p.matrix = superposition.text("matrix", p.matrix, kMatrix);
  if ((aggregates && lacks_stones(*aggregates)) ||
      std::ranges::any_of(root.optional_sections("inclusions"), lacks_stones))
    let_materials_stand_in(root, bearings, p);
  check_phases(superposition, p, bearings);
  p.superposition = superposition.choice<specimen::Superposition>(
      "rule",
      {{"area", specimen::Superposition::area,
        "circles, or balls, cover more than covered_fraction of the block"},
       {"fit", specimen::Superposition::fit,
        "the same with the fraction by which the blocks take the area of the circles, or the volume of the "
        "balls"},
       {"each", specimen::Superposition::each,
        "the same, but each circle, or ball, has a block first: the largest chooses first"},
       {"centroid", specimen::Superposition::centroid, "the block's centroid lies in a circle"},
       {"follow", specimen::Superposition::follow,
        "nothing is superposed: edges of blocks, in a solid faces, follow the surfaces of the stones, "
        "see [Stones](../do/bodies.md#stones)"}},
      "when a block is aggregate");
  if (p.superposition == specimen::Superposition::follow && p.blocks.cells)
    superposition.error("rule", "\"follow\" has no meaning beside blocks.file: those blocks are made");
  const bool has_shapes = std::ranges::any_of(specimen::stone_kinds(p),
                                              [](const auto* kind) { return specimen::has_shapes(*kind); });
  if (space.is_solid() && has_shapes && p.superposition != specimen::Superposition::follow &&
      p.superposition != specimen::Superposition::centroid)
    superposition.error("rule",
                        "the part of a block that a grain_shape covers is not worked out in a solid: "
                        "rule = \"follow\" or rule = \"centroid\"");
  if (p.superposition == specimen::Superposition::area)
    p.covered_fraction =
        superposition.number("covered_fraction", {.lower = 0.0, .upper = 1.0, .upper_inclusive = false},
                             "share of a block above which circles make it aggregate");
  else
    superposition.know({"covered_fraction"});
  return p;
}

}  // namespace pyroclast
