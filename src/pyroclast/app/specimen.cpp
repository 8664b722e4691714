#include <memory>

#include <fmt/format.h>

#include "pyroclast/app/deck_option.hpp"
#include "pyroclast/app/say_aside.hpp"
#include "pyroclast/base/shell_words.hpp"
#include "pyroclast/results/folder_lock.hpp"
#include "pyroclast/results/frame_series.hpp"
#include "pyroclast/results/specimen_files.hpp"
#include "pyroclast/simulation/simulation.hpp"
#include "pyroclast/simulation/skeleton.hpp"

namespace pyroclast::app {

namespace {

/// Returns what a user should know of a specimen, and of its contacts where they are known.
std::vector<std::string> warnings_of(const Setup& setup, const MadeSpecimen& specimen, const Model& model) {
  if (!setup.moving || !setup.code_not_allowed.empty()) return warnings(specimen);
  const auto materials = make_materials(setup.block_materials, *setup.moving, numbers_of(specimen));
  return warnings(specimen, model, materials.contacts);
}

int make_specimen(const RunOptions& asked) {
  RunOptions options = asked;
  if (options.out.empty()) options.out = output_folder(asked).string() + "-specimen";
  const DeckOfRun opened = open_deck(options, false);
  const Setup& setup = opened.setup;
  const FolderLock lock(output_folder(options));
  RunFolder::check(output_folder(options), options.overwrite);
  const MadeSpecimen specimen = make_checked_specimen(setup.specimen, opened.team.get());
  SpecimenBody body = make_body(specimen, setup.thickness, setup.sets, setup.moving);
  const Model* const model = body.model.get();
  const auto warned = warnings_of(setup, specimen, *model);  // may refuse the deck: before a folder is made
  const RunFolder folder(output_folder(options), options.overwrite,
                         {opened.deck.name(),
                          inputs_of(opened.deck, setup),
                          setup.specimen.seed,
                          opened.team->size(),
                          name(opened.instructions),
                          options.command,
                          own_laws(),
                          {}});
  print_kept(folder.path(), folder.foreign());
  std::filesystem::create_directories(folder.path() / "fields");
  write_mesh(folder.path() / "fields", *model);
  body.told =
      std::make_shared<const SpecimenTold>(told_of(specimen, setup.specimen, app::describe(specimen)));
  write_specimen_files(folder.path() / "specimen", body.told->files);
  write_body(folder.path(), body_inputs(opened.deck, setup), body);
  say(fmt::format("{}{}{}results         {}\n", describe_warnings(opened.warnings), body.told->text,
                  describe_warnings(warned), folder.path().string()));
  if (options.figures) draw_figures("specimen", folder.path());
  return 0;
}

}  // namespace

Command add_specimen(CLI::App& cli) {
  const auto options = std::make_shared<RunOptions>();
  auto* command = cli.add_subcommand("specimen", "Make only the specimen of a deck, with its pictures");
  add_deck(command, options->deck);
  add_own_laws(command, options->laws);
  add_seed(command, options->seed);
  add_changes(command, *options);
  add_output(command, *options);
  add_threads(command, options->threads);
  return {command, [options](const std::vector<std::string>& typed) {
            options->command = shell_command(typed);
            return make_specimen(*options);
          }};
}

}  // namespace pyroclast::app
