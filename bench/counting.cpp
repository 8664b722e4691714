#include "counting.hpp"

#include "pyroclast/mechanics/step.hpp"

namespace bench {

using pyroclast::Bundle;
using pyroclast::BundleKind;
using pyroclast::bytes_of;
using pyroclast::kLanes;
using pyroclast::Pass;
using pyroclast::StepState;

namespace {

using CountingStep = pyroclast::Step<2, Counting>;

Operations counted;

void update_faces(StepState<2>& s, int first, int last, bool measure) {
  const auto before = Counted::operations;
  CountingStep::update_faces(s, first, last, measure);
  if (!measure) counted.faces += Counted::operations - before;
}

void move_bundles(StepState<2>& s, int first, int last, Pass pass, double* scratch) {
  const auto before = Counted::operations;
  CountingStep::move_bundles(s, first, last, pass, scratch);
  if (pass == Pass::move) counted.bundles += Counted::operations - before;
}

/// Arrays of a step, added up.
class Arrays {
 public:
  void read(std::size_t bytes) { add(bytes, 1); }
  void write(std::size_t bytes) { add(bytes, 1); }
  void read_and_write(std::size_t bytes) { add(bytes, 2); }
  Traffic traffic() const { return traffic_; }

 private:
  void add(std::size_t bytes, int times) {
    traffic_.moved += static_cast<double>(bytes) * times;
    traffic_.working_set += static_cast<double>(bytes);
  }
  Traffic traffic_;
};

void add_faces(const StepState<2>& s, Arrays& arrays) {
  const std::size_t point_rows = s.history.size();
  constexpr std::size_t kHeldSlip = kLanes * sizeof(double);  // of a row: what is always written
  arrays.read(bytes_of(s.layout->faces) + bytes_of(s.layout->rows_reached));
  arrays.read(bytes_of(s.one_set) + bytes_of(s.set_of_faces));
  arrays.read(bytes_of(s.contact_constants_rows));
  arrays.write(bytes_of(s.losing));
  arrays.read(bytes_of(s.history) - point_rows * kHeldSlip);
  arrays.read_and_write(point_rows * kHeldSlip);
  arrays.read_and_write(bytes_of(s.contact_force));  // read where it is summed
  arrays.read_and_write(bytes_of(s.turning_force));  // empty where frames do not turn
}

void add_bundles(const StepState<2>& s, Arrays& arrays) {
  const auto& layout = *s.layout;
  int spread_rows = 0;
  for (const Bundle& bundle : layout.bundles)
    if (bundle.kind == BundleKind::spread) spread_rows += bundle.rows;
  const auto share = [&](int rows, std::size_t bytes) { return bytes / layout.gridpoint_rows * rows; };
  const bool finite = s.kinematics == pyroclast::Kinematics::finite;
  arrays.read(bytes_of(layout.bundles) + bytes_of(s.constraints_of_bundle) + bytes_of(s.real_mass));
  arrays.read(bytes_of(layout.contacts_of_row) + bytes_of(layout.acting));
  arrays.read(bytes_of(layout.spread_zones));
  arrays.read(bytes_of(s.zone_properties));
  // alike blocks read their positions in rows, spread ones and frames that turn gather them
  arrays.read(share(layout.gridpoint_rows - spread_rows, s.position.bytes()));
  arrays.read(share(finite ? layout.gridpoint_rows : spread_rows, bytes_of(s.gathered_position)));
  arrays.read(bytes_of(s.step_over_mass));
  arrays.read_and_write(bytes_of(s.displacement));
  arrays.read_and_write(s.velocity.bytes());
  if (s.damping_form == pyroclast::DampingForm::combined)
    arrays.read_and_write(s.force.bytes());
  else
    arrays.write(s.force.bytes());
  arrays.read_and_write(bytes_of(s.bundle_sums));
  for (const auto& constraints : s.constraints) arrays.read(constraints.memory());
}

}  // namespace

pyroclast::StepFunctions<2> counting_step() {
  return {update_faces, move_bundles, CountingStep::sum_stiffness};
}

Operations operations() {
  return counted;
}

void reset_operations() {
  counted = {};
}

Traffic traffic(const StepState<2>& state) {
  Arrays arrays;
  add_faces(state, arrays);
  add_bundles(state, arrays);
  return arrays.traffic();
}

}  // namespace bench
