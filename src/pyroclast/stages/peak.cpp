#include "pyroclast/stages/peak.hpp"

namespace pyroclast {

void Peak::take(double driven, double size, const PeakRule& rule) {
  if (is_found()) return;
  if (size > size_) {
    size_ = size;
    driven_ = driven;
    has_fallen_ = 0;
    return;
  }
  if (size_ - size < rule.least) return;
  if (size < (1.0 - rule.fall) * size_) has_fallen_ = 1;
  const bool collapsed = size_ > 0.0 && size < (1.0 - rule.collapse) * size_;
  if (collapsed || (has_fallen() && driven - driven_ >= rule.lasting)) is_found_ = 1;
}

void Peak::visit_state(StateVisitor& visitor) {
  visitor.visit("size", size_);
  visitor.visit("driven", driven_);
  visitor.visit("has_fallen", has_fallen_, state::within(0, 1));
  visitor.visit("is_found", is_found_, state::within(0, 1));
}

}  // namespace pyroclast
