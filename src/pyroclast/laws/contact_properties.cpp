#include "pyroclast/laws/contact_properties.hpp"

#include <algorithm>
#include <string_view>
#include <utility>

#include <fmt/format.h>
#include <fmt/printf.h>

#include "pyroclast/base/error.hpp"

namespace pyroclast {

ContactProperties::ContactProperties(const LawTable& of, std::vector<double> with, std::vector<int> chosen)
    : law(&of), numbers(std::move(with)), choices(std::move(chosen)) {
  if (numbers.size() != of.properties.size() || choices.size() != of.choices.size())
    throw Error(fmt::format("the law \"{}\" takes {} numbers and {} choices, not {} and {}", of.name,
                            of.properties.size(), of.choices.size(), numbers.size(), choices.size()));
}

std::vector<std::byte> ContactProperties::constants() const {
  std::vector<std::byte> c(law->size);
  law->derive(numbers.data(), choices.data(), c.data());
  return c;
}

void ContactProperties::require(const LawTable& wanted) const {
  if (law != &wanted)
    throw Error(fmt::format("these are properties of the law \"{}\", not \"{}\"", law ? law->name : "none",
                            wanted.name));
}

namespace {

[[noreturn]] void fail(const std::string& name, const PropertyInfo& property, double value,
                       const std::string& wanted) {
  const std::string unit = property.unit == unit::dimensionless ? "" : fmt::format(" ({})", property.unit.si);
  throw PropertyError(
      fmt::format("{}: {}{} = {:g}, but it must be {}", name, property.key, unit, value, wanted),
      property.key, wanted);
}

}  // namespace

void validate(const ContactProperties& p, const std::string& name) {
  const auto& infos = p.law->properties;
  for (std::size_t i = 0; i < infos.size(); ++i)
    if (!infos[i].range.contains(p.numbers[i])) fail(name, infos[i], p.numbers[i], infos[i].range.describe());
  const Objection objection = p.law->check(p.numbers.data(), p.choices.data());
  if (!objection.key) return;
  for (std::size_t i = 0; i < infos.size(); ++i)
    if (infos[i].key == std::string_view(objection.key))
      fail(name, infos[i], p.numbers[i], fmt::sprintf(objection.wanted, objection.bound));
  throw Error(fmt::format("{}: the law \"{}\" objects to \"{}\", which is none of its properties", name,
                          p.law->name, objection.key));
}

void ContactSets::add(const ContactProperties& set) {
  law_.push_back(set.law);
  first_number_.push_back(numbers_.size());
  first_choice_.push_back(choices_.size());
  numbers_.insert(numbers_.end(), set.numbers.begin(), set.numbers.end());
  choices_.insert(choices_.end(), set.choices.begin(), set.choices.end());
}

}  // namespace pyroclast
