#include "adapter.hpp"

namespace bench {

double damaged_share(const pyroclast::Mechanics<2>& body) {
  const int contacts = body.model().contact_count();
  int damaged = 0;
  for (int c = 0; c < contacts; ++c) {
    const auto history = body.contact_history(c);
    damaged += history.tension_damage > 0.0 || history.shear_damage > 0.0;
  }
  return static_cast<double>(damaged) / contacts;
}

double damaged_share(const textbook::Body& body) {
  std::size_t damaged = 0;
  for (const auto& c : body.contacts()) damaged += c.tension_damage > 0.0 || c.shear_damage > 0.0;
  return static_cast<double>(damaged) / static_cast<double>(body.contacts().size());
}

// The place for the library's own counts.
std::optional<StepCost> step_cost(const pyroclast::Mechanics<2>&) {
  return std::nullopt;
}

}  // namespace bench
