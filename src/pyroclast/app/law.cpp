#include <algorithm>
#include <array>
#include <cmath>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "pyroclast/app/load.hpp"
#include "pyroclast/base/error.hpp"
#include "pyroclast/laws/kit.hpp"
#include "pyroclast/laws/registry.hpp"
#include "pyroclast/material/jump_path.hpp"
#include "pyroclast/mechanics/law_row.hpp"
#include "pyroclast/plugin/find_law.hpp"
#include "pyroclast/results/text_file.hpp"

namespace pyroclast::app {

namespace {

/// The contacts of an interface, of the deck or of two blocks of one phase. Throws Error when there is none.
const ContactMaterial& contact_of(const ConcreteMaterials& concrete, const InterfaceTable& table,
                                  const std::string& name) {
  const auto& names = table.names();
  const auto found = std::ranges::find(names, name);
  if (found == names.end())
    throw Error(fmt::format("--interface {}: must be one of {}", name, fmt::join(names, ", ")));
  return concrete.contacts[found - names.begin()];
}

/// One contact point on its way along a path, with its energies added up.
class Drive {
 public:
  explicit Drive(const ContactMaterial& material)
      : material_(material),
        law_(*material.law),
        history_(law_.history(2).size()),
        losses_(law_.losses.size()) {
    warm_to(kReferenceTemperature);
  }

  void go(const JumpPathPoint& to) {
    if (to.temperature != at_.temperature) {
      warm_to(to.temperature);
      const double before = response_.stored + dissipated();
      update(at_);
      property_change_ += response_.stored + dissipated() - before;
    }
    update(to);
    at_ = to;
  }

  std::string header() const {
    std::string names = "u_n_m,u_s_m,T_degC,sigma_Pa,tau_Pa,stored_J_m2,property_change_J_m2";
    const auto add = [&](const char* prefix, const char* name, const Unit& unit) {
      names += fmt::format(",{}{}", prefix, name);
      if (unit != unit::dimensionless) names += fmt::format("_{}", spelt(unit));
    };
    for (const HistoryInfo& info : law_.history(2)) add("", info.name, info.unit);
    for (const LossInfo& info : law_.losses) add(info.is_energy() ? "dissipated_" : "", info.name, info.unit);
    return names + "\n";
  }

  std::string row() const {
    std::string cells = fmt::format("{:.12g},{:.12g},{:.12g},{:.12g},{:.12g},{:.12g},{:.12g}", at_.opening,
                                    at_.slip, at_.temperature, response_.normal_traction,
                                    response_.shear_traction[0], response_.stored, property_change_);
    for (double value : history_) cells += fmt::format(",{:.12g}", value);
    for (double value : losses_) cells += fmt::format(",{:.12g}", value);
    return cells + "\n";
  }

 private:
  static std::string spelt(const Unit& unit) {
    std::string name = unit.si;
    std::ranges::replace(name, '/', '_');
    return name;
  }

  void warm_to(double temperature) { constants_ = material_.at(temperature).constants(); }

  void update(const JumpPathPoint& point) {
    const std::array jump{point.opening, point.slip};
    response_ = law_.update(2)(constants_.data(), jump.data(), history_.data(), losses_.data());
  }

  double dissipated() const {
    double sum = 0.0;
    for (std::size_t i = 0; i < losses_.size(); ++i)
      if (law_.losses[i].is_energy()) sum += losses_[i];
    return sum;
  }

  const ContactMaterial& material_;
  const LawTable& law_;
  std::vector<std::byte> constants_;
  std::vector<double> history_, losses_;
  PointResponse response_;
  JumpPathPoint at_;
  double property_change_ = 0.0;
};

}  // namespace

namespace {

/// Property or choice `key` of a law, from "key=value".
void set_value(ContactMaterial& material, const LawTable& law, const std::string& change,
               std::vector<bool>& given) {
  const auto equals = change.find('=');
  const std::string key = change.substr(0, equals);
  const std::string value = equals == std::string::npos ? "" : change.substr(equals + 1);
  std::vector<std::string_view> keys;
  for (std::size_t i = 0; i < law.properties.size(); ++i) {
    const PropertyInfo& info = law.properties[i];
    keys.emplace_back(info.key);
    if (key != info.key) continue;
    try {
      material.numbers[i] = Curve::constant(parse_quantity(value, info.unit));
    } catch (const Error& e) {
      throw Error(fmt::format("--set {}: {}", change, e.what()));
    }
    given[i] = true;
    return;
  }
  for (std::size_t i = 0; i < law.choices.size(); ++i) {
    const ChoiceInfo& info = law.choices[i];
    keys.emplace_back(info.key);
    if (key != info.key) continue;
    std::vector<std::string_view> options;
    for (int option = 0; option < ChoiceInfo::kMostOptions && info.options[option].name; ++option) {
      options.emplace_back(info.options[option].name);
      if (value != info.options[option].name) continue;
      material.choices[i] = option;
      return;
    }
    throw Error(fmt::format("--set {}: allowed are {}", change, fmt::join(options, ", ")));
  }
  throw Error(fmt::format("--set {}: the contact law \"{}\" has no \"{}\"; it has {}", change, law.name, key,
                          fmt::join(keys, ", ")));
}

/// A law that the command line states, with all its properties.
ContactMaterial stated_material(const LawOptions& options) {
  const LawTable& law = find_law(options.law, {}, sources_of(options.sources));
  if (!law.update(2))
    throw Error(fmt::format("the contact law \"{}\" is made for bodies in 3D alone", law.name));
  fmt::print(stderr, "{}", describe_own_laws());
  ContactMaterial material(law);
  std::vector<bool> given(law.properties.size());
  for (const std::string& change : options.values) set_value(material, law, change, given);
  for (std::size_t i = 0; i < given.size(); ++i)
    if (!given[i])
      throw Error(fmt::format("the contact law \"{}\" needs {}: {}; say for example --set {}='{}'", law.name,
                              law.properties[i].key, law.properties[i].meaning, law.properties[i].key,
                              law.properties[i].unit.example));
  validate(material.at(kReferenceTemperature), law.name);
  return material;
}

ContactMaterial material_of_deck(const LawOptions& options) {
  const Deck deck = Deck::load(options.deck);
  const Setup setup = read_setup(deck, options.deck.parent_path(), {}, sources_of(options.sources));
  if (!setup.motion)
    throw Error(fmt::format("{}: is of heat conduction alone and has no contacts, so no contact law",
                            options.deck.string()));
  const ContactParameters& contacts = setup.motion->contacts;
  const auto concrete = make_concrete(setup.solids, contacts, expected_block_size(setup.specimen, contacts));
  const InterfaceTable table(phases_of(setup.solids), contacts.interfaces);
  const std::string matrix = contacts.matrix + "_" + contacts.matrix;
  return contact_of(concrete, table, options.interface.empty() ? matrix : options.interface);
}

}  // namespace

int law(const LawOptions& options) {
  if (options.law.empty() && options.deck.empty())
    throw Error("law: state a deck, or a law with --law and its properties with --set");
  const ContactMaterial material = options.law.empty() ? material_of_deck(options) : stated_material(options);
  Drive drive(material);

  std::string csv = drive.header();
  JumpPathPoint from;
  for (const JumpPathPoint& to : read_jump_path(options.path)) {
    for (int i = 1; i <= options.steps; ++i) {
      const double share = static_cast<double>(i) / options.steps;
      const auto between = [&](double a, double b) { return i == options.steps ? b : a + share * (b - a); };
      drive.go({between(from.opening, to.opening), between(from.slip, to.slip),
                between(from.temperature, to.temperature)});
      csv += drive.row();
    }
    from = to;
  }
  if (options.out.empty())
    fmt::print("{}", csv);
  else
    write_text_file(options.out, csv);
  return 0;
}

int verify_laws(const VerifyOptions& options) {
  std::vector<const LawTable*> wanted;
  for (const std::string& name : options.laws) {
    wanted.push_back(&find_law(name, {}, sources_of(options.sources)));
  }
  fmt::print(stderr, "{}", describe_own_laws());
  if (wanted.empty()) wanted.assign(built_in_laws().begin(), built_in_laws().end());
  bool passed = true;
  for (const LawTable* law : wanted) {
    KitOptions kit;
    kit.paths = options.paths;
    kit.seed = options.seed;
    kit.lanes = lanes_of_step(*law);
    const KitReport report = verify(*law, kit);
    fmt::print("{}", report.text());
    passed = passed && report.passed();
  }
  return passed ? 0 : 1;
}

}  // namespace pyroclast::app
