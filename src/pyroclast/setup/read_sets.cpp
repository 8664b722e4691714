#include "pyroclast/setup/read_sets.hpp"

#include <algorithm>
#include <string>
#include <string_view>

#include <fmt/format.h>

#include "pyroclast/setup/read_name.hpp"

namespace pyroclast {

namespace {

/// Returns a place of a deck as a vector, m.
Vec<3> vec_of(const std::pair<double, double>& place) {
  return {{place.first, place.second}};
}

/// Reads a list that must hold two places.
std::array<Vec<3>, 2> read_two(const Section& s, const char* key, Meaning meaning) {
  const auto places = s.places(key, unit::length, 2, meaning);
  if (places.size() > 2) s.error(key, "must be two places, [[x, y], [x, y]]");
  if (places.size() < 2) return {};
  return {vec_of(places[0]), vec_of(places[1])};
}

Place read_place_of_set(const Section& s) {
  constexpr const char* kForms[] = {"box", "centre", "line", "nearest"};
  int stated = 0;
  for (const char* form : kForms) stated += s.has(form) ? 1 : 0;
  if (stated > 1) s.error("one of box, centre, line and nearest; not several");
  s.know({"box", "centre", "radius", "line", "nearest"});
  if (s.has("box")) {
    const auto [low, high] = read_two(s, "box", "lower left and upper right corner, which belong to it");
    if (s.ok() && (low[0] > high[0] || low[1] > high[1]))
      s.error("box", "is inside out: the lower left corner comes first");
    return InBox{low, high};
  }
  if (s.has("centre")) {
    const auto centre = s.place("centre", unit::length, "of a disc");
    return InBall{vec_of(centre.value_or(std::pair{0.0, 0.0})),
                  s.quantity("radius", unit::length, Range::positive(), "of a disc")};
  }
  if (s.has("line")) {
    const auto [from, to] = read_two(s, "line", "the ends of a straight line, which belong to it");
    return OnLine{from, to};
  }
  if (s.has("nearest"))
    return NearestTo{vec_of(
        s.place("nearest", unit::length, "what is nearest to this place").value_or(std::pair{0.0, 0.0}))};
  return Everywhere{};
}

Vec<3> read_direction(const Section& s) {
  const std::string stated = s.word_or_text("direction", {{"x", 0, "to the right"}, {"y", 1, "upwards"}},
                                            "x or y behind a minus", "along which it is measured");
  const bool is_negative = stated.starts_with('-');
  const std::string axis = stated.substr(is_negative ? 1 : 0);
  if (axis != "x" && axis != "y")
    s.error("direction", fmt::format("must be \"x\", \"y\", \"-x\" or \"-y\"; got \"{}\"", stated));
  const double sign = is_negative ? -1.0 : 1.0;
  return axis == "y" ? Vec<3>{{0.0, sign}} : Vec<3>{{sign, 0.0}};
}

RecordParameters read_record(const Section& s) {
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
       {"crack_opening", RecordKind::crack_opening, "mean over a set of contacts, by length"}},
      "what is recorded");
  r.set = s.text("set", "of which it is; see [bodies.md](bodies.md#sets)");
  s.know({"other", "direction", "over"});
  if (r.kind == RecordKind::displacement || r.kind == RecordKind::opening ||
      r.kind == RecordKind::temperature)
    r.over =
        s.choice<MeanOver, MeanOver>("over",
                                     {{"size", MeanOver::size,
                                       "the zones that lie wholly in the set, by area; where there is none "
                                       "its faces, by length; else gridpoints"},
                                      {"gridpoints", MeanOver::gridpoints, "its gridpoints, each alike"}},
                                     MeanOver::size, "what the mean is taken over");
  if (r.kind == RecordKind::opening)
    r.other = s.text("other", "the set that moves away from `set`, or towards it");
  switch (r.kind) {
    case RecordKind::displacement:
    case RecordKind::opening:
    case RecordKind::force:
    case RecordKind::stress:
      r.direction = read_direction(s);
      break;
    case RecordKind::temperature:
    case RecordKind::crack_length:
    case RecordKind::crack_opening:
      break;
  }
  return r;
}

}  // namespace

std::vector<SetParameters> read_sets(const Section& root) {
  std::vector<SetParameters> sets;
  for (const Section& s : root.optional_sections(
           "sets",
           "parts of the body that stages, records and heat boundaries name, any number; see "
           "[bodies.md](bodies.md#sets)")) {
    SetParameters set;
    set.name = s.text("name", "another than those of the sets that there are anyhow");
    set.deck_place = fmt::format("{}: {}", s.where("name"), s.path());
    set.of = s.choice<SetOf, SetOf>(
        "of",
        {{"gridpoints", SetOf::gridpoints, "to hold, move, load or watch"},
         {"faces", SetOf::faces, "those of faces that lie wholly there and meet no other block"},
         {"blocks", SetOf::blocks, "those of blocks whose centroids lie there"},
         {"contacts", SetOf::contacts, "to watch cracks"}},
        SetOf::gridpoints, "what it is a set of");
    set.within = s.text("within", "", "a set that it is a part of; without one, all of the body");
    set.place = read_place_of_set(s);
    if (s.ok() && std::ranges::find(sets, set.name, &SetParameters::name) != sets.end())
      s.error("name", fmt::format("\"{}\" is the name of another set", set.name));
    sets.push_back(std::move(set));
  }
  return sets;
}

std::vector<RecordParameters> read_records(const Section& root) {
  std::vector<RecordParameters> records;
  for (const Section& s : root.optional_sections(
           "record",
           "quantities that are recorded: columns of history.csv and curves of the figures, any number")) {
    RecordParameters record = read_record(s);
    if (s.ok() && std::ranges::find(records, record.name, &RecordParameters::name) != records.end())
      s.error("name", fmt::format("\"{}\" is the name of another record", record.name));
    records.push_back(std::move(record));
  }
  return records;
}

}  // namespace pyroclast
