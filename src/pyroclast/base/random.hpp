#pragma once

#include <cstdint>
#include <random>

namespace pyroclast {

/// Random numbers: the project's one source of randomness. `std::mt19937_64` is specified bit by bit, the
/// standard distributions are not; so a seed gives the same specimen with every standard library.
class Random {
 public:
  explicit Random(std::uint64_t seed) : engine_(seed) {}

  /// Returns a number uniform in [0, 1), with 53 random bits.
  double uniform() { return static_cast<double>(engine_() >> 11) * 0x1.0p-53; }
  /// Returns a number uniform in [low, high).
  double uniform(double low, double high) { return low + (high - low) * uniform(); }

 private:
  std::mt19937_64 engine_;
};

}  // namespace pyroclast
