#include <cstdio>
#include <exception>

#include <benchmark/benchmark.h>

#include "pyroclast/base/processors.hpp"
#include "register.hpp"

/// pyroclast_bench DECK [flags of Google Benchmark]; bench/run calls it.
int main(int argc, char** argv) {
  benchmark::Initialize(&argc, argv);
  if (argc != 2) {
    std::fprintf(stderr, "usage: pyroclast_bench DECK [--benchmark_...]\n");
    return 2;
  }
  try {
    const bench::Deck deck(argv[1]);
    auto specimens = deck.specimens();
    auto cubes = deck.cubes();
    bench::register_machine();
    bench::register_steps(specimens, cubes);
    bench::register_kernels(specimens, cubes);
    benchmark::AddCustomContext("processor", pyroclast::processor_name());
    benchmark::AddCustomContext("compiler", "g++ " __VERSION__);
    benchmark::RunSpecifiedBenchmarks();
  } catch (const std::exception& error) {
    std::fprintf(stderr, "pyroclast_bench: %s\n", error.what());
    return 1;
  }
  return 0;
}
