#pragma once

#include <cmath>
#include <cstdint>
#include <limits>
#include <memory>
#include <string_view>
#include <vector>

#include "pyroclast/base/state_visitor.hpp"
#include "pyroclast/base/team.hpp"
#include "pyroclast/laws/contact_properties.hpp"
#include "pyroclast/material/creep.hpp"
#include "pyroclast/mechanics/compiled_step.hpp"
#include "pyroclast/mechanics/found/parameters.hpp"
#include "pyroclast/mechanics/state.hpp"
#include "pyroclast/model/model.hpp"

namespace pyroclast {

/// Choice of the mass that moves.
enum class MassChoice : std::uint8_t {
  real,  ///< density times volume; the stiffest and lightest gridpoint sets the time step
  /// Density scaling: the mass of each gridpoint makes its own limit the common step; quasi-static runs only.
  scaled
};

struct MechanicsParameters {
  Vec<3> gravity{};            ///< m/s²
  double local_damping = 0.0;  ///< lambda of Eq. (8), in [0, 1)
  DampingForm damping_form = DampingForm::local;
  double viscous_damping = 0.0;  ///< xi of Eq. (3), 1/s
  Kinematics kinematics = Kinematics::small;
  MassChoice mass = MassChoice::real;
  double time_step = 0.0;  ///< time step, s: the common step of MassChoice::scaled, not used with real mass
  double safety = 0.0;     ///< fraction of the stable step that is taken, in (0, 1]
  FoundParameters found;   ///< contacts that are found; in the plane with finite kinematics only
  InstructionSet instructions = best_instruction_set();
  bool loses_blocks = false;  ///< true where blocks may leave the body, see Mechanics::remove
  // The parameters from here on change speed, not results.
  LayoutParameters layout;
  /// Least zones of a thread; with fewer a thread waits longer at barriers than it saves.
  int zones_for_a_thread = 500;
};

/// Parameters of a body at its present temperatures.
struct BodyProperties {
  std::vector<ZoneProperties> zones;  ///< parameters of each zone
  ContactSets contacts;               ///< sets of parameters that occur, each once, validated
  std::vector<int> of_contact;        ///< index into `contacts` of each contact
  /// Creep of each zone, from these temperatures on; empty where none ever creeps.
  std::vector<CreepIncrement> creep;
  /// Index into `contacts` of each interface, for found contacts far from every contact of the interface;
  /// empty where there are none.
  std::vector<int> of_interface = {};
  /// Pressure of pore water that parts the sides of each contact, Pa; empty where water presses on none.
  std::vector<double> pore_pressure = {};
  /// Opening of each contact at which its pressure stands, m: a further opening du lowers it to its share
  /// pore_reserve / (pore_reserve + du). Empty where no opening lowers any.
  std::vector<double> pore_opening = {};
  double pore_reserve = 0.0;  ///< m, with pore_opening

  /// Returns the work by area that the pressure of a contact has done on its way to an opening, up to a
  /// constant, J/m2.
  double work_of_pore_pressure(int contact, double opening) const {
    const double pressure = pore_pressure[contact];
    if (pore_opening.empty()) return pressure * opening;
    const double further = opening - pore_opening[contact];
    return pressure * (further > 0.0 ? pore_reserve * std::log1p(further / pore_reserve) : further);
  }
};

/// Returns the properties of a body whose contacts differ by interface alone.
/// \param interfaces  contact properties of each interface, validated
BodyProperties by_interface(const Model& model, std::vector<ZoneProperties> zones,
                            const std::vector<ContactProperties>& interfaces);

/// Creep of a zone between two changes of its properties.
template <int Dim>
struct CreepUnderWay {
  CreepSplit<Dim> split;
  double poisson = 0.0;           ///< nu_L
  SymmetricTensor<Dim> stress{};  ///< stress at the beginning, in the zone's own frame, Pa
};

/// Tie before its slots stand one after the other in the state.
struct TieOfBundle {
  int bundle;  ///< bundle of the slots; the first of their block where it stands in pieces
  int component;
  std::vector<int> slots;
};

template <int Dim>
struct FoundData;

/// Energies that the body books beside its arrays, J, see EnergyLedger.
struct Books {
  double property_change = 0.0, mass_scaling = 0.0;
  /// Parts that a change of properties adds to both through the half step already begun; the next step books
  /// them.
  double begun_property_change = 0.0, begun_mass_scaling = 0.0;
  double creep_work = 0.0;                    ///< work of creep
  double pore_pressure = 0.0;                 ///< work of pore pressures up to their last change
  double removed = 0.0, begun_removed = 0.0;  ///< energy of blocks that are gone, as of properties
  double gravity = 0.0;                       ///< work of the weight of blocks that are gone
  double start = 0.0;                         ///< kinetic energy of the velocities at the start
};

/// Body in lanes: layout and state of a model's blocks, with the model's chunks. A body is data alone.
/// Constraints hold, drive and load it, Properties and Masses follow its temperatures, the Mover moves it,
/// Reader and Totals read it. Each of them works on a body and does not know who calls it: that is Mechanics.
template <int Dim>
struct Body {
  static constexpr std::size_t kMostDissipations = 16;
  static constexpr std::size_t kMostLaws = 256;  ///< most laws that State::law_of_faces can tell apart

  /// Makes the body at rest, without masses and with no property in its place.
  /// \param threads  threads that touch the arrays first
  Body(const ModelOf<Dim>& of, BodyProperties with, const MechanicsParameters& by,
       std::shared_ptr<Team> threads);
  Body(const Body&) = delete;
  Body& operator=(const Body&) = delete;
  ~Body();

  double time_step() const { return state.time_step; }
  /// Tells whether zones of this body can creep.
  bool creeps() const { return !creep_strain.empty(); }
  /// Tells whether water in the pores presses on the contacts of this body.
  bool has_pore_pressure() const { return !properties.pore_pressure.empty(); }
  const LawTable& law_of(int contact) const {
    return properties.contacts.law(properties.of_contact[contact]);
  }
  const LawTable& law_of_pack(int face_pack) const { return *laws[arrays.law_of_faces[face_pack]]; }
  /// Tells whether a block has left the body, see Mechanics::remove.
  bool is_gone(int block) const { return !gone.empty() && gone[block]; }
  bool has_left(int gridpoint) const { return !left.empty() && left[gridpoint]; }
  /// Tells whether a contact has a gone block on a side.
  bool has_left(const Contact<Dim>& contact) const { return has_left(contact.a) || has_left(contact.b); }
  /// Leaves a face out: its contact points keep what they remember, and bear nothing.
  void leave_out(int face);
  bool leaves_out(int face) const { return !is_left_out.empty() && is_left_out[face]; }
  /// Takes all faces in again.
  void leave_none_out();
  /// Tells whether a face is torn because its sides have turned against each other, see TornFaces.
  bool is_torn(int face) const { return !torn.empty() && torn[face]; }
  /// Returns the first bundle of the block whose gridpoints, or some of them, stand in a bundle.
  int first_bundle_of(int bundle) const;
  /// Tells whether gridpoints of a block that stands in parts are tied: its parts then wait for each other.
  bool ties_join_parts() const;
  /// Returns the place of the constraints of a gridpoint's pack, once its bundle has some; else -1.
  int constraint_pack_of(int gridpoint) const;
  /// Returns the bytes of all arrays of layout and state.
  std::size_t memory() const;

  template <class T>
  FlatArray<T> made(std::size_t size) const {
    return FlatArray<T>(size, team.get());
  }
  /// Returns the working memory of one thread for a step.
  FlatArray<double> make_scratch() const;
  /// Lets the state see the arrays as they are now.
  void refresh_views() { see(state, arrays); }
  /// Uses another compilation of the step.
  void use(const StepFunctions<Dim>& other);

  /// Fills all that steps change with NaN; in idle places forces stay zero, for gridpoints gather from them
  /// too.
  void forget();
  /// Shows the arrays that last from one step to the next, but those of constraints.
  void visit_arrays(StateVisitor& visitor);

  const ModelOf<Dim>& model;
  const MechanicsParameters parameters;
  const std::shared_ptr<Team> team;
  const ZoneGeometry<Dim> geometry;
  const Layout<Dim> layout;
  StateArrays<Dim, FlatArray> arrays;
  State<Dim> state;  ///< view of layout and arrays
  StepFunctions<Dim> step;
  std::vector<const LawTable*> laws;              ///< laws in the order of the interfaces, each once
  std::vector<PackFunctions<Dim>> law_functions;  ///< functions of each law, from `step`; the state sees them
  std::vector<std::string_view> dissipations;     ///< energies that the laws lose, each once

  BodyProperties properties;  ///< properties without the softening by creep that is under way
  std::vector<SymmetricTensor<Dim>> creep_strain;  ///< creep strain of each zone, in its own frame; see State
  std::vector<CreepUnderWay<Dim>>
      creep_under_way;  ///< creep of each zone; empty where none creeps at present

  std::vector<int> made_constraints;  ///< constraints of each bundle that ever had some; else -1
  bool constraints_are_in_order = true;
  std::vector<TieOfBundle> made_ties;

  std::vector<double> gravity_mass;  ///< real mass of each gridpoint, on which gravity acts, kg
  std::vector<double> mass;          ///< mass of each gridpoint that moves, kg
  std::vector<double> stiffness;     ///< k_gp of each gridpoint, N/m
  double mean_height = 0.0;          ///< mean height of zones, m
  int gridpoints_of_whole = 0;       ///< gridpoints of the whole body, where this is a part
  double least_force = 0.0;          ///< sum over all gridpoints, N; a smaller sum of forces counts as none
  double real_mass = 0.0, moving_mass = 0.0;  ///< kg

  std::unique_ptr<FoundData<Dim>> found;  ///< contacts that are found; null where contacts are the first ones

  std::vector<bool> gone;            ///< by block, see is_gone; empty as long as none is
  std::vector<bool> left;            ///< by gridpoint: those of gone blocks; empty as long as none is
  std::vector<bool> is_left_out;     ///< by face, see leaves_out; empty as long as none is
  FlatArray<std::uint8_t> left_out;  ///< bits of these faces, see State::left_out
  std::vector<bool> torn;            ///< by face, see is_torn; empty as long as none is

  std::int64_t steps = 0;
  Books books;

 private:
  void list_laws();
  /// Names the energies that the laws lose, and creep where zones creep.
  void name_dissipations();
  double block_size() const;
  void place_model();
  void place_positions();
  void place_turning();
  void place_internals();
  ChunkList chunks_of(const ArrayInfo& info, const void* array) const;
  void take_contacts_from_owners();
};

/// Returns the lines of the point of a contact in the internal variables or the losses, from the first of its
/// pack of faces on.
/// \param first  first line of each pack of faces
/// \param count  number of lines of a point
template <int Dim, class Lines, class First>
auto lines_of(const Layout<Dim>& layout, Lines& lines, const First& first, int contact, std::size_t count) {
  const int point = layout.contact_slot[contact] / kLanes, pack = layout.face_pack_of_point[point];
  return lines.data() + first[pack] + static_cast<std::size_t>(point - layout.first_point_of(pack)) * count;
}

/// Largest number of anything in a body that a state may state.
inline constexpr double kMostOfAKind = std::numeric_limits<int>::max();

/// Returns the place of an internal variable among those of a law; -1 where it has none of this meaning.
int place_of(const LawTable& law, Remembers what, int dim);

extern template struct Body<2>;
extern template struct Body<3>;

}  // namespace pyroclast
