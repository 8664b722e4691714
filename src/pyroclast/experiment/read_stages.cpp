#include "pyroclast/experiment/read_stages.hpp"

#include "pyroclast/thermal/boundary_condition.hpp"

namespace pyroclast {

namespace {

SettleStage read_settle(const Section& s) {
  SettleStage stage;
  stage.unbalanced_ratio = s.number("unbalanced_ratio", Range::positive());
  stage.most_steps = s.integer("most_steps", Range::between(1, 1e12));
  return stage;
}

/// The velocity changes between `velocity` and `fastest_velocity`.
VelocityControl read_velocity_control(const Section& s, const CompressStage& stage) {
  VelocityControl c;
  c.fastest = s.quantity("fastest_velocity", unit::velocity, Range::positive());
  if (s.ok() && c.fastest < stage.velocity) s.error("fastest_velocity", "must not be less than velocity");
  if (s.ok() && stage.ramp_time == 0.0)
    s.error("ramp_time", "must be greater than 0 with fastest_velocity: it bounds the acceleration");
  c.unbalanced_ratio = s.number("unbalanced_ratio", Range::positive());
  c.kinetic_over_strain = s.number("kinetic_over_strain", Range::positive());
  c.platen_difference = s.number("platen_difference", Range::positive());
  c.dissipation_rate = s.quantity("dissipation_rate", unit::frequency, Range::positive());
  return c;
}

CompressStage read_compress(const Section& s) {
  CompressStage stage;
  stage.velocity = s.quantity("velocity", unit::velocity, Range::positive());
  stage.ramp_time = s.quantity("ramp_time", unit::time, Range::non_negative());
  if (s.has("fastest_velocity"))
    stage.control = read_velocity_control(s, stage);
  else
    s.know({"unbalanced_ratio", "kinetic_over_strain", "platen_difference", "dissipation_rate"});
  stage.stop_strain = s.number("stop_strain", Range::inside(0.0, 1.0));
  stage.stop_fraction =
      s.number("stop_fraction_of_peak", {.lower = 0.0, .upper = 1.0, .upper_inclusive = false}, 0.0);
  return stage;
}

/// The load is a stress, or a level: a fraction of a strength that is given with it.
LoadStage read_load(const Section& s) {
  LoadStage stage;
  if (s.has("level")) {
    stage.level = s.number("level", Range::non_negative());
    stage.stress = *stage.level * s.quantity("f_c", unit::stress, Range::positive());
    if (s.has("stress")) s.error("stress", "either stress, or level and f_c; not both");
  } else {
    stage.stress = s.quantity("stress", unit::stress, Range::non_negative());
  }
  stage.ramp_time = s.quantity("ramp_time", unit::time, Range::non_negative());
  stage.unbalanced_ratio = s.number("unbalanced_ratio", Range::positive());
  stage.most_steps = s.integer("most_steps", Range::between(1, 1e12));
  return stage;
}

/// How temperatures are handed to the mechanics: [coupling], the same for all stages.
Coupling read_coupling(const Section& s) {
  Coupling c;
  c.increment = s.quantity("exchange_increment", unit::temperature_difference, Range::positive());
  c.unbalanced_ratio = s.number("unbalanced_ratio", Range::positive());
  c.platen_difference = s.quantity("platen_difference", unit::stress, Range::positive());
  c.least_cycles = s.integer("least_cycles", Range::between(0, 1e12));
  c.most_cycles = s.integer("most_cycles", Range::between(1, 1e12));
  if (s.ok() && c.most_cycles < c.least_cycles) s.error("most_cycles", "must not be less than least_cycles");
  c.predictor = s.flag("predictor", false);
  c.failure_strain = s.number("failure_strain", Range::inside(0.0, 1.0));
  return c;
}

PlatenControl read_platen(const Section& s) {
  return s.choice<PlatenControl>("platen",
                                 {{"force", PlatenControl::force}, {"fixed", PlatenControl::fixed}});
}

HeatStage read_heat_stage(const Section& s, const Coupling& coupling) {
  HeatStage stage;
  stage.to = s.quantity("to", unit::temperature, Range::at_least(absolute_zero));
  stage.rate = s.quantity("rate", unit::heating_rate, Range::positive());
  stage.coupling = coupling;
  stage.coupling.platen = read_platen(s);
  return stage;
}

ExposeStage read_expose(const Section& s, const Coupling& coupling) {
  ExposeStage stage;
  stage.duration = s.quantity("duration", unit::time, Range::positive());
  stage.coupling = coupling;
  stage.coupling.platen = read_platen(s);
  return stage;
}

/// The frame interval stands in [output].
HeatRun read_conduct(const Section& s) {
  HeatRun run;
  run.duration = s.quantity("duration", unit::time, Range::positive());
  run.interval = s.quantity("interval", unit::time, Range::positive());
  run.change = s.quantity("change", unit::temperature_difference, Range::positive(), run.change);
  if (s.has("steady_rate"))
    run.steady_rate = s.quantity("steady_rate", unit::heating_rate, Range::positive());
  return run;
}

enum class Kind { settle, load, compress, heat, expose, conduct };

Kind read_kind(const Section& s) {
  return s.choice<Kind>("kind", {{"settle", Kind::settle},
                                 {"load", Kind::load},
                                 {"compress", Kind::compress},
                                 {"heat", Kind::heat},
                                 {"expose", Kind::expose},
                                 {"conduct", Kind::conduct}});
}

std::vector<Stage> read_mechanical_stages(const Section& root, const std::vector<Section>& sections,
                                          const std::vector<Kind>& kinds) {
  const auto table = root.optional_section("coupling");
  const Coupling coupling = table ? read_coupling(*table) : Coupling{};
  std::vector<Stage> stages;
  for (std::size_t i = 0; i < sections.size(); ++i) {
    const Section& s = sections[i];
    if ((kinds[i] == Kind::heat || kinds[i] == Kind::expose) && !table)
      s.error("kind", "a stage that changes temperatures needs the table [coupling]");
    switch (kinds[i]) {
      case Kind::settle:
        stages.emplace_back(read_settle(s));
        break;
      case Kind::load:
        stages.emplace_back(read_load(s));
        break;
      case Kind::compress:
        stages.emplace_back(read_compress(s));
        break;
      case Kind::heat:
        stages.emplace_back(read_heat_stage(s, coupling));
        break;
      case Kind::expose:
        if (coupling.predictor)
          table->error("predictor", "is for stages of kind \"heat\": it takes the temperature as uniform");
        stages.emplace_back(read_expose(s, coupling));
        break;
      case Kind::conduct:
        read_conduct(s);  // so that its keys are known
        s.error("kind",
                "a stage of kind \"conduct\" must be the only stage; beside mechanics use \"expose\"");
        break;
    }
  }
  return stages;
}

}  // namespace

ReadStages read_stages(const Section& root) {
  const auto sections = root.sections("stages");
  std::vector<Kind> kinds;
  for (const Section& s : sections) kinds.push_back(read_kind(s));
  if (kinds == std::vector{Kind::conduct}) {
    root.know({"coupling"});
    return {.stages = {}, .conduct = read_conduct(sections.front())};
  }
  return {.stages = read_mechanical_stages(root, sections, kinds), .conduct = {}};
}

}  // namespace pyroclast
