// Runs a deck, as `pyroclast run` does, in a program of one's own:
//
//     run_deck DECK.toml FOLDER
#include <cstdio>

#include <pyroclast/base/error.hpp>
#include <pyroclast/session/session.hpp>

int main(int argc, char** argv) try {
  using namespace pyroclast;
  if (argc != 3) throw Error("usage: run_deck DECK.toml FOLDER");

  const std::filesystem::path deck = argv[1];
  const auto session =
      Session::begin({Deck::open(deck), deck.parent_path(), {}}, RunOutput{.folder = argv[2]});
  while (session->next()) {
  }  // each time the run stands at a look: simulation() and run() have what there is
  session->finish();

  const Run& run = session->run();
  std::printf("%s; %zu rows, temperature %g degC\n", describe(run.outcome()), run.history().row_count(),
              *run.history().last("temperature_degC"));
} catch (const pyroclast::Error& e) {
  std::fprintf(stderr, "error: %s\n", e.what());
  return 1;
}
