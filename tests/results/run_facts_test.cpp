#include "pyroclast/results/run_facts.hpp"

#include <algorithm>
#include <cmath>
#include <set>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "pyroclast/stages/possible_columns.hpp"
#include "stages/small_runs.hpp"

/// What `run.json` says of a run.
namespace pyroclast::run_facts_test {
namespace {

using nlohmann::json;

json facts_of(const Finished& finished) {
  return json::parse(run_facts_text(finished.run));
}

/// Returns the names in a list of facts whose `key` has a value, in order.
std::vector<std::string> names(const json& list, const std::string& key, const std::string& value) {
  std::vector<std::string> found;
  for (const json& each : list)
    if (each.value(key, "") == value) found.push_back(each["name"]);
  return found;
}

using Names = std::vector<std::string>;

TEST(RunFacts, ColumnsHaveRolesThatTellTheLedgerAndTheCracks) {
  const Finished finished(deck(kUniform + kSettle + kCompress));
  const json facts = facts_of(finished);
  EXPECT_EQ(facts["dimension"], 2);
  EXPECT_EQ(facts["moves"], true);
  EXPECT_EQ(facts["has_press"], true);
  EXPECT_EQ(facts["extent"], (json{{"name", "length"}, {"unit", "m"}}));
  EXPECT_EQ(facts["test_stage"], 1);
  const json& columns = facts["columns"];
  ASSERT_EQ(columns.size(), finished.run.history().columns().size());
  for (std::size_t i = 0; i < columns.size(); ++i) {
    EXPECT_EQ(columns[i]["name"], finished.run.history().columns()[i].name);
    EXPECT_NE(columns[i]["role"], "own") << columns[i];
    EXPECT_NE(columns[i]["meaning"], "") << columns[i];
    EXPECT_NE(columns[i]["of"], "") << columns[i];
  }
  const auto role = [&](const char* name) { return names(columns, "role", name); };
  EXPECT_EQ(role("energy.put_in"), (Names{"energy_loading_J", "energy_gravity_J", "energy_property_change_J",
                                          "energy_mass_scaling_J"}));
  EXPECT_EQ(role("energy.held"), (Names{"energy_zones_J", "energy_contacts_J", "energy_kinetic_J"}));
  EXPECT_EQ(role("energy.error"), Names{"energy_error_J"});
  EXPECT_EQ(role("crack.opening"), Names{"mean_opening_m"});
  // The entries of the ledger close by their roles alone.
  const History& history = finished.run.history();
  double sum = 0.0, size = 0.0;
  for (const json& column : columns) {
    const std::string of = column["role"];
    if (!of.starts_with("energy.")) continue;
    const double value = history.last(column["name"].get<std::string>()).value();
    sum += (of == "energy.put_in" ? 1.0 : -1.0) * value;
    size += std::abs(value);
  }
  EXPECT_LT(std::abs(sum), 1e-9 * size);
  for (const json& column : columns)
    if (column["role"] == "crack.broken_extent") {
      EXPECT_EQ(column["unit"], facts["extent"]["unit"]);
      EXPECT_EQ(column["name"], column["mode"].get<std::string>() + "_" +
                                    column["interface"].get<std::string>() + "_broken_length_m");
    }
  EXPECT_EQ(role("crack.broken_extent").size(), finished.simulation->motion().crack_kinds().size());
}

// Promise: the test is the last stage that measures a strength, else the last with a result of a test.
TEST(RunFacts, TellWhichStageIsTheTest) {
  const auto test = [](const std::string& stages) {
    return facts_of(Finished(deck(kUniform + stages)))["test_stage"];
  };
  EXPECT_EQ(test(kSettle), nullptr);
  EXPECT_EQ(test(kSettle + kCompress + kSettle), 1);
  EXPECT_EQ(test(kSettle + kCompress + kCompress), 2);
}

TEST(RunFacts, ResultsNameTheirReasonsAndDoubts) {
  const json results = facts_of(Finished(deck(kUniform + kSettle + kCompress)))["results"];
  EXPECT_EQ(names(results, "about", "f_c_MPa"), (Names{"f_c_none_because", "f_c_doubtful_because"}));
  std::set<std::string> told;
  for (const json& each : results) {
    EXPECT_TRUE(told.insert(each["name"]).second) << each;
    EXPECT_NE(each["meaning"], "") << each;
    EXPECT_EQ(each["unit"] == "", each["of"] == "reason" || each["of"] == "doubt") << each;
    EXPECT_TRUE(!each.contains("about") || told.contains(each["about"])) << each;
  }
}

// Promise: what `list columns` prints and what a run has are one table: same unit, role and meaning.
TEST(RunFacts, EachColumnIsOneThatTheProgramLists) {
  const std::vector<Column> listed = possible_columns();
  const Finished finished(deck(kUniform + kSettle + kCompress));
  for (const Column& column : finished.run.history().columns()) {
    const auto is_it = [&](const Column& of) {
      return of.role == column.role && of.unit == column.unit && of.meaning == column.meaning;
    };
    EXPECT_TRUE(std::ranges::any_of(listed, is_it)) << column.name;
  }
}

}  // namespace
}  // namespace pyroclast::run_facts_test
