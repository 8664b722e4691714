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
  std::vector<std::byte> c(law->constants_size);
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
      property.key, fmt::format("{}; it is {:g}", wanted, value));
}

void require_valid(const LawTable& law, std::span<const double> numbers, std::span<const int> choices,
                   const std::string& name) {
  const auto& infos = law.properties;
  for (std::size_t i = 0; i < infos.size(); ++i)
    if (!infos[i].range.contains(numbers[i])) fail(name, infos[i], numbers[i], infos[i].range.describe());
  const Objection objection = law.check(numbers.data(), choices.data());
  if (!objection.key) return;
  for (std::size_t i = 0; i < infos.size(); ++i)
    if (infos[i].key == std::string_view(objection.key))
      fail(name, infos[i], numbers[i], fmt::sprintf(objection.wanted, objection.bound));
  throw Error(fmt::format("{}: the law \"{}\" objects to \"{}\", which is none of its properties", name,
                          law.name, objection.key));
}

}  // namespace

void validate(const ContactProperties& p, const std::string& name) {
  require_valid(*p.law, p.numbers, p.choices, name);
}

void ContactSets::add(const ContactProperties& set) {
  std::ranges::copy(set.numbers, add(*set.law, set.choices).begin());
}

std::span<double> ContactSets::add(const LawTable& law, const std::vector<int>& choices) {
  kind_.push_back(kind_of(law, choices));
  first_number_.push_back(numbers_.size());
  numbers_.resize(numbers_.size() + law.properties.size());
  return {numbers_.data() + first_number_.back(), law.properties.size()};
}

void ContactSets::reserve(std::size_t sets, std::size_t numbers) {
  kind_.reserve(sets);
  first_number_.reserve(sets);
  numbers_.reserve(numbers);
}

std::uint16_t ContactSets::kind_of(const LawTable& law, const std::vector<int>& choices) {
  auto kind = std::ranges::find_if(
      kinds_, [&](const Kind& known) { return known.law == &law && known.choices == choices; });
  if (kind == kinds_.end()) kind = kinds_.insert(kind, {&law, choices});
  return static_cast<std::uint16_t>(kind - kinds_.begin());
}

std::vector<const LawTable*> ContactSets::laws() const {
  std::vector<const LawTable*> laws;
  for (const Kind& kind : kinds_)
    if (std::ranges::find(laws, kind.law) == laws.end()) laws.push_back(kind.law);
  return laws;
}

void ContactSets::clear() {
  kinds_.clear();
  kind_.clear();
  first_number_.clear();
  numbers_.clear();
}

void ContactSets::validate(int set, const std::string& name) const {
  require_valid(law(set), numbers(set), choices(set), name);
}

}  // namespace pyroclast
