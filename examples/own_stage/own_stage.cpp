// Runs a deck, and behind its stages those of another file, which may be of kind "shake":
//
//     own_stage DECK.toml shake.toml FOLDER [KEY=VALUE ...]     # with other values of the deck's keys
#include <cstdio>

#include <pyroclast/base/error.hpp>
#include <pyroclast/base/read_file.hpp>
#include <pyroclast/session/session.hpp>

#include "shake.hpp"

int main(int argc, char** argv) try {
  using namespace pyroclast;
  if (argc < 4) throw Error("usage: own_stage DECK.toml STAGES.toml FOLDER [KEY=VALUE ...]");

  const std::filesystem::path deck = argv[1];
  RunChoices choices;
  choices.kinds = mine::with_shake();
  const auto session =
      Session::begin({Deck::open(deck, {argv + 4, argv + argc}, {read_file(argv[2]), argv[2]}),
                      deck.parent_path(), std::move(choices)},
                     RunOutput{.folder = argv[3]});
  while (session->next()) {
  }
  session->finish();

  const Run& run = session->run();
  std::printf("%s; %g turns of the platen\n", describe(run.outcome()),
              run.history().last("turn").value_or(0.0));
} catch (const pyroclast::Error& e) {
  std::fprintf(stderr, "error: %s\n", e.what());
  return 1;
}
