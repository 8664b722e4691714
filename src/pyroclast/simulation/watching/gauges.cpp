#include "pyroclast/simulation/watching/gauges.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include <fmt/format.h>

#include "pyroclast/mechanics/cracks.hpp"

namespace pyroclast {

namespace {

/// Column and the function that takes its value from a measurement. Words in capitals in the name stand for
/// names of the body.
template <class Measured>
struct ColumnOf {
  const char* name;
  const char* unit;
  ColumnRole role;
  const char* of;
  const char* meaning;
  double (*value)(const Measured&);
};

/// Returns the columns of a table.
template <class Measured, std::size_t N>
std::vector<Column> columns_of(const std::array<ColumnOf<Measured>, N>& table) {
  std::vector<Column> columns;
  for (const auto& column : table)
    columns.push_back({column.name, column.unit, column.meaning, column.role, column.of});
  return columns;
}

void append(std::vector<Column>& to, const std::vector<Column>& more) {
  to.insert(to.end(), more.begin(), more.end());
}

/// Makes a gauge that measures once for all its columns. The table must outlive the gauge.
template <class Measured, std::size_t N, class Measure>
Gauge make_gauge(const std::array<ColumnOf<Measured>, N>& table, Measure measure, bool of_motion) {
  Gauge gauge;
  gauge.columns = columns_of(table);
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
    {"step", "1", ColumnRole::clock, "step", "steps of the mechanics since the start",
     [](const M& m) { return static_cast<double>(m.steps()); }},
    {"time_s", "s", ColumnRole::clock, "time", "time of the mechanics since the start",
     [](const M& m) { return m.time(); }},
});

using S = Simulation;
constexpr auto kTemperature = std::to_array<ColumnOf<S>>({
    {"heating_time_s", "s", ColumnRole::clock, "heating_time", "time since heating began",
     [](const S& s) { return s.heating_time(); }},
    {"temperature_degC", "degC", ColumnRole::temperature, "mean",
     "mean temperature over the volume of the specimen", [](const S& s) { return s.field().mean(); }},
    {"temperature_min_degC", "degC", ColumnRole::temperature, "lowest", "lowest temperature of the specimen",
     [](const S& s) { return s.field().minimum(); }},
    {"temperature_max_degC", "degC", ColumnRole::temperature, "highest",
     "highest temperature of the specimen", [](const S& s) { return s.field().maximum(); }},
});

using P = Press;
constexpr auto kPress = std::to_array<ColumnOf<P>>({
    {"strain", "1", ColumnRole::press, "strain",
     "approach of the platens' inner faces over the height, since the body came to rest; shortening counts "
     "as positive",
     [](const P& p) { return p.strain(); }},
    {"stage_strain", "1", ColumnRole::press, "stage_strain", "the same since the stage began",
     [](const P& p) { return p.stage_strain(); }},
    {"specimen_strain", "1", ColumnRole::press, "specimen_strain",
     "approach of the specimen's own ends over its height, since the body came to rest",
     [](const P& p) { return p.specimen_strain(); }},
    {"stress_MPa", "MPa", ColumnRole::press, "stress",
     "mean reaction of both platens over the area; compression counts as positive",
     [](const P& p) { return p.stress() * kMega; }},
    {"stress_top_MPa", "MPa", ColumnRole::press, "stress_top", "reaction of the upper platen over the area",
     [](const P& p) { return p.stress_top() * kMega; }},
    {"stress_bottom_MPa", "MPa", ColumnRole::press, "stress_bottom",
     "reaction of the lower platen over the area", [](const P& p) { return p.stress_bottom() * kMega; }},
    {"lateral_strain", "1", ColumnRole::press, "lateral_strain",
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
    {"unbalanced_ratio", "1", ColumnRole::rest, "unbalanced_ratio",
     "unbalanced forces over all forces on gridpoints; small where the body is at rest",
     [](const MotionReading& m) { return m.unbalanced_ratio; }},
    {"kinetic_over_strain", "1", ColumnRole::rest, "kinetic_over_elastic", "kinetic over elastic energy",
     [](const MotionReading& m) { return m.energy.kinetic_over_elastic(); }},
    {"largest_jump", "1", ColumnRole::rest, "largest_jump",
     "largest jump of a contact point over the length of its edge; of a solid over the mean block size",
     [](const MotionReading& m) { return m.largest_jump; }},
});

constexpr auto kTransport = std::to_array<ColumnOf<HeatSolver>>({
    {"rate_K_s", "K/s", ColumnRole::heat_flow, "rate",
     "root of the mean square of the temperature's rate over the volume",
     [](const HeatSolver& h) { return h.rate(); }},
});
constexpr auto kGas = std::to_array<ColumnOf<HeatSolver>>({
    {"gas_max_degC", "degC", ColumnRole::heat_flow, "hottest_gas", "hottest gas of all boundaries of heat",
     [](const HeatSolver& h) { return *h.hottest_gas(); }},
});

using W = MoistureField;
constexpr auto kWater = std::to_array<ColumnOf<W>>({
    {"water_kg", "kg", ColumnRole::water, "held", "water in the pores",
     [](const W& w) { return w.water().stored(); }},
    {"water_released_kg", "kg", ColumnRole::water, "released",
     "water that hydrates gave back to the pores since the start",
     [](const W& w) { return w.water().state().ledger.released; }},
    {"water_left_kg", "kg", ColumnRole::water, "left",
     "water that left the specimen since the start, less what came in",
     [](const W& w) { return w.water().state().ledger.left; }},
    {"water_error_kg", "kg", ColumnRole::water, "error",
     "water in the pores, less that at the start and what hydrates gave back, plus what left",
     [](const W& w) { return w.water().imbalance(); }},
    {"pore_pressure_max_MPa", "MPa", ColumnRole::water, "largest_pressure",
     "largest pressure of the vapour in pores, less that of the atmosphere",
     [](const W& w) { return w.largest_pore_pressure() * kMega; }},
    {"pore_pressure_over_saturation_max", "1", ColumnRole::water, "largest_pressure_ratio",
     "largest pressure of the vapour over that above water of the same temperature; above 1 where liquid "
     "fills the pores",
     [](const W& w) { return w.largest_pressure_ratio(); }},
});

constexpr auto kOfPressedContacts = std::to_array<ColumnOf<S>>({
    {"pore_pressure_over_strength_max", "1", ColumnRole::water, "largest_pressure_over_strength",
     "largest pore pressure that an intact contact bears over its tensile strength, see the field "
     "pressure_over_strength",
     [](const S& s) {
       double largest = 0.0;
       for (int c = 0; c < s.model().contact_count(); ++c)
         largest = std::max(largest, s.pressure_over_strength(c));
       return largest;
     }},
});

using Sp = Spalling;
constexpr auto kSpalling = std::to_array<ColumnOf<Sp>>({
    {"spalled_pieces", "1", ColumnRole::spalling, "pieces", "pieces that have left the body",
     [](const Sp& s) { return static_cast<double>(s.spalls().size()); }},
    {"spalled_blocks", "1", ColumnRole::spalling, "blocks", "blocks of these pieces",
     [](const Sp& s) { return static_cast<double>(s.blocks_gone()); }},
    {"spalled_mass_kg", "kg", ColumnRole::spalling, "mass", "mass of these pieces at 20 °C, without water",
     [](const Sp& s) { return s.mass_gone(); }},
    {"spalled_depth_mean_m", "m", ColumnRole::spalling, "mean_depth",
     "volume of these pieces over the area of the faces that fire acts on",
     [](const Sp& s) { return s.mean_depth(); }},
    {"spalled_depth_max_m", "m", ColumnRole::spalling, "largest_depth",
     "largest depth of these pieces below the faces of the start that fire acts on",
     [](const Sp& s) { return s.largest_depth(); }},
    {"lost_section", "1", ColumnRole::spalling, "lost_section",
     "volume of these pieces over that of the specimen", [](const Sp& s) { return s.lost_section(); }},
});

double gap_extent(const S& s) {
  return s.field().conduction()->gap_area() / s.model().thickness;
}

/// Extent of the contacts whose sides have temperatures of their own; the first is of plane bodies, the
/// second of bodies in space.
constexpr auto kGaps = std::to_array<ColumnOf<S>>({
    {"heat_gap_length_m", "m", ColumnRole::heat_flow, "gap_extent",
     "length of the contacts whose sides have temperatures of their own, of a plane body", gap_extent},
    {"heat_gap_area_m2", "m2", ColumnRole::heat_flow, "gap_extent", "area of these contacts, of a solid",
     gap_extent},
});

const HeatSolver& solver_of(const Simulation& simulation) {
  return *simulation.field().conduction();
}

/// Makes a gauge of contacts whose sides have temperatures of their own.
Gauge gap_gauge(const Model& model) {
  const std::size_t own = model.dimension() == 2 ? 0 : 1;
  return {{columns_of(kGaps)[own]},
          [own](const Simulation& s) { return std::vector<double>{kGaps[own].value(s)}; }};
}

/// What a side of a ledger is called in meanings, and the roles of its columns.
struct Side {
  const char* words;
  ColumnRole of_energy, of_heat;
};

Side words_of(LedgerSide side) {
  switch (side) {
    case LedgerSide::put_in:
      return {"put in", ColumnRole::energy_put_in, ColumnRole::heat_put_in};
    case LedgerSide::held:
      return {"held", ColumnRole::energy_held, ColumnRole::heat_held};
    case LedgerSide::lost:
      return {"lost", ColumnRole::energy_lost, ColumnRole::heat_lost};
    case LedgerSide::error:
      return {"error", ColumnRole::energy_error, ColumnRole::heat_error};
  }
  return {"", ColumnRole::own, ColumnRole::own};
}

/// Returns the column of an entry of a ledger.
/// \param of_what  "energy" or "heat"
/// \param role     Side::of_energy or Side::of_heat
template <class Ledger>
Column column_of_entry(const LedgerEntry<Ledger>& entry, const char* of_what, ColumnRole Side::*role) {
  const Side side = words_of(entry.side);
  return {entry.column, "J",        fmt::format("{} {}, {}", of_what, side.words, entry.meaning),
          side.*role,   entry.name, entry.label};
}

/// Returns the column of an energy that contact laws or creep dissipate.
Column dissipated_column(std::string_view name, std::string label = {}) {
  return {fmt::format("dissipated_{}_J", name),
          "J",
          "energy lost by one part of the contact laws, or by creep",
          ColumnRole::energy_lost,
          std::string(name),
          std::move(label)};
}

/// Calls one of two functions for each energy, in the order of the columns: `of_entry` for an entry of the
/// ledger, and `of_dissipated`, with its number, for an energy that contact laws or creep dissipate.
template <class OfEntry, class OfDissipated>
void for_each_energy(const EnergyLedger& ledger, std::size_t dissipations, OfEntry of_entry,
                     OfDissipated of_dissipated) {
  bool are_told = false;
  for (const auto& entry : kEnergies) {
    if (!entry.is_there(ledger)) continue;
    const bool follows = entry.side == LedgerSide::lost || entry.side == LedgerSide::error;
    if (follows && !std::exchange(are_told, true))
      for (std::size_t i = 0; i < dissipations; ++i) of_dissipated(i);
    of_entry(entry);
  }
}

/// Returns the columns of the energies, with those of the dissipated ones.
std::vector<Column> energy_columns(const EnergyLedger& ledger, const std::vector<Column>& dissipated) {
  std::vector<Column> columns;
  for_each_energy(
      ledger, dissipated.size(),
      [&](const auto& entry) { columns.push_back(column_of_entry(entry, "energy", &Side::of_energy)); },
      [&](std::size_t i) { columns.push_back(dissipated[i]); });
  return columns;
}

std::vector<Column> heat_columns(const HeatLedger& ledger) {
  std::vector<Column> columns;
  for (const auto& entry : kHeats)
    if (entry.is_there(ledger)) columns.push_back(column_of_entry(entry, "heat", &Side::of_heat));
  return columns;
}

/// Returns few words for an energy that a body dissipates, by the law that does.
std::string label_of_loss(const Motion& motion, std::string_view name) {
  for (const LawTable* law : motion.laws())
    for (const LossInfo& loss : law->losses)
      if (loss.is_energy() && loss.name == name && !std::string_view(loss.label).empty()) return loss.label;
  std::string label(name);
  std::ranges::replace(label, '_', ' ');
  return label;
}

Gauge motion_gauge(const Motion& motion) {
  Gauge gauge;
  gauge.columns = columns_of(kMotion);
  std::vector<Column> dissipated;
  for (const auto& name : motion.dissipations())
    dissipated.push_back(dissipated_column(name, label_of_loss(motion, name)));
  append(gauge.columns, energy_columns(motion.totals().energy(), dissipated));
  gauge.read = [](const Simulation& simulation) {
    const MotionReading measured = measure_motion(simulation.motion());
    std::vector<double> values;
    for (const auto& column : kMotion) values.push_back(column.value(measured));
    const auto& lost = measured.energy.dissipated.energies;
    for_each_energy(
        measured.energy, lost.size(),
        [&](const auto& entry) { values.push_back(entry.value(measured.energy)); },
        [&](std::size_t i) { values.push_back(lost[i]); });
    return values;
  };
  gauge.of_motion = true;
  return gauge;
}

/// Makes a gauge of rate and heat of a computed field.
Gauge transport_gauge(const HeatSolver& solver) {
  Gauge gauge;
  gauge.columns = columns_of(kTransport);
  append(gauge.columns, heat_columns(solver.ledger()));
  gauge.read = [](const Simulation& simulation) {
    const HeatSolver& conduction = solver_of(simulation);
    const HeatLedger heat = conduction.ledger();
    std::vector<double> values;
    for (const auto& column : kTransport) values.push_back(column.value(conduction));
    for (const auto& entry : kHeats)
      if (entry.is_there(heat)) values.push_back(entry.value(heat));
    return values;
  };
  return gauge;
}

/// Column of the cracks by a mode at an interface.
struct CrackColumn {
  int dimension;  ///< dimension of the bodies that have it; 0: any
  ColumnOf<CrackCount> of;
};

constexpr const char* kKindOfCracks = "MODE_INTERFACE";
constexpr auto kCracks = std::to_array<CrackColumn>({
    {0,
     {"damaged", "1", ColumnRole::crack_damaged, "points",
      "contact points of the interface whose damage by the mode is above 0",
      [](const CrackCount& c) { return static_cast<double>(c.damaged); }}},
    {0,
     {"broken", "1", ColumnRole::crack_broken, "points",
      "contact points of the interface whose damage by the mode is 1",
      [](const CrackCount& c) { return static_cast<double>(c.broken); }}},
    {2,
     {"length_m", "m", ColumnRole::crack_damaged_extent, "extent",
      "length that the damaged contact points stand for, of a plane body",
      [](const CrackCount& c) { return c.extent; }}},
    {3,
     {"area_m2", "m2", ColumnRole::crack_damaged_extent, "extent",
      "area that the damaged contact points stand for, of a solid",
      [](const CrackCount& c) { return c.extent; }}},
    {2,
     {"broken_length_m", "m", ColumnRole::crack_broken_extent, "extent",
      "length that the broken contact points stand for, of a plane body",
      [](const CrackCount& c) { return c.broken_extent; }}},
    {3,
     {"broken_area_m2", "m2", ColumnRole::crack_broken_extent, "extent",
      "area that the broken contact points stand for, of a solid",
      [](const CrackCount& c) { return c.broken_extent; }}},
});
constexpr auto kOpening = std::to_array<ColumnOf<Cracks>>({
    {"mean_opening_m", "m", ColumnRole::crack_opening, "mean",
     "mean opening of contacts damaged in tension or mixed mode, by extent",
     [](const Cracks& c) { return c.mean_opening; }},
});

/// Returns a column of the cracks of a kind, "tension_mortar_mortar", or of any kind.
Column crack_column(const CrackColumn& column, const char* kind, const char* mode = "",
                    const std::string& interface = {}) {
  return {fmt::format("{}_{}", kind, column.of.name),
          column.of.unit,
          column.of.meaning,
          column.of.role,
          column.of.of,
          {},
          mode,
          interface};
}

/// Makes a gauge of cracks, with columns for each mode and interface in which the laws of the body can break.
Gauge crack_gauge(const Motion& motion) {
  Gauge gauge;
  const auto kinds = motion.crack_kinds();
  const int dimension = motion.model().dimension();
  std::vector<double (*)(const CrackCount&)> read;
  for (const CrackColumn& column : kCracks)
    if (column.dimension == 0 || column.dimension == dimension) read.push_back(column.of.value);
  for (const CrackKind& kind : kinds)
    for (const CrackColumn& column : kCracks)
      if (column.dimension == 0 || column.dimension == dimension)
        gauge.columns.push_back(crack_column(column, kind.name.c_str(), name_of_mode(kind.damage),
                                             motion.model().interface_names[kind.interface]));
  append(gauge.columns, columns_of(kOpening));
  gauge.read = [kinds, read](const Simulation& simulation) {
    const Cracks cracks = simulation.motion().totals().count_cracks(kinds);
    std::vector<double> values;
    for (const CrackCount& count : cracks.of_kind)
      for (const auto value : read) values.push_back(value(count));
    for (const auto& column : kOpening) values.push_back(column.value(cracks));
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
  gauge.of_places = true;
  return gauge;
}

const Motion& motion_of(const Simulation& simulation) {
  return simulation.motion();
}

Column bar_column(const std::string& name) {
  return {fmt::format("bar_{}_degC", name), "degC",
          "mean temperature of what is left at the depth of a bar, see spalling.bars of the deck",
          ColumnRole::bar, name};
}

Column unspalled_bar_column(const std::string& name) {
  return {fmt::format("bar_{}_unspalled_degC", name), "degC",
          "the same, had no piece left; cracks hinder heat as they did when the first one left",
          ColumnRole::bar_unspalled, name};
}

Gauge bar_gauge(const Spalling& spalling) {
  Gauge gauge;
  gauge.of_places = true;
  for (const double depth : spalling.rule().bars) {
    gauge.columns.push_back(bar_column(name_of_bar(depth)));
    gauge.columns.push_back(unspalled_bar_column(name_of_bar(depth)));
  }
  gauge.read = [](const Simulation& s) {
    std::vector<double> values;
    for (std::size_t bar = 0; bar < s.spalling()->rule().bars.size(); ++bar)
      for (const TemperatureField* field : {&s.field(), &s.unspalled_field()})
        values.push_back(s.spalling()->temperature_at(bar, *field));
    return values;
  };
  return gauge;
}

Column probe_pressure_column(const std::string& name) {
  return {fmt::format("probe_{}_pore_MPa", name), "MPa",
          "pore pressure of the block at a [[probes]] of the deck, less that of the atmosphere",
          ColumnRole::probe_pressure, name};
}

Column probe_column(const std::string& name) {
  return {fmt::format("probe_{}_degC", name), "degC", "temperature at a [[probes]] of the deck",
          ColumnRole::probe, name};
}

}  // namespace

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
  if (simulation.spalling()) {
    gauges.push_back(make_gauge(
        kSpalling, [](const Simulation& s) -> const Spalling& { return *s.spalling(); }, false));
    gauges.push_back(bar_gauge(*simulation.spalling()));
  }
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
  std::vector<Gauge> gauges{transport_gauge(solver_of(simulation))};
  if (simulation.field().conduction()->hottest_gas()) gauges.push_back(make_gauge(kGas, solver_of, false));
  if (simulation.cracks_hinder_heat()) gauges.push_back(gap_gauge(simulation.model()));
  if (simulation.moisture())
    gauges.push_back(make_gauge(
        kWater, [](const Simulation& s) -> const MoistureField& { return *s.moisture(); }, false));
  if (simulation.moves() && simulation.moisture() && simulation.moisture()->acts_on_contacts())
    gauges.push_back(make_gauge(
        kOfPressedContacts, [](const Simulation& s) -> const Simulation& { return s; }, false));
  return gauges;
}

std::vector<Gauge> probe_gauges(const Simulation& simulation) {
  Gauge gauge;
  gauge.of_places = true;
  for (const auto& probe : simulation.probes()) gauge.columns.push_back(probe_column(probe.name()));
  gauge.read = [](const Simulation& s) {
    std::vector<double> values;
    for (const auto& probe : s.probes()) values.push_back(probe.read(s.field().gridpoints()));
    return values;
  };
  std::vector<Gauge> gauges{std::move(gauge)};
  if (!simulation.moisture()) return gauges;
  Gauge& pressures = gauges.emplace_back();
  pressures.of_places = true;
  for (const auto& probe : simulation.probes())
    pressures.columns.push_back(probe_pressure_column(probe.name()));
  pressures.read = [](const Simulation& s) {
    std::vector<double> values;
    for (const auto& probe : s.probes())
      if (const int block = s.model().block_of(probe.gridpoint()); s.is_gone(block))
        values.push_back(std::numeric_limits<double>::quiet_NaN());
      else
        values.push_back(kMega * s.moisture()->pore_pressure(block));
    return values;
  };
  return gauges;
}

std::vector<Column> possible_gauge_columns() {
  std::vector<Column> columns;
  EnergyLedger all;
  all.has_pore_pressure = all.loses_blocks = true;
  append(columns, columns_of(kClock));
  append(columns, columns_of(kTemperature));
  append(columns, columns_of(kPress));
  append(columns, columns_of(kMotion));
  append(columns, energy_columns(all, {dissipated_column("NAME")}));
  for (const CrackColumn& column : kCracks) columns.push_back(crack_column(column, kKindOfCracks));
  append(columns, columns_of(kOpening));
  columns.push_back({"NAME_UNIT", "its own", kMeaningOfRecord, ColumnRole::record});
  append(columns, columns_of(kTransport));
  append(columns, columns_of(kGas));
  HeatLedger all_heat;
  all_heat.loses_blocks = true;
  append(columns, heat_columns(all_heat));
  append(columns, columns_of(kGaps));
  append(columns, columns_of(kWater));
  append(columns, columns_of(kOfPressedContacts));
  append(columns, columns_of(kSpalling));
  columns.push_back(bar_column("NAME"));
  columns.push_back(unspalled_bar_column("NAME"));
  columns.push_back(probe_column("NAME"));
  columns.push_back(probe_pressure_column("NAME"));
  return columns;
}

}  // namespace pyroclast
