#pragma once

#include <cmath>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "pyroclast/base/team.hpp"
#include "pyroclast/material/concrete.hpp"
#include "pyroclast/mechanics/mechanics.hpp"
#include "pyroclast/model/concrete_model.hpp"
#include "pyroclast/model/sets.hpp"
#include "pyroclast/simulation/coupling.hpp"
#include "pyroclast/simulation/heat_conditions.hpp"
#include "pyroclast/simulation/loads.hpp"
#include "pyroclast/simulation/press.hpp"
#include "pyroclast/simulation/probe.hpp"
#include "pyroclast/simulation/records.hpp"
#include "pyroclast/simulation/stress_free.hpp"
#include "pyroclast/simulation/supports.hpp"
#include "pyroclast/specimen/specimen.hpp"
#include "pyroclast/thermal/temperature_field.hpp"

namespace pyroclast {

/// What a simulation that moves the body is made from, beside what every one is made from.
struct MotionParameters {
  std::vector<Bearing> bearings;
  ContactParameters contacts;
  std::optional<StrainOfConcrete> strain_of_concrete;  ///< where phases follow it
  OnCooling on_cooling = OnCooling::irreversible;
  std::optional<StressFree> stress_free;  ///< else the reference temperature
  MechanicsParameters<2> mechanics;
};

/// Whether phases follow the composition of their specimen, see follow_composition.
bool follows_composition(const std::vector<SolidMaterial>& solids, const MotionParameters& motion);

/// What this specimen is made of. Throws Error, see make_concrete and follow_composition.
ConcreteMaterials make_materials(const std::vector<SolidMaterial>& solids, const MotionParameters& motion,
                                 const specimen::Specimen& specimen);

/// A specimen as a model, its temperatures, and, where a stage moves it, its mechanics, what loads it, and
/// the press around it where there are platens. Not movable: the solvers refer to the model beside them.
class Simulation {
 public:
  /// \param thickness     of the specimen, out of plane, m
  /// \param solids        by phase of the specimen, then those of bearings
  /// \param sets          beside those that every model has
  /// \param probes        of temperature
  /// \param records       of motion only where something moves
  /// \param motion        empty where nothing moves: then there are no platens and no mechanics
  /// \param team          the threads of the run
  ///
  /// Throws Error when the model or a solver cannot be made, see make_conduction and properties_at, or a
  /// probe lies outside.
  Simulation(specimen::Specimen specimen, double thickness, const std::vector<SolidMaterial>& solids,
             const std::vector<SetParameters<2>>& sets, const HeatConditions& heat,
             const std::vector<ProbePosition>& probes, const std::vector<RecordParameters>& records,
             const std::optional<MotionParameters>& motion, std::shared_ptr<Team> team);
  Simulation(const Simulation&) = delete;
  Simulation& operator=(const Simulation&) = delete;

  /// May change in number between two batches.
  Team& team() { return *team_; }
  const specimen::Specimen& specimen() const { return specimen_; }
  /// Side of the square of its area, m: what lengths of the body are measured by.
  double body_size() const { return std::sqrt(specimen_.region.area()); }
  const Model<2>& model() const { return model_; }
  const ConcreteMaterials& materials() const { return materials_; }
  /// Other properties from now on, at the temperatures that there are: as an exchange of temperatures, see
  /// `hand_over`. Densities, laws and whether anything creeps are those of before.
  void set_materials(ConcreteMaterials materials);
  const HeatConditions& heat() const { return heat_; }
  TemperatureField& field() { return field_; }
  const TemperatureField& field() const { return field_; }
  const std::vector<Probe>& probes() const { return probes_; }

  /// Whether cracks hinder heat.
  bool cracks_hinder_heat() const { return heat_.cracks.has_value(); }
  /// How heat and motion act on each other, in words.
  const char* coupling_of_heat() const;
  /// Shows the heat solver what is left of each contact now, where cracks hinder heat: before heat flows, at
  /// each exchange of temperatures.
  void show_cracks_to_heat();

  /// Whether there are mechanics.
  bool moves() const { return mechanics_ != nullptr; }
  Mechanics<2>& mechanics() { return *mechanics_; }
  const Mechanics<2>& mechanics() const { return *mechanics_; }
  Loads<2>& loads() { return *loads_; }
  const Loads<2>& loads() const { return *loads_; }
  const Supports<2>& supports() const { return *supports_; }
  /// A set takes hold of a component, or moves on in another way, at a velocity from the next step on; see
  /// Supports::hold.
  void hold(const std::string& set, int component, const HeldMotion& motion, const std::string& place);
  /// Another velocity of a set that is driven, m/s.
  void drive(const std::string& set, int component, double velocity);
  /// A set that was driven rests.
  void halt(const std::string& set, int component);
  /// See Supports::release.
  void release(const std::string& set, int component, const std::string& place);
  const std::vector<Record>& records() const { return records_; }
  /// Throws Error when there is none of that name.
  const Record& record(std::string_view name) const;
  /// Strains, displacements and openings count from now.
  void set_zero();

  bool has_press() const { return press_ != nullptr; }
  Press<2>& press() { return *press_; }
  const Press<2>& press() const { return *press_; }

  /// Since heating began, s: at the temperatures that the last exchange or conduction came to.
  double heating_time() const { return heating_time_; }
  void set_heating_time(double time) { heating_time_ = time; }
  /// An exchange: hands the field's temperatures over to the mechanics, see Mechanics::set_properties. What
  /// creeps does so from now until the next look of the run.
  void hand_over();
  /// The field came to temperatures that an exchange will hand over later: what heat takes, these take.
  void see_temperatures() { hottest_.see(field_); }
  /// The hottest that the mechanics was so far, °C.
  const HottestTemperatures& hottest() const { return hottest_; }
  /// Number of a new exchange of temperatures, from 1.
  std::int64_t count_exchange() { return ++exchanges_; }

  /// Clock, temperatures, mechanics and press.
  void visit_state(StateVisitor& visitor);

 private:
  std::shared_ptr<Team> team_;
  specimen::Specimen specimen_;
  Model<2> model_;
  ConcreteMaterials materials_;
  HeatConditions heat_;
  TemperatureField field_;
  HottestTemperatures hottest_;
  std::vector<Probe> probes_;
  std::unique_ptr<Mechanics<2>> mechanics_;
  std::unique_ptr<Loads<2>> loads_;
  std::unique_ptr<Supports<2>> supports_;
  std::vector<Record> records_;
  std::unique_ptr<Press<2>> press_;
  double heating_time_ = 0.0;
  std::int64_t exchanges_ = 0;
};

/// Upper estimate of the memory that a run with so many blocks needs, bytes.
double estimate_memory(std::int64_t blocks);

/// Makes a specimen. Throws Error when it cannot be made, or a run of it would not fit into the memory that
/// is free.
/// \param team  its threads; one alone where there is none
specimen::Specimen make_checked_specimen(const specimen::SpecimenParameters& parameters,
                                         Team* team = nullptr);

/// Lower estimate of Young's modulus of the model in the vertical direction, Pa: the same vertical stress
/// everywhere, compliances of zones and contacts added up (Reuss). Platens left out.
/// \param temperature  °C
double estimate_modulus(const Model<2>& model, const ConcreteMaterials& materials,
                        double temperature = kReferenceTemperature);

/// Time in which a stress wave runs through the uncracked specimen from platen to platen once, at its mean
/// temperature and with the mass that moves, s.
double wave_time(const Simulation& simulation);

}  // namespace pyroclast
