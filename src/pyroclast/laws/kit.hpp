#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <string>
#include <type_traits>
#include <vector>

#include "pyroclast/laws/table.hpp"

/// Kit that tries a contact law on random paths, whoever wrote the law: it checks what every law must hold.
///
/// The kit draws properties by their units within their ranges; where the law objects, it draws others. Each
/// path has three sets of properties, as at three temperatures. Pressures reach 20 times the greatest
/// strength, 600 MPa where a law has none. Eight paths go side by side, so that lanes differ in what they do.
namespace pyroclast {

/// Way to take eight points through the law, such as the step's own (mechanics/lanes_of_step.hpp).
struct KitLanes {
  std::string name;  ///< name for messages
  /// Updates in 2D and 3D; empty where the law is not made for the dimension.
  std::array<std::function<std::remove_pointer_t<LanesUpdate>>, 2> update_of;
};

struct KitOptions {
  int paths = 10000;  ///< number of paths in each dimension
  std::uint64_t seed = 1;
  std::vector<int> dimensions{2, 3};  ///< dimensions to try, where the law is made for them
  std::vector<KitLanes> lanes;
};

/// Finding on one property of a law.
struct KitFinding {
  const char* property;
  const char* meaning;
  std::int64_t checks = 0, failures = 0;
  double worst = 0.0;    ///< largest error, over its scale
  double allowed = 0.0;  ///< largest error allowed, over its scale
  std::string first{};   ///< place and numbers of the first failure

  bool passed() const { return failures == 0; }
};

struct KitReport {
  const LawTable* law = nullptr;
  KitOptions options;
  std::vector<KitFinding> findings;  ///< findings on all properties, in a fixed order
  /// Order of convergence in the number of cuts, on legs along several axes; NaN if all are exact.
  double order = 0.0;

  bool passed() const;
  /// Returns one line for each property, and the first failure of each that failed.
  std::string text() const;
};

/// Tries a law. Throws Error when the kit finds no properties that the law takes.
KitReport verify(const LawTable& law, const KitOptions& options = {});

}  // namespace pyroclast
