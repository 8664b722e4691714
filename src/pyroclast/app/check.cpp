#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <sys/resource.h>

#include "pyroclast/app/deck_option.hpp"
#include "pyroclast/app/say_aside.hpp"
#include "pyroclast/app/specimen_scatter.hpp"
#include "pyroclast/base/place_text.hpp"
#include "pyroclast/base/shown.hpp"
#include "pyroclast/material/first_guess.hpp"
#include "pyroclast/session/foretold_heat.hpp"
#include "pyroclast/session/rehearsal.hpp"
#include "pyroclast/simulation/body_on_ranks.hpp"
#include "pyroclast/stages/load.hpp"

namespace pyroclast::app {

namespace {

/// Says in words how pore water and motion act on each other.
std::string describe(const PoreCoupling& coupling, bool finds_contacts) {
  const char* const bears = coupling.acts == PressureActs::no      ? "acts on nothing"
                            : coupling.acts == PressureActs::zones ? "acts on blocks"
                                                                   : "acts on blocks and contacts";
  return fmt::format("its pressure {}; faces that stand open by {:.3g} um or more drain it{}", bears,
                     1e6 * coupling.crack_width,
                     finds_contacts ? "; none flows through contacts that are found" : "");
}

/// Share by which E of contacts may differ from that of blocks without a word.
constexpr double kLikeModulus = 0.1;
/// Share by which a strength may differ from that of specimens with such mortar without a word.
constexpr double kLikeStrength = 0.2;

void print_strength(const Setup& setup) {
  const auto is_compress = [](const auto& stage) { return stage->kind() == std::string_view("compress"); };
  const auto like = studied_like(setup.specimen);
  if (!like || std::ranges::none_of(setup.stages, is_compress)) return;
  fmt::print(
      "strength        blocks are {:.2f} of d_max; of specimens with {:.2f}, {} of {} fell clearly, and f_c\n"
      "                scattered by {:.0f} % from seed to seed (docs/validation/peaks.md). Their stones "
      "held\n"
      "                together where they touch; more fall where stones may part (between_stones)\n",
      setup.specimen.block_size() / setup.specimen.aggregates.d_max, like->size, like->fell_clearly, like->of,
      100.0 * like->scatter);
}

/// Tells the modulus that a stated K_n means, which does not follow E of the blocks.
void print_stated_stiffness(const Setup& setup) {
  if (!setup.moving) return;
  const ContactParameters& contacts = setup.moving->contacts;
  for (const InterfaceParameters& interface : contacts.interfaces) {
    if (!interface.normal_stiffness) continue;
    double young = std::numeric_limits<double>::infinity();
    for (const auto& pair : interface.between)
      for (const std::string& phase : pair)
        for (const BlockMaterial& material : setup.block_materials)
          if (material.name == phase) young = std::min(young, material.young(kReferenceTemperature));
    const double stated = *interface.normal_stiffness * contacts.fracture_zone;
    const bool is_like = std::abs(stated / young - 1.0) < kLikeModulus;
    fmt::print(
        "contacts        {}: K_n is stated, E = K_n t_b {:.3g} GPa; the softest blocks have {:.3g} GPa{}\n",
        interface.name, 1e-9 * stated, 1e-9 * young,
        is_like ? "" : ": leave K_n and K_s out, and they follow E of the blocks");
  }
}

/// Tells properties of contacts that go with the block size.
void print_with_size(const Setup& setup) {
  const ContactParameters& contacts = setup.moving->contacts;
  for (const Role role : contacts.with_size)
    for (const InterfaceParameters& interface : contacts.interfaces) {
      for (const PropertyInfo& info : interface.contact.law->properties)
        if (info.role == role && interface.contact.has(info))
          fmt::print("contacts        {}: {} goes with the block size, {:.4g} times its value in the deck\n",
                     interface.name, info.key, setup.specimen.block_size() / *contacts.fracture_zone_size);
    }
}

/// Tells what small kinematics make of blocks of a solid that meet others.
/// \param young  Pa
void print_found(const Setup& setup, const Model& model, double young) {
  constexpr double kTurn = 0.04;
  const MechanicsParameters& mechanics = setup.moving->mechanics;
  if (!mechanics.found.is_on || model.dimension() == 2 || mechanics.kinematics == Kinematics::finite) return;
  fmt::print(
      "contacts        are found, but blocks may not tumble: their zones do not turn, and a turn of {} rad "
      "alone stresses them\n                by some {:.0f} MPa; mechanics.kinematics = \"finite\" turns "
      "them\n",
      kTurn, 1e-6 * 0.5 * young * kTurn * kTurn);
}

/// Warns of loads that are shares of a strength which mortar like the deck's does not give.
void warn_of_strengths(const Setup& setup, const Simulation& simulation) {
  if (!setup.moving) return;
  const std::string& matrix = setup.moving->contacts.matrix;
  const auto& materials = simulation.materials();
  const auto joint = std::ranges::find(materials.interfaces, matrix + "_" + matrix);
  const auto mortar = std::ranges::find(materials.block_materials, matrix, &BlockMaterial::name);
  if (joint == materials.interfaces.end() || mortar == materials.block_materials.end()) return;
  const ContactMaterial& contact = materials.contacts[joint - materials.interfaces.begin()];
  const FirstGuess& known = first_guess(simulation.model().dimension());
  const auto factor = known.factor_of(contact);
  if (!factor) return;
  for (const auto& stage : setup.stages) {
    const auto* load = dynamic_cast<const Load*>(stage.get());
    if (!load || !load->keys().level || *load->keys().level == 0.0) continue;
    const double stated = load->keys().strength;
    const double like =
        known.strength_with(mortar->young(kReferenceTemperature), setup.specimen.block_size(), *factor);
    if (std::abs(stated / like - 1.0) > kLikeStrength)
      fmt::print("{}", describe_warnings(
                           {fmt::format("a load is {:g} of f_c = {:.3g} MPa, but specimens with such mortar "
                                        "bear some {:.2g} MPa: crush this one at 20 degC and take its f_c, "
                                        "f_c = {{ run = \"folder\" }}",
                                        *load->keys().level, 1e-6 * stated, 1e-6 * like)}));
  }
}

/// Returns by what the body of a run differs from that of a deck; empty: by nothing.
std::string other_body_of(const std::filesystem::path& run, const DeckOfRun& opened) {
  RunChoices choices = opened.choices;
  choices.seed.reset();  // a run's deck has its own
  choices.body.clear();
  choices.needs_code = false;
  try {
    const DeckOfRun of(Deck::open(run / RunFolder::kDeck), run, choices);
    const std::string other =
        first_difference(body_inputs(of.deck, of.setup), body_inputs(opened.deck, opened.setup));
    return other.empty() ? other : "whose body is another one: " + other;
  } catch (const Error& error) {  // its f_c counts all the same
    return fmt::format("whose body cannot be compared: {}", error.what());
  }
}

/// Warns of loads that are shares of the strength which another body had.
void warn_of_other_bodies(const DeckOfRun& opened) {
  for (const auto& stage : opened.setup.stages) {
    const auto* load = dynamic_cast<const Load*>(stage.get());
    if (!load || !exists(load->keys().run / RunFolder::kDeck)) continue;
    if (const std::string other = other_body_of(load->keys().run, opened); !other.empty())
      fmt::print("{}", describe_warnings({fmt::format("a load is a share of f_c of the run {}, {}",
                                                      load->keys().run.string(), other)}));
  }
}

double peak_memory() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return 1024.0 * static_cast<double>(usage.ru_maxrss);
}

void print_composition(const Composition& whole, int dimension) {
  fmt::print("composition     {:.3f} inclusions, taken for {}\n", whole.inclusions,
             dimension == 2 ? "discs in plane stress" : "balls");
  if (whole.creep_share) {
    const auto [at_once, far] = *whole.creep_share;
    fmt::print("                creep of the concrete over creep of its matrix, R = {:.4f}", at_once);
    if (far != at_once)
      fmt::print(
          " when the matrix has crept\n                by its elastic strain, {:.4f} by ten times as much",
          far);
    fmt::print("\n");
  }
  if (whole.strain_weight)
    fmt::print("                weight of the inclusions in the free strain, w = {:.4f}\n",
               *whole.strain_weight);
}

void print_mechanics(const Setup& setup, const Simulation& simulation) {
  const MassChoice mass = setup.moving->mechanics.mass;
  const Motion& motion = simulation.motion();
  const Model& model = simulation.model();
  const TimeStepLimit limit = motion.real_mass_limit();
  const int g = limit.gridpoint, block = model.block_of(g);
  fmt::print("time step       {:.3g} s, {}\n", motion.time_step(),
             mass == MassChoice::scaled
                 ? fmt::format("by density scaling of all {} gridpoints: moving mass {:.3g} x the real one",
                               model.gridpoint_count(), motion.mass_ratio())
                 : "with real mass");
  fmt::print("                with real mass {:.3g} s, set by gridpoint {} of block {} ({})", limit.step, g,
             block, model.material_names[model.block_material[block]]);
  fmt::print(" at {} mm\n", place_text(1e3 * model.place(g), model.dimension(), "{:.2f}"));
  const double young = estimate_modulus(model, simulation.materials());
  fmt::print("materials       E about {:.2f} GPa (uniform stress estimate, a lower bound), t_b {:.3f} mm\n",
             young * 1e-9, 1e3 * simulation.materials().fracture_zone);
  if (setup.moving->contacts.fracture_zone_size && !setup.specimen.blocks.finer.empty())
    fmt::print("                of blocks of the mean size; between others t_b goes with their size\n");
  print_stated_stiffness(setup);
  print_with_size(setup);
  print_found(setup, model, young);
  const auto& whole = simulation.materials().composition;
  if (whole && (whole->creep_share || whole->strain_weight)) print_composition(*whole, model.dimension());
}

/// Tells how much a run writes, apart from its checkpoints and figures.
void print_results(const Rehearsal& cost, bool has_fields) {
  constexpr double kKilo = 1e3, kMega = 1e6, kGiga = 1e9;
  const double bytes = std::max(kKilo, cost.history_bytes + cost.field_bytes);
  const double frames = std::max(1.0, std::ceil(cost.forecast.frames));
  fmt::print(
      "results         about {:.2g} rows of history.csv{}; {} of disk\n", std::max(1.0, cost.forecast.looks),
      has_fields ? fmt::format(", {:.2g} frame{} of the fields", frames, frames == 1.0 ? "" : "s") : "",
      bytes < kMega   ? fmt::format("{:.0f} kB", bytes / kKilo)
      : bytes < kGiga ? fmt::format("{:.0f} MB", bytes / kMega)
                      : fmt::format("{:.3g} GB", bytes / kGiga));
}

/// Peaks of the memory of one process, bytes.
struct Peaks {
  double specimen = 0.0;  ///< when the specimen was made
  double model = 0.0;     ///< when its model was made too: so far every rank makes the whole
  double whole = 0.0;     ///< when the whole body could run
};

/// Tells what each of several ranks would hold and send.
void print_ranks(const std::vector<HeldByRank>& held, const Simulation& whole, const Peaks& peaks) {
  const Model& model = whole.model();
  const auto count = static_cast<double>(held.size());
  const auto tell = [&](const char* what, int decimals, auto number) {
    double sum = 0.0, most = 0.0;
    for (const HeldByRank& rank : held) {
      sum += number(rank);
      most = std::max<double>(most, number(rank));
    }
    fmt::print("                {:<44}{:>10.{}f}{:>10.{}f}\n", what, sum / count, decimals, most, decimals);
  };
  fmt::print(
      "{:<60}{:>10}{:>10}\n",
      fmt::format("ranks           {} share {} chunks; of a rank", held.size(), model.chunks().count()),
      "mean", "most");
  tell("blocks", 0, [](const HeldByRank& rank) { return rank.blocks; });
  tell("zones over the mean", 2,
       [&](const HeldByRank& rank) { return rank.zones * count / model.zone_count(); });
  tell("blocks of other ranks that it holds too", 0,
       [](const HeldByRank& rank) { return rank.foreign_blocks; });
  tell("neighbours", 1, [](const HeldByRank& rank) { return rank.neighbours(); });
  if (whole.moves())
    tell("sent after each step [kB]", 1,
         [&](const HeldByRank& rank) { return 1e-3 * rank.step_bytes(model.dimension()); });
  if (!whole.field().is_uniform())
    tell("sent after each stage of the heat solver [kB]", 1,
         [](const HeldByRank& rank) { return 1e-3 * rank.stage_bytes(); });
  tell("memory [MB]", 0, [&](const HeldByRank& rank) {
    const double share = static_cast<double>(rank.zones + rank.foreign_zones) / model.zone_count();
    return 1e-6 * std::max(peaks.model, peaks.specimen + (peaks.whole - peaks.specimen) * share);
  });
}

/// Tells what is known of a deck without the code that it names. Returns the exit code.
int say_unchecked(const DeckOfRun& opened) {
  fmt::print("deck            {} holds no other error: {}\n{}", shown(opened.deck.name()),
             shown(opened.setup.title), describe_warnings(opened.warnings));
  for (const std::string& code : opened.setup.code_not_allowed)
    fmt::print("not checked     the keys of its law: {}\n", shown(code, true));
  return kCodeNotAllowed;
}

}  // namespace

int check(const RunOptions& options) {
  DeckOfRun opened = open_deck(options, false);
  Setup& setup = opened.setup;
  if (!setup.code_not_allowed.empty()) return say_unchecked(opened);
  if (setup.heat.moisture) require_one_process(options.ranks);
  opened.choices.before_making(opened);
  auto specimen = make_checked_specimen(setup.specimen, opened.team.get(), !setup.heat.uniform);
  Peaks peaks{peak_memory()};
  if (options.ranks > 0) make_model(specimen, setup.thickness, setup.moving);
  peaks.model = peak_memory();
  const auto simulation = make_simulation(setup, std::move(specimen), opened.team);
  peaks.whole = peak_memory();
  const Model& model = simulation->model();
  std::vector<HeldByRank> held;
  if (options.ranks > 0) held = held_by_ranks(*simulation, options.ranks);
  fmt::print("deck            {} is valid: {}\n", shown(opened.deck.name()), shown(setup.title));
  say(fmt::format("{}{}{}{}{}", describe_warnings(opened.warnings), describe_unused(setup),
                  describe_own_laws(), describe(*simulation->specimen()),
                  describe_warnings(simulation->warnings_of_specimen())));
  fmt::print("model           {} blocks{}, {} zones, {} gridpoints, {} contacts\n", model.block_count(),
             setup.moving && !setup.moving->bearings.empty() ? " with the bearings" : "", model.zone_count(),
             model.gridpoint_count(), model.contact_count());
  if (!model.symmetry.empty()) {
    std::vector<std::string> sides;
    for (const PlaneOfSymmetry& plane : model.symmetry) sides.push_back(plane.side);
    fmt::print("symmetry        a plane at {}: forces, energies and cracks count this part alone\n",
               fmt::join(sides, ", at "));
  }
  if (simulation->moves()) print_mechanics(setup, *simulation);
  if (const auto* conduction = simulation->field().conduction()) {
    fmt::print("{}", describe(*conduction, model, setup.temperatures));
    if (model.dimension() == 3 && setup.specimen.blocks.shortest_edge == 0.0)
      fmt::print("{}",
                 describe_warnings({"cells keep their short edges, so heat takes 50 to 100 times the time "
                                    "that it takes with [blocks] shortest_edge = 0.35"}));
  }
  if (const MoistureField* moisture = simulation->moisture())
    fmt::print("water           {:.3g} kg in the pores at the start, its vapour at {:.3g} of saturation\n",
               moisture->water().stored(), moisture->largest_pressure_ratio());
  if (const int pockets = simulation->moisture() ? simulation->moisture()->pocket_blocks() : 0)
    fmt::print(
        "                {} blocks of the matrix are closed in by stones, or by sealed faces: what their "
        "stones let pass decides their pressure\n",
        pockets);
  if (simulation->moisture() && simulation->moves())
    fmt::print("                {}\n",
               describe(setup.heat.moisture->coupling, setup.moving->mechanics.found.is_on));
  if (const auto told = foretell_heat(setup, *simulation)) {
    fmt::print("                by heat alone {}\n", describe(*told));
    if (const std::string warning = warning_of(*told, setup); !warning.empty())
      fmt::print("{}", describe_warnings({warning}));
  }
  if (!simulation->field().is_uniform() && simulation->moves())
    fmt::print("                {}\n", simulation->coupling_of_heat());

  print_strength(setup);
  warn_of_strengths(setup, *simulation);
  warn_of_other_bodies(opened);
  const std::size_t stages = setup.stages.size();
  const bool has_fields = setup.has_fields;
  const Rehearsal cost = rehearse(std::move(setup), *simulation);
  const Forecast& expected = cost.forecast;
  fmt::print("run             {} stages", stages);
  if (expected.steps > 0.0) fmt::print(", about {:.2g} steps", expected.steps);
  if (expected.heating_duration > 0.0) fmt::print(", heat flows for {}", duration(expected.heating_duration));
  fmt::print("; about {}\n", duration(cost.seconds));
  if (expected.heating_duration > 0.0)
    fmt::print("                a minute of heat takes about {:.0f} stages of the heat solver\n",
               60.0 * cost.heat_evaluations / expected.heating_duration);
  fmt::print("                on {} with {} instructions, {:.0f} MB of memory\n", describe(*opened.team),
             name(opened.instructions), peak_memory() * 1e-6);
  print_results(cost, has_fields);
  if (!held.empty()) print_ranks(held, *simulation, peaks);
  return 0;
}

Command add_check(CLI::App& cli) {
  const auto options = std::make_shared<RunOptions>();
  auto* command = cli.add_subcommand("check", "Check a deck and forecast its run, without running it");
  add_deck(command, options->deck);
  add_own_laws(command, options->laws);
  add_seed(command, options->seed);
  add_changes(command, *options);
  add_processor(command, *options);
  command
      ->add_option("--ranks", options->ranks,
                   "Tell what each of so many ranks, processes that share the body, would hold and send")
      ->check(whole_number(1, kMostRanks));
  return {command, [options](const auto&) { return check(*options); }};
}

}  // namespace pyroclast::app
