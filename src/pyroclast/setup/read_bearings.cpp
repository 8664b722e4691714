#include "pyroclast/setup/read_bearings.hpp"

#include <algorithm>

#include <fmt/format.h>

namespace pyroclast {

namespace {

ReadBearing read_bearing(const Section& s, const DeckSpace& space) {
  ReadBearing read{s, {}, {}, {}, {}, 0.0};
  Bearing& bearing = read.bearing;
  bearing.name = s.text("name", "of the bearing, and of the sets that come with it");
  if (s.has("side")) {
    bearing.side = s.text("side", "side of the specimen that the bearing covers from end to end");
    for (const char* key : {"at", "width"})
      if (s.has(key)) s.error(key, "either side, or at and width; not both");
  } else {
    bearing.side = bearing.name + "_seat";
    const StatedPlace at =
        s.place("at", unit::length, space.of_extrusion(),
                "middle of its seat, on the outline; in a solid a pair stands for the middle of the depth")
            .value_or(StatedPlace{});
    read.at = Vec<2>{{at.x, at.y}};
    read.z = at.z;
    read.width =
        s.quantity("width", unit::length, Range::positive(), "of its seat, straight from end to end");
  }
  bearing.thickness = s.quantity("thickness", unit::length, Range::positive(), "away from the specimen");
  bearing.material =
      s.text("material", "platen", "of the bearing: a table of [materials], at 20 °C in every run");
  bearing.interface = read.interface.name = bearing.name;
  BearingInterface& interface = read.interface;
  interface.contact = s.choice<BearingContact>(
      "contact",
      {{"frictional", BearingContact::frictional, "bears no tension, and slips by Coulomb's law"},
       {"glued", BearingContact::glued, "stays elastic and never parts"}},
      "how the bearing meets the specimen");
  if (interface.contact == BearingContact::frictional)
    interface.friction = s.number("friction", Range::non_negative().usually(0.0, 1.0),
                                  "coefficient of friction between bearing and specimen");
  else
    s.know({"friction"});
  if (s.has("K_n"))
    interface.stiffness = {
        s.quantity("K_n", unit::stiffness_per_area, Range::positive(),
                   "normal stiffness of a layer between bearing and specimen; without one that "
                   "of the matrix's own contacts"),
        s.quantity("K_s", unit::stiffness_per_area, Range::positive(), "shear stiffness likewise")};
  else
    s.know({"K_s"});
  return read;
}

}  // namespace

std::vector<ReadBearing> read_bearings(const Section& root, const DeckSpace& space) {
  std::vector<ReadBearing> bearings;
  for (const Section& s :
       root.optional_sections("bearings",
                              "blocks beside the specimen that load or hold the specimen, any number; see "
                              "[Bearings](../do/bodies.md#bearings)")) {
    ReadBearing read = read_bearing(s, space);
    const auto same = [&](const ReadBearing& other) { return other.bearing.name == read.bearing.name; };
    if (s.ok() && std::ranges::any_of(bearings, same))
      s.error("name", fmt::format("\"{}\" is the name of another bearing", read.bearing.name));
    bearings.push_back(std::move(read));
  }
  return bearings;
}

}  // namespace pyroclast
