#include "pyroclast/session/law_point.hpp"

#include <algorithm>
#include <array>
#include <string_view>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "pyroclast/base/error.hpp"
#include "pyroclast/units/units.hpp"

namespace pyroclast {

namespace {

/// Sets the property or choice of a law that "key=value" names.
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

}  // namespace

ContactMaterial stated_material(const LawTable& law, const std::vector<std::string>& values) {
  if (!law.update(2))
    throw Error(fmt::format("the contact law \"{}\" is made for bodies in 3D alone", law.name));
  ContactMaterial material(law);
  std::vector<bool> given(law.properties.size());
  for (const std::string& change : values) set_value(material, law, change, given);
  for (std::size_t i = 0; i < given.size(); ++i)
    if (!given[i] && law.properties[i].role == Role::cold_strength)
      material.numbers[i] = material.of(Role::strength);
    else if (given[i] != material.has(law.properties[i]))
      throw given[i] ? Error(fmt::format("the contact law \"{}\" has {} with \"{}\" alone", law.name,
                                         law.properties[i].key, law.properties[i].of_option))
                     : Error(fmt::format("the contact law \"{}\" needs {}: {}; say for example --set {}='{}'",
                                         law.name, law.properties[i].key, law.properties[i].meaning,
                                         law.properties[i].key, law.properties[i].unit.example));
  try {
    validate(material.at(kReferenceTemperature), law.name);
  } catch (const PropertyError& e) {
    const auto change = std::ranges::find_if(
        values, [&](const std::string& value) { return value.starts_with(e.key + "="); });
    throw Error(
        fmt::format("--set {}: {} of the contact law \"{}\" must be {}", *change, e.key, law.name, e.wanted));
  }
  return material.without_hidden_cracks();
}

LawPoint::LawPoint(ContactMaterial material, OnCooling on_cooling, double temperature, double hottest)
    : material_(std::move(material)),
      on_cooling_(on_cooling),
      hottest_(std::max(temperature, hottest)),
      law_(*material_.law),
      internals_(law_.internals(2).size()),
      losses_(law_.losses.size()),
      at_{.temperature = temperature} {
  warm_to(temperature);
}

void LawPoint::go(const JumpPathPoint& to) {
  if (to.temperature != at_.temperature) {
    warm_to(to.temperature);
    const double before = response_.stored + dissipated();
    update(at_);
    property_change_ += response_.stored + dissipated() - before;
  }
  update(to);
  at_ = to;
}

void LawPoint::warm_to(double temperature) {
  const double hottest = std::max(hottest_, temperature);
  for (const Curve& number : material_.numbers) number(temperature);  // a curve throws outside its range
  const ContactProperties now =
      material_.at(temperature, property_temperature(on_cooling_, temperature, hottest));
  validate(now, fmt::format("at {:g} degC", temperature));
  constants_ = now.constants();
  hottest_ = hottest;
}

std::vector<Column> LawPoint::columns() const {
  std::vector<Column> columns{{"u_n_m", "m"},
                              {"u_s_m", "m"},
                              {"T_degC", "degC"},
                              {"sigma_Pa", "Pa"},
                              {"tau_Pa", "Pa"},
                              {"stored_J_m2", "J/m2"},
                              {"property_change_J_m2", "J/m2"}};
  for (const InternalInfo& info : law_.internals(2))
    columns.push_back(column_with_unit(info.name, info.unit));
  for (const LossInfo& info : law_.losses)
    columns.push_back(
        column_with_unit(fmt::format("{}{}", info.is_energy() ? "dissipated_" : "", info.name), info.unit));
  return columns;
}

std::vector<double> LawPoint::values() const {
  std::vector<double> values{at_.opening,
                             at_.slip,
                             at_.temperature,
                             response_.normal_traction,
                             response_.shear_traction[0],
                             response_.stored,
                             property_change_};
  values.insert(values.end(), internals_.begin(), internals_.end());
  values.insert(values.end(), losses_.begin(), losses_.end());
  return values;
}

void LawPoint::update(const JumpPathPoint& point) {
  const std::array jump{point.opening, point.slip};
  response_ = law_.update(2)(constants_.data(), jump.data(), internals_.data(), losses_.data());
}

double LawPoint::dissipated() const {
  double sum = 0.0;
  for (std::size_t i = 0; i < losses_.size(); ++i)
    if (law_.losses[i].is_energy()) sum += losses_[i];
  return sum;
}

}  // namespace pyroclast
