#include "pyroclast/setup/read_blocks.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <numbers>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "pyroclast/base/error.hpp"
#include "pyroclast/base/nearest.hpp"
#include "pyroclast/base/overloaded.hpp"
#include "pyroclast/specimen/cells_file.hpp"
#include "pyroclast/specimen/neper_tess.hpp"

namespace pyroclast {

namespace {

/// Numbers of blocks that a specimen may have.
constexpr Range kBlockCount = Range::between(4, 100e6);

/// Reads the blocks of a Neper file; returns none after an error, or where the outline takes no such file.
std::optional<specimen::NeperTess> read_tessellation(const Section& blocks, const std::filesystem::path& file,
                                                     const ReadOutline& outline, const DeckSpace& space) {
  if (space.is_solid()) return std::nullopt;
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

/// Warns of cells of a Neper file that have no vertices.
/// \param empty  their numbers in the file
void warn_of_empty_cells(const Section& blocks, std::span<const int> empty) {
  constexpr std::size_t kNamed = 5;
  if (empty.empty()) return;
  blocks.warn("file", fmt::format("{} of its cells ha{} no vertices and {} left out: cell{} {}{} (from 1)",
                                  empty.size(), empty.size() == 1 ? "s" : "ve",
                                  empty.size() == 1 ? "is" : "are", empty.size() == 1 ? "" : "s",
                                  fmt::join(empty.first(std::min(kNamed, empty.size())), ", "),
                                  empty.size() > kNamed ? ", ..." : ""));
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

/// Returns a number of blocks that follows from their size. Records an error where it is out of range.
int count_in_range(const Section& blocks, double count) {
  count = std::round(count);
  if (kBlockCount.contains(count)) return static_cast<int>(count);
  blocks.error(
      "size", fmt::format("gives {:.6g} blocks, but their number must be {}", count, kBlockCount.describe()));
  return 0;
}

std::span<const specimen::Notch> notches_of(const specimen::SpecimenParameters& specimen) {
  if (const specimen::Prism* body = specimen.prism()) return body->section().notches();
  return specimen.region()->notches();
}

/// Returns the names of all parts near which blocks may be finer.
std::vector<std::string> parts_of(const specimen::SpecimenParameters& specimen,
                                  std::span<const ReadBearing> bearings,
                                  std::span<const SetParameters> sets) {
  std::vector<std::string> names{"outline"};
  const auto add = [&](const std::string& name) {
    if (std::ranges::find(names, name) == names.end()) names.push_back(name);
  };
  for (const specimen::Side& side : specimen.sides()) add(side.name);
  for (const specimen::Notch& notch : notches_of(specimen)) {
    add(notch.name);
    add(notch.name + kTip);
  }
  for (const ReadBearing& b : bearings) add(b.bearing.name);
  for (const SetParameters& set : sets) add(set.name);
  return names;
}

/// Adds the parts of a body's surface that are of a side, or the whole surface, "outline".
void add_side(const specimen::SpecimenParameters& specimen, const std::string& name,
              specimen::FinerPart& part) {
  const bool is_all = name == "outline";
  const auto& sides = specimen.sides();
  for (specimen::FlatPart& flat : specimen.flat_parts()) {
    int side = flat.side;
    while (side >= 0 && !is_all && sides[side].name != name) side = sides[side].part_of;
    if (side >= 0) part.pieces.push_back(std::move(flat.corners));
  }
}

/// Gives finer blocks the place of a part by its name. A set without a place has that of the set that it lies
/// within. Records an error where there is none.
void find_part(const specimen::SpecimenParameters& specimen, std::span<const ReadBearing> bearings,
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
  for (const specimen::Notch& notch : notches_of(specimen)) {
    if (notch.name == name) part.pieces.push_back({resized<3>(notch.mouth), resized<3>(notch.tip)});
    if (notch.name + kTip != name) continue;
    part.pieces.push_back({resized<3>(notch.tip)});
    part.is_along_z = specimen.prism() != nullptr;
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

}  // namespace

ReadBlocks read_blocks(const Section& s, const std::filesystem::path& folder, const ReadOutline& outline,
                       const DeckSpace& space, bool is_covered) {
  ReadBlocks read;
  specimen::BlockParameters& b = read.parameters;
  read_regularity(s, space, b);
  if (s.has("file") && space.is_solid())
    s.error(
        "file",
        fmt::format("holds cells of a plane; a solid makes its own blocks: count or size says how many. {}",
                    specimen::kInSpace));
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
    if (auto tess = read_tessellation(s, file, outline, space)) {
      warn_of_empty_cells(s, tess->empty);
      read_groups(s, *tess, names, is_covered, b);
      b.cells = std::move(tess->cells);
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

bool make_finer(const Section& blocks, ReadBlocks& read, std::span<const ReadBearing> bearings,
                std::span<const SetParameters> sets, const specimen::SpecimenParameters& p) {
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
  std::visit(
      [&](const auto& outline) { find_sizes(blocks, specimen::room_of_blocks(outline), read.size, b); },
      p.outline);
  for (const ReadFiner& finer : read.finer)
    if (blocks.ok() && finer.part.size >= b.largest_size)
      finer.section.error(
          "size",
          fmt::format("must be less than the size of the other blocks, {:.4g} mm{}; got {:.4g} mm",
                      1e3 * b.largest_size, read.size > 0.0 ? "" : ", which follows from blocks.count",
                      1e3 * finer.part.size));
  return all_ok();
}

int count_of(const Section& blocks, const specimen::SpecimenParameters& specimen, double size) {
  return count_in_range(blocks, specimen.extent() / std::pow(size, specimen.dimension()));
}

}  // namespace pyroclast
