#pragma once

#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "pyroclast/base/team.hpp"
#include "pyroclast/material/concrete.hpp"
#include "pyroclast/mechanics/motion.hpp"
#include "pyroclast/model/model.hpp"
#include "pyroclast/model/sets.hpp"
#include "pyroclast/simulation/acting/heat_conditions.hpp"
#include "pyroclast/simulation/acting/loads.hpp"
#include "pyroclast/simulation/acting/press.hpp"
#include "pyroclast/simulation/acting/spalling.hpp"
#include "pyroclast/simulation/acting/supports.hpp"
#include "pyroclast/simulation/coupling.hpp"
#include "pyroclast/simulation/moisture_field.hpp"
#include "pyroclast/simulation/specimen_body.hpp"
#include "pyroclast/simulation/watching/probe.hpp"
#include "pyroclast/simulation/watching/records.hpp"
#include "pyroclast/thermal/temperature_field.hpp"

namespace pyroclast {

/// Tells whether phases follow the composition of their specimen, see follow_composition.
bool follows_composition(const std::vector<BlockMaterial>& block_materials, const MovingBody& moving);

/// Makes the materials of a specimen. Throws Error, see make_concrete and follow_composition.
ConcreteMaterials make_materials(const std::vector<BlockMaterial>& block_materials, const MovingBody& moving,
                                 const SpecimenNumbers& specimen);

/// Specimen as a model and its temperatures; where a stage moves it, also its motion and loads, and the
/// press around it where there are platens. A simulation cannot be moved: the solvers refer to the model
/// beside them.
class Simulation {
 public:
  /// \param thickness     thickness of a specimen in the plane, m; of a solid not used
  /// \param block_materials  materials by phase of the specimen, then those of bearings
  /// \param sets          sets beside those that every model has
  /// \param probes        probes of temperature
  /// \param records       records; those of motion only where something moves
  /// \param moving        empty where nothing moves: then there are no platens and no mechanics
  /// \param team          threads of the run
  /// \param ranks         ranks that hold the body, each of which makes a simulation; null: one
  ///
  /// Throws Error when the model or a solver cannot be made, see make_conduction and properties_at, or a
  /// probe lies outside.
  Simulation(MadeSpecimen specimen, double thickness, const std::vector<BlockMaterial>& block_materials,
             const std::vector<SetParameters>& sets, const HeatConditions& heat,
             const std::vector<ProbePosition>& probes, const std::vector<RecordParameters>& records,
             const std::optional<MovingBody>& moving, std::shared_ptr<Team> team,
             std::shared_ptr<Ranks> ranks = nullptr);
  /// Takes a body that was made elsewhere. Its model has the bearings, interfaces and chunks already, so
  /// those of `moving` are not used. Throws Error as above, and for a body that is none.
  Simulation(SpecimenBody body, const std::vector<BlockMaterial>& block_materials, const HeatConditions& heat,
             const std::vector<ProbePosition>& probes, const std::vector<RecordParameters>& records,
             const std::optional<MovingBody>& moving, std::shared_ptr<Team> team,
             std::shared_ptr<Ranks> ranks = nullptr);
  Simulation(const Simulation&) = delete;
  Simulation& operator=(const Simulation&) = delete;

  /// Returns the team, whose number of threads may change between two batches.
  Team& team() { return *team_; }
  /// Returns the specimen of which the body was made here; empty where the body was made elsewhere.
  const std::optional<MadeSpecimen>& specimen() const { return specimen_; }
  /// Returns what is told of the specimen of a body that was read; else null.
  const SpecimenTold* told() const { return told_.get(); }
  /// Returns what a user should know of the specimen and of stones that hold together, one line each: a
  /// collective. Nothing where another rank is the first.
  std::vector<std::string> warnings_of_specimen() const;
  const SpecimenNumbers& numbers() const { return numbers_; }
  double body_size() const { return numbers_.size; }
  /// Returns the area across a square or a cube of this side, m².
  double area_across(double side) const {
    return side * (model_->dimension() == 2 ? model_->thickness : side);
  }
  const Model& model() const { return *model_; }
  Ranks& ranks() const { return model_->ranks(); }
  const ConcreteMaterials& materials() const { return materials_; }
  /// Sets other properties from now on, at the present temperatures, as an exchange of temperatures does, see
  /// `hand_over`. Densities and laws stay, and whether anything creeps.
  void set_materials(ConcreteMaterials materials);
  const HeatConditions& heat() const { return heat_; }
  TemperatureField& field() { return field_; }
  const TemperatureField& field() const { return field_; }
  const std::vector<Probe>& probes() const { return probes_; }
  /// Returns the water in the pores; null where the deck has none.
  const MoistureField* moisture() const { return moisture_.get(); }

  /// Tells whether cracks hinder heat.
  bool cracks_hinder_heat() const { return heat_.cracks.has_value(); }
  /// Describes in words how heat and motion act on each other.
  const char* coupling_of_heat() const;
  void begin_moving(const std::vector<StartVelocity>& velocities);
  /// Hands the present gap of each contact to the heat solver, where cracks hinder heat, and the cracks to
  /// the water that they drain. Called before heat flows, at each exchange of temperatures.
  void show_cracks();
  /// Tells whether cracks under pressure have widened so far that the water must be asked what it does; then
  /// the next exchange comes soon.
  bool cracks_outrun_water();
  /// Tells whether pieces of the body move away from it, see Spalling::find.
  bool pieces_fly() const { return spalling_ && spalling_->any_fly(*motion_); }
  /// Lets pieces that move away leave the body for good: motion, heat and water go on without them. Throws
  /// Error where a load acts on one of them.
  void let_pieces_go();
  /// Returns the pieces that have left; null where all blocks stay.
  const Spalling* spalling() const { return spalling_.get(); }
  /// Returns the temperatures of the specimen had no piece left it.
  const TemperatureField& unspalled_field() const { return unspalled_ ? *unspalled_ : field_; }
  bool has_lost_blocks() const { return spalling_ && !spalling_->spalls().empty(); }
  /// Tells whether a block has left the body.
  bool is_gone(int block) const { return spalling_ && spalling_->is_gone(block); }
  /// Returns the time of the next exchange that the water asks for, s of heating.
  double next_exchange_of_water() const {
    return moisture_ ? moisture_->next_exchange() : std::numeric_limits<double>::infinity();
  }

  /// Tells whether the body moves.
  bool moves() const { return motion_ != nullptr; }
  Motion& motion() { return *motion_; }
  const Motion& motion() const { return *motion_; }
  Loads& loads() { return *loads_; }
  const Loads& loads() const { return *loads_; }
  const Supports& supports() const { return *supports_; }
  /// Lets a set take hold of a component, or move on in another way, at a velocity from the next step on; see
  /// Supports::hold.
  void hold(const std::string& set, int component, const HeldMotion& motion, const std::string& place);
  /// Changes the velocity of a set that is driven, m/s.
  void drive(const std::string& set, int component, double velocity);
  /// Brings a set that was driven to rest.
  void halt(const std::string& set, int component);
  /// Lets a set release a component, see Supports::release.
  void release(const std::string& set, int component, const std::string& place);
  const std::vector<Record>& records() const { return records_; }
  /// Returns a record by its name. Throws Error when there is none of that name.
  const Record& record(std::string_view name) const;
  /// Takes the present state as zero of strains, displacements and openings.
  void set_zero();

  bool has_press() const { return press_ != nullptr; }
  Press& press() { return *press_; }
  const Press& press() const { return *press_; }

  /// Returns the time since heating began, s, of the temperatures to which the last exchange or conduction
  /// came.
  double heating_time() const { return heating_time_; }
  void set_heating_time(double time) { heating_time_ = time; }
  /// Takes over the time to which the field has conducted heat; water flows until then. Throws Error, see
  /// MoistureField::follow.
  void follow_heat();
  /// Widens the range of temperatures to those that boundaries may bring by a time, s of heating, see
  /// TemperatureField::begin_exposure.
  void begin_exposure(double until);
  /// Makes an exchange: hands the field's temperatures over to the mechanics, see Mechanics::set_properties.
  /// Zones that creep do so from now until the next look of the run.
  void hand_over() { hand_over(materials_); }
  /// Notes that the field came to temperatures that an exchange will hand over later; the losses by heat
  /// count them already.
  void see_temperatures() { hottest_.note_field(field_); }
  /// Returns the highest temperatures of the mechanics so far, °C.
  const HottestTemperatures& hottest() const { return hottest_; }
  /// Returns the pore pressure that an intact contact bears over its tensile strength at its temperatures; 0
  /// where it is damaged, where its law has no such strength, and without water. Above 1 a contact that bears
  /// nothing else tears.
  double pressure_over_strength(int contact) const;
  /// Counts a new exchange of temperatures and returns its number, from 1.
  std::int64_t count_exchange() { return ++exchanges_; }

  /// Shows clock, temperatures, mechanics and press to a visitor.
  void visit_state(StateVisitor& visitor);

 private:
  void hand_over(const ConcreteMaterials& materials);
  void remove(const std::vector<int>& blocks);
  void keep_unspalled();
  void require_there(const std::string& set, const std::string& place) const;

  std::shared_ptr<Team> team_;
  std::optional<MadeSpecimen> specimen_;
  std::shared_ptr<const SpecimenTold> told_;
  std::unique_ptr<Model> model_;
  SpecimenNumbers numbers_;
  ConcreteMaterials materials_;
  HeatConditions heat_;
  TemperatureField field_;
  std::unique_ptr<MoistureField> moisture_;
  HottestTemperatures hottest_;
  BodyProperties earlier_;  ///< properties before the last exchange, whose memory serves the next one
  std::vector<Probe> probes_;
  std::unique_ptr<Motion> motion_;
  std::unique_ptr<Loads> loads_;
  std::unique_ptr<Supports> supports_;
  std::vector<Record> records_;
  std::unique_ptr<Press> press_;
  std::unique_ptr<Spalling> spalling_;
  /// Temperatures had no piece left, from the first one on; null before.
  std::unique_ptr<TemperatureField> unspalled_;
  double heating_time_ = 0.0;
  std::int64_t exchanges_ = 0;
};

/// Returns a lower estimate of Young's modulus of the model along an axis, Pa: the same stress along it
/// everywhere, compliances of zones and contacts added up (Reuss), without platens.
/// \param temperature  °C
double estimate_modulus(const Model& model, const ConcreteMaterials& materials,
                        double temperature = kReferenceTemperature, int axis = kVertical);

/// Returns the time in which a stress wave runs through the uncracked specimen from platen to platen once, at
/// its mean temperature and with the mass that moves, s.
double wave_time(const Simulation& simulation);

}  // namespace pyroclast
