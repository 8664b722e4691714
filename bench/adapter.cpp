#include "adapter.hpp"

#include "counting.hpp"

namespace bench {

template <int Dim>
double damaged_share(const pyroclast::Mechanics<Dim>& body) {
  const int contacts = body.model().contact_count();
  int damaged = 0;
  for (int c = 0; c < contacts; ++c) {
    damaged += body.read().remembered(c, pyroclast::Remembers::tension_damage) > 0.0 ||
               body.read().remembered(c, pyroclast::Remembers::shear_damage) > 0.0;
  }
  return static_cast<double>(damaged) / contacts;
}

template <int Dim>
double damaged_share(const textbook::Body<Dim>& body) {
  std::size_t damaged = 0;
  for (const auto& c : body.contacts()) damaged += c.tension_damage > 0.0 || c.shear_damage > 0.0;
  return static_cast<double>(damaged) / static_cast<double>(body.contacts().size());
}

template <int Dim>
StepCost step_cost(pyroclast::Mechanics<Dim>& body) {
  reset_operations();
  body.use(counting_step<Dim>());
  body.advance(2);
  body.use(pyroclast::step_functions<Dim>(body.body().parameters.instructions));
  const Operations done = operations();
  const auto& model = body.model();
  const auto& layout = body.body().layout;
  const auto in_use = [](int items, int packs) {
    return static_cast<double>(items) / (static_cast<double>(packs) * pyroclast::kLanes);
  };
  const Traffic arrays = traffic(body);
  StepCost cost;
  cost.flops = static_cast<double>(done.faces) * in_use(model.contact_count(), layout.point_packs - 1) +
               static_cast<double>(done.bundles) * in_use(model.zone_count(), layout.zone_packs);
  cost.bytes = arrays.moved;
  cost.working_set = arrays.working_set;
  cost.memory = static_cast<double>(body.body().memory());
  return cost;
}

template double damaged_share(const pyroclast::Mechanics<2>&);
template double damaged_share(const pyroclast::Mechanics<3>&);
template double damaged_share(const textbook::Body<2>&);
template double damaged_share(const textbook::Body<3>&);
template StepCost step_cost(pyroclast::Mechanics<2>&);
template StepCost step_cost(pyroclast::Mechanics<3>&);

}  // namespace bench
