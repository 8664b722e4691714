#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "pyroclast/laws/table.hpp"
#include "pyroclast/material/zone_law.hpp"
#include "pyroclast/mechanics/layout.hpp"

namespace pyroclast {

/// Form of the local damping. The force opposing motion is lambda |F| times a sign.
enum class DampingForm : std::uint8_t {
  /// sgn(v), Eq. (8). A body in steady motion keeps vibrating, since v does not change sign, and is dragged.
  local,
  /// (sgn(v) - sgn(dF/dt)) / 2: damps vibration about a steady motion too (Itasca's combined damping).
  combined
};

/// Vectors of the gridpoints of a pack, component by component.
template <int Dim>
struct alignas(64) VectorPack {
  double c[Dim][kLanes];
};

/// Returns the vector of a slot in an array of packs.
template <int Dim>
Vec<Dim> vector_at(ConstView<VectorPack<Dim>> packs, int slot) {
  Vec<Dim> v;
  for (int i = 0; i < Dim; ++i) v[i] = packs[slot / kLanes].c[i][slot % kLanes];
  return v;
}
template <int Dim>
void set_vector(View<VectorPack<Dim>> packs, int slot, const Vec<Dim>& v) {
  for (int i = 0; i < Dim; ++i) packs[slot / kLanes].c[i][slot % kLanes] = v[i];
}

/// Vector in space as lanes read and write it at once: four numbers, of which the last means nothing.
struct alignas(32) Four {
  double c[4];
};

struct alignas(64) ZonePropertyPack {
  double lambda[kLanes], mu[kLanes], thermal_strain[kLanes];
};

/// Symmetric tensors of eight zones, component by component.
template <int Dim>
struct alignas(64) TensorPack {
  double component[std::tuple_size_v<SymmetricTensor<Dim>>][kLanes];
};

/// Constraints that hold, drive or load the gridpoints of a pack.
template <int Dim>
struct alignas(64) ConstraintPack {
  double prescribed_velocity[Dim][kLanes];  ///< m/s
  double applied[Dim][kLanes];              ///< applied force, N
  /// Bits by component, one a lane: 1 where the velocity is prescribed.
  std::array<std::uint8_t, Dim> prescribed;
};

/// Gridpoints of one block that share one component of their motion.
struct Tie {
  int component = 0;
  int begin = 0, end = 0;  ///< entries of tied_slots
};

/// Constraints that hold, drive or load a bundle.
struct BundleConstraints {
  int first_pack = 0;               ///< entry of constraint_packs, one for each pack of gridpoints
  int first_tie = 0, last_tie = 0;  ///< entries of ties: [first, last)
  bool ties() const { return first_tie != last_tie; }
  double loading_work = 0.0;  ///< work of the reactions and applied forces, J
};

/// Sums over a bundle. They are taken when a step is measured, except the works, to which every step adds.
struct BundleSums {
  double damping_work = 0.0, viscous_work = 0.0;  ///< works including the whole last step, J
  /// Works of the second half of the last step, J.
  double begun_damping = 0.0, begun_viscous = 0.0, begun_loading = 0.0;
  double stored = 0.0;   ///< J
  double kinetic = 0.0;  ///< J
  /// Sum of the magnitudes of zone forces, weights and applied forces, N.
  double applied = 0.0;
  /// Sum of the magnitudes of the sums of forces, N.
  double unbalanced = 0.0;
};

/// Sums over a pack of faces.
struct FaceSums {
  double stored = 0.0;   ///< J
  double applied = 0.0;  ///< sum of the magnitudes of contact forces, N
  double jump = 0.0;     ///< largest jump over the length of its face
};

/// Arrays of a state, owned (FlatArray) or seen (View).
template <int Dim, template <class> class Array>
struct StateArrays {
  Array<VectorPack<Dim>> position;  ///< positions, from which alike bundles read, m; 2D only
  Array<VectorPack<Dim>> velocity;
  Array<VectorPack<Dim>> force;  ///< sum of forces at the last step, N
  /// Largest sum of |stiffness| over a gridpoint's rows of the assembled matrix, by slot, N/m.
  Array<double> stiffness;
  /// Positions by slot, from which zones of pieces and found contacts gather, m; in 3D only for these.
  Array<Vec<Dim>> gathered_position;
  Array<Four> from_last;         ///< places by slot, seen from the last gridpoint of the block, m; 3D only
  Array<Vec<Dim>> displacement;  ///< displacements by slot, from which faces gather, m
  /// Time step over moving mass by slot, s/kg; any finite number where idle.
  Array<double> step_over_mass;
  Array<double> real_mass;                  ///< mass by slot on which gravity acts, kg; empty without gravity
  Array<ZonePropertyPack> zone_properties;  ///< properties by pack of zones, or by bundle
  /// Free strain beside the thermal strain, by pack of zones, in the zones' own frames. Empty where none
  /// creeps.
  Array<TensorPack<Dim>> creep_strain;

  // Contact points. All points of a pack of faces have one law. Each list holds the numbers that this law
  // has, one line for eight points; a law without such numbers has no lines. A step touches losses only where
  // something is lost.
  Array<std::uint8_t> law_of_faces;  ///< entry of `State::laws`, by pack of faces
  Array<Line> internals, loss;       ///< lines of each pack of points in turn
  Array<int> first_internal;         ///< first line of each pack of faces, and of one more
  Array<int> first_loss;             ///< first line of each pack of faces, and of one more
  /// Step at which each point was first found cracked, by slot, see note_cracks; kNotCracked before that.
  Array<double> crack_step;
  Array<bool> losing;             ///< true for a pack of points that lost something in the last step
  Array<Vec<Dim>> contact_force;  ///< force on side a by slot, from which gridpoints gather, N
  // Finite kinematics only, see TurningFrame; gradient and weights in 3D alone
  Array<Vec<Dim>> turning_force;       ///< force of the turn on both sides by slot, N
  Array<FacePack<Dim>> face_gradient;  ///< gradients of the faces at the start
  /// Weights of the gridpoints of both sides in the gradient of their face, 1/m: two lines for each pack of
  /// points.
  Array<Line> turning_weight;
  /// Forces of zones of pieces on their corners, from which gridpoints gather, N: for each pack of zones
  /// eight of each corner; behind them eight idle ones.
  Array<Vec<Dim>> corner_force;
  /// Sums of forces of the gridpoints of parts until their ties share them out, by `corners_of_pack`, N.
  Array<VectorPack<Dim>> part_force;
  Array<std::byte> contact_constants;  ///< constants of sets in turn
  /// First byte of the set of each pack of faces; where its points differ only the set's choices count.
  Array<int> first_constant;
  Array<bool> one_set;  ///< true for a pack of faces whose points all share one set
  /// Constants of each pack of points in turn, if lanes of any pack of faces differ.
  Array<Line> own_constants;
  Array<int> first_own_constant;  ///< first line of each pack of faces, and of one more

  /// Pressure of pore water that parts the sides of the points of each pack, Pa; empty where there is none.
  Array<Line> pore_pressure;
  /// Opening at which it stands, m; empty where a further opening does not lower it.
  Array<Line> pore_opening;

  Array<int> constraints_of_bundle;  ///< -1 for a bundle that nothing holds, drives or loads now
  Array<BundleConstraints> constraints;
  Array<ConstraintPack<Dim>> constraint_packs;
  Array<Tie> ties;
  Array<int> tied_slots;

  Array<BundleSums> bundle_sums;
  Array<FaceSums> face_sums;

  template <class F, class... S>
  static void each(F&& f, S&... s) {
    f(ArrayInfo{"position", Per::gridpoint_pack, Touched::alike}, s.position...);
    f(ArrayInfo{"velocity", Per::gridpoint_pack, Touched::all, Touched::all, Lasts::kept, Travels::each_call},
      s.velocity...);
    f(ArrayInfo{"force", Per::gridpoint_pack, Touched::combined, Touched::all, Lasts::kept}, s.force...);
    f(ArrayInfo{"stiffness", Per::gridpoint_slot}, s.stiffness...);
    f(ArrayInfo{"gathered_position", Per::gridpoint_slot, Touched::gathered}, s.gathered_position...);
    f(ArrayInfo{"from_last", Per::gridpoint_slot, Touched::all}, s.from_last...);
    f(ArrayInfo{"displacement", Per::gridpoint_slot, Touched::all, Touched::all, Lasts::kept,
                Travels::each_step},
      s.displacement...);
    f(ArrayInfo{"step_over_mass", Per::gridpoint_slot, Touched::all}, s.step_over_mass...);
    f(ArrayInfo{"real_mass", Per::gridpoint_slot, Touched::all}, s.real_mass...);
    f(ArrayInfo{"zone_properties", Per::zone_pack_or_bundle, Touched::all}, s.zone_properties...);
    f(ArrayInfo{"creep_strain", Per::zone_pack, Touched::all}, s.creep_strain...);
    f(ArrayInfo{"law_of_faces", Per::face_pack, Touched::all}, s.law_of_faces...);
    f(ArrayInfo{"internals", Per::entry, Touched::all, Touched::held, Lasts::kept}, s.internals...);
    f(ArrayInfo{"loss", Per::entry, Touched::none, Touched::none, Lasts::kept}, s.loss...);
    f(ArrayInfo{"first_internal", Per::face_pack_end, Touched::all}, s.first_internal...);
    f(ArrayInfo{"first_loss", Per::face_pack_end, Touched::all}, s.first_loss...);
    f(ArrayInfo{"crack_step", Per::point_slot_or_idle, Touched::none, Touched::none, Lasts::kept},
      s.crack_step...);
    f(ArrayInfo{"losing", Per::point_pack_or_idle, Touched::none, Touched::all, Lasts::a_step}, s.losing...);
    f(ArrayInfo{"contact_force", Per::point_slot_or_idle, Touched::all, Touched::all, Lasts::a_step},
      s.contact_force...);  // read where it is summed
    f(ArrayInfo{"turning_force", Per::point_slot_or_idle, Touched::all, Touched::all, Lasts::a_step},
      s.turning_force...);
    f(ArrayInfo{"face_gradient", Per::face_pack, Touched::all}, s.face_gradient...);
    f(ArrayInfo{"turning_weight", Per::entry, Touched::all}, s.turning_weight...);
    f(ArrayInfo{"corner_force", Per::entry, Touched::all, Touched::all, Lasts::a_step}, s.corner_force...);
    f(ArrayInfo{"part_force", Per::entry, Touched::none, Touched::none, Lasts::a_step}, s.part_force...);
    f(ArrayInfo{"contact_constants", Per::entry}, s.contact_constants...);  // few, and always near
    f(ArrayInfo{"first_constant", Per::face_pack, Touched::all}, s.first_constant...);
    f(ArrayInfo{"one_set", Per::face_pack, Touched::all}, s.one_set...);
    f(ArrayInfo{"own_constants", Per::entry, Touched::all}, s.own_constants...);
    f(ArrayInfo{"first_own_constant", Per::face_pack_end, Touched::all}, s.first_own_constant...);
    f(ArrayInfo{"pore_pressure", Per::point_pack, Touched::all}, s.pore_pressure...);
    f(ArrayInfo{"pore_opening", Per::point_pack, Touched::all}, s.pore_opening...);
    f(ArrayInfo{"constraints_of_bundle", Per::bundle, Touched::all, Touched::none, Lasts::kept},
      s.constraints_of_bundle...);
    f(ArrayInfo{"constraints", Per::entry, Touched::all, Touched::all, Lasts::kept}, s.constraints...);
    f(ArrayInfo{"constraint_packs", Per::entry, Touched::all, Touched::none, Lasts::kept},
      s.constraint_packs...);
    f(ArrayInfo{"ties", Per::entry, Touched::all, Touched::none, Lasts::kept}, s.ties...);
    f(ArrayInfo{"tied_slots", Per::entry, Touched::all, Touched::none, Lasts::kept}, s.tied_slots...);
    f(ArrayInfo{"bundle_sums", Per::bundle, Touched::all, Touched::all, Lasts::kept}, s.bundle_sums...);
    f(ArrayInfo{"face_sums", Per::face_pack, Touched::none, Touched::none, Lasts::kept}, s.face_sums...);
  }
};

/// Step of a contact point that has not cracked.
inline constexpr double kNotCracked = -1.0;

/// Parameters that all parts of the body share in a step.
template <int Dim>
struct StepParameters {
  Vec<Dim> gravity;  ///< m/s²
  double time_step = 0.0, local_damping = 0.0, viscous_damping = 0.0;
  DampingForm damping_form = DampingForm::local;
  Kinematics kinematics = Kinematics::small;
  double thickness = 1.0;     ///< m
  double block_size = 0.0;    ///< root of the mean area or volume of a block that is of no bearing, m
  double pore_reserve = 0.0;  ///< see BodyProperties, m
  bool by_bundle = false;     ///< true where all zones of a block have the same properties
};

template <int Dim>
struct State;
template <int Dim>
struct FoundRows;

/// Functions of a law for packs of faces that have it, compiled for one instruction set.
template <int Dim>
struct PackFunctions {
  /// Takes the contact points of packs through the law, from jumps to forces.
  void (*update)(State<Dim>&, int first, int last, bool measure);
  /// Writes the sums of |stiffness| over the rows of the contacts' matrix in the place of their forces, N/m.
  void (*place_stiffness)(State<Dim>&, int first, int last);
  /// Takes eight contact points that belong to no body through the law.
  LanesUpdate update_lanes;
};

/// State as a step sees it: numbers, and views of arrays that stand elsewhere.
template <int Dim>
struct State : StepParameters<Dim>, StateArrays<Dim, View> {
  LayoutArrays<Dim, ConstView> layout;
  const PackFunctions<Dim>* laws = nullptr;  ///< functions of the laws of the body
  FoundRows<Dim>* found = nullptr;  ///< contacts that are found; null where contacts are the first ones
  /// Bits of the faces of each pack of faces that bear nothing any more: handed over to found contacts, or of
  /// a block that is gone. Empty as long as there are none.
  ConstView<std::uint8_t> left_out;

  bool weighs() const { return !this->real_mass.empty(); }
};

/// Lets the views of one list of arrays see the arrays of another.
template <class Views, class Owners>
void see(Views& views, Owners& owners) {
  for_each_array(
      [](const ArrayInfo&, auto& view, auto& owner) {
        view = {owner.data(), owner.size()};
      },
      views, owners);
}

/// Numbers of working memory that a step needs for a pack of gridpoints of a bundle: displacements and sums
/// of forces, and in 3D both as fours too.
template <int Dim>
inline constexpr int kScratchNumbers = kLanes*(Dim == 2 ? 4 : 14);

/// Work of a pass over bundles.
enum class Pass : std::uint8_t {
  move,              ///< a step
  move_and_measure,  ///< a step whose sums are taken
  measure            ///< forces and their sums, without motion
};

/// Passes of the step, compiled for one instruction set; packs of faces are compiled with their law.
template <int Dim>
struct StepPasses {
  /// Computes the corner forces of parts of large blocks.
  /// \param first, last  entries of `parts`
  void (*place_corner_forces)(State<Dim>&, int first, int last, Pass);
  /// Sums the forces of bundles and moves their gridpoints. Those of tied parts still stand: their forces
  /// wait for the sums of the block's other parts.
  /// \param scratch  kScratchNumbers for every pack of the largest bundle, aligned to 64 bytes
  void (*move_bundles)(State<Dim>&, int first, int last, Pass, double* scratch);
  /// Shares the sums of tied parts out and moves their gridpoints.
  /// \param first, last  entries of `parts`
  void (*move_tied_parts)(State<Dim>&, int first, int last, Pass, double* scratch);
  /// Computes `State::stiffness`; leaves contact and corner forces unset until the next sweep.
  void (*sum_stiffness)(State<Dim>&, double* scratch);
  /// Adds the pressure of pore water to the forces of the contact points of packs of faces.
  void (*add_pore_pressure)(State<Dim>&, int first, int last);
  // Found contacts, see FoundContactForces.
  void (*update_found)(State<Dim>&, int first, int last);
  double (*way_of_found)(const State<Dim>&, int first, int last);
};

/// Functions compiled for one instruction set, for bodies in 2D and in 3D.
template <template <int> class Functions>
struct ByDimension {
  Functions<2> in_2d;
  Functions<3> in_3d;

  template <int Dim>
  const Functions<Dim>& of() const {
    if constexpr (Dim == 2)
      return in_2d;
    else
      return in_3d;
  }
};

/// Calls `f(functions, first, last)` for consecutive packs of faces that have one law.
template <int Dim, class F>
void for_each_law(const State<Dim>& s, int first, int last, F f) {
  for (int pack = first; pack < last;) {
    const auto law = s.law_of_faces[pack];
    int end = pack + 1;
    while (end < last && s.law_of_faces[end] == law) ++end;
    f(s.laws[law], pack, end);
    pack = end;
  }
}

}  // namespace pyroclast
