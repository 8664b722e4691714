#include "pyroclast/setup/read_specimen.hpp"

#include <algorithm>
#include <cstdint>

#include <fmt/format.h>

namespace pyroclast {

namespace {

/// Placing an aggregate is given up after this many random centres.
constexpr int kPlacementAttempts = 100'000;

/// Smallest side of a test specimen over the largest aggregate (EN 12390-1 asks for 3.5).
constexpr double kFewestAggregatesAcross = 3.0;

constexpr Meaning kPhase = "what they are made of: a table of [materials]";

int read_attempts(const Section& s) {
  return static_cast<int>(
      s.integer("attempts", Range::between(1, 1e9), kPlacementAttempts,
                "random places that are tried for one of them before placing is given up"));
}

specimen::AggregateParameters read_aggregates(const Section& s) {
  specimen::AggregateParameters a;
  a.phase = s.text("phase", "aggregate", kPhase);
  a.fraction =
      s.number("fraction", Range{.lower = 0.0, .upper = 1.0, .upper_inclusive = false}.usually(0.0, 0.5),
               "area of coarse aggregate over area of the specimen");
  a.d_min = s.quantity("d_min", unit::length, Range::positive().usually(5e-4, 0.1), "smallest diameter");
  a.d_max = s.quantity("d_max", unit::length, Range::positive().usually(5e-4, 0.15), "largest diameter");
  a.fuller_exponent = s.number("fuller_exponent", Range::positive().usually(0.2, 1.0), "of Fuller's curve");
  a.minimum_gap = s.quantity("minimum_gap", unit::length, Range::non_negative(),
                             "between two aggregates, and between an aggregate and the outline");
  a.attempts = read_attempts(s);
  a.place = fmt::format("{}: {}", s.where("fraction"), s.path());
  const auto between = s.quantities("sieves", unit::length, Range::positive(),
                                    "bounds of the size intervals between d_min and d_max, ascending");
  if (!s.ok()) return a;
  if (a.d_max <= a.d_min) s.error("d_max", "must be greater than d_min");
  a.sieves = {a.d_min};
  for (double sieve : between) {
    if (sieve <= a.sieves.back() || sieve >= a.d_max) {
      s.error("sieves", "must ascend and lie between d_min and d_max, both excluded");
      return a;
    }
    a.sieves.push_back(sieve);
  }
  a.sieves.push_back(a.d_max);
  return a;
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

/// The largest aggregate must have a place, and the specimen should be some of them wide.
void check_size(const Section& s, const specimen::SpecimenParameters& p) {
  const double narrowest = std::min(p.width, p.height), largest = p.aggregates.d_max;
  if (p.aggregates.fraction == 0.0) return;
  if (largest + 2.0 * p.aggregates.minimum_gap > narrowest)
    s.error("d_max", fmt::format("with minimum_gap on both sides must be less than the specimen, {:.6g} m",
                                 narrowest));
  else if (kFewestAggregatesAcross * largest > narrowest)
    s.warn("d_max", fmt::format("the specimen is only {:.1f} times as wide, but usually at least {} times",
                                narrowest / largest, kFewestAggregatesAcross));
}

std::vector<specimen::Inclusions> read_inclusions(const Section& root) {
  std::vector<specimen::Inclusions> list;
  for (const Section& s : root.optional_sections(
           "inclusions", "what stands in the matrix beside [aggregates]; placed after these, in turn")) {
    enum class Shape { circle, fibre };
    const auto shape = s.choice<Shape>(
        "shape",
        {{"circle", Shape::circle, "circles with a gradation of their own: another aggregate, or pores"},
         {"fibre", Shape::fibre, "straight fibres: the blocks that one crosses are of its phase"}},
        "shape of the inclusions");
    if (shape == Shape::circle)
      list.emplace_back(read_aggregates(s));
    else
      list.emplace_back(read_fibres(s));
  }
  return list;
}

specimen::BlockParameters read_blocks(const Section& s, const std::filesystem::path& folder) {
  specimen::BlockParameters b;
  b.shortest_edge =
      s.number("shortest_edge", Range::between(0.0, 0.5),
               "shorter edges are removed where the blocks allow it; as a fraction of the mean edge");
  if (s.has("file")) {
    b.file =
        folder /
        s.text("file", "Neper tessellation (.tess), beside the deck, that is read instead of making one");
    s.names_file("file", b.file);
    if (s.has("count")) s.error("count", "has no meaning beside file: the tessellation is read, not made");
    return b;
  }
  b.count = static_cast<int>(s.integer("count", Range::between(4, 100e6), "number of blocks"));
  b.relaxation =
      static_cast<int>(s.integer("relaxation", Range::between(0, 1000), 0,
                                 "iterations of Lloyd's relaxation; 0 leaves the seeds at random"));
  b.radius_spread = s.number("radius_spread", {.lower = 0.0, .upper = 1.0, .upper_inclusive = false}, 0.0,
                             "Laguerre radii are uniform within 1 ± radius_spread times half the mean "
                             "spacing; 0 makes a Voronoi tessellation");
  return b;
}

}  // namespace

specimen::SpecimenParameters read_specimen(const Section& root, const std::filesystem::path& folder) {
  specimen::SpecimenParameters p;
  const Section s = root.section("specimen", "size of the specimen, and its seed");
  p.width = s.quantity("width", unit::length, Range::positive().usually(0.01, 10.0), "of the specimen");
  p.height = s.quantity("height", unit::length, Range::positive().usually(0.01, 10.0), "of the specimen");
  p.seed = static_cast<std::uint64_t>(
      s.integer("seed", Range::between(0, static_cast<double>(specimen::kLargestSeed)),
                "of the random numbers; the same seed gives the same specimen"));
  const Section aggregates =
      root.section("aggregates",
                   "coarse aggregates, placed as circles with diameters after Fuller's curve "
                   "P(d) = (d / d_max)^fuller_exponent, Eq. (16)");
  p.aggregates = read_aggregates(aggregates);
  if (s.ok() && aggregates.ok()) check_size(aggregates, p);
  p.inclusions = read_inclusions(root);
  p.blocks = read_blocks(root.section("blocks", "the tessellation into blocks"), folder);
  const Section superposition = root.section("superposition", "which blocks are of which phase");
  p.matrix = superposition.text("matrix", "mortar", "phase of the blocks that nothing else covers");
  for (const auto& phase : specimen::phases(p))
    if (phase == "platen")
      superposition.error("\"platen\" is the solid of the platens; a phase needs another name");
  p.superposition = superposition.choice<specimen::Superposition>(
      "rule",
      {{"area", specimen::Superposition::area, "circles cover more than covered_fraction of the block"},
       {"fit", specimen::Superposition::fit,
        "the same with the fraction by which the blocks take the area of the circles"},
       {"centroid", specimen::Superposition::centroid, "the block's centroid lies in a circle"}},
      "when a block is aggregate");
  if (p.superposition == specimen::Superposition::area)
    p.covered_fraction =
        superposition.number("covered_fraction", {.lower = 0.0, .upper = 1.0, .upper_inclusive = false},
                             "share of a block above which circles make it aggregate");
  else
    superposition.know({"covered_fraction"});
  return p;
}

}  // namespace pyroclast
