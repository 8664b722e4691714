#include <algorithm>
#include <span>
#include <string>

#include <benchmark/benchmark.h>
#include <fmt/format.h>

#include "register.hpp"

namespace bench {

namespace {

constexpr int kLeastSteps = 50;      ///< a run looks at its body as often or less often
constexpr int kZoneSteps = 200'000;  ///< about so many in one call of advance

/// Times whole steps of a body. The driven end moves at the velocity of the case, down and up in turn, so
/// that small bodies, which take many steps, stay as loaded as they are.
template <int Dim, class Body>
void time_steps(benchmark::State& state, Bodies<Dim>& bodies, const Sample<Dim>& sample, Body& body,
                int threads) {
  double velocity = bodies.velocity();
  bodies.team().resize(threads);
  const auto& model = sample.model;
  const int steps = std::max(kLeastSteps, kZoneSteps / model.zone_count());
  for (auto _ : state) {
    for (int g : sample.driven) body.constraints().prescribe_velocity(g, 1, -velocity);
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

/// Name of a benchmark: specimens have zones, cubes have blocks.
template <int Dim>
std::string name_of(const char* code, Loading loading, int size, int threads) {
  return fmt::format("{}/{}/{}/{}:{}/threads:{}", Dim == 2 ? "step" : "solid", code, name(loading),
                     Dim == 2 ? "zones" : "blocks", size, threads);
}

template <int Dim>
void register_step(Bodies<Dim>& bodies, Loading loading, int size, int threads) {
  const auto run = [&bodies, loading, size, threads](benchmark::State& state) {
    time_steps(state, bodies, bodies.sample(size), bodies.mechanics(size, loading), threads);
    add_cost(state, bodies.step_cost(size, loading));
  };
  benchmark::RegisterBenchmark(name_of<Dim>("pyroclast", loading, size, threads).c_str(), run)->UseRealTime();
}

template <int Dim>
void register_textbook(Bodies<Dim>& bodies, Loading loading, int size) {
  const auto run = [&bodies, loading, size](benchmark::State& state) {
    time_steps(state, bodies, bodies.sample(size), bodies.textbook(size, loading), 1);
  };
  benchmark::RegisterBenchmark(name_of<Dim>("textbook", loading, size, 1).c_str(), run)->UseRealTime();
}

template <int Dim>
void register_sizes(Bodies<Dim>& bodies, std::span<const int> sizes) {
  for (int size : sizes)
    for (Loading loading : {Loading::intact, Loading::cracked}) {
      for (int threads : {1, 2}) register_step(bodies, loading, size, threads);
      register_textbook(bodies, loading, size);
    }
}

}  // namespace

void register_steps(Bodies<2>& specimens, Bodies<3>& cubes) {
  register_sizes(specimens, kZones);
  register_sizes(cubes, kBlocks);
}

}  // namespace bench
