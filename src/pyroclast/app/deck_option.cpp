#include "pyroclast/app/deck_option.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "pyroclast/app/say_aside.hpp"
#include "pyroclast/base/place_text.hpp"
#include "pyroclast/plugin/open_library.hpp"

namespace pyroclast::app {

namespace {

constexpr double kMilli = 1e3;
/// Number of blocks that take some seconds to be made.
constexpr int kManyBlocks = 20'000;

/// Describes what specimens of the plane and of space have in common.
template <int Dim>
std::string describe_phases(const specimen::Specimen<Dim>& s) {
  const auto [blocks, extent] =
      Dim == 2 ? std::pair("blocks", "area") : std::pair("blocks in space", "volume");
  const std::size_t stone_count = s.stones.size();
  std::string text = fmt::format("specimen        {} {}", s.phase.size(), blocks);
  if (stone_count > 0 || s.fraction_asked > 0.0)
    text += fmt::format(
        ", {} aggregates\n                aggregate fraction {:.3f} asked, {:.3f} placed, {:.3f} after "
        "superposition",
        stone_count, s.fraction_asked, s.fraction_placed, s.fraction_superposed);
  text += '\n';
  for (std::size_t i = 0; i < s.phases.size(); ++i)
    text += fmt::format("                {:<12} {:.3f} of the {}\n", s.phases[i], s.fraction[i], extent);
  for (const auto& c : s.classes)
    text += fmt::format(
        "                {:g} to {:g} mm: {:.3f} asked, {:.3f} placed by {} stones, {:.3f} superposed; {} "
        "without a block\n",
        kMilli * c.from, kMilli * c.to, c.asked, c.placed, c.stones, c.superposed, c.without_a_block);
  return text;
}

/// Returns the line that tells the sizes of blocks; none where they are alike.
std::string describe_sizes(const std::vector<double>& sizes) {
  if (sizes.empty()) return {};
  const auto [smallest, largest] = std::ranges::minmax(sizes);
  return fmt::format("                from {:.3f} mm where they are finest to {:.3f} mm\n", kMilli * smallest,
                     kMilli * largest);
}

std::string describe_specimen(const specimen::Specimen<2>& s) {
  const auto& m = s.metrics;
  std::string text = describe_phases(s);
  text += fmt::format("blocks          mean size {:.3f} mm, mean edge {:.3f} mm\n", kMilli * m.mean_size,
                      kMilli * m.mean_edge);
  text += describe_sizes(s.size);
  text += fmt::format("                shortest edge {:.3f} mm, block {} at ({:.2f}, {:.2f}) mm\n",
                      kMilli * m.shortest_edge, m.shortest_edge_cell, kMilli * m.shortest_edge_at[0],
                      kMilli * m.shortest_edge_at[1]);
  text += fmt::format("                smallest zone angle {:.1f} deg, block {}\n", m.smallest_angle,
                      m.smallest_angle_cell);
  text += fmt::format("                {} edges removed, {} left short, {} seeds redrawn\n",
                      m.vertices_merged, m.edges_left_short, m.seeds_redrawn);
  return text;
}

std::string describe_specimen(const specimen::Specimen<3>& s) {
  const auto& m = s.metrics;
  std::string text = describe_phases(s);
  text += fmt::format("blocks          mean size {:.3f} mm, {:.1f} zones", kMilli * m.mean_size,
                      m.zones_per_block);
  if (m.most_corners > 0) text += fmt::format(", faces of up to {} corners", m.most_corners);
  text += "\n";
  text += describe_sizes(s.size);
  text += fmt::format(
      "                shortest edge {:.3g} mm, lowest zone {:.3g} mm, of block {}; {} seeds redrawn\n",
      kMilli * m.shortest_edge, kMilli * m.lowest_zone, m.lowest_zone_cell, m.seeds_redrawn);
  if (m.vertices_merged > 0)
    text += fmt::format(
        "                {} vertices merged, {} edges left short, faces bent by up to {:.1f} deg\n",
        m.vertices_merged, m.edges_left_short, m.largest_bend);
  return text;
}

}  // namespace

DeckOfRun open_deck(const RunOptions& options, bool needs_code) {
  RunChoices choices = choices_of(options);
  choices.needs_code = needs_code;
  return {Deck::open(options.deck, options.changes), options.deck.parent_path(), std::move(choices)};
}

RunChoices choices_of(const RunOptions& options) {
  RunChoices choices;
  if (options.seed) choices.seed = static_cast<std::uint64_t>(*options.seed);
  choices.threads = options.threads;
  choices.instructions = options.instructions;
  choices.checkpoint = options.checkpoint;
  choices.ranks = options.held_by;
  choices.body = options.body;
  choices.laws = sources_of(options.laws);
  choices.before_making = [speech = options.speech](const DeckOfRun& opened) {
    const int blocks = opened.setup.specimen.blocks.count;
    if (blocks < kManyBlocks || speech == Speech::quiet) return;
    fmt::print("making the specimen of {} blocks ...\n", blocks);
    std::fflush(stdout);
  };
  return choices;
}

std::filesystem::path output_folder(const RunOptions& options) {
  return options.out.empty() ? std::filesystem::path("runs") / options.deck.stem() : options.out;
}

LawSources sources_of(const OwnLawOptions& options) {
  auto sources = LawSources::of_environment();
  sources.folders.insert(sources.folders.begin(), options.folders.begin(), options.folders.end());
  sources.may_compile = sources.may_compile && options.may_compile;
  sources.permission.allow = options.allow_code;
  sources.changes_name = !options.of_study;
  sources.compiler.tell = [](const std::string& command) {
    say_aside(fmt::format("compiling a law: {}\n", command));
  };
  return sources;
}

std::string describe_own_laws() {
  std::string text;
  for (const OpenedLaw* law : opened_laws())
    text +=
        fmt::format("law             \"{}\" is code that is not part of pyroclast: {}{}, compiled by {}\n",
                    law->table.name, law->headers.empty() ? "" : law->headers.front().string() + " in ",
                    law->shared_object.string(), law->compiler);
  return text;
}

void print_kept(const std::filesystem::path& folder, const std::vector<std::filesystem::path>& foreign) {
  for (const auto& file : foreign)
    say(fmt::format("kept            {}, which no run writes\n", (folder / file).string()));
}

std::string describe(const MadeSpecimen& specimen) {
  return std::visit([](const auto& s) { return describe_specimen(s); }, specimen);
}

std::string describe(const Ranks& ranks) {
  return ranks.count() == 1 ? "" : fmt::format("{} ranks with ", ranks.count());
}

std::string describe(const Team& team) {
  return team.size() == 1 ? "1 thread" : fmt::format("up to {} threads", team.size());
}

std::string describe_unused(const Setup& setup) {
  std::string text;
  if (!setup.unused_sets.empty())
    text = fmt::format("{:<16}{}: no table names {}, so for Python and ParaView alone\n", "sets",
                       fmt::join(setup.unused_sets, ", "), setup.unused_sets.size() == 1 ? "it" : "them");
  for (const std::string& line : setup.unused_properties) text += fmt::format("{:<16}{}\n", "unused", line);
  return text;
}

std::string describe_warnings(const std::vector<std::string>& warnings) {
  std::string text;
  for (const auto& warning : warnings) text += fmt::format("{:<16}{}\n", "warning", warning);
  return text;
}

std::string describe(const HeatSolver& conduction, const Model& model, const Interval& temperatures) {
  const HeatStepLimit limit = conduction.step_limit();
  const std::vector<int>& firsts = conduction.nodes().gridpoint;
  std::vector<Vec<3>> strictest;
  if (limit.node >= 0) strictest.push_back(model.place(firsts[limit.node]));
  const Vec<3> at = model.ranks().collect(strictest).front();
  const auto nodes = model.ranks().sum(std::ranges::count_if(
      firsts, [own = model.gridpoint_chunks().own()](int g) { return own.contain(g); }));
  std::string text = fmt::format("heat            {} nodes, {:.0f} to {:.0f} degC\n", nodes,
                                 temperatures.lower, temperatures.upper) +
                     fmt::format("                stable step {:.3g} s at first, set at {} mm\n", limit.step,
                                 place_text(kMilli * at, model.dimension(), "{:.2f}"));
  if (const GapHeat* gaps = conduction.gap_law())
    text += fmt::format(
        "                cracks hinder heat: it meets {:.3g} {} of gaps at first; contacts part "
        "temperatures\n"
        "                below h_m = {:.3g} W/(m2 K)\n",
        conduction.gap_area() * (model.dimension() == 2 ? kMilli / model.thickness : kMilli * kMilli),
        model.dimension() == 2 ? "mm" : "mm2", gaps->split_below);
  return text;
}

std::string duration(double seconds) {
  constexpr double kLongest = 3e9;
  if (!(seconds < kLongest)) return "more than a hundred years";
  const auto s = static_cast<long>(std::lround(seconds));
  if (s < 60) return fmt::format("{} s", s);
  if (s < 3600) return fmt::format("{} min {} s", s / 60, s % 60);
  return fmt::format("{} h {} min", s / 3600, s % 3600 / 60);
}

}  // namespace pyroclast::app
