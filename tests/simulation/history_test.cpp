#include "pyroclast/simulation/watching/history.hpp"

#include <gtest/gtest.h>

#include "pyroclast/base/error.hpp"

namespace pyroclast {
namespace {

History two_columns() {
  History history;
  history.add_column({"stage", "1"});
  history.add_column({"stress_MPa", "MPa"});
  history.add_column({"stage", "1"});
  return history;
}

TEST(History, HasEachColumnOnceInTheOrderOfAdding) {
  EXPECT_EQ(two_columns().columns(), (std::vector<Column>{{"stage", "1"}, {"stress_MPa", "MPa"}}));
  EXPECT_THROW(two_columns().add_column({"stress_MPa", "Pa"}), Error);
}

TEST(History, ACellThatNobodySetIsEmpty) {
  History history = two_columns();
  history.add_row();
  history.set("stage", 0.0);
  history.add_row();
  history.set("stress_MPa", 1.0 / 3.0);
  EXPECT_EQ(history.row_count(), 2U);
  EXPECT_EQ(history.cell(0, "stage"), 0.0);
  EXPECT_FALSE(history.cell(0, "stress_MPa"));
  EXPECT_EQ(history.last("stress_MPa"), 1.0 / 3.0);  // in full precision
  EXPECT_FALSE(history.last("strain"));
  EXPECT_EQ(history.values("stress_MPa", {1, 2}), (std::vector<double>{1.0 / 3.0}));
}

TEST(History, SaysWhichColumnOrValueIsMissing) {
  History history = two_columns();
  history.add_row();
  const auto message = [](auto action) -> std::string {
    try {
      action();
    } catch (const Error& e) {
      return e.what();
    }
    return "";
  };
  EXPECT_NE(message([&] { history.set("strain", 0.0); }).find("\"strain\"; it has stage, stress_MPa"),
            std::string::npos);
  EXPECT_NE(message([&] { history.values("stress_MPa", {0, 1}); }).find("row 0"), std::string::npos);
}

TEST(History, TakesRowsIntoOtherColumns) {
  History old;
  for (const char* name : {"a", "b"}) old.add_column({name, "1"});
  old.add_row();
  old.set("b", 2.0);
  History history;
  for (const char* name : {"c", "b"}) history.add_column({name, "1"});
  history.take_rows(old);
  EXPECT_EQ(history.row(0), (std::vector<std::optional<double>>{std::nullopt, 2.0}));
}

}  // namespace
}  // namespace pyroclast
