#include "pyroclast/setup/read_probes.hpp"

#include <algorithm>
#include <string>
#include <utility>

#include <fmt/format.h>

#include "pyroclast/setup/read_name.hpp"

namespace pyroclast {

namespace {

/// Largest distance by which a probe on the outline may lie outside, from rounding, m.
constexpr double kOnOutline = 1e-9;

}  // namespace

std::vector<ProbePosition> read_probes(const Section& root, const specimen::Region& region) {
  std::vector<ProbePosition> probes;
  // A region that stands in for an error refuses no probe.
  const bool known = root.section("specimen").ok();
  const auto within = [&](int axis) {
    return known ? Range::between(region.box().low[axis], region.box().high[axis]) : Range::any();
  };
  for (const Section& s :
       root.optional_sections("probes", "places whose temperature is recorded, any number")) {
    ProbePosition probe;
    probe.name = read_name(s, "letters, digits and _; the column in history.csv is probe_<name>_degC");
    if (std::any_of(probes.begin(), probes.end(), [&](const auto& p) { return p.name == probe.name; }))
      s.error("name", "is the name of another probe already");
    probe.position = {{s.quantity("x", unit::length, within(0),
                                  "from the lower left corner of a rectangle, the middle of a disc"),
                       s.quantity("y", unit::length, within(1), "likewise")}};
    const specimen::Point at{{probe.position[0], probe.position[1]}};
    if (known && s.ok() && region.distance(at) > kOnOutline)
      s.error("x", fmt::format("with y is a point outside of the specimen, {:.4g} mm from it",
                               1e3 * region.distance(at)));
    probes.push_back(std::move(probe));
  }
  return probes;
}

}  // namespace pyroclast
