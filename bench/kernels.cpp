#include <algorithm>
#include <vector>

#include <benchmark/benchmark.h>
#include <fmt/format.h>

#include "native_step.hpp"
#include "pyroclast/laws/registry.hpp"
#include "register.hpp"

namespace bench {

namespace {

/// Times one part of the step of a body, over and over on a copy of its state. Contacts begin each time with
/// the internal variables of the copy, so that they break and slip as in the body's next step; where motion
/// drifts to, no other part looks.
template <int Dim>
void time_part(benchmark::State& state, const pyroclast::Mechanics<Dim>& body, const Part<Dim>& part) {
  auto storage = body.body().arrays;
  pyroclast::State<Dim> copy = body.body().state;
  pyroclast::see(copy, storage);
  std::vector<pyroclast::PackFunctions<Dim>> laws;
  for (const auto* law : body.body().laws)
    laws.push_back(native_laws<Dim>()[static_cast<std::size_t>(pyroclast::index_of(*law))]);
  copy.laws = laws.data();
  const auto& internals = body.body().arrays.internals;
  auto scratch = body.body().make_scratch();
  for (auto _ : state) {
    state.PauseTiming();
    std::copy(internals.begin(), internals.end(), copy.internals.begin());
    state.ResumeTiming();
    part.run(copy, scratch.data());
    benchmark::ClobberMemory();
  }
  const int zones = body.model().zone_count();
  state.counters["zones"] = zones;
  state.counters["threads"] = 1;
  state.counters["zone_steps"] = benchmark::Counter(
      static_cast<double>(zones) * static_cast<double>(state.iterations()), benchmark::Counter::kIsRate);
}

template <int Dim>
void register_parts(Bodies<Dim>& bodies, int size) {
  for (Loading loading : {Loading::intact, Loading::cracked})
    for (const Part<Dim>& part : parts<Dim>()) {
      const auto run = [&bodies, &part, loading, size](benchmark::State& state) {
        time_part(state, bodies.mechanics(size, loading), part);
      };
      const auto name_of = fmt::format("{}/{}/{}/{}:{}/threads:1", Dim == 2 ? "kernel" : "solid_kernel",
                                       part.name, name(loading), Dim == 2 ? "zones" : "blocks", size);
      benchmark::RegisterBenchmark(name_of.c_str(), run)->UseRealTime();
    }
}

}  // namespace

void register_kernels(Bodies<2>& specimens, Bodies<3>& cubes) {
  register_parts(specimens, kCaseZones);
  register_parts(cubes, kCubeBlocks);
}

}  // namespace bench
