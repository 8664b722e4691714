#include "pyroclast/session/session.hpp"

#include <algorithm>
#include <string>
#include <vector>

#include "in_plane.hpp"
#include "messages.hpp"
#include "pyroclast/base/error.hpp"
#include "pyroclast/base/processors.hpp"
#include "results/folder.hpp"
#include "stages/small_runs.hpp"

namespace pyroclast {
namespace {

const std::string kUnload =
    "[[stages]]\nkind = \"compress\"\nvelocity = \"0.5 mm/s\"\nramp_time = \"20 ms\"\nto_stress = \"1 "
    "MPa\"\n";

DeckOfRun opened(const std::string& stages) {
  RunChoices choices;
  choices.threads = 1;
  return {Deck::parse(deck(kUniform + kSettle + stages), "deck.toml"), ".", choices};
}

std::unique_ptr<Session> session(const std::string& stages) {
  return Session::begin(opened(stages), std::nullopt);
}

void finish(Session& session) {
  while (session.next()) continue;
  session.finish();
}

/// All cells, an empty one as a text that no number has.
std::vector<std::string> cells(const Session& session) {
  std::vector<std::string> all;
  const History& history = session.run().history();
  for (std::size_t row = 0; row < history.row_count(); ++row)
    for (const auto& cell : history.row(row)) all.push_back(printed(cell));
  return all;
}

TEST(DeckOfRun, TakesNoMoreThreadsThanProcessorsAreFreeAndSaysSo) {
  const auto with_threads = [](int threads) {
    RunChoices choices;
    choices.threads = threads;
    return DeckOfRun(Deck::parse(deck(kUniform + kSettle), "deck.toml"), ".", choices);
  };
  const auto says_so = [](const DeckOfRun& opened) {
    return std::ranges::count_if(opened.warnings, [](const std::string& warning) {
      return warning.find("were asked for") != std::string::npos;
    });
  };
  const int free = free_processors();
  for (const int threads : {0, 1, free}) {
    const DeckOfRun opened = with_threads(threads);
    EXPECT_EQ(opened.team->size(), threads == 0 ? free : threads);
    EXPECT_EQ(says_so(opened), 0);
  }
  const DeckOfRun more = with_threads(free + 6);
  EXPECT_EQ(more.team->size(), free);
  EXPECT_EQ(says_so(more), 1);
  EXPECT_THROW(with_threads(-1), Error);
}

TEST_F(Results, ASessionWritesWhatItsHistoryHas) {
  const auto written = Session::begin(opened(kCompress), RunOutput{folder_ / "run", false, "test"});
  finish(*written);
  const std::string csv = content(folder_ / "run" / "history.csv");
  EXPECT_EQ(std::ranges::count(csv, '\n'),
            static_cast<std::ptrdiff_t>(written->run().history().row_count()) + 1);
  EXPECT_TRUE(fs::exists(folder_ / "run" / "summary.json"));
  EXPECT_TRUE(fs::exists(stage_checkpoint(folder_ / "run", 1)));
  const auto silent = session(kCompress);
  finish(*silent);
  EXPECT_EQ(cells(*silent), cells(*written));
  EXPECT_TRUE(silent->folder().empty());
}

TEST(Session, AStopIsTakenBackByGoingOn) {
  const auto straight = session(kCompress), stopped = session(kCompress);
  finish(*straight);
  int asked = 0;
  stopped->stop_when([&] { return ++asked % 5 == 0; });
  int stops = 0;
  while (stopped->next() || stopped->run().outcome() == Outcome::stopped)
    if (stopped->run().outcome() == Outcome::stopped) ++stops;
  EXPECT_GT(stops, 5);
  EXPECT_EQ(stopped->run().outcome(), Outcome::completed);
  EXPECT_EQ(cells(*stopped), cells(*straight));
}

TEST(Session, ACopyInTheMiddleGoesTheSameWay) {
  const auto run = session(kCompress);
  while (run->run().stage_number() < 1) run->next();
  run->next();
  const auto copied = run->copy({}, std::nullopt);
  finish(*copied);
  finish(*run);
  EXPECT_EQ(cells(*copied), cells(*run));
  const auto displacements = [](const Session& session) {
    return in_plane::mechanics(session.run().simulation().motion()).body().arrays.displacement.data();
  };
  EXPECT_NE(displacements(*copied), displacements(*run));
}

TEST(Session, ACopyWhereCracksHinderHeatGoesTheSameWay) {
  std::string stages =
      kExpose + with(kHeatedFace, "rate = \"10 K/min\", to = \"70", "rate = \"100 K/min\", to = \"620") +
      "[heat.cracks]\n";
  RunChoices choices;
  choices.threads = 1;
  const std::string text =
      with(with(deck(kSettle + stages, "\"6e-5 1/K\""), "conductivity = \"40 W", "conductivity = \"4 W"),
           "exchange_increment = \"5 K\"", "exchange_increment = \"40 K\"");
  const auto run = Session::begin({Deck::parse(text, "deck.toml"), ".", choices}, std::nullopt);
  const auto gaps = [](const Session& session) {
    return session.run().simulation().field().conduction()->gap_area();
  };
  int asked = 0;
  run->stop_when([&] { return gaps(*run) > 0.0 && ++asked == 4; });  // somewhere between two looks
  while (run->next()) continue;
  ASSERT_EQ(run->run().outcome(), Outcome::stopped);
  const double then = gaps(*run);
  const auto copied = run->copy({}, std::nullopt);
  for (auto* session : {run.get(), copied.get()}) {
    session->stop_when([] { return false; });
    finish(*session);
  }
  EXPECT_EQ(cells(*copied), cells(*run));
  EXPECT_GT(gaps(*run), then);
}

TEST(Session, ACopyWithOtherLaterStagesIsTheRunOfThatDeck) {
  const std::string changed = with(kCompress, "0.0002", "0.0001");
  const auto run = session(kCompress), whole = session(changed);
  while (!run->run().stage_is_over()) run->next();
  const auto copied = run->copy({"stages[1].stop_strain=0.0001"}, std::nullopt);
  finish(*copied);
  finish(*whole);
  EXPECT_EQ(cells(*copied), cells(*whole));
  EXPECT_NE(message([&] {
              run->copy({"stages[0].most_steps=5"}, std::nullopt);
            }).find("the parent has done this stage"),
            std::string::npos);
}

TEST_F(Results, AnAppendedStageGivesTheRunOfTheWholeDeck) {
  const auto run = Session::begin(opened(kCompress), RunOutput{folder_ / "run", false, "test"});
  const auto whole = Session::begin(opened(kCompress + kUnload), RunOutput{folder_ / "whole", false, "test"});
  finish(*run);
  run->change_stages({}, kUnload);
  EXPECT_EQ(run->run().outcome(), Outcome::running);
  finish(*run);
  finish(*whole);
  for (const char* file : {"history.csv", "deck.toml"}) {
    const auto lines = [](std::string text) {
      std::erase(text, '\n');  // the appended text begins with one
      return text;
    };
    EXPECT_EQ(lines(content(folder_ / "run" / file)), lines(content(folder_ / "whole" / file))) << file;
  }
}

TEST_F(Results, WhatAScriptDidIsSaidAndKeepsARunFromBeingResumed) {
  const auto run = Session::begin(opened(kCompress), RunOutput{folder_ / "run", false, "test"});
  while (run->run().stage_number() < 1) run->next();
  run->change_materials({"materials.mortar.E=15 GPa"});
  run->next();
  const Summary summary = run->finish();
  EXPECT_TRUE(std::ranges::any_of(summary.warnings, [](const std::string& line) {
    return line.find("not reproducible from the deck: materials.mortar.E=15 GPa") != std::string::npos;
  }));
  ASSERT_EQ(RunFolder::departures(folder_ / "run").size(), 1u);
  EXPECT_TRUE(RunFolder::departures(folder_ / "run").front().is_change);
  EXPECT_LT(run->run().simulation().motion().totals().energy().property_change, 0.0);
}

TEST_F(Results, ARunThatAScriptChangedIsNotResumed) {
  {
    const auto run = Session::begin(opened(kCompress), RunOutput{folder_ / "run", false, "test"});
    run->next();
    run->depart({"mine"});
    run->depart({"mine"});
    run->write_checkpoint();
  }
  EXPECT_EQ(RunFolder::departures(folder_ / "run").size(), 1u);
  EXPECT_NE(message([&] { Session::resume(folder_ / "run", {}, {}); }).find("only the script"),
            std::string::npos);
}

TEST(Session, WhatCannotChangeInARunIsRefused) {
  const auto run = session(kCompress);
  run->next();
  EXPECT_NE(message([&] { run->change_materials({"materials.mortar.density=2000 kg/m3"}); }).find("density"),
            std::string::npos);
  EXPECT_NE(message([&] { run->change_materials({"specimen.width=1 m"}); }).find("specimen.width"),
            std::string::npos);
  EXPECT_NE(message([&] { run->write_checkpoint(); }).find("no folder"), std::string::npos);
  EXPECT_NE(message([&] { run->run().end_stage(); }).find("no stage is under way"), std::string::npos);
}

TEST(Session, AStageCanBeEndedAtALook) {
  const auto run = session(kCompress + kUnload);
  while (run->run().stage_number() < 1) run->next();
  for (int look = 0; look < 4; ++look) run->next();
  run->run().end_stage();
  finish(*run);
  EXPECT_EQ(run->run().courses()[1].outcome, Outcome::completed);
  EXPECT_EQ(run->run().courses()[1].rows.last - run->run().courses()[1].rows.first, 5u);
  EXPECT_EQ(run->run().outcome(), Outcome::completed);
}

TEST(Session, MeasuringAddsNoRowAndIsWhatALookHas) {
  const auto run = session(kCompress);
  while (run->run().stage_number() < 1) run->next();
  const History& history = run->run().history();
  const std::size_t rows = history.row_count();
  EXPECT_EQ(run->run().measure(), history.row(rows - 1));
  EXPECT_EQ(history.row_count(), rows);
}

}  // namespace
}  // namespace pyroclast
