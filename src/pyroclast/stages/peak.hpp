#pragma once

#include <cstdint>
#include <optional>

#include "pyroclast/base/state_visitor.hpp"

namespace pyroclast {

/// By what a peak is told, see [method.md](docs/method.md) "Peaks" and validation/peaks.md.
struct PeakRule {
  double fall = 0.02;     ///< share of the peak by which the size must fall below it
  double lasting = 3e-4;  ///< how much farther the body must be driven before the size comes back to it
  double collapse = 0.5;  ///< share of the peak: a fall by so much is one at once
};

/// Finds the peak of what a test measures while the body is driven on: the largest size before the first fall
/// that is deep and lasting enough. A size that is larger later, as of a body that has failed and hardens, is
/// none.
class Peak {
 public:
  /// \param driven  how far the body was driven on by now: a strain or a share of a way; never less than
  /// before \param size    what is measured; where it is not above 0 there is no peak
  void take(double driven, double size, const PeakRule& rule);

  /// The body has failed, as another quantity shows, and is driven no farther: what has fallen has its peak.
  void end() {
    if (has_fallen()) is_found_ = 1;
  }

  bool is_found() const { return is_found_ != 0; }
  /// The largest size before the peak was found: the peak where it was found, else what may become it.
  double size() const { return size_; }
  /// How far the body was driven then.
  double driven() const { return driven_; }
  /// Whether the size has fallen deep enough below it, lasting or not.
  bool has_fallen() const { return has_fallen_ != 0; }

  void visit_state(StateVisitor& visitor);

 private:
  double size_ = 0.0, driven_ = 0.0;
  std::uint8_t has_fallen_ = 0, is_found_ = 0;
};

}  // namespace pyroclast
