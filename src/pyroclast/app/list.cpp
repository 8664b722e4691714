#include <functional>
#include <map>
#include <string>

#include <fmt/format.h>

#include "pyroclast/app/cases.hpp"
#include "pyroclast/app/commands.hpp"
#include "pyroclast/base/error.hpp"
#include "pyroclast/base/nearest.hpp"
#include "pyroclast/laws/registry.hpp"
#include "pyroclast/material/builtin_curves.hpp"
#include "pyroclast/setup/setup.hpp"
#include "pyroclast/simulation/fields.hpp"
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
  for (const DeckTable& table : deck_schema().tables)
    for (const DeckKey& key : table.keys)
      fmt::print("{}{}{}\n", table.path, table.path.empty() ? "" : ".", key.key);
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

}  // namespace

int print_list(const std::string& what) {
  const std::map<std::string, std::function<void()>> lists = {
      {"curves", [] { print_curves(builtin_curves()); }},
      {"fields", print_fields},
      {"fires", [] { print_curves(fire_curves()); }},
      {"units", print_units},
      {"keys", print_key_paths},
      {"cases", print_cases},
      {"laws", print_law_names},
  };
  if (const auto found = lists.find(what); found != lists.end()) {
    found->second();
    return 0;
  }
  std::vector<std::string> names;
  for (const auto& [name, print] : lists) names.push_back(name);
  throw Error(fmt::format("list {}: there is no such list{}; lists: {}", what,
                          did_you_mean(what, names, "; "), quoted_list(names)));
}

}  // namespace pyroclast::app
