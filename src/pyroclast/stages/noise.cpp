#include "pyroclast/stages/noise.hpp"

#include <algorithm>
#include <cmath>

#include "pyroclast/base/state_visitor.hpp"

namespace pyroclast {

void Noise::begin(const EnergyLedger& energy) {
  first_work_ = energy.loading;
  most_kinetic_ = std::abs(energy.kinetic);
}

bool Noise::is_below(double share, const EnergyLedger& energy) {
  most_kinetic_ = std::max(most_kinetic_, std::abs(energy.kinetic));
  return most_kinetic_ <= share * share * std::abs(energy.loading - first_work_);
}

void Noise::visit_state(StateVisitor& visitor) {
  visitor.visit("first_work", first_work_);
  visitor.visit("most_kinetic", most_kinetic_);
}

}  // namespace pyroclast
