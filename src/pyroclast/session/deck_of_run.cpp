#include "pyroclast/session/deck_of_run.hpp"

#include <utility>

#include <fmt/format.h>

#include "pyroclast/base/error.hpp"
#include "pyroclast/base/processors.hpp"
#include "pyroclast/plugin/open_library.hpp"

namespace pyroclast {

namespace {

/// Returns the sources for a run: a law in a header is compiled for the instruction set of the run.
LawSources laws_for(InstructionSet set, LawSources laws) {
  laws.compiler.instructions = set;
  return laws;
}

}  // namespace

DeckOfRun::DeckOfRun(Deck read, std::filesystem::path folder_of_deck, RunChoices chosen)
    : choices(std::move(chosen)),
      folder(std::move(folder_of_deck)),
      deck(std::move(read)),
      instructions(choices.instructions.empty() ? best_instruction_set()
                                                : instruction_set(choices.instructions)),
      setup(read_setup(deck, folder, choices.kinds, laws_for(instructions, choices.laws))),
      team(std::make_shared<Team>(usable_threads(choices.threads))) {
  if (choices.needs_code) require_code(setup);
  for (const Diagnostic& warning : setup.warnings) warnings.push_back(to_string(warning));
  if (choices.threads > team->size())
    warnings.push_back(fmt::format(
        "threads: {} were asked for, and at most {} are taken, one for each processor that is free for "
        "this process",
        choices.threads, team->size()));
  if (choices.seed && setup.specimen.is_of_file())
    throw Error("a seed has no meaning for a specimen whose blocks come from a file");
  if (choices.seed) setup.specimen.seed = *choices.seed;
  if (choices.checkpoint) setup.checkpoints.interval = *choices.checkpoint;
  if (setup.moving) setup.moving->mechanics.instructions = instructions;
  if (choices.body.empty()) return;
  body.emplace(choices.body);
  body->require(body_inputs(deck, setup));
}

std::vector<OwnLaw> own_laws() {
  std::vector<OwnLaw> laws;
  for (const OpenedLaw* law : opened_laws())
    laws.push_back({law->table.name, law->shared_object,
                    law->headers.empty() ? std::filesystem::path() : law->headers.front(), law->compiler});
  return laws;
}

}  // namespace pyroclast
