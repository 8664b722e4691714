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
void time_part(benchmark::State& state, const pyroclast::Mechanics<2>& body, const Part& part) {
  auto storage = body.body().arrays;
  pyroclast::State<2> copy = body.body().state;
  pyroclast::see(copy, storage);
  std::vector<pyroclast::PackFunctions<2>> laws;
  for (const auto* law : body.body().laws)
    laws.push_back(kNativeLaws[static_cast<std::size_t>(pyroclast::index_of(*law))]);
  copy.laws = laws.data();
  const auto& internals = body.body().arrays.internals;
  pyroclast::FlatArray<double> scratch(static_cast<std::size_t>(4 * pyroclast::kLanes) *
                                       body.body().layout.most_packs);
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

}  // namespace

void register_kernels(Bodies& bodies) {
  for (Loading loading : {Loading::intact, Loading::cracked})
    for (const Part& part : kParts) {
      const auto run = [&bodies, &part, loading](benchmark::State& state) {
        time_part(state, bodies.mechanics(kCaseZones, loading), part);
      };
      const auto name_of =
          fmt::format("kernel/{}/{}/zones:{}/threads:1", part.name, name(loading), kCaseZones);
      benchmark::RegisterBenchmark(name_of.c_str(), run)->UseRealTime();
    }
}

}  // namespace bench
