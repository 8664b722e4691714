#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include <fmt/format.h>

#include "pyroclast/app/cases.hpp"
#include "pyroclast/app/commands.hpp"
#include "pyroclast/base/error.hpp"
#include "pyroclast/base/nearest.hpp"
#include "pyroclast/laws/registry.hpp"
#include "pyroclast/material/builtin_curves.hpp"
#include "pyroclast/material/rocks.hpp"
#include "pyroclast/setup/setup.hpp"
#include "pyroclast/simulation/watching/fields.hpp"
#include "pyroclast/stages/possible_columns.hpp"
#include "pyroclast/thermal/fire_curves.hpp"

namespace pyroclast::app {

namespace {

void print_curves(const CurveCatalogue& curves) {
  for (const NamedCurve& each : curves.entries())
    fmt::print("{:<34} {:<8} {:>6g} to {:<6g} {:<5} {} ({})\n", each.name, each.unit,
               each.curve.range().lower, each.curve.range().upper, each.curve.axis().unit, each.description,
               each.source);
}

void print_units() {
  for (const Unit* each : unit::all) fmt::print("{:<30} {:<8} \"{}\"\n", each->name, each->si, each->example);
  fmt::print(
      "Any unit of the same kind will do, as UDUNITS-2 knows it: mm, inch, N/mm2, ksi, min, h, degF ...\n");
}

void print_key_paths() {
  for (const std::string& path : key_paths()) fmt::print("{}\n", path);
}

void print_cases() {
  for (const CaseDeck& each : kCases) {
    const auto title = each.text.find("title = \"") + std::string_view("title = \"").size();
    fmt::print("{:<20} {}\n", each.name, each.text.substr(title, each.text.find('"', title) - title));
  }
}

void print_law_names() {
  for (const LawTable* law : built_in_laws()) fmt::print("{:<20} {}\n", law->name, law->meaning);
}

void print_fields() {
  for (const FieldInfo& field : possible_fields())
    fmt::print("{:<24} {:<8} {:<12} {}\n", field.name, field.unit.si, name_of(field.item), field.meaning);
}

void print_columns() {
  for (const Column& each : possible_columns())
    fmt::print("{:<30} {:<8} {:<21} {}\n", each.name, each.unit, name_of(each.role), each.meaning);
}

void print_rocks() {
  for (const Rock& each : rocks()) {
    fmt::print("{}\n", each.name);
    const auto print = [](const char* what, const SourcedNumber& of, const char* unit) {
      fmt::print("  {:<24} {:>6g} {:<7} {}\n", what, of.value, unit, of.source);
    };
    print("Young's modulus", each.modulus, "GPa");
    print("Poisson's ratio", each.poisson, "");
    print("density", each.density, "kg/m3");
    print("expansion near 20 degC", each.expansion, "1e-6/K");
    print("over the expansion of its concrete", each.expansion_ratio, "");
    fmt::print("  {:<24} {} ({})\n", "strain of its concrete", each.concrete_curve, each.curve_source);
  }
}

struct List {
  std::string_view name;
  void (*print)();
};

constexpr List kLists[] = {
    {"cases", print_cases},
    {"columns", print_columns},
    {"curves", [] { print_curves(builtin_curves()); }},
    {"fields", print_fields},
    {"fires", [] { print_curves(fire_curves()); }},
    {"keys", print_key_paths},
    {"laws", print_law_names},
    {"rocks", print_rocks},
    {"units", print_units},
};

int print_list(const std::string& what) {
  for (const auto& [name, print] : kLists)
    if (name == what) {
      print();
      return 0;
    }
  const std::vector<std::string> names = names_of_lists();
  if (what.empty()) throw Error(fmt::format("list: name one of {}", quoted_list(names)));
  throw Error(fmt::format("list {}: there is no such list{}; lists: {}", what,
                          did_you_mean(what, names, "; "), quoted_list(names)));
}

}  // namespace

std::vector<std::string> key_paths(bool of_tables) {
  std::vector<std::string> paths;
  for (const DeckTable& table : known_deck_schema().tables) {
    if (of_tables && table.is_form) continue;
    for (const DeckKey& key : table.keys)
      paths.push_back(fmt::format("{}{}{}", table.path, table.path.empty() ? "" : ".", key.key));
  }
  return paths;
}

std::vector<std::string> names_of_lists() {
  std::vector<std::string> names;
  for (const auto& [name, print] : kLists) names.emplace_back(name);
  return names;
}

Command add_list(CLI::App& cli) {
  const auto what = std::make_shared<std::string>();
  auto* list = cli.add_subcommand("list", "List the names that a deck may use, a line each");
  list->add_option("WHAT", *what, "cases, columns, curves, fields, fires, keys, laws, rocks or units");
  return {list, [what](const auto&) { return print_list(*what); }};
}

}  // namespace pyroclast::app
