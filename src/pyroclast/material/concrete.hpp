#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "pyroclast/laws/built_in.hpp"
#include "pyroclast/laws/contact_properties.hpp"
#include "pyroclast/material/cooling.hpp"
#include "pyroclast/material/creep.hpp"
#include "pyroclast/material/curve.hpp"
#include "pyroclast/material/thermal_strain.hpp"
#include "pyroclast/material/zone_law.hpp"

namespace pyroclast {

/// What a strain for each unit of stress is one of.
enum class CreepLevel : std::uint8_t {
  concrete,  ///< of the whole, of which its one phase that creeps gives way more
  phase      ///< of the phase itself
};

/// How a phase creeps when it is heated under stress, see material/creep.hpp.
struct CreepMaterial {
  Curve strain = Curve::constant(0.0);  ///< B since the reference temperature: strain at a stress of f_c
  CreepLevel level = CreepLevel::concrete;
  std::optional<double> share;  ///< R of the concrete's strain in that of the phase; else of the specimen
  double strength = 0.0;        ///< f_c, Pa: what B's stresses are counted by
  CreepIncrement choices;       ///< but for its compliance

  /// Of being heated for the first time from one temperature to another, °C; none where it is not hotter.
  CreepIncrement between(double from, double to) const;
};

/// What a block is made of: the zones' parameters as functions of temperature.
struct SolidMaterial {
  std::string name;                             ///< as in [materials]
  Curve young = Curve::constant(0.0);           ///< E, Pa
  double poisson = 0.0;                         ///< nu
  Curve density = Curve::constant(0.0);         ///< kg/m³; mass is that at the reference temperature
  Curve thermal_strain = Curve::constant(0.0);  ///< free strain since the reference temperature
  std::optional<QuartzStep> quartz_step;        ///< that thermal_strain holds, of a phase alone
  std::optional<CreepMaterial> creep;           ///< of a phase alone
  /// Of a phase: expansion coefficient where it is colder than it was, 1/K; else back along thermal_strain.
  std::optional<double> contraction;
  std::optional<Curve> residual_ratio;  ///< of E, see share_left; only where cooling is irreversible
  std::optional<Curve> conductivity;    ///< gamma, W/(m K); only for heat conduction
  std::optional<Curve> specific_heat;   ///< c, J/(kg K); likewise
  bool is_of_bearing = false;           ///< not of the specimen: at 20 °C in every run
  double first_strain = 0.0;  ///< thermal strain at the temperature without stress, see set_stress_free

  /// Free strain, since the temperature without stress, at one of what was at the hottest one before, °C.
  double free_strain(double temperature, double hottest) const;
  /// E, Pa, at a temperature.
  /// \param marked  that it is that of, see OnCooling
  double young_at(double temperature, double marked) const {
    return young(marked) * share_left(residual_ratio, temperature, marked);
  }
};

/// A contact's parameters as functions of temperature (paper, Table 2 and §4.1), of any law.
struct ContactMaterial {
  const LawTable* law = nullptr;
  std::vector<Curve> numbers;  ///< in the order of LawTable::properties
  /// Of those that do not follow the temperature back on cooling, see share_left; likewise.
  std::vector<std::optional<Curve>> residual_ratios;
  std::vector<int> choices;  ///< likewise

  ContactMaterial() = default;
  /// All zero, with the first option of each choice.
  explicit ContactMaterial(const LawTable& of);

  /// The property of that key. Throws Error when the law has none.
  Curve& operator[](std::string_view key);
  const Curve& operator[](std::string_view key) const;
  /// Sets every property of a role.
  void set(Role role, const Curve& curve, const std::optional<Curve>& residual_ratio = std::nullopt);
  /// The property of a role, where there is one alone.
  const Curve& of(Role role) const;
  /// With every property of a role multiplied.
  ContactMaterial times(Role role, double factor) const;

  /// Parameters at a temperature, °C. Throws Error when a curve is not defined there.
  ContactProperties at(double temperature) const { return at(temperature, temperature); }
  /// \param marked  that strengths, energies and stiffnesses are those of, see OnCooling
  ContactProperties at(double temperature, double marked) const;
};

/// What holds the blocks of two phases together, as a deck says it.
struct InterfaceParameters {
  std::string name;
  std::vector<std::array<std::string, 2>> between;  ///< pairs of phases, in any order
  ContactMaterial contact;                          ///< its stiffnesses are filled in by make_concrete
  std::optional<double> normal_stiffness;  ///< K_n at the reference temperature, Pa/m; else see below
  std::optional<double> shear_stiffness;   ///< K_s, likewise
  std::optional<std::string> like;         ///< interface whose stiffness it has, times the factor;
                                           ///< without one E / t_b of the phase, Eq. (17)
  double stiffness_factor = 1.0;
};

/// Free thermal strain of the concrete as a whole, which those of its two phases make together:
/// inclusions kappa eps_c, matrix (1 - w kappa) / (1 - w) eps_c.
struct StrainOfConcrete {
  Curve strain = Curve::constant(0.0);  ///< eps_c since the reference temperature
  double ratio = 1.0;                   ///< kappa: strain of the inclusions over that of the concrete
  std::optional<double> weight;         ///< w of the inclusions; else of the specimen
};

/// How a bearing and the specimen meet.
enum class BearingContact : std::uint8_t {
  frictional,  ///< no tension; slips by Coulomb's law
  glued        ///< elastic, and never parts
};

/// What is between a bearing and the specimen.
struct BearingInterface {
  std::string name;
  BearingContact contact = BearingContact::frictional;
  double friction = 0.0;  ///< tan(phi), of one that is frictional
  /// K_n and K_s, Pa/m: of a layer between them; without one those of the matrix's own contacts.
  std::optional<std::array<double, 2>> stiffness = {};
};

/// The contacts of a concrete.
struct ContactParameters {
  std::vector<InterfaceParameters> interfaces;
  double fracture_zone = 0.0;  ///< t_b, m, Eq. (17)
  /// Block size at which t_b and the stated stiffnesses hold, m; they scale with the size; else fixed.
  std::optional<double> fracture_zone_size;
  std::vector<BearingInterface> bearings;
  std::string matrix;  ///< phase whose own contacts' stiffness those of the bearings have
};

/// What the phases of a specimen are as a whole.
struct Composition {
  double inclusions = 0.0;  ///< share of the volume that is not matrix
  /// R, creep of the whole over that of its matrix, when the matrix has crept as much as it gives way
  /// elastically, and ten times as much; the same where a deck states it.
  std::optional<std::array<double, 2>> creep_share;
  std::optional<double> strain_weight;  ///< w that its strains got
};

/// Which interface blocks of two phases have.
class InterfaceTable {
 public:
  InterfaceTable() = default;
  /// Without a word of the deck each pair of phases has an interface of its own, named `a_b`; so have two
  /// blocks of one phase that no interface of the deck is for.
  /// \param phases      of the specimen
  /// \param interfaces  of the deck; none where nothing moves
  explicit InterfaceTable(const std::vector<std::string>& phases,
                          const std::vector<InterfaceParameters>& interfaces = {});

  const std::vector<std::string>& names() const { return names_; }
  int between(int phase, int other) const { return of_pair_.at(phase * phases_ + other); }
  int count() const { return static_cast<int>(names_.size()); }
  /// A pair of phases that has the interface, the first one.
  std::array<int, 2> pair_of(int interface) const;

 private:
  int phases_ = 0;
  std::vector<std::string> names_;
  std::vector<int> of_pair_;
};

/// What a body that cools does with E of its phases, and strengths, fracture energies and stiffnesses of its
/// contacts. Free thermal strains go back along their curves in any case, or by SolidMaterial::contraction.
enum class OnCooling : std::uint8_t {
  irreversible,  ///< they stay those of the highest temperature that was there
  reversible     ///< they come back along their curves
};

/// Whether any of them does.
bool any_creeps(const std::vector<SolidMaterial>& solids);

/// What E, strengths, energies and stiffnesses are those of, °C.
inline double marked_by(OnCooling on_cooling, double temperature, double hottest) {
  return on_cooling == OnCooling::irreversible ? hottest : temperature;
}

/// Everything a concrete specimen is made of.
struct ConcreteMaterials {
  std::vector<SolidMaterial> solids;      ///< by phase, then those of bearings
  std::vector<std::string> interfaces;    ///< see InterfaceTable, then those of bearings
  std::vector<ContactMaterial> contacts;  ///< likewise
  double fracture_zone = 0.0;             ///< t_b as it came out, m
  OnCooling on_cooling = OnCooling::irreversible;
  std::optional<Composition> composition;  ///< where `follow_composition` was asked
  std::optional<double> stress_free;       ///< where `set_stress_free` was asked, °C

  bool creeps() const { return any_creeps(solids); }
  bool asks_for_hottest() const;  ///< whether anything follows the highest temperature that was there
  /// That E, strengths, energies and stiffnesses are those of, see OnCooling, °C.
  double marked(double temperature, double hottest) const {
    return marked_by(on_cooling, temperature, hottest);
  }
};

/// Names of the solids that are not of bearings.
std::vector<std::string> phases_of(const std::vector<SolidMaterial>& solids);

/// \param solids      by phase, then those of bearings
/// \param block_size  square root of the mean block area, m: t_b scales with it
/// \param foreseen    that size as a deck foresees it, sqrt(area / count); else the same. Stated stiffnesses
///                    scale with it: they are as printed, to the last bit, where it is fracture_zone_size.
/// Throws Error when blocks of two phases would have no interface.
ConcreteMaterials make_concrete(const std::vector<SolidMaterial>& solids, const ContactParameters& parameters,
                                double block_size, std::optional<double> foreseen = std::nullopt);

/// Lets the thermal strain of every phase count from a temperature, °C, at which the body was put together
/// without stress, and where it was once; else it counts from the reference temperature. Comes after all that
/// changes thermal strains. Throws Error where one is not defined there.
void set_stress_free(ConcreteMaterials& concrete, double temperature);

/// Gives the phases of this specimen what follows from its share of inclusions: the creep that makes the
/// concrete's (see CreepLevel), and the thermal strains that make the concrete's. Both by Mixture<2>, with
/// phases as soft as their blocks are with the contacts between them: 1 / E + 1 / (K_n block size).
/// \param contacts    that `concrete` was made with
/// \param fraction    of each phase, of the volume
/// \param block_size  square root of the mean block area, m
/// Throws Error when inclusions creep too, or strains of phases are asked for and not two phases are there.
void follow_composition(ConcreteMaterials& concrete, const ContactParameters& contacts,
                        const std::optional<StrainOfConcrete>& strain, const std::vector<double>& fraction,
                        double block_size);

}  // namespace pyroclast
