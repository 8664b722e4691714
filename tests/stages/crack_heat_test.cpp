#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "messages.hpp"
#include "pyroclast/base/error.hpp"
#include "pyroclast/simulation/contact_gaps.hpp"
#include "small_runs.hpp"

/// Cracks that hinder heat: the body opens them, and the heat of the next exchange meets them.
namespace pyroclast {
namespace {

const std::string kCracks = "[heat.cracks]\n";

/// All cells of the columns that a history without cracks has.
std::vector<std::optional<double>> cells(const History& history, const std::vector<std::string>& columns) {
  std::vector<std::optional<double>> all;
  for (std::size_t row = 0; row < history.row_count(); ++row)
    for (const auto& name : columns) all.push_back(history.cell(row, name));
  return all;
}

TEST(CrackHeat, CracksThatAFireOpensHoldItsHeatBack) {
  const Finished without(hot_deck("")), with_cracks(hot_deck(kCracks));
  ASSERT_EQ(without.run.outcome(), Outcome::completed);
  ASSERT_EQ(with_cracks.run.outcome(), Outcome::completed);
  EXPECT_FALSE(without.run.history().has("heat_gap_length_m"));
  EXPECT_GT(with_cracks.last("heat_gap_length_m"), 0.03);
  EXPECT_GT(with_cracks.last("mean_opening_m"), 1e-5);
  EXPECT_LT(with_cracks.last("heat_stored_J"), 0.998 * without.last("heat_stored_J"));
  EXPECT_LT(with_cracks.last("temperature_min_degC"), without.last("temperature_min_degC") - 0.5);
  EXPECT_NEAR(with_cracks.last("heat_error_J"), 0.0, 1e-9 * with_cracks.last("heat_stored_J"));
  // the body opens them at an exchange, and the heat before the next one is the first that meets them
  const History& history = with_cracks.run.history();
  const RowRange rows = with_cracks.run.courses()[1].rows;
  EXPECT_EQ(history.cell(rows.first, "heat_gap_length_m"), 0.0);
  const auto& field = with_cracks.simulation->field();
  const auto gaps = contact_gaps(with_cracks.simulation->model(), {}, &with_cracks.simulation->motion());
  double largest = 0.0, jump = 0.0;
  for (int i = 0; i < with_cracks.simulation->model().contact_count(); ++i) {
    const Joint& c = with_cracks.simulation->model().joint(i);
    if (with_cracks.simulation->model().is_of_bearing(c)) continue;
    largest = std::max(largest, gaps[i].opening);
    jump = std::max(jump, std::abs(field.gridpoints()[c.b] - field.gridpoints()[c.a]));
    EXPECT_EQ(field.contacts()[i], 0.5 * (field.gridpoints()[c.a] + field.gridpoints()[c.b]));
  }
  EXPECT_GT(largest, 2e-5);
  EXPECT_GT(jump, 1.0);
}

TEST(CrackHeat, WhereNothingCracksItChangesNoBit) {
  std::string strong = hot_deck("");
  for (const auto& [from, to] : {std::pair{"f_t = \"2.5 MPa\"", "f_t = \"2500 MPa\""},
                                 std::pair{"G_f1 = \"60 N/m\"", "G_f1 = \"60000000 N/m\""},
                                 std::pair{"G_f2 = \"240 N/m\"", "G_f2 = \"240000000 N/m\""},
                                 std::pair{"c_o = \"3.8 MPa\"", "c_o = \"3800 MPa\""}})
    strong = with(strong, from, to);
  const Finished without(strong), with_cracks(strong + kCracks);
  std::vector<std::string> columns;
  for (const Column& column : without.run.history().columns()) columns.push_back(column.name);
  EXPECT_EQ(cells(with_cracks.run.history(), columns), cells(without.run.history(), columns));
  EXPECT_EQ(with_cracks.last("heat_gap_length_m"), 0.0);
}

/// A plate with a slit across the middle third of its left half, pulled apart.
TEST(CrackHeat, AGapIsWhatIsStatedAndWhatTheMotionOpens) {
  const std::string slit =
      "[[specimen.notches]]\nmouth = [\"0 mm\", \"60 mm\"]\ntip = [\"30 mm\", \"60 mm\"]\n";
  const std::string text = with(deck(kSettle + kExpose + kHeatedFace), "[aggregates]", slit + "[aggregates]");
  const auto simulation = make_simulation(read(text + kCracks));
  const Model& model = simulation->model();
  const auto& parted = model.contact_sets.at("notch_1");
  EXPECT_EQ(simulation->field().conduction()->gap_area(), 0.0) << "its walls touch";
  Motion& motion = simulation->motion();
  for (int g : model.set("top_platen")) motion.constraints().prescribe_velocity(g, 1, 0.01);
  for (int g : model.set("bottom_platen")) motion.constraints().prescribe_velocity(g, 1, -0.01);
  for (int g : model.set("specimen"))
    if (std::abs(model.place(g)[1] - 0.06) > 0.055)
      motion.constraints().prescribe_velocity(g, 1, model.place(g)[1] > 0.06 ? 0.01 : -0.01);
  motion.advance(300);
  const auto gaps = contact_gaps(model, {{"notch_1", 1e-3, ""}}, &motion);
  for (int contact : parted) {
    EXPECT_EQ(gaps[contact].damage, 1.0);
    EXPECT_EQ(gaps[contact].opening, 1e-3 + std::max(0.0, motion.read().opening(contact)));
  }
  EXPECT_GT(motion.read().opening(parted.front()), 1e-5);
  for (int i = 0; i < model.contact_count(); ++i)
    if (!std::ranges::count(parted, i)) {
      EXPECT_EQ(gaps[i].damage, motion.read().remembered(i, Remembers::tension_damage));
      EXPECT_EQ(gaps[i].opening, std::max(0.0, motion.read().opening(i)));
    }
  simulation->show_cracks();
  EXPECT_GT(simulation->field().conduction()->gap_area(), 0.02 * model.thickness);
  for (int contact : parted) {
    EXPECT_GT(simulation->field().conduction()->conductances(simulation->field().gridpoints())[contact], 4.0);
  }
}

TEST(CrackHeat, GapsNameSetsOfContactsAndDoNotMeet) {
  const auto simulation = make_simulation(read(deck(kSettle + kExpose + kHeatedFace)));
  const auto told = [&](const std::vector<StatedGap>& gaps) {
    return message([&] { contact_gaps(simulation->model(), gaps, nullptr); });
  };
  const std::string missing = told({{"scab", 1e-3, "deck.toml:9: heat.cracks.gaps[0]"}});
  EXPECT_NE(missing.find("deck.toml:9: heat.cracks.gaps[0]: contacts = \"scab\" is no set of contacts"),
            std::string::npos)
      << missing;
  EXPECT_NE(missing.find("mortar_mortar"), std::string::npos) << missing;
  EXPECT_NE(told({{"mortar_mortar", 1e-3, "a"}, {"specimen", 1e-4, "b"}})
                .find("b: contacts of \"specimen\" have "
                      "a gap already (a)"),
            std::string::npos);
}

TEST(CrackHeat, IsReadFromTheDeck) {
  const auto cracks_of = [](const std::string& cracks) {
    return read(deck(kSettle + kExpose + kHeatedFace + cracks)).heat.cracks;
  };
  EXPECT_FALSE(cracks_of(""));
  const auto defaults = cracks_of(kCracks);
  ASSERT_TRUE(defaults);
  EXPECT_EQ(defaults->law.bridges, 5e4);
  EXPECT_EQ(defaults->law.jump_distance, 2e-7);
  EXPECT_EQ(defaults->law.emissivity, 0.9);
  EXPECT_TRUE(defaults->splits_by_block_size);
  EXPECT_NEAR(defaults->law.gas_conductivity(20.0), 0.0257, 1e-4);
  EXPECT_TRUE(defaults->gaps.empty());
  const auto stated = cracks_of(kCracks +
                                "bridges = \"2e5 W/(m2 K)\"\ngas_conductivity = \"0.03 W/(m K)\"\n"
                                "jump_distance = \"1 um\"\nemissivity = 0.5\nsplit_below = \"5 kW/(m2 K)\"\n"
                                "[[heat.cracks.gaps]]\ncontacts = \"mortar_mortar\"\nwidth = \"0.1 mm\"\n");
  EXPECT_EQ(stated->law.bridges, 2e5);
  EXPECT_EQ(stated->law.gas_conductivity(300.0), 0.03);
  EXPECT_EQ(stated->law.jump_distance, 1e-6);
  EXPECT_EQ(stated->law.emissivity, 0.5);
  EXPECT_FALSE(stated->splits_by_block_size);
  EXPECT_EQ(stated->law.split_below, 5e3);
  ASSERT_EQ(stated->gaps.size(), 1U);
  EXPECT_EQ(stated->gaps[0].contacts, "mortar_mortar");
  EXPECT_EQ(stated->gaps[0].width, 1e-4);
}

// Promise: what is left out is 5 % of the resistance of a block of the specimen's own size and mean
// conductivity.
TEST(CrackHeat, ContactsPartBelowAConductanceOfTheBlockSize) {
  const std::string text =
      with(deck(kSettle + kExpose + kHeatedFace + kCracks), "conductivity = \"40 W/(m K)\"",
           "conductivity = { table = [[\"20 degC\", \"4 W/(m K)\"], [\"70 degC\", \"1 W/(m K)\"]] }");
  for (const char* count : {"count = 60", "count = 240"}) {
    const auto simulation = make_simulation(read(with(text, "count = 60", count)));
    const auto& specimen = std::get<specimen::Specimen<2>>(*simulation->specimen());
    const double conductivity = 4.0 * specimen.fraction[0] + 40.0 * specimen.fraction[1];
    const double size = std::sqrt(specimen.outline.extent() / std::stod(std::string(count).substr(8)));
    EXPECT_NEAR(simulation->field().conduction()->gap_law()->split_below, 20.0 * conductivity / size,
                1e-9 * conductivity / size);
  }
  const auto stated = make_simulation(read(text + "split_below = \"5 kW/(m2 K)\"\n"));
  EXPECT_EQ(stated->field().conduction()->gap_law()->split_below, 5e3);
}

TEST(CrackHeat, ADeckIsToldWhatIsWrong) {
  const auto key_of = [](const std::string& text) {
    try {
      read(text);
    } catch (const DeckError& e) {
      return e.diagnostics().front().key + ": " + e.diagnostics().front().message;
    }
    return std::string("nothing");
  };
  const auto told = [&](const std::string& line, const std::string& key, const std::string& what) {
    const std::string d = key_of(deck(kSettle + kExpose + kHeatedFace + kCracks + line));
    EXPECT_EQ(d.substr(0, key.size()), key) << d;
    expect_in(what, d);
  };
  told("emissivity = 1.5\n", "heat.cracks.emissivity", "between 0 and 1");
  told("split_below = \"0 W/(m2 K)\"\n", "heat.cracks.split_below", "greater than 0");
  told("jump_distance = \"0 m\"\n", "heat.cracks.jump_distance", "greater than 0");
  told("gas_conductivity = \"-1 W/(m K)\"\n", "heat.cracks.gas_conductivity", "greater than 0");
  told("bridges = \"5 m\"\n", "heat.cracks.bridges", "wrong dimension");
  told("gap = 1\n", "heat.cracks.gap", "unknown key");
  told("[[heat.cracks.gaps]]\ncontacts = \"specimen\"\nwidth = \"0 mm\"\n", "heat.cracks.gaps[0].width",
       "greater than 0");
  told("[[heat.cracks.gaps]]\nwidth = \"1 mm\"\n", "heat.cracks.gaps[0].contacts", "missing");
  const std::string uniform = key_of(deck(kSettle + heat("60 degC") + kUniform + kCracks));
  expect_in("heat.cracks", uniform);
  expect_in("no effect", uniform);
}

}  // namespace
}  // namespace pyroclast
