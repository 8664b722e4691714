#include "pyroclast/material/concrete.hpp"

#include <algorithm>
#include <utility>

#include <fmt/format.h>

#include "pyroclast/base/error.hpp"
#include "pyroclast/material/mixture.hpp"

namespace pyroclast {

namespace {

/// K_n and K_s over the temperature, Pa/m, and their residual ratios on cooling: both follow E of a block.
struct Stiffness {
  Curve normal, shear;
  std::optional<Curve> normal_residual, shear_residual;

  void put_into(ContactMaterial& contact) const {
    contact.set(Role::normal_stiffness, normal, normal_residual);
    contact.set(Role::shear_stiffness, shear, shear_residual);
  }
};

/// Returns E(T) / t_b and G(T) / t_b of Eq. (17).
Stiffness stiffness_of(const BlockMaterial& material, double fracture_zone) {
  return {material.young * (1.0 / fracture_zone),
          material.young * (0.5 / (1.0 + material.poisson) / fracture_zone), material.residual_ratio,
          material.residual_ratio};
}

const InterfaceParameters* find(const std::vector<InterfaceParameters>& interfaces, const std::string& name) {
  const auto found = std::ranges::find(interfaces, name, &InterfaceParameters::name);
  return found == interfaces.end() ? nullptr : &*found;
}

/// Stiffnesses of interfaces, some of which have those of others.
class StiffnessOfInterfaces {
 public:
  StiffnessOfInterfaces(const std::vector<BlockMaterial>& block_materials,
                        const ContactParameters& parameters, double fracture_zone, double stated_scale)
      : materials_(block_materials),
        parameters_(parameters),
        fracture_zone_(fracture_zone),
        scale_(stated_scale) {}

  Stiffness of(const InterfaceParameters& interface, std::size_t depth = 0) const {
    if (depth > parameters_.interfaces.size())
      throw Error(fmt::format("contacts.{}: \"like\" leads back to itself", interface.name));
    const BlockMaterial& material = softest(interface);
    Stiffness k = stiffness_of(material, fracture_zone_);
    if (interface.like) {
      const InterfaceParameters* other = find(parameters_.interfaces, *interface.like);
      if (!other)
        throw Error(
            fmt::format("contacts.{}: there is no interface \"{}\"", interface.name, *interface.like));
      k = of(*other, depth + 1);
      k.normal = k.normal * interface.stiffness_factor;
      k.shear = k.shear * interface.stiffness_factor;
    }
    // A stated stiffness follows E(T) like a computed one.
    const double young = material.young(kReferenceTemperature);
    if (interface.normal_stiffness) {
      k.normal = material.young * (*interface.normal_stiffness * scale_ / young);
      k.normal_residual = material.residual_ratio;
    }
    if (interface.shear_stiffness) {
      k.shear = material.young * (*interface.shear_stiffness * scale_ / young);
      k.shear_residual = material.residual_ratio;
    }
    return k;
  }

 private:
  /// Returns the phase with the least E at the reference temperature of those that an interface joins.
  const BlockMaterial& softest(const InterfaceParameters& interface) const {
    const BlockMaterial* softest = nullptr;
    const auto joins = [&](const std::string& phase) {
      return std::ranges::find(interface.between_stones, phase) != interface.between_stones.end() ||
             std::ranges::any_of(interface.between,
                                 [&](const auto& pair) { return pair[0] == phase || pair[1] == phase; });
    };
    for (const BlockMaterial& material : materials_)
      if (joins(material.name) &&
          (!softest || material.young(kReferenceTemperature) < softest->young(kReferenceTemperature)))
        softest = &material;
    if (!softest)
      throw Error(fmt::format("contacts.{}: none of its phases is in the specimen", interface.name));
    return *softest;
  }

  const std::vector<BlockMaterial>& materials_;
  const ContactParameters& parameters_;
  double fracture_zone_, scale_;
};

std::size_t place_of(const LawTable& law, std::string_view key) {
  for (std::size_t i = 0; i < law.properties.size(); ++i)
    if (law.properties[i].key == key) return i;
  throw Error(fmt::format("the contact law \"{}\" has no property \"{}\"", law.name, key));
}

}  // namespace

ContactMaterial::ContactMaterial(const LawTable& of)
    : law(&of),
      numbers(of.properties.size(), Curve::constant(0.0)),
      residual_ratios(of.properties.size()),
      choices(of.choices.size()) {
  for (std::size_t i = 0; i < numbers.size(); ++i)
    if (of.properties[i].of_option) numbers[i] = Curve::constant(1.0);
}

bool ContactMaterial::has(const PropertyInfo& info) const {
  if (!info.of_option) return true;
  for (std::size_t i = 0; i < choices.size(); ++i)
    if (const char* chosen = law->choices[i].options[choices[i]].name;
        chosen && std::string_view(chosen) == info.of_option)
      return true;
  return false;
}

Curve& ContactMaterial::operator[](std::string_view key) {
  return numbers[place_of(*law, key)];
}

const Curve& ContactMaterial::operator[](std::string_view key) const {
  return numbers[place_of(*law, key)];
}

void ContactMaterial::set(Role role, const Curve& curve, const std::optional<Curve>& residual_ratio) {
  for (std::size_t i = 0; i < numbers.size(); ++i) {
    if (law->properties[i].role != role) continue;
    numbers[i] = curve;
    residual_ratios[i] = residual_ratio;
  }
}

const Curve& ContactMaterial::of(Role role) const {
  for (std::size_t i = 0; i < numbers.size(); ++i)
    if (law->properties[i].role == role) return numbers[i];
  throw Error(fmt::format("the contact law \"{}\" has no property of that role", law->name));
}

ContactMaterial ContactMaterial::times(Role role, double factor) const {
  ContactMaterial scaled = *this;
  for (std::size_t i = 0; i < numbers.size(); ++i)
    if (law->properties[i].role == role) scaled.numbers[i] = numbers[i] * factor;
  return scaled;
}

ContactMaterial ContactMaterial::without_hidden_cracks() const {
  ContactMaterial whole = *this;
  for (std::size_t i = 0; i < numbers.size(); ++i) {
    if (law->properties[i].role != Role::hidden_cracks) continue;
    const Curve& cracks = numbers[i];
    const auto raise = [cracks](double temperature) { return 1.0 / (1.0 - cracks(temperature)); };
    const Curve factor = cracks.is_constant()
                             ? Curve::constant(raise(kReferenceTemperature))
                             : Curve::function("1 / (1 - cracks)", raise, cracks.range(), cracks.axis());
    for (std::size_t k = 0; k < numbers.size(); ++k)
      if (law->properties[k].role == Role::strength) whole.numbers[k] = whole.numbers[k] * factor;
  }
  return whole;
}

void ContactMaterial::scale_to_size(double factor, std::span<double> among) const {
  for (std::size_t i = 0; i < among.size(); ++i) {
    const Role role = law->properties[i].role;
    if (role == Role::normal_stiffness || role == Role::shear_stiffness) among[i] *= factor;
    if (std::ranges::find(with_size, role) != with_size.end()) among[i] /= factor;
  }
}

ContactProperties ContactMaterial::at(double temperature, double property_temperature) const {
  std::vector<double> values(numbers.size());
  write_at(temperature, property_temperature, values);
  return {*law, std::move(values), choices};
}

void ContactMaterial::write_at(double temperature, double property_temperature, std::span<double> to) const {
  for (std::size_t i = 0; i < numbers.size(); ++i) to[i] = value_at(i, temperature, property_temperature);
}

double ContactMaterial::value_at(std::size_t number, double temperature, double property_temperature) const {
  return is_apart_from_temperature(law->properties[number].role)
             ? numbers[number](temperature)
             : numbers[number](property_temperature) *
                   share_left(residual_ratios[number], temperature, property_temperature);
}

std::optional<double> ContactMaterial::tensile_strength(double temperature,
                                                        double property_temperature) const {
  for (std::size_t i = 0; i < numbers.size(); ++i)
    if (law->properties[i].key == std::string_view(info::tensile_strength.key))
      return value_at(i, temperature, property_temperature);
  return std::nullopt;
}

double BlockMaterial::free_strain(double temperature, double hottest) const {
  if (!contraction || temperature >= hottest) return thermal_strain(temperature) - first_strain;
  return thermal_strain(hottest) - *contraction * (hottest - temperature) - first_strain;
}

void set_stress_free(ConcreteMaterials& concrete, double temperature) {
  concrete.stress_free = temperature;
  for (BlockMaterial& material : concrete.block_materials)
    if (!material.is_of_bearing) material.first_strain = material.thermal_strain(temperature);
}

CreepIncrement CreepMaterial::between(double from, double to) const {
  CreepIncrement increment = choices;
  if (to > from) increment.compliance = (strain(to) - strain(from)) / strength;
  return increment;
}

bool any_creeps(const std::vector<BlockMaterial>& block_materials) {
  return std::ranges::any_of(block_materials,
                             [](const BlockMaterial& material) { return material.creep.has_value(); });
}

bool ConcreteMaterials::asks_for_hottest() const {
  const auto contracts = [](const BlockMaterial& material) { return material.contraction.has_value(); };
  return on_cooling == OnCooling::irreversible || creeps() || std::ranges::any_of(block_materials, contracts);
}

InterfaceTable::InterfaceTable(const std::vector<std::string>& phases,
                               const std::vector<InterfaceParameters>& interfaces)
    : phases_(static_cast<int>(phases.size())), of_pair_(phases.size() * phases.size()) {
  const auto stated = [&](const std::string& a, const std::string& b) -> const InterfaceParameters* {
    for (const InterfaceParameters& interface : interfaces)
      for (const auto& [first, second] : interface.between)
        if ((first == a && second == b) || (first == b && second == a)) return &interface;
    return nullptr;
  };
  const auto number_of = [&](const std::string& name) {
    auto known = std::ranges::find(names_, name);
    if (known == names_.end()) known = names_.insert(names_.end(), name);
    return static_cast<int>(known - names_.begin());
  };
  for (int a = 0; a < phases_; ++a)
    for (int b = a; b < phases_; ++b) {
      const InterfaceParameters* own = stated(phases[a], phases[b]);
      of_pair_[a * phases_ + b] = of_pair_[b * phases_ + a] =
          number_of(own ? own->name : phases[a] + "_" + phases[b]);
    }
  for (int phase = 0; phase < phases_; ++phase) {
    of_stones_.push_back(between(phase, phase));
    for (const InterfaceParameters& interface : interfaces)
      if (std::ranges::find(interface.between_stones, phases[phase]) != interface.between_stones.end())
        of_stones_.back() = number_of(interface.name);
  }
}

std::array<int, 2> InterfaceTable::pair_of(int interface) const {
  for (int a = 0; a < phases_; ++a)
    for (int b = a; b < phases_; ++b)
      if (between(a, b) == interface) return {a, b};
  for (int phase = 0; phase < phases_; ++phase)
    if (between_stones(phase) == interface) return {phase, phase};
  throw Error(fmt::format("no pair of phases has interface {}; there are {}", interface, count()));
}

std::vector<std::string> phases_of(const std::vector<BlockMaterial>& block_materials) {
  std::vector<std::string> names;
  for (const BlockMaterial& material : block_materials)
    if (!material.is_of_bearing) names.push_back(material.name);
  return names;
}

ConcreteMaterials make_concrete(const std::vector<BlockMaterial>& block_materials, const ContactParameters& p,
                                double block_size, std::optional<double> foreseen) {
  const InterfaceTable table(phases_of(block_materials), p.interfaces);
  ConcreteMaterials concrete;
  concrete.block_materials = block_materials;
  concrete.interfaces = table.names();
  concrete.fracture_zone =
      p.fracture_zone_size ? p.fracture_zone * block_size / *p.fracture_zone_size : p.fracture_zone;
  const double scale = p.fracture_zone_size ? *p.fracture_zone_size / foreseen.value_or(block_size) : 1.0;
  const StiffnessOfInterfaces stiffness(block_materials, p, concrete.fracture_zone, scale);
  std::optional<Stiffness> of_matrix;
  for (int i = 0; i < table.count(); ++i) {
    const auto [a, b] = table.pair_of(i);
    if (const InterfaceParameters* stated = find(p.interfaces, table.names()[i])) {
      concrete.contacts.push_back(stated->contact.without_hidden_cracks());
      const Stiffness k = stiffness.of(*stated);
      k.put_into(concrete.contacts.back());
      if (block_materials[a].name == p.matrix && a == b) of_matrix = k;
    } else if (a == b) {
      concrete.contacts.emplace_back(table_of<Elastic>());
      stiffness_of(block_materials[a], concrete.fracture_zone).put_into(concrete.contacts.back());
    } else {
      throw Error(fmt::format("contacts: blocks of {} and {} may meet, but no interface is between them",
                              block_materials[a].name, block_materials[b].name));
    }
  }
  if (p.fracture_zone_size)
    for (ContactMaterial& contact : concrete.contacts) {
      contact.block_size = block_size;
      contact.with_size = p.with_size;
      for (const Role role : p.with_size) contact = contact.times(role, 1.0 / scale);
    }
  if (!of_matrix)
    throw Error(fmt::format("contacts: no interface is between two blocks of the matrix, {}", p.matrix));

  concrete.bearing_interfaces = p.bearings.size();
  for (const BearingInterface& bearing : p.bearings) {
    const bool is_glued = bearing.contact == BearingContact::glued;
    ContactMaterial& contact =
        concrete.contacts.emplace_back(is_glued ? table_of<Elastic>() : table_of<Frictional>());
    concrete.interfaces.push_back(bearing.name);
    of_matrix->put_into(contact);
    if (p.fracture_zone_size && !bearing.stiffness) contact.block_size = block_size;
    if (bearing.stiffness) {
      contact.set(Role::normal_stiffness, Curve::constant((*bearing.stiffness)[0]));
      contact.set(Role::shear_stiffness, Curve::constant((*bearing.stiffness)[1]));
    }
    if (!is_glued) contact["friction"] = Curve::constant(bearing.friction);
  }
  return concrete;
}

namespace {

/// Returns a phase at the reference temperature. Its blocks lie in series with the contacts between them.
MixedPhase with_contacts(const BlockMaterial& material, double fraction, const ContactMaterial& contact,
                         double block_size) {
  const double young = material.young(kReferenceTemperature);
  const double layer = contact.at(kReferenceTemperature).stiffness().normal * block_size;
  return {fraction, 1.0 / (1.0 / young + 1.0 / layer), material.poisson};
}

/// Creep of the matrix as a function of the creep of the whole, both 1/Pa: the inverse of Mixture::creep,
/// linear between points that stand close enough for five digits.
class CreepOfMatrix {
 public:
  template <int Dim>
  CreepOfMatrix(const Mixture<Dim>& mixture, double elastic, double poisson) {
    constexpr double kFirst = 1e-3, kGrowth = 1.02, kLast = 1e4;  // over the elastic compliance of the matrix
    for (double ratio = kFirst; ratio < kLast; ratio *= kGrowth) {
      const double of_whole = mixture.creep(ratio * elastic, poisson);
      if (!(of_whole > of_whole_.back())) break;  // the inclusions bear all that is left
      of_whole_.push_back(of_whole);
      of_matrix_.push_back(ratio * elastic);
    }
  }

  /// Returns the creep of the matrix. Throws Error when the matrix cannot make the whole creep so much.
  double operator()(double of_whole) const {
    if (of_whole > of_whole_.back())
      throw Error(
          "inclusions bear on one another so much that their matrix cannot make the concrete creep by that; "
          "state share, or the creep of the phase itself with of = \"phase\"");
    const auto above = std::ranges::lower_bound(of_whole_, of_whole);
    if (above == of_whole_.begin()) return 0.0;
    const auto i = static_cast<std::size_t>(above - of_whole_.begin());
    const double t = (of_whole - of_whole_[i - 1]) / (of_whole_[i] - of_whole_[i - 1]);
    return of_matrix_[i - 1] + t * (of_matrix_[i] - of_matrix_[i - 1]);
  }

 private:
  std::vector<double> of_whole_{0.0}, of_matrix_{0.0};
};

/// Turns the creep of the concrete into that of its matrix.
template <int Dim>
void take_to_matrix(CreepMaterial& creep, const Mixture<Dim>& mixture, const MixedPhase& matrix) {
  creep.level = CreepLevel::phase;
  if (creep.share) {
    creep.strain = creep.strain * (1.0 / *creep.share);
    return;
  }
  const CreepOfMatrix of_matrix(mixture, 1.0 / matrix.young, creep.choices.poisson);
  const auto strain = [of_whole = creep.strain, of_matrix, f_c = creep.strength](double temperature) {
    return f_c * of_matrix(of_whole(temperature) / f_c);
  };
  strain(creep.strain.range().upper);  // throws where this is too much
  creep.strain = Curve::function("creep of the matrix, from " + creep.strain.description(), strain,
                                 creep.strain.range(), creep.strain.axis());
}

template <int Dim>
void follow_mixture(ConcreteMaterials& concrete, const ContactParameters& parameters,
                    const std::optional<StrainOfConcrete>& strain, const std::vector<double>& fraction,
                    double block_size) {
  const auto phases = phases_of(concrete.block_materials);
  const InterfaceTable table(phases, parameters.interfaces);
  const auto of_matrix =
      static_cast<std::size_t>(std::ranges::find(phases, parameters.matrix) - phases.begin());
  std::vector<MixedPhase> mixed, inclusions;
  for (std::size_t i = 0; i < phases.size(); ++i) {
    const int phase = static_cast<int>(i);
    mixed.push_back(with_contacts(concrete.block_materials[i], fraction[i],
                                  concrete.contacts[table.between(phase, phase)], block_size));
    if (i != of_matrix && fraction[i] > 0.0) inclusions.push_back(mixed.back());
  }
  const Mixture<Dim> mixture(mixed[of_matrix], inclusions);
  Composition& whole = concrete.composition.emplace();
  whole.inclusions = 1.0 - fraction[of_matrix];

  for (std::size_t i = 0; i < phases.size(); ++i) {
    auto& creep = concrete.block_materials[i].creep;
    if (!creep || creep->level == CreepLevel::phase) continue;
    if (i != of_matrix)
      throw Error(
          fmt::format("materials.{}.creep: only the creep of the matrix, {}, follows from the "
                      "concrete's; state that of the phase itself with of = \"phase\"",
                      phases[i], parameters.matrix));
    const auto share = [&](double ratio) {
      return creep->share.value_or(mixture.creep_share(ratio, creep->choices.poisson));
    };
    whole.creep_share = {share(1.0), share(10.0)};
    take_to_matrix(*creep, mixture, mixed[of_matrix]);
  }
  if (!strain) return;
  if (phases.size() > 2)
    throw Error(
        fmt::format("concrete.inclusion_ratio: gives the strains of a matrix and of one kind of inclusions, "
                    "and not of {} phases",
                    phases.size()));
  const double weight = inclusions.empty() ? 0.0 : strain->weight.value_or(mixture.inclusion_weight());
  whole.strain_weight = weight;
  for (std::size_t i = 0; i < phases.size(); ++i) {
    const double ratio = i == of_matrix ? (1.0 - weight * strain->ratio) / (1.0 - weight) : strain->ratio;
    concrete.block_materials[i].thermal_strain =
        (strain->strain * ratio).named(fmt::format("materials.{}.thermal_strain", phases[i]));
  }
}

}  // namespace

void follow_composition(ConcreteMaterials& concrete, const ContactParameters& parameters,
                        const std::optional<StrainOfConcrete>& strain, const std::vector<double>& fraction,
                        double block_size, int dimension) {
  const auto follow = dimension == 2 ? follow_mixture<2> : follow_mixture<3>;
  follow(concrete, parameters, strain, fraction, block_size);
}

}  // namespace pyroclast
