// Every term of the time of a step on several ranks: what each holds and sends, and how long its part takes.
// bench/ranks calls it. The ranks are threads of this process.

#include <algorithm>
#include <cstdio>
#include <ctime>
#include <filesystem>
#include <functional>
#include <string>
#include <thread>
#include <vector>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "counted_ranks.hpp"
#include "pyroclast/base/error.hpp"
#include "pyroclast/base/processors.hpp"
#include "pyroclast/mechanics/halo.hpp"
#include "pyroclast/setup/setup.hpp"
#include "pyroclast/simulation/body_on_ranks.hpp"
#include "pyroclast/simulation/loop/run.hpp"
#include "ranks_in_threads.hpp"

namespace {

using namespace pyroclast;

constexpr int kStepsOfABatch = 10, kFirstSteps = 20;
constexpr double kVelocity = 0.01;  // of the platens, m/s
/// A message between two nodes as the model has it: time to begin, s, and bytes a second.
constexpr double kLatency = 2e-6, kBandwidth = 10e9;

/// What is asked for.
struct Asked {
  std::filesystem::path deck;
  std::vector<std::string> changes;
  std::vector<int> ranks{2, 4, 8};
  int batches = 60;

  Setup setup() const { return read_setup(Deck::open(deck, changes), deck.parent_path()); }
};

/// Returns the processor time that an action takes on this thread, s.
double seconds_of(const std::function<void()>& action) {
  const auto now = [] {
    timespec time{};
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
    return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
  };
  const double start = now();
  action();
  return now() - start;
}

/// Shortest of several times, s.
struct Shortest {
  double seconds = 1e9;
  void take(double other) { seconds = std::min(seconds, other); }
};

/// The body on one rank, or whole.
struct OnRank {
  std::shared_ptr<CountedRanks> ranks;
  std::unique_ptr<Simulation> simulation;
  std::unique_ptr<Run> run;  ///< for its looks
  Shortest step, look, packing;
  double inner_share = 0.0;  ///< share of own zones that move while messages travel

  OnRank(const Asked& asked, const MadeSpecimen& specimen, std::shared_ptr<CountedRanks> of)
      : ranks(std::move(of)) {
    Setup setup = asked.setup();
    simulation = make_simulation(setup, specimen, std::make_shared<Team>(1, WhenCrowded::stay), ranks);
    run = std::make_unique<Run>(*simulation, std::move(setup.stages));
    if (simulation->has_press()) simulation->press().control_by_motion(kVelocity);
    simulation->motion().advance(kFirstSteps);
    find_inner_share();
  }

  /// Returns the time of a step. The first step of a batch is not timed: it finds other bodies in the caches.
  double batch() {
    simulation->motion().advance(1);
    return seconds_of([&] { simulation->motion().advance(kStepsOfABatch); }) / kStepsOfABatch;
  }
  template <class F>
  void with_mechanics(F f) {
    if (simulation->model().dimension() == 2)
      f(dynamic_cast<MotionOf<2>&>(simulation->motion()).mechanics());
    else
      f(dynamic_cast<MotionOf<3>&>(simulation->motion()).mechanics());
  }
  std::size_t arrays() {
    std::size_t bytes = 0;
    with_mechanics([&](const auto& mechanics) { bytes = mechanics.body().memory(); });
    return bytes;
  }
  void find_inner_share() {
    int inner = 0, own = 0;
    with_mechanics([&]<int Dim>(const Mechanics<Dim>& mechanics) {
      const Layout<Dim>& layout = mechanics.body().layout;
      const std::vector<int> sent = Halo<Dim>(mechanics.model(), layout).bundles_sent();
      const auto [first, last] = layout.chunks.bundles.own();
      for (int b = first; b < last; ++b) {
        const int zones = layout.bundles[b].zone_packs();
        own += zones;
        if (!layout.bundles[b].is_part && !std::ranges::binary_search(sent, b)) inner += zones;
      }
    });
    inner_share = static_cast<double>(inner) / own;
  }
  /// Times a halo by itself, on a copy of the arrays.
  void time_packing(int times) {
    with_mechanics([&]<int Dim>(const Mechanics<Dim>& mechanics) {
      Halo<Dim> halo(mechanics.model(), mechanics.body().layout);
      auto arrays = mechanics.body().arrays;
      for (int i = 0; i < times; ++i)
        packing.take(seconds_of([&] { halo.exchange(arrays, Travels::each_step); }));
    });
  }
};

/// Times of a body on so many ranks.
struct OnRanks {
  std::vector<HeldByRank> held;
  std::vector<std::unique_ptr<OnRank>> parts;
  std::int64_t within_batch = 0, of_look = 0;  ///< collectives
  Shortest together;                           ///< processor time of a step on all ranks

  double most(const std::function<double(int)>& of_rank) const {
    double largest = 0.0;
    for (int r = 0; r < static_cast<int>(held.size()); ++r) largest = std::max(largest, of_rank(r));
    return largest;
  }
  double sum(const std::function<double(int)>& of_rank) const {
    double all = 0.0;
    for (int r = 0; r < static_cast<int>(held.size()); ++r) all += of_rank(r);
    return all;
  }
};

/// Makes the parts and lets them step together.
OnRanks on_ranks(const Asked& asked, const Simulation& whole, int count) {
  OnRanks all;
  all.held = held_by_ranks(whole, count);
  all.parts.resize(static_cast<std::size_t>(count));
  std::vector<std::vector<double>> batches(static_cast<std::size_t>(count));
  RanksInThreads::run(count, [&](const std::shared_ptr<Ranks>& ranks) {
    const auto me = static_cast<std::size_t>(ranks->me());
    all.parts[me] = std::make_unique<OnRank>(asked, *whole.specimen(), std::make_shared<CountedRanks>(ranks));
    OnRank& part = *all.parts[me];
    part.ranks->forget();
    for (int i = 0; i < asked.batches; ++i) batches[me].push_back(part.batch());
    const std::int64_t within = part.ranks->collectives;
    part.ranks->together([&] { return part.run->measure(); });  // as a run does
    if (me == 0) {
      all.within_batch = within;
      all.of_look = part.ranks->collectives - within;
    }
  });
  for (int i = 0; i < asked.batches; ++i) {
    double step = 0.0;
    for (const auto& of_rank : batches) step += of_rank[static_cast<std::size_t>(i)];
    all.together.take(step);
  }
  for (const auto& part : all.parts) part->ranks->is_alone = true;
  return all;
}

void print(const Asked& asked, OnRank& whole, std::vector<OnRanks>& all) {
  const Model& model = whole.simulation->model();
  fmt::print("{}: {} blocks in {} dimensions, {} zones, {} contact points, {} chunks; {}\n",
             asked.deck.filename().string(), model.block_count(), model.dimension(), model.zone_count(),
             model.contact_count(), model.chunks().count(), processor_name());
  fmt::print("one process: step {:.1f} us, look {:.1f} us, arrays {:.2f} MB\n\n", 1e6 * whole.step.seconds,
             1e6 * whole.look.seconds, 1e-6 * static_cast<double>(whole.arrays()));
  const auto row = [&](const char* what, const char* form, auto number) {
    fmt::print("| {:<62} |", what);
    for (OnRanks& of : all) fmt::print(" {:>9} |", fmt::format(fmt::runtime(form), number(of)));
    fmt::print("\n");
  };
  const auto heading = [&](const char* what) {
    fmt::print("| {:<62} |", what);
    for (const OnRanks& of : all) fmt::print(" {:>9} |", fmt::format("{} ranks", of.held.size()));
    fmt::print("\n|---|");
    for (std::size_t i = 0; i < all.size(); ++i) fmt::print("---:|");
    fmt::print("\n");
  };
  const int dimension = model.dimension();
  const auto zones = static_cast<double>(model.zone_count());
  const auto ranks_of = [](const OnRanks& of) { return static_cast<double>(of.held.size()); };
  const auto slowest = [](const OnRanks& of) {
    return of.most([&](int r) { return of.parts[static_cast<std::size_t>(r)]->step.seconds; });
  };
  const auto held = [](auto number) {
    return [number](const OnRanks& of) {
      return
          [&of, number](int r) { return static_cast<double>(number(of.held[static_cast<std::size_t>(r)])); };
    };
  };
  const auto of_zones = held([](const HeldByRank& rank) { return rank.zones; });
  const auto of_bytes = held([&](const HeldByRank& rank) { return rank.step_bytes(dimension); });
  const auto of_neighbours = held([](const HeldByRank& rank) { return rank.neighbours(); });
  const auto of_foreign = held([](const HeldByRank& rank) { return rank.foreign_blocks; });
  const auto of_foreign_zones = held([](const HeldByRank& rank) { return rank.foreign_zones; });
  const auto of_cut_points = held([](const HeldByRank& rank) { return rank.cut_points; });

  heading("counted");
  row("zones of a rank, most", "{:.0f}", [&](auto& of) { return of.most(of_zones(of)); });
  row("the same over the mean", "{:.2f}",
      [&](auto& of) { return of.most(of_zones(of)) * ranks_of(of) / zones; });
  row("points of faces between ranks, updated twice [% of all]", "{:.1f}",
      [&](auto& of) { return 50.0 * of.sum(of_cut_points(of)) / model.contact_count(); });
  row("blocks of other ranks that ranks hold too [% of all]", "{:.1f}",
      [&](auto& of) { return 100.0 * of.sum(of_foreign(of)) / model.block_count(); });
  row("zones of these [% of all]", "{:.1f}",
      [&](auto& of) { return 100.0 * of.sum(of_foreign_zones(of)) / zones; });
  row("arrays of the largest rank [MB]", "{:.2f}", [&](auto& of) {
    return of.most(
        [&](int r) { return 1e-6 * static_cast<double>(of.parts[static_cast<std::size_t>(r)]->arrays()); });
  });
  row("the same over those of one process", "{:.3f}", [&](auto& of) {
    return of.most([&](int r) {
      return static_cast<double>(of.parts[static_cast<std::size_t>(r)]->arrays());
    }) / static_cast<double>(whole.arrays());
  });
  row("zones that move while messages travel, least [% of own]", "{:.0f}", [](auto& of) {
    double least = 1.0;
    for (const auto& part : of.parts) least = std::min(least, part->inner_share);
    return 100.0 * least;
  });
  row("messages of a rank after each step, mean", "{:.1f}",
      [&](auto& of) { return of.sum(of_neighbours(of)) / ranks_of(of); });
  row("messages, most", "{:.0f}", [&](auto& of) { return of.most(of_neighbours(of)); });
  row("bytes of a rank after each step, mean [kB]", "{:.1f}",
      [&](auto& of) { return 1e-3 * of.sum(of_bytes(of)) / ranks_of(of); });
  row("bytes, most [kB]", "{:.1f}", [&](auto& of) { return 1e-3 * of.most(of_bytes(of)); });
  row("collectives within batches", "{}", [](auto& of) { return of.within_batch; });
  row("collectives of a look", "{}", [](auto& of) { return of.of_look; });

  fmt::print("\n");
  heading("measured: processor time of threads, shortest of all batches");
  row("step of the slowest part alone [us]", "{:.1f}", [&](auto& of) { return 1e6 * slowest(of); });
  row("packing and unpacking in it, most [us]", "{:.1f}", [](auto& of) {
    return of.most([&](int r) { return 1e6 * of.parts[static_cast<std::size_t>(r)]->packing.seconds; });
  });
  row("step of the slowest part over that of one process", "{:.3f}",
      [&](auto& of) { return slowest(of) / whole.step.seconds; });
  row("step of all parts, each alone, over that of one process", "{:.2f}", [&](auto& of) {
    return of.sum([&](int r) { return of.parts[static_cast<std::size_t>(r)]->step.seconds; }) /
           whole.step.seconds;
  });
  row("the same together, with exchanges between threads", "{:.2f}",
      [&](auto& of) { return of.together.seconds / whole.step.seconds; });

  fmt::print("\n");
  heading("modelled: nobody has run this");
  const auto messages_of = [&](const OnRanks& of, int r) {
    return of_neighbours(of)(r) * kLatency + of_bytes(of)(r) / kBandwidth;
  };
  const auto messages = [&](const OnRanks& of) { return of.most([&](int r) { return messages_of(of, r); }); };
  row(fmt::format("messages at {:.0f} us each and {:.0f} GB/s [us]", 1e6 * kLatency, 1e-9 * kBandwidth)
          .c_str(),
      "{:.1f}", [&](auto& of) { return 1e6 * messages(of); });
  const auto in_view = [&](const OnRanks& of) {
    return of.most([&](int r) {
      const OnRank& part = *of.parts[static_cast<std::size_t>(r)];
      return std::max(0.0, messages_of(of, r) - part.inner_share * part.step.seconds);
    });
  };
  row("what is left of them behind inner zones [us]", "{:.1f}", [&](auto& of) { return 1e6 * in_view(of); });
  row("step, a core and a memory of its own for each rank [us]", "{:.1f}",
      [&](auto& of) { return 1e6 * (slowest(of) + in_view(of)); });
  row("efficiency: step of one process over ranks times this", "{:.2f}",
      [&](auto& of) { return whole.step.seconds / (ranks_of(of) * (slowest(of) + in_view(of))); });
}

}  // namespace

int main(int argc, char** argv) {
  Asked asked;
  CLI::App cli("What each of several ranks holds and sends, and how long its part of a step takes");
  cli.add_option("DECK", asked.deck, "deck whose body is timed; a stage must move it")->required();
  cli.add_option("--set", asked.changes, "change a key of the deck")->take_all()->allow_extra_args(false);
  cli.add_option("--ranks", asked.ranks, "numbers of ranks");
  cli.add_option("--batches", asked.batches, "batches of 10 steps that are timed");
  CLI11_PARSE(cli, argc, argv);
  try {
    const Setup setup = asked.setup();
    if (!setup.moving) throw Error("no stage of the deck moves the body");
    const auto own = [] {
      return std::make_shared<CountedRanks>(std::shared_ptr<Ranks>(&one_rank(), [](Ranks*) {}));
    };
    OnRank whole(asked, make_checked_specimen(setup.specimen), own());
    std::vector<OnRanks> all;
    for (const int count : asked.ranks) all.push_back(on_ranks(asked, *whole.simulation, count));
    // by turns, as other work on the machine comes and goes
    for (int i = 0; i < asked.batches; ++i) {
      whole.step.take(whole.batch());
      for (OnRanks& of : all)
        for (const auto& part : of.parts) part->step.take(part->batch());
    }
    whole.look.take(seconds_of([&] { whole.run->measure(); }));
    for (OnRanks& of : all)
      for (const auto& part : of.parts) part->time_packing(10 * asked.batches);
    print(asked, whole, all);
  } catch (const std::exception& error) {
    fmt::print(stderr, "bench/ranks: {}\n", error.what());
    return 1;
  }
  return 0;
}
