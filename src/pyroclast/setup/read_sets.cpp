#include "pyroclast/setup/read_sets.hpp"

#include <algorithm>
#include <string>
#include <string_view>

#include <fmt/format.h>

#include "pyroclast/setup/read_name.hpp"

namespace pyroclast {

namespace {

void read_place_of_set(const Section& s, const DeckSpace& space, SetParameters& set) {
  constexpr const char* kForms[] = {"box", "centre", "line", "nearest"};
  int stated = 0;
  for (const char* form : kForms) stated += s.has(form) ? 1 : 0;
  if (stated > 1) s.error("one of box, centre, line and nearest; not several");
  s.know({"box", "centre", "radius", "line", "nearest"});
  if (s.has("box")) {
    const TwoPlaces box = read_two_places(
        s, "box", space,
        "lower left and upper right corner, which belong to it; in a solid the lower one is in front, "
        "and pairs stand for all z");
    require_upright(s, "box", box);
    set.is_along_z = box.is_along_z;
    set.place = InBox{box.places[0], box.places[1]};
  } else if (s.has("centre")) {
    const auto centre = s.place("centre", unit::length, space.of_point(), "of a disc, in a solid of a ball");
    set.place = InBall{vec_of(centre.value_or(StatedPlace{})),
                       s.quantity("radius", unit::length, Range::positive(), "of a disc, or ball")};
  } else if (s.has("line")) {
    const TwoPlaces line = read_two_places(
        s, "line", space,
        "the ends of a straight line, which belong to it; in a solid pairs stand for the plane "
        "through it along z");
    set.is_along_z = line.is_along_z;
    set.place = OnLine{line.places[0], line.places[1]};
  } else if (s.has("nearest")) {
    const auto nearest =
        s.place("nearest", unit::length, space.of_point(), "the items nearest to this place");
    set.place = NearestTo{vec_of(nearest.value_or(StatedPlace{}))};
  }
}

Vec<3> read_direction(const Section& s, const DeckSpace& space) {
  const std::string stated = s.word_or_text(
      "direction", {{"x", 0, "to the right"}, {"y", 1, "upwards"}, {"z", 2, "to the back of a solid"}},
      "x, y or z behind a minus", "along which the record is measured");
  const bool is_negative = stated.starts_with('-');
  const std::string axis = stated.substr(is_negative ? 1 : 0);
  Vec<3> direction{};
  if (axis == "x" || axis == "y" || (axis == "z" && space.is_solid()))
    direction[axis[0] - 'x'] = is_negative ? -1.0 : 1.0;
  else
    s.error("direction", fmt::format("must be \"x\", \"y\", \"-x\" or \"-y\"{}; got \"{}\"",
                                     space.is_solid() ? ", \"z\", \"-z\"" : "", stated));
  return direction;
}

RecordParameters read_record(const Section& s, const DeckSpace& space) {
  RecordParameters r;
  r.name = read_name(s, "letters, digits and _; the column in history.csv is this and the unit");
  r.place = fmt::format("{}: {}", s.where("name"), s.path());
  r.kind = s.choice<RecordKind>(
      "kind",
      {{"displacement", RecordKind::displacement, "mean of a set"},
       {"opening", RecordKind::opening, "mean displacement of the set `other` minus that of `set`"},
       {"force", RecordKind::force,
        "on the body by a set that loads, holds or drives it; else all that acts on the body there"},
       {"stress", RecordKind::stress, "mean over the zones of a set, tension positive"},
       {"temperature", RecordKind::temperature, "mean of a set"},
       {"crack_length", RecordKind::crack_length, "of the damaged contact points of a set of contacts"},
       {"crack_area", RecordKind::crack_area, "the same of a solid"},
       {"crack_opening", RecordKind::crack_opening,
        "mean over a set of contacts, by length, of a solid by area"}},
      "recorded quantity");
  if (r.kind == RecordKind::crack_length && space.is_solid())
    s.error("kind", "cracks of a solid have an area: kind = \"crack_area\"");
  if (r.kind == RecordKind::crack_area && !space.is_solid())
    s.error("kind", "cracks in the plane have a length: kind = \"crack_length\"");
  r.set = s.text("set", "set that is recorded; see [Sets](../do/bodies.md#sets)");
  s.know({"other", "direction", "over"});
  if (r.kind == RecordKind::displacement || r.kind == RecordKind::opening ||
      r.kind == RecordKind::temperature)
    r.over = s.choice<MeanOver, MeanOver>(
        "over",
        {{"size", MeanOver::size,
          "the zones that lie wholly in the set, by area; where there is none "
          "its faces, by length; of a solid by volume and by area; else gridpoints"},
         {"gridpoints", MeanOver::gridpoints, "its gridpoints, each alike"}},
        MeanOver::size, "items of which the mean is taken");
  if (r.kind == RecordKind::opening)
    r.other = s.text("other", "the set that moves away from `set`, or towards it");
  switch (r.kind) {
    case RecordKind::displacement:
    case RecordKind::opening:
    case RecordKind::force:
    case RecordKind::stress:
      r.direction = read_direction(s, space);
      break;
    case RecordKind::temperature:
    case RecordKind::crack_length:
    case RecordKind::crack_area:
    case RecordKind::crack_opening:
      break;
  }
  return r;
}

}  // namespace

std::vector<SetParameters> read_sets(const Section& root, const DeckSpace& space) {
  std::vector<SetParameters> sets;
  for (const Section& s : root.optional_sections(
           "sets",
           "parts of the body that stages, records and heat boundaries name, any number; see "
           "[Sets](../do/bodies.md#sets)")) {
    SetParameters set;
    set.name = s.text("name", "of the set; no name that a set of the program has");
    set.deck_place = fmt::format("{}: {}", s.where("name"), s.path());
    set.of = s.choice<SetOf, SetOf>(
        "of",
        {{"gridpoints", SetOf::gridpoints, "to hold, move, load or watch"},
         {"faces", SetOf::faces, "gridpoints of faces that lie wholly there and meet no other block"},
         {"blocks", SetOf::blocks, "gridpoints of blocks whose centroids lie there"},
         {"contacts", SetOf::contacts, "to watch cracks"}},
        SetOf::gridpoints, "items of the set");
    set.within = s.text("within", "", "a set of which this one is a part; without one, all of the body");
    read_place_of_set(s, space, set);
    if (s.ok() && std::ranges::find(sets, set.name, &SetParameters::name) != sets.end())
      s.error("name", fmt::format("\"{}\" is the name of another set", set.name));
    sets.push_back(std::move(set));
  }
  return sets;
}

std::vector<RecordParameters> read_records(const Section& root, const DeckSpace& space) {
  std::vector<RecordParameters> records;
  for (const Section& s : root.optional_sections(
           "record",
           "quantities that are recorded: columns of history.csv and curves of the figures, any number")) {
    RecordParameters record = read_record(s, space);
    if (s.ok() && std::ranges::find(records, record.name, &RecordParameters::name) != records.end())
      s.error("name", fmt::format("\"{}\" is the name of another record", record.name));
    records.push_back(std::move(record));
  }
  return records;
}

}  // namespace pyroclast
