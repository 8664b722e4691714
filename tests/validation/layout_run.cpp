// A run of a deck as `pyroclast run` has it, in a layout of its own choice: the environment variable
// FEWEST_BLOCKS gives the fewest blocks of a bundle. Takes the arguments that validation/reference gives to a
// program.

#include <cstdlib>
#include <filesystem>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>

#include "pyroclast/results/history_file.hpp"
#include "pyroclast/results/text_file.hpp"
#include "pyroclast/setup/setup.hpp"
#include "pyroclast/simulation/loop/run.hpp"

int main(int argc, char** argv) {
  using namespace pyroclast;
  CLI::App cli;
  std::filesystem::path deck, out;
  std::vector<std::string> changes;
  auto* command = cli.add_subcommand("run");
  command->add_option("DECK", deck)->required();
  command->add_option("--out", out)->required();
  command->add_option("--set", changes)->take_all()->allow_extra_args(false);
  command->add_flag("--no-figures");
  command->add_option("--threads");
  CLI11_PARSE(cli, argc, argv);

  Setup setup = read_setup(Deck::open(deck, changes), deck.parent_path());
  setup.moving->mechanics.layout.fewest_blocks = std::stoi(std::getenv("FEWEST_BLOCKS"));
  const auto simulation = make_simulation(setup);
  std::filesystem::create_directories(out);
  write_text_file(out / "manifest.json", R"({"commit": "this"})");
  Run run(*simulation, std::move(setup.stages));
  HistoryFile history(out / "history.csv", run.history());
  while (run.next()) history.write(run.history());
  return 0;
}
