#include <algorithm>

#include <gtest/gtest.h>

#include "pyroclast/base/error.hpp"
#include "shake.hpp"

namespace pyroclast {
namespace {

TEST(OwnStage, IsReadFromADeckAndRun) {
  Trial trial(deck(kUniform + kSettle + kShake + kCompress), with_shake());
  EXPECT_EQ(trial.run.run(), Outcome::completed);
  const History& history = trial.run.history();
  const StageCourse& record = trial.run.courses()[1];
  EXPECT_EQ(history.values("turn", record.rows), (std::vector<double>{1, 2, 3, 4}));
  EXPECT_FALSE(history.last("turn"));  // the compression has none
  const auto strain = history.values("stage_strain", record.rows);
  EXPECT_GT(strain[0], strain[1]);
  EXPECT_LT(strain[1], strain[2]);
  const StageReport report = trial.run.stages()[1]->report(history, record.rows, record.outcome);
  EXPECT_GT(std::get<double>(report.results.at(0).value), 0.0);
}

TEST(OwnStage, ErrorsInItsTableAreToldLikeAnyOther) {
  const auto message = [](const std::string& text, const StageRegistry& kinds) -> std::string {
    try {
      read(text, kinds);
    } catch (const DeckError& e) {
      return e.what();
    }
    return "";
  };
  EXPECT_NE(message(deck(kUniform + with(kShake, "1 mm/s", "1 mm")), with_shake()).find("stages[0].velocity"),
            std::string::npos);
  EXPECT_NE(message(deck(kUniform + kShake + "colour = 1\n"), with_shake()).find("colour"),
            std::string::npos);
  EXPECT_NE(message(deck(kUniform + kShake), {}).find("shake"), std::string::npos);
}

TEST(OwnStage, ItsNameMustBeFree) {
  StageRegistry kinds = with_shake();
  EXPECT_THROW(kinds.add(shake_kind()), Error);
}

}  // namespace
}  // namespace pyroclast
