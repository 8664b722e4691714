#pragma once

#include "bodies.hpp"

/// Each adds its benchmarks to Google Benchmark's list. The bodies must outlive the run.
namespace bench {

/// Bandwidth of every level of memory and peak of fused multiply-adds, on 1 and 2 threads.
void register_machine();
/// Whole steps: the library on 1 and 2 threads, the textbook on one, intact and cracked.
void register_steps(Bodies<2>& specimens, Bodies<3>& cubes);
/// Parts of the library's step on the specimen of the case and on a cube, on one thread.
void register_kernels(Bodies<2>& specimens, Bodies<3>& cubes);

/// The specimen of cases/compression.toml, 5,000 blocks.
inline constexpr int kCaseZones = 27'000;
/// Numbers of zones whose steps are timed.
inline constexpr int kZones[] = {1'000, 5'000, 10'000, kCaseZones, 100'000, 1'000'000};
/// Numbers of blocks of cubes whose steps are timed, of about 43 to 45 zones each.
inline constexpr int kBlocks[] = {300, 1'000, 5'000, 20'000};
/// The cube whose parts of the step are timed.
inline constexpr int kCubeBlocks = 1'000;

}  // namespace bench
