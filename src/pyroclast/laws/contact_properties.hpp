#pragma once

#include <concepts>
#include <cstdint>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "pyroclast/base/error.hpp"
#include "pyroclast/laws/table.hpp"

namespace pyroclast {

/// Parameters of a contact at one temperature, for any law.
struct ContactProperties {
  const LawTable* law = nullptr;
  std::vector<double> numbers;  ///< numbers in the order of LawTable::properties
  std::vector<int> choices;     ///< options chosen, in the order of LawTable::choices

  ContactProperties() = default;
  ContactProperties(const LawTable& of, std::vector<double> with, std::vector<int> chosen);
  /// Converts the parameters from a law's own struct.
  template <class P>
  requires std::same_as<P, typename P::Law::template Properties<double>> ContactProperties(const P& p)
      : law(&table_of<typename P::Law>()),
        numbers(static_cast<std::size_t>(count_of<P>())),
        choices(static_cast<std::size_t>(choices_of<P>())) {
    put(p, numbers.data());
    put_choices(p, choices.data());
  }

  /// Returns the parameters as the struct of their law. Throws Error when they are of another law.
  template <class Law>
  typename Law::template Properties<double> as() const {
    require(table_of<Law>());
    return law_table::properties<Law>(numbers.data(), choices.data());
  }

  /// Returns the constants of the law, derived from the parameters.
  std::vector<std::byte> constants() const;
  ContactStiffness<double> stiffness() const { return law->stiffness(constants().data()); }

 private:
  void require(const LawTable& wanted) const;
};

/// Error of a property whose value is not allowed.
class PropertyError : public Error {
 public:
  PropertyError(const std::string& message, std::string of, std::string as)
      : Error(message), key(std::move(of)), wanted(std::move(as)) {}
  std::string key;     ///< key of the property
  std::string wanted;  ///< allowed values in words
};

/// Throws PropertyError when a parameter is out of its range or the law objects.
/// \param name  name of the contact, for the message
void validate(const ContactProperties& properties, const std::string& name);

/// Parameters of many contacts, one set after the other.
class ContactSets {
 public:
  ContactSets() = default;
  explicit ContactSets(const std::vector<ContactProperties>& sets) {
    for (const auto& set : sets) add(set);
  }

  void add(const ContactProperties& set);
  /// Adds a set and returns its numbers, which the caller writes before it adds another set.
  std::span<double> add(const LawTable& law, const std::vector<int>& choices);
  /// Makes room for so many sets with so many numbers in all.
  void reserve(std::size_t sets, std::size_t numbers);
  /// Makes a law known that sets may have, with its choices.
  void know(const LawTable& law, const std::vector<int>& choices) { kind_of(law, choices); }
  /// Returns the laws of all sets, each once, in the order in which they came to be known.
  std::vector<const LawTable*> laws() const;
  /// Removes all sets and keeps their memory.
  void clear();
  int size() const { return static_cast<int>(kind_.size()); }
  const LawTable& law(int set) const { return *kinds_[kind_[set]].law; }
  std::span<const double> numbers(int set) const {
    return {numbers_.data() + first_number_[set], law(set).properties.size()};
  }
  const std::vector<int>& choices(int set) const { return kinds_[kind_[set]].choices; }
  ContactProperties operator[](int set) const {
    const auto n = numbers(set);
    return {law(set), {n.begin(), n.end()}, choices(set)};
  }
  /// Throws PropertyError as `validate` of a single set does.
  void validate(int set, const std::string& name) const;
  /// Makes the constants of a set, see LawTable::derive.
  void derive(int set, void* constants) const {
    law(set).derive(numbers(set).data(), choices(set).data(), constants);
  }

 private:
  struct Kind {
    const LawTable* law;
    std::vector<int> choices;
  };

  std::uint16_t kind_of(const LawTable& law, const std::vector<int>& choices);

  std::vector<Kind> kinds_;  ///< kinds that occur, each once: few
  std::vector<std::uint16_t> kind_;
  std::vector<std::size_t> first_number_;
  std::vector<double> numbers_;
};

}  // namespace pyroclast
