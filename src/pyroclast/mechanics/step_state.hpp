#pragma once

#include <cstdint>
#include <vector>

#include "pyroclast/base/flat_array.hpp"
#include "pyroclast/material/contact_law.hpp"
#include "pyroclast/material/zone_law.hpp"
#include "pyroclast/mechanics/layout.hpp"

namespace pyroclast {

/// Form of the local damping. The force opposing motion is lambda |F| times a sign.
enum class DampingForm : std::uint8_t {
  local,  ///< sgn(v), Eq. (8). A body in steady motion keeps vibrating, since v does not change sign, and is
          ///< dragged.
  combined  ///< (sgn(v) - sgn(dF/dt)) / 2: damps vibration about a steady motion too (Itasca's combined
            ///< damping)
};

/// Vectors of the gridpoints of a row, component by component.
template <int Dim>
struct alignas(64) VectorRow {
  double c[Dim][kLanes];
};

/// Vectors by slot, in rows.
template <int Dim>
class RowVectors {
 public:
  RowVectors() = default;
  explicit RowVectors(int rows) : rows_(static_cast<std::size_t>(rows)) {}

  Vec<Dim> operator[](int slot) const {
    Vec<Dim> v;
    for (int i = 0; i < Dim; ++i) v[i] = rows_[slot / kLanes].c[i][slot % kLanes];
    return v;
  }
  void set(int slot, const Vec<Dim>& v) {
    for (int i = 0; i < Dim; ++i) rows_[slot / kLanes].c[i][slot % kLanes] = v[i];
  }
  VectorRow<Dim>& row(int r) { return rows_[r]; }
  const VectorRow<Dim>& row(int r) const { return rows_[r]; }
  std::size_t bytes() const { return rows_.size() * sizeof(VectorRow<Dim>); }

 private:
  FlatArray<VectorRow<Dim>> rows_;
};

struct alignas(64) ZonePropertyRow {
  double lambda[kLanes], mu[kLanes], thermal_strain[kLanes];
};

/// What a step reads of the contact points of a row, and what it may change.
template <int Dim>
struct alignas(64) HistoryRow {
  double tension_damage[kLanes], shear_damage[kLanes], closure[kLanes], slip[Dim - 1][kLanes],
      held_slip[kLanes];
};

/// What a step touches only where something breaks, slips or yields.
struct alignas(64) LossRow {
  double slipped[kLanes];                                                        ///< m
  double tension[kLanes], shear[kLanes], friction[kLanes], compression[kLanes];  ///< J/m²
};

/// Numbers of ContactConstantsOf for contact points that have each their own temperature, one after the
/// other.
struct alignas(64) ContactConstantsRow {
  double number[kContactConstants][kLanes];
};

/// Gridpoints of one block that share one component of their motion.
struct Tie {
  int component;
  std::vector<int> slots;  ///< of the gridpoints
};

/// What holds, drives or loads the gridpoints of a bundle.
template <int Dim>
struct Constraints {
  RowVectors<Dim> prescribed_velocity;                    ///< m/s
  RowVectors<Dim> applied;                                ///< N
  std::vector<std::array<std::uint8_t, Dim>> prescribed;  ///< by row and component, a bit a lane
  std::vector<Tie> ties;
  double loading_work = 0.0;  ///< of the reactions and applied forces, J

  /// Bytes of all arrays.
  std::size_t memory() const {
    return prescribed_velocity.bytes() + applied.bytes() + bytes_of(prescribed) + bytes_of(ties);
  }
};

/// Sums over a bundle, taken when a step is measured but for the work, which every step adds to.
struct BundleSums {
  double damping_work = 0.0, viscous_work = 0.0;  ///< with the whole of the last step, J
  double begun_damping = 0.0, begun_viscous = 0.0, begun_loading = 0.0;  ///< second half of the last step, J
  double stored = 0.0;                                                   ///< J
  double kinetic = 0.0;                                                  ///< J
  double applied = 0.0;     ///< sum of the magnitudes of zone forces, weights and applied forces, N
  double unbalanced = 0.0;  ///< of the magnitudes of the sums of forces, N
};

struct FaceSums {
  double stored = 0.0;   ///< J
  double applied = 0.0;  ///< sum of the magnitudes of contact forces, N
  double jump = 0.0;     ///< largest, over the length of its face
};

/// What a step of the whole body has in common.
template <int Dim>
struct StepParameters {
  Vec<Dim> gravity;  ///< m/s²
  double time_step = 0.0, local_damping = 0.0, viscous_damping = 0.0;
  DampingForm damping_form = DampingForm::local;
  Kinematics kinematics = Kinematics::small;
  double thickness = 1.0;  ///< m
};

/// All that moves, in the order of a Layout, with what a step reads.
template <int Dim>
struct StepState : StepParameters<Dim> {
  const Layout<Dim>* layout = nullptr;

  RowVectors<Dim> position, velocity;
  RowVectors<Dim> force;                  ///< sum at the last step, N
  RowVectors<Dim> stiffness;              ///< sum of |stiffness| over each row of the assembled matrix, N/m
  FlatArray<Vec<Dim>> gathered_position;  ///< by slot: zones of spread blocks gather from it, m
  FlatArray<Vec<Dim>> displacement;       ///< by slot: faces gather from it
  FlatArray<double> step_over_mass;       ///< by slot, s/kg; where idle any finite number
  FlatArray<ZonePropertyRow> zone_properties;  ///< by row of zones, or by bundle
  bool by_bundle = false;                      ///< every zone of a block has the same properties
  FlatArray<double> real_mass;  ///< by slot, which gravity acts on, kg; empty where there is none

  FlatArray<HistoryRow<Dim>> history;  ///< by row of contact points
  FlatArray<LossRow> loss;
  FlatArray<std::uint8_t> losing;     ///< by row of contact points: something was lost in the last step
  FlatArray<Vec<Dim>> contact_force;  ///< on side a, by slot: gridpoints gather from it, N
  FlatArray<Vec<Dim>> turning_force;  ///< on both sides, by slot; finite kinematics only, N
  std::vector<ContactConstants> contact_constants;
  std::vector<int>
      set_of_faces;  ///< by row of faces: into contact_constants; where lanes differ its choices only
  std::vector<std::uint8_t> one_set;  ///< by row of faces: all its points share one set
  FlatArray<ContactConstantsRow>
      contact_constants_rows;  ///< by row of contact points, if any row has no one set

  std::vector<int> constraints_of_bundle;  ///< -1 where nothing holds, drives or loads it now
  std::vector<Constraints<Dim>> constraints;

  std::vector<BundleSums> bundle_sums;
  std::vector<FaceSums> face_sums;

  bool weighs() const { return !real_mass.empty(); }

  /// Bytes of all arrays, without those of the layout.
  std::size_t memory() const {
    std::size_t bytes = position.bytes() + velocity.bytes() + force.bytes() + stiffness.bytes();
    for (std::size_t array :
         {bytes_of(gathered_position), bytes_of(displacement), bytes_of(step_over_mass),
          bytes_of(zone_properties), bytes_of(real_mass), bytes_of(history), bytes_of(loss), bytes_of(losing),
          bytes_of(contact_force), bytes_of(turning_force), bytes_of(contact_constants),
          bytes_of(set_of_faces), bytes_of(one_set), bytes_of(contact_constants_rows),
          bytes_of(constraints_of_bundle), bytes_of(constraints), bytes_of(bundle_sums), bytes_of(face_sums)})
      bytes += array;
    for (const auto& c : constraints) bytes += c.memory();
    return bytes;
  }
};

/// What a pass over bundles does.
enum class Pass : std::uint8_t {
  move,              ///< a step
  move_and_measure,  ///< a step whose sums are taken
  measure            ///< forces and their sums, without motion
};

/// The step, compiled for one instruction set.
template <int Dim>
struct StepFunctions {
  /// Takes the contact points of rows of faces through the law.
  void (*update_faces)(StepState<Dim>&, int first, int last, bool measure);
  /// Sums the forces of bundles and moves their gridpoints.
  /// \param scratch  2 Dim kLanes numbers for every row of the largest bundle, aligned to 64 bytes
  void (*move_bundles)(StepState<Dim>&, int first, int last, Pass, double* scratch);
  /// Works out `StepState::stiffness`; leaves the contact forces unset until faces are updated.
  void (*sum_stiffness)(StepState<Dim>&, double* scratch);
};

}  // namespace pyroclast
