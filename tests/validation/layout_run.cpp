// A run of a deck as `pyroclast run` has it, in a layout of its own choice: the environment variable
// FEWEST_BLOCKS gives the fewest blocks of a bundle. Takes the arguments that validation/reference gives to a
// program.

#include <cstdlib>
#include <filesystem>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>

#include "pyroclast/experiment/case.hpp"
#include "pyroclast/experiment/experiment.hpp"
#include "pyroclast/experiment/simulation.hpp"
#include "pyroclast/results/history_file.hpp"
#include "pyroclast/results/text_file.hpp"

namespace {

using namespace pyroclast;

struct Recorder : Observer {
  explicit Recorder(const std::filesystem::path& folder) : history(folder / "history.csv") {}
  void sample(const Experiment&, const Sample& sample) override { history.write(sample); }
  HistoryFile history;
};

}  // namespace

int main(int argc, char** argv) {
  CLI::App cli;
  std::filesystem::path deck, out;
  std::vector<std::string> changes;
  auto* run = cli.add_subcommand("run");
  run->add_option("DECK", deck)->required();
  run->add_option("--out", out)->required();
  run->add_option("--set", changes)->take_all()->allow_extra_args(false);
  run->add_flag("--no-figures");
  run->add_option("--threads");
  CLI11_PARSE(cli, argc, argv);

  Case c = read_case(Deck::load(deck, changes), deck.parent_path());
  c.mechanics.fewest_blocks = std::stoul(std::getenv("FEWEST_BLOCKS"));
  Simulation simulation(c);
  std::filesystem::create_directories(out);
  write_text_file(out / "manifest.json", R"({"commit": "this"})");
  Recorder recorder(out);
  Experiment(simulation, c.stages, c.sampling, recorder).run();
  return 0;
}
