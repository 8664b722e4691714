#pragma once

#include <cstdint>
#include <optional>

#include "pyroclast/base/state_visitor.hpp"

namespace pyroclast {

/// Rule that tells a peak, see docs/understand/theory.md "Peaks" and docs/validation/peaks.md.
struct PeakRule {
  double fall = 0.02;  ///< share of the peak by which the size must fall below it
  /// Distance by which the body must be driven farther before the size comes back to the peak.
  double lasting = 3e-4;
  double collapse = 0.5;  ///< share of the peak: a fall by this share makes a peak at once
  double least = 0.0;     ///< depth that any fall must exceed, in the size's unit
};

/// Finder of the peak of a size that a test measures while the body is driven on: the largest size before the
/// first fall that is deep and lasting enough. A larger size later, as of a body that has failed and hardens,
/// is no peak.
class Peak {
 public:
  /// Takes a reading.
  /// \param driven  distance that the body was driven so far: a strain or a share of a way; never less than
  ///                before
  /// \param size    measured size; where it is not above 0 there is no peak
  void take(double driven, double size, const PeakRule& rule);

  /// Ends the search where another quantity shows that the body has failed and is driven no farther: a size
  /// that has fallen then has its peak.
  void end() {
    if (has_fallen()) is_found_ = 1;
  }

  bool is_found() const { return is_found_ != 0; }
  /// Returns the largest size before the peak was found: the peak where it was found, else its candidate.
  double size() const { return size_; }
  /// Returns how far the body was driven at this size.
  double driven() const { return driven_; }
  /// Tells whether the size has fallen deep enough below the peak, lasting or not.
  bool has_fallen() const { return has_fallen_ != 0; }

  void visit_state(StateVisitor& visitor);

 private:
  double size_ = 0.0, driven_ = 0.0;
  std::uint8_t has_fallen_ = 0, is_found_ = 0;
};

}  // namespace pyroclast
