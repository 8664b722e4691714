#include <string>

#include <fmt/format.h>

#include "pyroclast/app/commands.hpp"
#include "pyroclast/laws/registry.hpp"

namespace pyroclast::app {

namespace {

constexpr auto kLawsIntroduction = R"(# Contact laws

The laws that are part of the program, as they tell of themselves (`pyroclast laws`). A deck chooses one
with `law = "name"` in a table of `[contacts]` ([Phases and interfaces](../understand/deck.md#phases-and-interfaces)).
The [method](../understand/theory.md) tells how they work, [Add a law](../develop/architecture.md#add-a-law) how to add
one, and [What every contact law must hold](../develop/laws-verified.md) what each is tried for.

- **Role.** Factors of an interface and `temperature_ratio` act on strengths and energies, K = E / t_b on stiffnesses.
  Keys of `[contacts]` let others go with the block size: `second_slope` second slopes, `mode_2_energy` energies of
  sliding, `mode_1_slope` first softening.
- **Remembered.** What a contact point carries from step to step. A value "in files" is a field of the contacts in
  `fields/`, and a column of `pyroclast law`.
- **Lost.** Energies are columns `dissipated_<name>_J` of the history and entries of the energy ledger.

The pictures are of one contact point, driven by `pyroclast law`; `validation/law-paths` draws them anew.
)";

const char* name_of(Role role) {
  switch (role) {
    case Role::normal_stiffness:
    case Role::shear_stiffness:
      return "stiffness";
    case Role::strength:
      return "strength";
    case Role::energy:
      return "energy";
    case Role::sliding_energy:
      return "energy of sliding";
    case Role::first_softening:
      return "first softening";
    case Role::second_slope:
      return "second slope";
    case Role::cold_strength:
      return "strength at 20 °C";
    case Role::hidden_cracks:
      return "cracks below the mesh";
    case Role::plain:
      break;
  }
  return "–";
}

const char* name_of(Remembers what) {
  switch (what) {
    case Remembers::tension_damage:
      return "damage in tension";
    case Remembers::shear_damage:
      return "damage in shear";
    case Remembers::mixed_damage:
      return "damage in tension and shear";
    case Remembers::closure:
      return "closure";
    case Remembers::lost_strength:
    case Remembers::parameter:
    case Remembers::other:
      break;
  }
  return "–";
}

std::string capitalised(std::string text) {
  if (!text.empty() && text[0] >= 'a' && text[0] <= 'z') text[0] = static_cast<char>(text[0] - 'a' + 'A');
  return text;
}

std::string page_of(const LawTable& law) {
  std::string text = fmt::format("\n## `{}`\n\n{}.\n", law.name, capitalised(law.meaning));
  text += fmt::format("\n![{} along a path](../images/law_{}.png)\n", law.name, law.name);
  text += "\n| property | meaning | unit | allowed | role |\n|---|---|---|---|---|\n";
  for (const PropertyInfo& p : law.properties)
    text += fmt::format("| `{}` | {}{} | {} | {} | {} |\n", p.key, p.meaning,
                        p.of_option ? fmt::format(", with `{}` alone", p.of_option) : "", p.unit.si,
                        p.range.describe(), name_of(p.role));
  if (!law.choices.empty()) text += "\n| choice | meaning | options |\n|---|---|---|\n";
  for (const ChoiceInfo& c : law.choices) {
    std::string options;
    for (const OptionInfo& option : c.options)
      if (option.name)
        options += fmt::format("{}`{}`: {}", options.empty() ? "" : "; ", option.name, option.meaning);
    text += fmt::format("| `{}` | {} | {} |\n", c.key, c.meaning, options);
  }
  if (!law.internals(3).empty())
    text += "\n| remembered | meaning | unit | to cracks | in files |\n|---|---|---|---|---|\n";
  for (const InternalInfo& h : law.internals(2))
    text += fmt::format("| `{}` | {} | {} | {} | {} |\n", h.name, h.meaning, h.unit.si, name_of(h.what),
                        h.in_files ? "yes" : "no");
  if (!law.losses.empty()) text += "\n| lost | meaning | unit |\n|---|---|---|\n";
  for (const LossInfo& l : law.losses)
    text += fmt::format("| `{}` | {} | {} |\n", l.name, l.meaning, l.unit.si);
  return text;
}

int print_laws() {
  fmt::print("{}", kLawsIntroduction);
  for (const LawTable* law : built_in_laws()) fmt::print("{}", page_of(*law));
  return 0;
}

}  // namespace

Command add_laws(CLI::App& cli) {
  auto* laws = cli.add_subcommand("laws", "Print the contact laws of the program, as Markdown");
  return {laws, [](const auto&) { return print_laws(); }};
}

}  // namespace pyroclast::app
