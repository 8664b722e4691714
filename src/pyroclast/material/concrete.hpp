#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
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

/// Body to which a creep strain for each unit of stress refers.
enum class CreepLevel : std::uint8_t {
  concrete,  ///< the concrete as a whole; its one phase that creeps must creep more
  phase      ///< the phase itself
};

/// Creep of a phase that is heated under stress, see material/creep.hpp.
struct CreepMaterial {
  Curve strain = Curve::constant(0.0);  ///< B since the reference temperature: strain at a stress of f_c
  CreepLevel level = CreepLevel::concrete;
  /// R, creep of the concrete over creep of the phase; without it the value follows from the specimen.
  std::optional<double> share;
  double strength = 0.0;   ///< f_c, Pa, by which stresses are divided for B
  CreepIncrement choices;  ///< parameters of the increment except its compliance

  /// Returns the creep of heating for the first time from one temperature to another, °C; none where the
  /// second is not higher.
  CreepIncrement between(double from, double to) const;
};

/// Material of a block: the zones' parameters as functions of temperature.
struct BlockMaterial {
  std::string name;                    ///< name in [materials]
  Curve young = Curve::constant(0.0);  ///< E, Pa
  double poisson = 0.0;                ///< nu
  /// Density, kg/m³; the mass is computed at the reference temperature.
  Curve density = Curve::constant(0.0);
  Curve thermal_strain = Curve::constant(0.0);  ///< free strain since the reference temperature
  /// Quartz step that thermal_strain includes, for a phase only.
  std::optional<QuartzStep> quartz_step;
  std::optional<CreepMaterial> creep;  ///< creep, for a phase only
  /// Expansion coefficient of a phase that is colder than it was, 1/K; without it the strain goes back along
  /// thermal_strain.
  std::optional<double> contraction;
  /// Residual ratio of E, see share_left; only where cooling is irreversible.
  std::optional<Curve> residual_ratio;
  std::optional<Curve> conductivity;   ///< gamma, W/(m K); only for heat conduction
  std::optional<Curve> specific_heat;  ///< c, J/(kg K); only for heat conduction
  bool is_of_bearing = false;          ///< true for a bearing, which is at 20 °C in every run
  /// Thermal strain at the temperature without stress, see set_stress_free.
  double first_strain = 0.0;

  /// Returns the free strain, since the temperature without stress, at a temperature, °C.
  /// \param hottest  highest temperature so far, °C
  double free_strain(double temperature, double hottest) const;
  /// Returns E, Pa, at a temperature, °C.
  /// \param property_temperature  temperature on whose value of the curve E is based, °C, see OnCooling
  double young_at(double temperature, double property_temperature) const {
    return young(property_temperature) * share_left(residual_ratio, temperature, property_temperature);
  }
};

/// Parameters of a contact as functions of temperature (paper, Table 2 and §4.1), for any law.
struct ContactMaterial {
  const LawTable* law = nullptr;
  std::vector<Curve> numbers;  ///< numbers in the order of LawTable::properties
  /// Residual ratios, see share_left, of the properties that do not follow the temperature back on cooling;
  /// in the order of LawTable::properties.
  std::vector<std::optional<Curve>> residual_ratios;
  std::vector<int> choices;  ///< options chosen, in the order of LawTable::choices
  /// Block size at which the stiffnesses hold, m; they go with its inverse. 0: they hold for any.
  double block_size = 0.0;
  /// Roles of the properties that hold at that block size too, and go with it.
  std::vector<Role> with_size;

  ContactMaterial() = default;
  /// Makes a contact whose numbers are all zero, those of single options one, with the first option of each
  /// choice.
  explicit ContactMaterial(const LawTable& of);

  /// Tells whether the contact has a property of its law: true but for one of an option that is not chosen.
  bool has(const PropertyInfo& info) const;
  /// Returns the property of a key. Throws Error when the law has none of this key.
  Curve& operator[](std::string_view key);
  const Curve& operator[](std::string_view key) const;
  /// Sets every property of a role.
  void set(Role role, const Curve& curve, const std::optional<Curve>& residual_ratio = std::nullopt);
  /// Returns the first property of a role. Throws Error when the law has none.
  const Curve& of(Role role) const;
  /// Returns the same contact with every property of a role multiplied.
  ContactMaterial times(Role role, double factor) const;

  /// Returns the contact with the strengths that chemistry alone leaves. Stated curves of strengths are of
  /// contacts without load, so they include the cracks below the mesh A of a law that knows them: each is
  /// divided by 1 - A. Other laws stay as they are.
  ContactMaterial without_hidden_cracks() const;

  /// Returns the parameters at a temperature, °C. Throws Error when a curve is not defined there.
  ContactProperties at(double temperature) const { return at(temperature, temperature); }
  /// \param property_temperature  temperature on whose values strengths, energies and stiffnesses are based,
  /// °C, see
  ///                OnCooling
  ContactProperties at(double temperature, double property_temperature) const;
  /// Writes the numbers of the parameters, in the order of LawTable::properties.
  void write_at(double temperature, double property_temperature, std::span<double> to) const;
  /// Returns the tensile strength at a temperature, Pa, as write_at() gives it; none where the law has none.
  std::optional<double> tensile_strength(double temperature, double property_temperature) const;
  /// Returns the stiffness between blocks of a size over that of `numbers`.
  /// \param size  block size, m; 0: as that of `numbers`
  double stiffness_between(double size) const {
    return block_size > 0.0 && size > 0.0 ? block_size / size : 1.0;
  }
  /// Turns numbers of the law into those between blocks of another size, whose stiffnesses differ by a
  /// factor.
  void scale_to_size(double factor, std::span<double> among) const;

 private:
  double value_at(std::size_t number, double temperature, double property_temperature) const;
};

/// Interface between blocks of two phases, as a deck states it.
struct InterfaceParameters {
  std::string name;
  std::vector<std::array<std::string, 2>> between;  ///< pairs of phases, in any order
  std::vector<std::string> between_stones;          ///< phases of which two stones that touch have it
  ContactMaterial contact;                          ///< contact law; make_concrete fills in its stiffnesses
  /// K_n at the reference temperature, Pa/m; else from `like` or E / t_b.
  std::optional<double> normal_stiffness;
  /// K_s at the reference temperature, Pa/m; else from `like` or G / t_b.
  std::optional<double> shear_stiffness;
  /// Interface whose stiffness is taken, times the factor; without it E / t_b of the softest phase, Eq. (17).
  std::optional<std::string> like;
  double stiffness_factor = 1.0;
};

/// Free thermal strain of the concrete as a whole, from which the strains of its two phases follow:
/// inclusions kappa eps_c, matrix (1 - w kappa) / (1 - w) eps_c.
struct StrainOfConcrete {
  Curve strain = Curve::constant(0.0);  ///< eps_c since the reference temperature
  double ratio = 1.0;                   ///< kappa: strain of the inclusions over that of the concrete
  /// w of the inclusions; without it the value follows from the specimen.
  std::optional<double> weight;
};

/// Kind of contact between a bearing and the specimen.
enum class BearingContact : std::uint8_t {
  frictional,  ///< no tension; slips by Coulomb's law
  glued        ///< elastic, and never parts
};

/// Interface between a bearing and the specimen.
struct BearingInterface {
  std::string name;
  BearingContact contact = BearingContact::frictional;
  double friction = 0.0;  ///< tan(phi), for a frictional contact
  /// K_n and K_s, Pa/m, of a layer between bearing and specimen; without a layer those of the matrix's own
  /// contacts.
  std::optional<std::array<double, 2>> stiffness = {};
};

/// Contacts of a concrete.
struct ContactParameters {
  std::vector<InterfaceParameters> interfaces;
  double fracture_zone = 0.0;  ///< t_b, m, Eq. (17)
  /// Block size at which t_b and the stated stiffnesses hold, m; they scale with the size. Without it they
  /// are fixed.
  std::optional<double> fracture_zone_size;
  /// Roles of the properties that hold at that block size too, and go with it; all others but stiffnesses
  /// hold at any.
  std::vector<Role> with_size;
  std::vector<BearingInterface> bearings;
  std::string matrix;  ///< phase whose own contacts give the bearings' contacts their stiffness
};

/// Properties of the specimen's phases as a whole.
struct Composition {
  double inclusions = 0.0;  ///< share of the volume that is not matrix
  /// R, creep of the whole over creep of its matrix, when the matrix has crept once and ten times its elastic
  /// strain; both are the same where a deck states R.
  std::optional<std::array<double, 2>> creep_share;
  std::optional<double> strain_weight;  ///< weight w that the thermal strains of the phases got
};

/// Table of the interface that blocks of two phases have.
class InterfaceTable {
 public:
  InterfaceTable() = default;
  /// Gives each pair of phases an interface: the one that the deck states for the pair, else an interface of
  /// the pair's own, named `a_b`. The same holds for two blocks of one phase, but two stones of a phase may
  /// have another one.
  /// \param phases      phases of the specimen
  /// \param interfaces  interfaces of the deck; none where nothing moves
  explicit InterfaceTable(const std::vector<std::string>& phases,
                          const std::vector<InterfaceParameters>& interfaces = {});

  const std::vector<std::string>& names() const { return names_; }
  int between(int phase, int other) const { return of_pair_.at(phase * phases_ + other); }
  /// Returns the interface of blocks of two stones that are of one phase.
  int between_stones(int phase) const { return of_stones_.at(phase); }
  int count() const { return static_cast<int>(names_.size()); }
  /// Returns the first pair of phases that has the interface, or the phase, twice, whose stones have it.
  std::array<int, 2> pair_of(int interface) const;

 private:
  int phases_ = 0;
  std::vector<std::string> names_;
  std::vector<int> of_pair_, of_stones_;
};

/// Behaviour, when a body cools, of E of its phases and of strengths, fracture energies and stiffnesses of
/// its contacts. Free thermal strains go back along their curves in any case, or by
/// BlockMaterial::contraction.
enum class OnCooling : std::uint8_t {
  irreversible,  ///< values stay those of the highest temperature so far
  reversible     ///< values come back along their curves
};

/// Tells whether any of the materials creeps.
bool any_creeps(const std::vector<BlockMaterial>& block_materials);

/// Returns the temperature on whose values E, strengths, energies and stiffnesses are based, °C.
inline double property_temperature(OnCooling on_cooling, double temperature, double hottest) {
  return on_cooling == OnCooling::irreversible ? hottest : temperature;
}

/// Materials, interfaces and contacts of a concrete specimen.
struct ConcreteMaterials {
  std::vector<BlockMaterial> block_materials;  ///< materials by phase, then those of bearings
  std::vector<std::string> interfaces;         ///< names as in InterfaceTable, then those of bearings
  std::vector<ContactMaterial> contacts;       ///< contacts in the order of `interfaces`
  std::size_t bearing_interfaces = 0;          ///< number of those of bearings
  double fracture_zone = 0.0;                  ///< t_b that results where blocks have their mean size, m
  OnCooling on_cooling = OnCooling::irreversible;
  std::optional<Composition> composition;  ///< composition, where `follow_composition` was called
  std::optional<double> stress_free;       ///< temperature of `set_stress_free`, where it was called, °C
  /// True where blocks may meet others: found contacts ask for properties at no special place.
  bool has_found_contacts = false;

  bool creeps() const { return any_creeps(block_materials); }
  bool asks_for_hottest() const;  ///< Tells whether any property depends on the highest temperature so far.
  /// Returns the temperature on whose values E, strengths, energies and stiffnesses are based, see OnCooling,
  /// °C.
  double property_temperature(double temperature, double hottest) const {
    return pyroclast::property_temperature(on_cooling, temperature, hottest);
  }
};

/// Returns the names of the materials, without those of bearings.
std::vector<std::string> phases_of(const std::vector<BlockMaterial>& block_materials);

/// Makes the materials of a concrete. Throws Error when blocks of two phases would have no interface.
/// \param block_materials  materials by phase, then those of bearings
/// \param block_size  square root of the mean block area, m: t_b scales with it
/// \param foreseen    block size that a deck foresees, sqrt(area / count), m; without it block_size. Stated
///                    stiffnesses scale with it: where it is fracture_zone_size, they are as printed, to the
///                    last bit.
ConcreteMaterials make_concrete(const std::vector<BlockMaterial>& block_materials,
                                const ContactParameters& parameters, double block_size,
                                std::optional<double> foreseen = std::nullopt);

/// Counts the thermal strain of every phase from a temperature, °C, at which the body was put together
/// without stress; without this call it counts from the reference temperature. Call it after everything that
/// changes thermal strains. Throws Error where a thermal strain is not defined at the temperature.
void set_stress_free(ConcreteMaterials& concrete, double temperature);

/// Gives the phases of this specimen the creep (see CreepLevel) and the thermal strains that together make
/// those of the concrete. Both follow from the share of inclusions by Mixture; phases are as soft as their
/// blocks with the contacts between them: 1 / E + 1 / (K_n block size). Throws Error when inclusions creep
/// too, or when strains of phases are asked for and there are more than two phases.
/// \param contacts    parameters with which `concrete` was made
/// \param fraction    share of each phase in the volume
/// \param block_size  square root of the mean block area, in space cube root of the mean volume, m
/// \param dimension   2: inclusions are discs in plane stress; 3: balls
void follow_composition(ConcreteMaterials& concrete, const ContactParameters& contacts,
                        const std::optional<StrainOfConcrete>& strain, const std::vector<double>& fraction,
                        double block_size, int dimension);

}  // namespace pyroclast
