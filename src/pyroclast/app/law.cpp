#include <algorithm>
#include <limits>
#include <memory>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "pyroclast/app/deck_option.hpp"
#include "pyroclast/app/say_aside.hpp"
#include "pyroclast/base/error.hpp"
#include "pyroclast/laws/kit.hpp"
#include "pyroclast/laws/registry.hpp"
#include "pyroclast/mechanics/lanes_of_step.hpp"
#include "pyroclast/plugin/find_law.hpp"
#include "pyroclast/results/text_file.hpp"
#include "pyroclast/session/law_point.hpp"

namespace pyroclast::app {

namespace {

struct LawOptions {
  std::filesystem::path deck, path, out;
  std::string interface;
  std::string law;                  ///< law in place of a deck's, see find_law
  std::vector<std::string> values;  ///< properties of the law, "key=value"
  OwnLawOptions sources;
  int steps = 1;  ///< number of parts into which each leg of the path is cut
};

struct VerifyOptions {
  std::vector<std::string> laws;  ///< names of laws as find_law takes them; empty: all laws of the program
  OwnLawOptions sources;
  int paths = 10000;  ///< number of paths in each dimension
  std::uint64_t seed = 1;
};

/// Returns the contacts of an interface, of the deck or of two blocks of one phase. Throws Error when there
/// is none.
const ContactMaterial& contact_of(const ConcreteMaterials& concrete, const std::string& name) {
  const auto& names = concrete.interfaces;
  const auto found = std::ranges::find(names, name);
  if (found == names.end())
    throw Error(fmt::format("--interface {}: must be one of {}", name, fmt::join(names, ", ")));
  return concrete.contacts[found - names.begin()];
}

/// Returns the law that the command line states, with all its properties.
ContactMaterial material_of_command(const LawOptions& options) {
  const LawTable& law = find_law(options.law, {}, sources_of(options.sources), true);
  if (law.update(2)) say_aside(describe_own_laws());
  return stated_material(law, options.values);
}

LawPoint point_of_deck(const LawOptions& options) {
  const Deck deck = Deck::open(options.deck);
  const Setup setup = read_setup(deck, options.deck.parent_path(), {}, sources_of(options.sources));
  require_code(setup);
  if (!setup.moving)
    throw Error(fmt::format("{}: is of heat conduction alone and has no contacts, so no contact law",
                            options.deck.string()));
  const ContactParameters& contacts = setup.moving->contacts;
  const auto concrete =
      make_concrete(setup.block_materials, contacts, expected_block_size(setup.specimen, contacts));
  const std::string matrix = contacts.matrix + "_" + contacts.matrix;
  const auto& stress_free = setup.moving->stress_free;
  return LawPoint(
      contact_of(concrete, options.interface.empty() ? matrix : options.interface), setup.moving->on_cooling,
      setup.heat.initial,
      stress_free && !stress_free->is_field() ? stress_free->temperatures.front() : absolute_zero);
}

int drive_law(const LawOptions& options) {
  if (options.law.empty() && options.deck.empty())
    throw Error("law: state a deck, or a law with --law and its properties with --set");
  LawPoint point = options.law.empty() ? point_of_deck(options) : LawPoint(material_of_command(options));

  std::string csv;
  for (const Column& column : point.columns()) csv += (csv.empty() ? "" : ",") + column.name;
  csv += '\n';
  int number = 0;
  for (const JumpPathPoint& to : read_jump_path(options.path, point.temperature())) {
    ++number;
    try {
      point.go(to, options.steps, [&] { csv += fmt::format("{:.12g}\n", fmt::join(point.values(), ",")); });
    } catch (const Error& error) {
      throw Error(fmt::format("{}: row {}: {}", options.path.string(), number, error.what()));
    }
  }
  if (options.out.empty())
    fmt::print("{}", csv);
  else
    write_text_file(options.out, csv);
  return 0;
}

int verify_laws(const VerifyOptions& options) {
  std::vector<const LawTable*> wanted;
  for (const std::string& name : options.laws)
    if (!name.empty())  // CLI11 before 2.2 hands an empty word to an option that was given none
      wanted.push_back(&find_law(name, {}, sources_of(options.sources), true));
  say_aside(describe_own_laws());
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

}  // namespace

Command add_law(CLI::App& cli) {
  const auto options = std::make_shared<LawOptions>();
  const auto to_verify = std::make_shared<VerifyOptions>();
  auto* law = cli.add_subcommand("law",
                                 "Drive a contact law along a path of jumps and temperatures, or try laws on "
                                 "random paths: law --verify");
  auto* law_deck = law->add_option("DECK", options->deck, "TOML file that describes the run");
  auto* stated =
      law->add_option("--law", options->law,
                      "Use this law, not a deck's: a name, a shared object (mine.so) or a header (mine.hpp), "
                      "which is compiled");
  stated->excludes(law_deck);
  law->add_option("--set", options->values, "Set a property or a choice of the law: --set f_t='3 MPa'")
      ->take_all()
      ->allow_extra_args(false)
      ->needs(stated);
  add_own_laws(law, options->sources);
  auto* law_path =
      law->add_option("--path", options->path,
                      "CSV file with columns u_n, u_s and optionally T, each with its unit: u_n [um]");
  law->add_option(
      "--interface", options->interface,
      "A table of [contacts], or a_a for two blocks of phase a (default: the interface of the matrix)");
  law->add_option("--steps", options->steps, "Steps of each leg of the path")
      ->check(whole_number(1, std::numeric_limits<int>::max()))
      ->default_val(1);
  law->add_option("-o,--out", options->out, "CSV file to write (default: standard output)");
  auto* verify =
      law->add_option("--verify", to_verify->laws,
                      "Test these laws, or that of --law, or all, for the properties that a law must have")
          ->expected(0, -1)
          ->excludes(law_deck)
          ->excludes(law_path);
  law->add_option("--paths", to_verify->paths, "Number of random paths in each dimension")
      ->check(whole_number(1, std::numeric_limits<int>::max()))
      ->needs(verify)
      ->default_val(10000);
  law->add_option("--seed", to_verify->seed, "Seed of the random paths")->needs(verify)->default_val(1);
  law->callback([=] {
    to_verify->sources = options->sources;
    if (*verify && *stated) to_verify->laws.push_back(options->law);
    if (*verify) return;
    if (!*law_deck && !*stated) throw CLI::RequiredError("DECK, or --law");
    if (!*law_path) throw CLI::RequiredError(law_path->get_name());
  });
  return {law, [=](const auto&) { return *verify ? verify_laws(*to_verify) : drive_law(*options); }};
}

}  // namespace pyroclast::app
