#include "pyroclast/setup/read_specimen.hpp"

#include <cstdint>

namespace pyroclast {

namespace {

/// Placing an aggregate is given up after this many random centres.
constexpr int kPlacementAttempts = 100'000;

specimen::AggregateParameters read_aggregates(const Section& s) {
  specimen::AggregateParameters a;
  a.fraction = s.number("fraction", {.lower = 0.0, .upper = 1.0, .upper_inclusive = false});
  a.d_min = s.quantity("d_min", unit::length, Range::positive());
  a.d_max = s.quantity("d_max", unit::length, Range::positive());
  a.fuller_exponent = s.number("fuller_exponent", Range::positive());
  a.minimum_gap = s.quantity("minimum_gap", unit::length, Range::non_negative());
  a.attempts = static_cast<int>(s.integer("attempts", Range::between(1, 1e9), kPlacementAttempts));
  const auto between = s.quantities("sieves", unit::length, Range::positive());
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

specimen::BlockParameters read_blocks(const Section& s, const std::filesystem::path& folder) {
  specimen::BlockParameters b;
  b.shortest_edge = s.number("shortest_edge", Range::between(0.0, 0.5));
  if (s.has("file")) {
    b.file = folder / s.text("file");
    if (s.has("count")) s.error("count", "has no meaning beside file: the tessellation is read, not made");
    return b;
  }
  b.count = static_cast<int>(s.integer("count", Range::between(4, 100e6)));
  b.relaxation = static_cast<int>(s.integer("relaxation", Range::between(0, 1000), 0));
  b.radius_spread = s.number("radius_spread", {.lower = 0.0, .upper = 1.0, .upper_inclusive = false}, 0.0);
  return b;
}

}  // namespace

specimen::SpecimenParameters read_specimen(const Section& root, const std::filesystem::path& folder) {
  specimen::SpecimenParameters p;
  const Section s = root.section("specimen");
  p.width = s.quantity("width", unit::length, Range::positive());
  p.height = s.quantity("height", unit::length, Range::positive());
  p.seed = static_cast<std::uint64_t>(s.integer("seed", Range::between(0, 9e15)));
  p.aggregates = read_aggregates(root.section("aggregates"));
  p.blocks = read_blocks(root.section("blocks"), folder);
  const Section superposition = root.section("superposition");
  p.superposition = superposition.choice<specimen::Superposition>(
      "rule", {{"area", specimen::Superposition::area}, {"centroid", specimen::Superposition::centroid}});
  if (p.superposition == specimen::Superposition::area)
    p.covered_fraction =
        superposition.number("covered_fraction", {.lower = 0.0, .upper = 1.0, .upper_inclusive = false});
  return p;
}

}  // namespace pyroclast
