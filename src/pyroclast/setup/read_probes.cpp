#include "pyroclast/setup/read_probes.hpp"

#include <algorithm>
#include <string>
#include <utility>

#include <fmt/format.h>

#include "pyroclast/setup/make_body.hpp"
#include "pyroclast/setup/read_name.hpp"

namespace pyroclast {

namespace {

/// Largest distance by which a probe on the outline may lie outside, from rounding, m.
constexpr double kOnOutline = 1e-9;

}  // namespace

std::vector<ProbePosition> read_probes(const Section& root, const specimen::SpecimenParameters& specimen) {
  std::vector<ProbePosition> probes;
  // A specimen that stands in for an error refuses no probe.
  const bool known = is_outline_known(root, specimen);
  const auto within = [&](int axis) {
    return known ? Range::between(specimen.low()[axis], specimen.high()[axis]) : Range::any();
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
    if (specimen.dimension() == 2) {
      if (s.has("z")) s.error("z", "a body in the plane has no z; with [specimen] depth the body is a solid");
    } else if (!s.has("z")) {
      s.error("x", "with y is a point of a solid, whose z is needed too" +
                       (known ? fmt::format("; in the middle it is z = \"{:g} m\"",
                                            0.5 * (specimen.low()[2] + specimen.high()[2]))
                              : ""));
    } else {
      probe.position[2] =
          s.quantity("z", unit::length, within(2), "of a solid: from its front, of a cylinder from its axis");
    }
    if (known && s.ok() && specimen.distance(probe.position) > kOnOutline)
      s.error("x", fmt::format("with y {}is a point outside of the specimen, {:.4g} mm from it",
                               specimen.dimension() == 2 ? "" : "and z ",
                               1e3 * specimen.distance(probe.position)));
    probes.push_back(std::move(probe));
  }
  return probes;
}

}  // namespace pyroclast
