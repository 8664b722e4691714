#include "pyroclast/simulation/gauges.hpp"

#include <array>
#include <cmath>
#include <utility>

#include <fmt/format.h>

#include "pyroclast/mechanics/cracks.hpp"

namespace pyroclast {

namespace {

/// Column and the function that takes its value from a measurement.
template <class Measured>
struct ColumnOf {
  const char* name;
  const char* unit;
  const char* meaning;
  double (*value)(const Measured&);
};

/// Makes a gauge that measures once for all its columns. The table must outlive the gauge.
template <class Measured, std::size_t N, class Measure>
Gauge make_gauge(const std::array<ColumnOf<Measured>, N>& table, Measure measure, bool of_motion) {
  Gauge gauge;
  for (const auto& column : table) gauge.columns.push_back({column.name, column.unit});
  gauge.read = [&table, measure](const Simulation& simulation) {
    const Measured& measured = measure(simulation);
    std::vector<double> values;
    for (const auto& column : table) values.push_back(column.value(measured));
    return values;
  };
  gauge.of_motion = of_motion;
  return gauge;
}

constexpr double kMega = 1e-6;

using M = Motion;
constexpr auto kClock = std::to_array<ColumnOf<M>>({
    {"step", "1", "steps of the mechanics since the start",
     [](const M& m) { return static_cast<double>(m.steps()); }},
    {"time_s", "s", "time of the mechanics since the start", [](const M& m) { return m.time(); }},
});

using S = Simulation;
constexpr auto kTemperature = std::to_array<ColumnOf<S>>({
    {"heating_time_s", "s", "time since heating began", [](const S& s) { return s.heating_time(); }},
    {"temperature_degC", "degC", "mean temperature over the volume of the specimen",
     [](const S& s) { return s.field().mean(); }},
    {"temperature_min_degC", "degC", "lowest temperature of the specimen",
     [](const S& s) { return s.field().minimum(); }},
    {"temperature_max_degC", "degC", "highest temperature of the specimen",
     [](const S& s) { return s.field().maximum(); }},
});

using P = Press;
constexpr auto kPress = std::to_array<ColumnOf<P>>({
    {"strain", "1",
     "approach of the platens' inner faces over the height, since the body came to rest; shortening counts "
     "as positive",
     [](const P& p) { return p.strain(); }},
    {"stage_strain", "1", "the same since the stage began", [](const P& p) { return p.stage_strain(); }},
    {"specimen_strain", "1",
     "approach of the specimen's own ends over its height, since the body came to rest",
     [](const P& p) { return p.specimen_strain(); }},
    {"stress_MPa", "MPa", "mean reaction of both platens over the area; compression counts as positive",
     [](const P& p) { return p.stress() * kMega; }},
    {"stress_top_MPa", "MPa", "reaction of the upper platen over the area",
     [](const P& p) { return p.stress_top() * kMega; }},
    {"stress_bottom_MPa", "MPa", "reaction of the lower platen over the area",
     [](const P& p) { return p.stress_bottom() * kMega; }},
    {"lateral_strain", "1",
     "widening over the width, since the body came to rest; of a solid the mean of both directions across "
     "the axis",
     [](const P& p) { return p.lateral_strain(); }},
});

/// Measurements of the whole body's motion.
struct MotionReading {
  double unbalanced_ratio = 0.0, largest_jump = 0.0;
  EnergyLedger energy;
};

MotionReading measure_motion(const Motion& motion) {
  return {motion.totals().unbalanced_ratio(), motion.totals().largest_relative_jump(),
          motion.totals().energy()};
}

constexpr auto kMotion = std::to_array<ColumnOf<MotionReading>>({
    {"unbalanced_ratio", "1",
     "unbalanced forces over all forces on gridpoints; small where the body is at rest",
     [](const MotionReading& m) { return m.unbalanced_ratio; }},
    {"kinetic_over_strain", "1", "kinetic over elastic energy",
     [](const MotionReading& m) { return m.energy.kinetic_over_elastic(); }},
    {"largest_jump", "1",
     "largest jump of a contact point over the length of its edge; of a solid over the mean block size",
     [](const MotionReading& m) { return m.largest_jump; }},
});

/// Makes a gauge of the hottest gas that heat flows from or to.
Gauge gas_gauge() {
  Gauge gauge;
  gauge.columns.push_back({"gas_max_degC", "degC"});
  gauge.read = [](const Simulation& s) {
    return std::vector<double>{*s.field().conduction()->hottest_gas()};
  };
  return gauge;
}

/// Makes a gauge of contacts whose sides have temperatures of their own.
Gauge gap_gauge(const Model& model) {
  Gauge gauge;
  const Column extent = extent_column(model);
  gauge.columns.push_back({"heat_gap_" + extent.name, extent.unit});
  gauge.read = [](const Simulation& s) {
    return std::vector<double>{s.field().conduction()->gap_area() / s.model().thickness};
  };
  return gauge;
}

/// Calls one of two functions for each energy, in the order of the columns: `of_entry` for an entry of the
/// ledger, and `of_dissipated`, with its number, for an energy that contact laws or creep dissipate.
template <class OfEntry, class OfDissipated>
void for_each_energy(std::size_t dissipations, OfEntry of_entry, OfDissipated of_dissipated) {
  bool are_told = false;
  for (const auto& entry : kEnergies) {
    const bool follows = entry.side == LedgerSide::lost || entry.side == LedgerSide::error;
    if (follows && !std::exchange(are_told, true))
      for (std::size_t i = 0; i < dissipations; ++i) of_dissipated(i);
    of_entry(entry);
  }
}

Gauge motion_gauge(const Motion& motion) {
  Gauge gauge;
  for (const auto& column : kMotion) gauge.columns.push_back({column.name, column.unit});
  const auto names = motion.dissipations();
  for_each_energy(
      names.size(),
      [&](const auto& entry) {
        gauge.columns.push_back({entry.column, "J"});
      },
      [&](std::size_t i) {
        gauge.columns.push_back({fmt::format("dissipated_{}_J", names[i]), "J"});
      });
  gauge.read = [](const Simulation& simulation) {
    const MotionReading measured = measure_motion(simulation.motion());
    std::vector<double> values;
    for (const auto& column : kMotion) values.push_back(column.value(measured));
    const auto& dissipated = measured.energy.dissipated.energies;
    for_each_energy(
        dissipated.size(), [&](const auto& entry) { values.push_back(entry.value(measured.energy)); },
        [&](std::size_t i) { values.push_back(dissipated[i]); });
    return values;
  };
  gauge.of_motion = true;
  return gauge;
}

/// Makes a gauge of rate and heat of a computed field.
Gauge transport_gauge() {
  Gauge gauge;
  gauge.columns.push_back({"rate_K_s", "K/s"});
  for (const auto& entry : kHeats) gauge.columns.push_back({entry.column, "J"});
  gauge.read = [](const Simulation& simulation) {
    const HeatSolver& conduction = *simulation.field().conduction();
    const HeatLedger heat = conduction.ledger();
    std::vector<double> values{conduction.rate()};
    for (const auto& entry : kHeats) values.push_back(entry.value(heat));
    return values;
  };
  return gauge;
}

/// Makes a gauge of cracks, with columns for each mode and interface in which the laws of the body can break.
Gauge crack_gauge(const Motion& motion) {
  Gauge gauge;
  const auto kinds = motion.crack_kinds();
  const Column extent = extent_column(motion.model());
  for (const CrackKind& kind : kinds)
    for (const Column& column : {Column{"damaged", "1"}, Column{"broken", "1"}, extent,
                                 Column{"broken_" + extent.name, extent.unit}})
      gauge.columns.push_back({fmt::format("{}_{}", kind.name, column.name), column.unit});
  gauge.columns.push_back({"mean_opening_m", "m"});
  gauge.read = [kinds](const Simulation& simulation) {
    const Cracks cracks = simulation.motion().totals().count_cracks(kinds);
    std::vector<double> values;
    for (const CrackCount& count : cracks.of_kind)
      values.insert(values.end(), {static_cast<double>(count.damaged), static_cast<double>(count.broken),
                                   count.extent, count.broken_extent});
    values.push_back(cracks.mean_opening);
    return values;
  };
  gauge.of_motion = true;
  return gauge;
}

/// Makes a gauge with a column for each record of motion, or of temperature.
Gauge record_gauge(const Simulation& simulation, bool of_motion) {
  const auto is_of_it = [of_motion](const Record& record) {
    return (record.parameters().kind != RecordKind::temperature) == of_motion;
  };
  Gauge gauge;
  for (const Record& record : simulation.records())
    if (is_of_it(record)) gauge.columns.push_back(column_of(record.parameters()));
  gauge.read = [is_of_it](const Simulation& s) {
    std::vector<double> values;
    for (const Record& record : s.records())
      if (is_of_it(record)) values.push_back(column_over_si(record.parameters().kind) * record.read(s));
    return values;
  };
  gauge.of_motion = of_motion;
  return gauge;
}

const Motion& motion_of(const Simulation& simulation) {
  return simulation.motion();
}

template <class Measured, std::size_t N>
void add_infos(std::vector<ColumnInfo>& to, const std::array<ColumnOf<Measured>, N>& table) {
  for (const auto& column : table) to.push_back({column.name, column.unit, column.meaning});
}

/// Adds the columns of a ledger, with the side on which each entry stands.
template <class Ledger, std::size_t N>
void add_infos(std::vector<ColumnInfo>& to, const std::array<LedgerEntry<Ledger>, N>& ledger,
               const char* what) {
  const auto side = [](LedgerSide of) {
    switch (of) {
      case LedgerSide::put_in:
        return "put in, ";
      case LedgerSide::held:
        return "held, ";
      case LedgerSide::lost:
        return "lost, ";
      case LedgerSide::error:
        return "error, ";
    }
    return "";
  };
  for (const auto& entry : ledger)
    to.push_back({entry.column, "J", fmt::format("{} {}{}", what, side(entry.side), entry.meaning)});
}

}  // namespace

Column extent_column(const Model& model) {
  return model.dimension() == 2 ? Column{"length_m", "m"} : Column{"area_m2", "m2"};
}

std::vector<Gauge> clock_gauges(const Simulation& simulation) {
  if (!simulation.moves()) return {};
  return {make_gauge(kClock, motion_of, true)};
}

std::vector<Gauge> temperature_gauges() {
  return {make_gauge(
      kTemperature, [](const Simulation& s) -> const Simulation& { return s; }, false)};
}

std::vector<Gauge> motion_gauges(const Simulation& simulation) {
  if (!simulation.moves()) return {};
  std::vector<Gauge> gauges;
  if (simulation.has_press())
    gauges.push_back(make_gauge(
        kPress, [](const Simulation& s) -> const Press& { return s.press(); }, true));
  gauges.push_back(motion_gauge(simulation.motion()));
  gauges.push_back(crack_gauge(simulation.motion()));
  return gauges;
}

std::vector<Gauge> record_gauges(const Simulation& simulation) {
  std::vector<Gauge> gauges;
  if (simulation.moves()) gauges.push_back(record_gauge(simulation, true));
  gauges.push_back(record_gauge(simulation, false));
  return gauges;
}

std::vector<Gauge> transport_gauges(const Simulation& simulation) {
  if (simulation.field().is_uniform()) return {};
  std::vector<Gauge> gauges{transport_gauge()};
  if (simulation.field().conduction()->hottest_gas()) gauges.push_back(gas_gauge());
  if (simulation.cracks_hinder_heat()) gauges.push_back(gap_gauge(simulation.model()));
  return gauges;
}

std::vector<Gauge> probe_gauges(const Simulation& simulation) {
  Gauge gauge;
  for (const auto& probe : simulation.probes())
    gauge.columns.push_back({fmt::format("probe_{}_degC", probe.name()), "degC"});
  gauge.read = [](const Simulation& s) {
    std::vector<double> values;
    for (const auto& probe : s.probes()) values.push_back(probe.read(s.field().gridpoints()));
    return values;
  };
  return {std::move(gauge)};
}

std::vector<ColumnInfo> possible_gauge_columns() {
  std::vector<ColumnInfo> infos;
  add_infos(infos, kClock);
  add_infos(infos, kTemperature);
  add_infos(infos, kPress);
  add_infos(infos, kMotion);
  add_infos(infos, kEnergies, "energy");
  infos.push_back({"dissipated_NAME_J", "J", "energy lost by one part of the contact laws, or by creep"});
  const std::string crack = "MODE_INTERFACE_";
  infos.push_back(
      {crack + "damaged", "1", "contact points of the interface whose damage by the mode is above 0"});
  infos.push_back({crack + "broken", "1", "contact points of the interface whose damage by the mode is 1"});
  infos.push_back(
      {crack + "length_m", "m", "length that the damaged contact points stand for, of a plane body"});
  infos.push_back({crack + "area_m2", "m2", "area that the damaged contact points stand for, of a solid"});
  infos.push_back(
      {crack + "broken_length_m", "m", "length that the broken contact points stand for, of a plane body"});
  infos.push_back(
      {crack + "broken_area_m2", "m2", "area that the broken contact points stand for, of a solid"});
  infos.push_back(
      {"mean_opening_m", "m", "mean opening of contacts damaged in tension or mixed mode, by extent"});
  infos.push_back({"NAME_UNIT", "its own", "a [[record]] of the deck"});
  infos.push_back({"rate_K_s", "K/s", "root of the mean square of the temperature's rate over the volume"});
  infos.push_back({"gas_max_degC", "degC", "hottest gas of all boundaries of heat"});
  add_infos(infos, kHeats, "heat");
  infos.push_back({"heat_gap_length_m", "m",
                   "length of the contacts whose sides have temperatures of their own, of a plane body"});
  infos.push_back({"heat_gap_area_m2", "m2", "area of these contacts, of a solid"});
  infos.push_back({"probe_NAME_degC", "degC", "temperature at a [[probes]] of the deck"});
  return infos;
}

}  // namespace pyroclast
