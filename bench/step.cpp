#include <algorithm>
#include <string>

#include <benchmark/benchmark.h>
#include <fmt/format.h>

#include "register.hpp"

namespace bench {

namespace {

constexpr int kLeastSteps = 50;      ///< a run looks at its body as often or less often
constexpr int kZoneSteps = 200'000;  ///< about so many in one call of advance

/// Times whole steps of a body. The upper platen moves at the velocity of the case, down and up in turn, so
/// that small bodies, which take many steps, stay as loaded as they are.
template <class Body>
void time_steps(benchmark::State& state, Bodies& bodies, const Specimen& specimen, Body& body, int threads) {
  double velocity = bodies.velocity();
  bodies.team().resize(threads);
  const auto& model = specimen.model;
  const int steps = std::max(kLeastSteps, kZoneSteps / model.zone_count());
  for (auto _ : state) {
    for (int g : model.set("top_platen_support")) body.constraints().prescribe_velocity(g, 1, -velocity);
    velocity = -velocity;
    body.advance(steps);
  }
  const double done = static_cast<double>(steps) * static_cast<double>(state.iterations());
  using benchmark::Counter;
  state.counters["zones"] = model.zone_count();
  state.counters["contacts"] = model.contact_count();
  state.counters["threads"] = threads;
  state.counters["damaged"] = damaged_share(body);
  state.counters["zone_steps"] = Counter(done * model.zone_count(), Counter::kIsRate);
  state.counters["contact_updates"] = Counter(done * model.contact_count(), Counter::kIsRate);
}

void add_cost(benchmark::State& state, const StepCost& cost) {
  state.counters["flops_per_step"] = cost.flops;
  state.counters["bytes_per_step"] = cost.bytes;
  state.counters["working_set"] = cost.working_set;
  state.counters["memory"] = cost.memory;
}

std::string name_of(const char* code, Loading loading, int zones, int threads) {
  return fmt::format("step/{}/{}/zones:{}/threads:{}", code, name(loading), zones, threads);
}

void register_step(Bodies& bodies, Loading loading, int zones, int threads) {
  const auto run = [&bodies, loading, zones, threads](benchmark::State& state) {
    time_steps(state, bodies, bodies.specimen(zones), bodies.mechanics(zones, loading), threads);
    add_cost(state, bodies.step_cost(zones, loading));
  };
  benchmark::RegisterBenchmark(name_of("pyroclast", loading, zones, threads).c_str(), run)->UseRealTime();
}

void register_textbook(Bodies& bodies, Loading loading, int zones) {
  const auto run = [&bodies, loading, zones](benchmark::State& state) {
    time_steps(state, bodies, bodies.specimen(zones), bodies.textbook(zones, loading), 1);
  };
  benchmark::RegisterBenchmark(name_of("textbook", loading, zones, 1).c_str(), run)->UseRealTime();
}

}  // namespace

void register_steps(Bodies& bodies) {
  for (int zones : kZones)
    for (Loading loading : {Loading::intact, Loading::cracked}) {
      for (int threads : {1, 2}) register_step(bodies, loading, zones, threads);
      register_textbook(bodies, loading, zones);
    }
}

}  // namespace bench
