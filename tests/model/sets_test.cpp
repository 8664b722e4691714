#include "pyroclast/model/sets.hpp"

#include <algorithm>
#include <numeric>

#include <gtest/gtest.h>

#include "model/small_specimen.hpp"
#include "pyroclast/base/error.hpp"

namespace pyroclast {
namespace {

using Sets = std::vector<SetParameters<2>>;

Model<2> with_sets(const Sets& sets) {
  Model<2> model = between_platens(small_specimen(), 0.01, 0.5);
  add_sets(model, sets);
  return model;
}

TEST(Sets, HoldWhatLiesInTheirPlaceBoundsIncluded) {
  const Model<2> model =
      with_sets({{.name = "box", .place = InBox<2>{{{0.0, 0.0}}, {{0.01, 0.02}}}},
                 {.name = "disc", .place = InBall<2>{{{0.0, 0.0}}, 0.02}},
                 {.name = "line", .within = "specimen", .place = OnLine<2>{{{0.0, 0.0}}, {{0.05, 0.0}}}},
                 {.name = "corner", .within = "bottom", .place = NearestTo<2>{{{-1.0, 0.0}}}}});
  for (int g = 0; g < model.gridpoint_count(); ++g) {
    const auto is_in = [&](const char* name) { return std::ranges::count(model.set(name), g) == 1; };
    const Vec<2>& x = model.position[g];
    EXPECT_EQ(is_in("box"), 0.0 <= x[0] && x[0] <= 0.01 && 0.0 <= x[1] && x[1] <= 0.02);
    EXPECT_EQ(is_in("disc"), norm(x) <= 0.02);
    EXPECT_EQ(is_in("line"), x[1] == 0.0 && std::ranges::count(model.set("specimen"), g) > 0);
  }
  ASSERT_EQ(model.set("corner").size(), 1U);
  EXPECT_EQ(model.position[model.set("corner").front()], (Vec<2>{{0.0, 0.0}}));
}

TEST(Sets, OfContactsHoldThoseOnALine) {
  const Model<2> model =
      with_sets({{.name = "section", .of_contacts = true, .place = InBox<2>{{{0.02, 0.0}}, {{0.03, 0.1}}}}});
  const auto& section = model.contact_sets.at("section");
  EXPECT_GT(section.size(), 20U);
  for (int c = 0; c < model.contact_count(); ++c) {
    const double x = model.position[model.contacts[c].a][0];
    EXPECT_EQ(std::ranges::count(section, c), 0.02 <= x && x <= 0.03 ? 1 : 0);
  }
}

TEST(Sets, TributaryAreasAreThoseOfTheFacesThatMeetNoBlock) {
  const Model<2> model = with_sets({});
  const auto total = [&](const char* name) {
    std::vector<int> set = model.set(name);  // lists the gridpoints of both ends of each edge
    std::ranges::sort(set);
    set.erase(std::ranges::unique(set).begin(), set.end());
    const auto areas = tributary_areas(model, set);
    return std::accumulate(areas.begin(), areas.end(), 0.0);
  };
  EXPECT_NEAR(total("left"), 0.1 * 0.5, 1e-12);
  EXPECT_NEAR(total("top_platen_support"), 0.05 * 0.5, 1e-12);
  EXPECT_EQ(total("top"), 0.0);  // the platen lies on it
}

TEST(Sets, WhatIsWrongIsToldWithItsPlace) {
  const auto message = [](const SetParameters<2>& set) -> std::string {
    try {
      with_sets({set});
    } catch (const Error& e) {
      return e.what();
    }
    return "";
  };
  const auto says = [](const std::string& told, const std::string& part) {
    EXPECT_NE(told.find(part), std::string::npos) << told;
  };
  says(message({.name = "far", .place = InBall<2>{{{1.0, 1.0}}, 0.1}, .deck_place = "mine.toml:7"}),
       "mine.toml:7: set \"far\" is empty");
  says(message({.name = "left", .place = Everywhere{}}), "has the name of one");
  says(message({.name = "a", .within = "b", .place = Everywhere{}}),
       "no such set of gridpoints; there are aggregate, bottom");
}

}  // namespace
}  // namespace pyroclast
