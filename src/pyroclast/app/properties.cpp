#include <algorithm>
#include <memory>

#include <fmt/format.h>

#include "pyroclast/app/commands.hpp"
#include "pyroclast/app/deck_option.hpp"
#include "pyroclast/app/say_aside.hpp"
#include "pyroclast/results/properties_file.hpp"
#include "pyroclast/results/text_file.hpp"
#include "pyroclast/simulation/simulation.hpp"

namespace pyroclast::app {

namespace {

struct PropertiesOptions {
  std::filesystem::path deck;
  std::filesystem::path out;  ///< output folder; empty: runs/<name of the deck>-properties
};

/// Returns the phases as a run has them: those of the specimen, where they follow its composition.
std::vector<BlockMaterial> block_materials_of(const Setup& setup) {
  if (!setup.moving || !follows_composition(setup.block_materials, *setup.moving))
    return setup.block_materials;
  return make_materials(setup.block_materials, *setup.moving,
                        numbers_of(make_checked_specimen(setup.specimen)))
      .block_materials;
}

/// Returns the properties as a run has them, and whatever else the deck gives over the temperature, such as
/// an expansion coefficient.
std::vector<ReadCurve> properties_of(const Setup& setup) {
  ConcreteMaterials materials;
  if (setup.moving) {
    const ContactParameters& contacts = setup.moving->contacts;
    materials = make_concrete(setup.block_materials, contacts, expected_block_size(setup.specimen, contacts));
  }
  materials.block_materials = block_materials_of(setup);
  std::vector<ReadCurve> list = property_curves(materials, setup.moving.has_value());
  for (const ReadCurve& read : setup.curves) {
    const bool listed =
        std::ranges::any_of(list, [&](const ReadCurve& other) { return other.path == read.path; });
    if (!listed) list.push_back(read);
  }
  return list;
}

/// Prints the curves that the deck gives, a line each.
void print(const std::vector<ReadCurve>& curves) {
  for (const ReadCurve& read : curves)
    say(fmt::format("{:<42}{} {}\n", read.path, read.curve.describe(),
                    read.unit == "1" ? "" : fmt::format("[{}]", read.unit)));
}

int plot_properties(const PropertiesOptions& options) {
  const Deck deck = Deck::open(options.deck);
  const Setup setup = read_setup(deck, options.deck.parent_path());
  require_code(setup);
  const std::filesystem::path out =
      options.out.empty() ? std::filesystem::path("runs") / (options.deck.stem().string() + "-properties")
                          : options.out;
  std::filesystem::create_directories(out);
  write_text_file(out / "properties.csv",
                  properties_csv(properties_of(setup), setup.temperatures, PropertyRows::every_kelvin));
  print(setup.curves);
  say(fmt::format("{}\n", (out / "properties.csv").string()));
  draw_figures("properties", out);
  return 0;
}

}  // namespace

Command add_properties(CLI::App& cli) {
  const auto options = std::make_shared<PropertiesOptions>();
  auto* properties = cli.add_subcommand("plot-properties",
                                        "Draw and tabulate the properties of a deck over the temperature");
  add_deck(properties, options->deck);
  properties->add_option("-o,--out", options->out,
                         "Folder for table and figure (default: runs/<name of the deck>-properties)");
  return {properties, [options](const auto&) { return plot_properties(*options); }};
}

}  // namespace pyroclast::app
