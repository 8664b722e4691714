// Runs a deck, as `pyroclast run` does, in a program of one's own:
//
//     run_deck DECK.toml FOLDER
#include <cstdio>
#include <utility>

#include <pyroclast/base/error.hpp>
#include <pyroclast/results/folder_lock.hpp>
#include <pyroclast/results/recorder.hpp>
#include <pyroclast/results/run_folder.hpp>

int main(int argc, char** argv) try {
  using namespace pyroclast;
  if (argc != 3) throw Error("usage: run_deck DECK.toml FOLDER");

  // 1. Read the deck.
  const Deck deck = Deck::load(argv[1]);
  Setup setup = read_setup(deck, std::filesystem::path(argv[1]).parent_path());

  // 2. Make specimen, model and solvers.
  const auto simulation = make_simulation(setup);

  // 3. Go from look to look, and write what comes.
  const FolderLock lock(argv[2]);
  const RunFolder folder(argv[2], false, {.deck_name = deck.name(), .inputs = inputs_of(deck, setup)});
  Recorder recorder(folder.path(), setup);
  Run run(*simulation, std::move(setup.stages));
  recorder.begin(run);
  while (run.next()) recorder.record(run);
  recorder.finish(run);

  // 4. Every column of the history is at hand.
  std::printf("%s; %zu rows, temperature %g degC\n", describe(run.outcome()), run.history().row_count(),
              *run.history().last("temperature_degC"));
} catch (const pyroclast::Error& e) {
  std::fprintf(stderr, "error: %s\n", e.what());
  return 1;
}
