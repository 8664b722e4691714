#include "pyroclast/stages/until.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

namespace pyroclast {

namespace {

/// Largest noise with which a peak counts, over the recorded values; less where less is to fall from the
/// peak.
constexpr double kMostNoise = 0.1;
/// Share of its peak below which a record is behind the peak; the next peak is greater by as much.
constexpr double kBehindPeak = 1.0 - PeakRule().fall;

}  // namespace

RecordWatch::RecordWatch(const DriveKeys& drive) : drive_(drive) {
  // sized before the stage begins, because a state may be read into them
  kept_.last.resize(drive.until.size());
  kept_.peaks.resize(drive.until.size());
  kept_.record_peaks.resize(drive.records.size());
  for (const RecordKind kind : {RecordKind::force, RecordKind::stress})
    if (const auto first = std::ranges::find(drive.records, kind, &RecordParameters::kind);
        !leading_ && first != drive.records.end())
      leading_ = first->name;
}

RecordWatch::Seen RecordWatch::read(const Simulation& simulation) const {
  return simulation.ranks().together([&] {
    Seen seen;
    for (const RecordParameters& record : drive_.records)
      seen.values.push_back(simulation.record(record.name).read(simulation));
    seen.energy = simulation.motion().totals().energy();
    return seen;
  });
}

double RecordWatch::value(const Seen& seen, std::string_view record) const {
  const auto found = std::ranges::find(drive_.records, record, &RecordParameters::name);
  return seen.values.at(static_cast<std::size_t>(found - drive_.records.begin()));
}

void RecordWatch::begin(const Simulation& simulation) {
  kept_.record_peaks.assign(drive_.records.size(), {});
  kept_.peaks.assign(drive_.until.size(), {});
  kept_.last.clear();
  const Seen seen = read(simulation);
  for (const EndCondition& until : drive_.until)
    simulation.record(until.record).require_there(simulation, until.place);
  for (const EndCondition& until : drive_.until) kept_.last.push_back(value(seen, until.record));
  kept_.first_work = seen.energy.loading;
  kept_.most_kinetic = std::abs(seen.energy.kinetic);
}

void RecordWatch::take_peaks(const Simulation& simulation, double driven, bool is_driven) {
  const Seen seen = read(simulation);
  kept_.is_beyond_noise = kept_.is_beyond_noise || is_beyond_noise(kMostNoise, seen.energy);
  for (std::size_t i = 0; i < seen.values.size(); ++i)
    kept_.record_peaks[i].take(i, driven, is_driven && kept_.is_beyond_noise, simulation.motion().time(),
                               seen.values);
  for (std::size_t i = 0; i < drive_.until.size(); ++i) {
    const EndCondition& until = drive_.until[i];
    if (until.kind != EndCondition::Kind::share_of_peak || !is_driven) continue;
    const double size = std::abs(value(seen, until.record));
    const double most_noise = std::min(kMostNoise, 1.0 - until.value);
    if (kept_.peaks[i].size() > 0.0 ||
        (until.least_peak ? size > *until.least_peak : is_beyond_noise(most_noise, seen.energy)))
      kept_.peaks[i].take(driven, size, rule_of_records(kept_.peaks[i]));
  }
}

/// Tells whether noise is below a share of what records show of the stage. Forces go with the root of an
/// energy. So the kinetic energy, at any call so far, must be below the square of that share of the work of
/// the loads. A stage that loads nothing shakes nothing.
bool RecordWatch::is_beyond_noise(double share, const EnergyLedger& energy) {
  kept_.most_kinetic = std::max(kept_.most_kinetic, std::abs(energy.kinetic));
  return !drive_.loads() || kept_.most_kinetic <= share * share * std::abs(energy.loading - kept_.first_work);
}

bool RecordWatch::judge(double time, std::string_view lost) {
  bool is_over = false;
  for (std::size_t i = 0; i < drive_.until.size(); ++i) {
    if (!is_met(i, time, lost)) continue;
    is_over = true;
    if (drive_.until[i].kind == EndCondition::Kind::share_of_peak)
      for (RecordPeak& peak : kept_.record_peaks) peak.end();
  }
  kept_.last_look = time;
  return is_over;
}

bool RecordWatch::is_met(std::size_t condition, double time, std::string_view lost) {
  const EndCondition& until = drive_.until[condition];
  double& last = kept_.last[condition];
  const double value = this->value(seen_, until.record);
  const double rate = std::abs(value - last) / (time - kept_.last_look);
  last = value;
  if (until.record == lost) return false;
  switch (until.kind) {
    case EndCondition::Kind::above:
      return value > until.value;
    case EndCondition::Kind::below:
      return value < until.value;
    case EndCondition::Kind::share_of_peak:
      return kept_.peaks[condition].is_found() &&
             std::abs(value) < until.value * kept_.peaks[condition].size();
    case EndCondition::Kind::rate_above:
      return rate > until.value;
    case EndCondition::Kind::rate_below:
      return rate < until.value;
  }
  return false;
}

bool RecordWatch::has_fallen() {
  if (!leading_) return false;
  if (kept_.leading_peak == 0.0 && !is_beyond_noise(kMostNoise, seen_.energy)) return false;
  const double size = std::abs(value(seen_, *leading_));
  kept_.leading_peak = std::max(kept_.leading_peak, size);
  if (size >= kBehindPeak * kept_.leading_peak || kept_.framed_peak >= kBehindPeak * kept_.leading_peak)
    return false;
  kept_.framed_peak = kept_.leading_peak;
  return true;
}

std::vector<std::string> RecordWatch::describe_unmet() const {
  std::vector<std::string> lines;
  for (std::size_t i = 0; i < drive_.until.size(); ++i) lines.push_back(describe_unmet(i));
  return lines;
}

std::string RecordWatch::describe_unmet(std::size_t condition) const {
  const EndCondition& until = drive_.until[condition];
  const auto record = std::ranges::find(drive_.records, until.record, &RecordParameters::name);
  const double factor = column_over_si(record->kind);
  const std::string unit = column_of(*record).unit;
  const double last = factor * kept_.last[condition];
  switch (until.kind) {
    case EndCondition::Kind::above:
      return fmt::format("{} is {:.4g} {}, not above {:.4g}", until.record, last, unit, factor * until.value);
    case EndCondition::Kind::below:
      return fmt::format("{} is {:.4g} {}, not below {:.4g}", until.record, last, unit, factor * until.value);
    case EndCondition::Kind::share_of_peak:
      if (!kept_.peaks[condition].is_found())
        return fmt::format("{} had no peak; it is {:.4g} {}", until.record, last, unit);
      return fmt::format("{} is {:.4g} {}, not below {:g} of its peak, {:.4g}", until.record, last, unit,
                         until.value, factor * kept_.peaks[condition].size());
    case EndCondition::Kind::rate_above:
      return fmt::format("{} did not change faster than {:.4g} {}/s", until.record, factor * until.value,
                         unit);
    case EndCondition::Kind::rate_below:
      return fmt::format("{} did not change more slowly than {:.4g} {}/s", until.record, factor * until.value,
                         unit);
  }
  return {};
}

void RecordWatch::visit_state(StateVisitor& visitor) {
  auto& [record_peaks, peaks, last, last_look, leading_peak, framed_peak, first_work, most_kinetic,
         is_beyond_noise] = kept_;  // a new member needs a name here
  const auto visit_all = [&](const char* name, auto& all, auto... more) {
    for (std::size_t i = 0; i < all.size(); ++i) {
      const StateVisitor::Scope scope(visitor, fmt::format("{}[{}]", name, i));
      all[i].visit_state(visitor, more...);
    }
  };
  visit_all("record_peaks", record_peaks, drive_.records.size());
  visit_all("peaks", peaks);
  visitor.visit("last", last, state::finite().of(drive_.until.size()));
  visitor.visit("last_look", last_look);
  visitor.visit("leading_peak", leading_peak);
  visitor.visit("framed_peak", framed_peak);
  visitor.visit("first_work", first_work);
  visitor.visit("most_kinetic", most_kinetic);
  visitor.visit("is_beyond_noise", is_beyond_noise);
}

}  // namespace pyroclast
