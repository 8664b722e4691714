#include <algorithm>
#include <cstddef>
#include <memory>
#include <new>
#include <string>
#include <vector>

#include <benchmark/benchmark.h>
#include <fmt/format.h>

#include "pyroclast/base/team.hpp"
#include "register.hpp"

namespace bench {

namespace {

constexpr std::size_t kCacheLine = 64;

struct FreeAligned {
  void operator()(double* p) const { ::operator delete[](p, std::align_val_t{kCacheLine}); }
};
using Doubles = std::unique_ptr<double[], FreeAligned>;

Doubles make_doubles(std::size_t n, double value) {
  Doubles a(static_cast<double*>(::operator new[](n * sizeof(double), std::align_val_t{kCacheLine})));
  std::fill_n(a.get(), n, value);
  return a;
}

/// One thread's part of the triad.
struct Arrays {
  explicit Arrays(std::size_t n)
      : a(make_doubles(n, 0.0)), b(make_doubles(n, 1.0)), c(make_doubles(n, 2.0)) {}
  Doubles a, b, c;
};

/// The compiler may not leave out or join passes over `a`.
void keep(double* a) {
  asm volatile("" : : "r"(a) : "memory");
}

/// a = b + s c over a working set of so many bytes on each thread. Counted are the 24 bytes of an element
/// that the program names, not the line that a store reads first.
void triad(benchmark::State& state, std::size_t bytes, int threads) {
  constexpr std::size_t kBytesPerPass = 16U << 20U;
  const std::size_t n = bytes / (3 * sizeof(double));
  const auto passes = static_cast<int>(std::max<std::size_t>(1, kBytesPerPass / bytes));
  std::vector<std::unique_ptr<Arrays>> parts(static_cast<std::size_t>(threads));
  pyroclast::Team team(threads);
  // each thread touches its own first
  team.run(threads,
           [&](int thread) { parts[static_cast<std::size_t>(thread)] = std::make_unique<Arrays>(n); });
  for (auto _ : state) {
    team.run(threads, [&](int thread) {
      const Arrays& part = *parts[static_cast<std::size_t>(thread)];
      double* __restrict a = part.a.get();
      const double* __restrict b = part.b.get();
      const double* __restrict c = part.c.get();
      for (int pass = 0; pass < passes; ++pass) {
        for (std::size_t i = 0; i < n; ++i) a[i] = b[i] + 3.0 * c[i];
        keep(a);
      }
    });
  }
  const double named = 3.0 * sizeof(double) * static_cast<double>(n) * passes * threads;
  state.counters["bytes_per_s"] =
      benchmark::Counter(named * static_cast<double>(state.iterations()), benchmark::Counter::kIsRate);
  state.counters["threads"] = threads;
}

#if defined(__AVX512F__)
constexpr int kLanes = 8;
#elif defined(__AVX__)
constexpr int kLanes = 4;
#else
constexpr int kLanes = 2;
#endif
using Lanes [[gnu::vector_size(kLanes * sizeof(double))]] = double;

/// Independent chains of multiply-adds: enough to cover their latency, few enough for the registers.
constexpr int kChains = 12;

Lanes multiply_add(int times, Lanes factor, Lanes summand) {
  Lanes x[kChains];
  for (int k = 0; k < kChains; ++k) x[k] = summand * k;
  for (int i = 0; i < times; ++i)
#pragma GCC unroll 12
    for (int k = 0; k < kChains; ++k) x[k] = x[k] * factor + summand;
  Lanes sum = x[0];
  for (int k = 1; k < kChains; ++k) sum += x[k];
  return sum;
}

void peak(benchmark::State& state, int threads) {
  constexpr int kTimes = 100'000;
  double factor = 0.999, summand = 1e-3;
  pyroclast::Team team(threads);
  for (auto _ : state) {
    team.run(threads, [&](int) {
      benchmark::DoNotOptimize(factor);
      benchmark::DoNotOptimize(summand);
      const Lanes result = multiply_add(kTimes, Lanes{} + factor, Lanes{} + summand);
      double first = result[0];
      benchmark::DoNotOptimize(first);
    });
  }
  const double flops = 2.0 * kLanes * kChains * kTimes * threads;
  state.counters["flops_per_s"] =
      benchmark::Counter(flops * static_cast<double>(state.iterations()), benchmark::Counter::kIsRate);
  state.counters["threads"] = threads;
}

void register_triad(const std::string& level, std::size_t bytes, int threads) {
  benchmark::RegisterBenchmark(fmt::format("triad/{}/threads:{}", level, threads).c_str(), triad, bytes,
                               threads)
      ->UseRealTime();
}

}  // namespace

void register_machine() {
  std::size_t largest = 0;
  for (int threads : {1, 2}) {
    benchmark::RegisterBenchmark(fmt::format("peak/threads:{}", threads).c_str(), peak, threads)
        ->UseRealTime();
    for (const auto& cache : benchmark::CPUInfo::Get().caches) {
      if (cache.type == "Instruction") continue;
      const auto size = static_cast<std::size_t>(cache.size);
      // half of what a thread has of the cache; threads share it where cores do
      const int sharing = std::min(threads, cache.num_sharing);
      register_triad(fmt::format("L{}", cache.level), size / static_cast<std::size_t>(2 * sharing), threads);
      largest = std::max(largest, size);
    }
    register_triad("memory", 4 * largest / static_cast<std::size_t>(threads), threads);
  }
}

}  // namespace bench
