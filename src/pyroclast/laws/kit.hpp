#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "pyroclast/laws/table.hpp"

/// What every contact law must hold, whoever wrote it, tried on random paths.
///
/// Properties are drawn by their units within their ranges; where the law objects, others are drawn. Each
/// path has three sets of them, as at three temperatures. Pressures reach 20 times the greatest strength, 600
/// MPa where a law has none. Eight paths go side by side, so that lanes differ in what they do.
namespace pyroclast {

/// What eight contact points answer in lanes, each number one lane after the other.
struct LanesResponse {
  std::array<double, kLanes> normal_traction{};                ///< Pa
  std::array<std::array<double, kLanes>, 2> shear_traction{};  ///< Pa
  std::array<double, kLanes> stored{};                         ///< J/m²
  unsigned changed = 0;  ///< InternalInfo::when of what changed in any lane; 0: nothing was lost
};

/// Takes eight points to eight jumps. Number i of lane l stands at [i * kLanes + l].
/// \param constants  of all eight; of their choices only where each has its own numbers
/// \param own        numbers of their own constants, or null
/// \param internals  changes only where the law says that it did, as in the step
using LanesUpdate = std::function<LanesResponse(const void* constants, const double* own, const double* jump,
                                                double* internals, double* losses)>;

/// A way to take eight points through the law, such as that of the step (mechanics/law_pack.hpp).
struct KitLanes {
  std::string name;                      ///< for messages
  std::array<LanesUpdate, 2> update_of;  ///< in 2D and 3D; empty where the law is not made for them
};

struct KitOptions {
  int paths = 10000;  ///< in each dimension
  std::uint64_t seed = 1;
  std::vector<int> dimensions{2, 3};  ///< those that the law is made for are tried
  std::vector<KitLanes> lanes;
};

/// How a law fared in one property.
struct KitFinding {
  const char* property;
  const char* meaning;
  std::int64_t checks = 0, failures = 0;
  double worst = 0.0;    ///< largest error, over its scale
  double allowed = 0.0;  ///< likewise
  std::string first{};   ///< the first failure: where, and with which numbers

  bool passed() const { return failures == 0; }
};

struct KitReport {
  const LawTable* law = nullptr;
  KitOptions options;
  std::vector<KitFinding> findings;  ///< of all properties, in one order
  double order = 0.0;  ///< in the number of cuts, on legs along several axes; NaN if all are exact

  bool passed() const;
  /// One line for each property, and the first failure of each that failed.
  std::string text() const;
};

/// Tries a law. Throws Error when there are no properties that it takes.
KitReport verify(const LawTable& law, const KitOptions& options = {});

}  // namespace pyroclast
