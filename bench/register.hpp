#pragma once

#include "bodies.hpp"

/// Each adds its benchmarks to Google Benchmark's list. `bodies` must outlive the run.
namespace bench {

/// Bandwidth of every level of memory and peak of fused multiply-adds, on 1 and 2 threads.
void register_machine();
/// Whole steps: the library on 1 and 2 threads, the textbook on one, intact and cracked.
void register_steps(Bodies& bodies);
/// Parts of the library's step on the specimen of the case, on one thread.
void register_kernels(Bodies& bodies);

/// The specimen of cases/compression.toml, 5,000 blocks.
inline constexpr int kCaseZones = 27'000;
/// Numbers of zones whose steps are timed.
inline constexpr int kZones[] = {1'000, 5'000, 10'000, kCaseZones, 100'000, 1'000'000};

}  // namespace bench
