#include "pyroclast/model/sets.hpp"

#include <algorithm>
#include <numeric>
#include <set>

#include <gtest/gtest.h>

#include "messages.hpp"
#include "model/small_specimen.hpp"
#include "pyroclast/base/sort_unique.hpp"

namespace pyroclast {
namespace {

using Sets = std::vector<SetParameters>;

ModelOf<2> with_sets(const Sets& sets) {
  ModelOf<2> model = between_platens(small_specimen(), 0.01, 0.5);
  add_sets(model, sets);
  return model;
}

TEST(Sets, HoldWhatLiesInTheirPlaceBoundsIncluded) {
  const ModelOf<2> model =
      with_sets({{.name = "box", .place = InBox{{{0.0, 0.0}}, {{0.01, 0.02}}}},
                 {.name = "disc", .place = InBall{{{0.0, 0.0}}, 0.02}},
                 {.name = "line", .within = "specimen", .place = OnLine{{{0.0, 0.0}}, {{0.05, 0.0}}}},
                 {.name = "corner", .within = "bottom", .place = NearestTo{{{-0.002, 0.0}}}}});
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
  const ModelOf<2> model =
      with_sets({{.name = "section", .of = SetOf::contacts, .place = InBox{{{0.02, 0.0}}, {{0.03, 0.1}}}}});
  const auto& section = model.contact_sets.at("section");
  EXPECT_GT(section.size(), 20U);
  for (int c = 0; c < model.contact_count(); ++c) {
    const double x = model.position[model.contacts[c].a][0];
    EXPECT_EQ(std::ranges::count(section, c), 0.02 <= x && x <= 0.03 ? 1 : 0);
  }
}

TEST(Sets, OfBlocksHoldAllOfThoseWhoseCentroidsLieThere) {
  const ModelOf<2> model =
      with_sets({{.name = "lower",
                  .of = SetOf::blocks,
                  .within = "specimen",
                  .place = InBox{{{0.0, 0.0}}, {{0.05, 0.05}}}},
                 {.name = "middle", .of = SetOf::blocks, .place = NearestTo{{{0.025, 0.05}}}}});
  const auto& lower = model.set("lower");
  const auto zones = zone_geometry(model).volume;
  double area = 0.0;
  for (int block = 0; block < model.block_count(); ++block) {
    const auto count = std::ranges::count_if(lower, [&](int g) { return model.block_of(g) == block; });
    ASSERT_TRUE(count == 0 || count == model.block_gridpoints[block + 1] - model.block_gridpoints[block]);
    if (count == 0) continue;
    EXPECT_FALSE(model.is_of_bearing(block));
    for (int z = model.block_zones[block]; z < model.block_zones[block + 1]; ++z)
      area += zones[z] / model.thickness;
  }
  EXPECT_NEAR(area, 0.05 * 0.05, 0.05 * 0.003);  // but for halves of blocks along its upper bound
  const auto& middle = model.set("middle");
  EXPECT_EQ(
      std::ranges::count_if(middle, [&](int g) { return model.block_of(g) == model.block_of(middle[0]); }),
      std::ssize(middle));
}

TEST(Sets, OfFacesHoldThoseOfTheOutlineAlone) {
  const ModelOf<2> model = with_sets(
      {{.name = "patch", .of = SetOf::faces, .within = "left", .place = InBox{{{0.0, 0.03}}, {{0.01, 0.07}}}},
       {.name = "one", .of = SetOf::faces, .within = "left", .place = NearestTo{{{0.0, 0.05}}}}});
  double low = 1.0, high = 0.0;
  for (int g : model.set("patch")) {
    EXPECT_EQ(model.position[g][0], 0.0);
    low = std::min(low, model.position[g][1]);
    high = std::max(high, model.position[g][1]);
  }
  EXPECT_GE(low, 0.03);
  EXPECT_LE(high, 0.07);
  const auto& patch = model.set("patch");
  const auto areas = tributary_areas(patch, faces_in(model, patch));
  EXPECT_NEAR(std::accumulate(areas.begin(), areas.end(), 0.0), (high - low) * model.thickness, 1e-12);
  EXPECT_GT(*std::ranges::min_element(areas), 0.0);
  EXPECT_EQ(model.set("one").size(), 2U);
}

TEST(Sets, ThereAreThoseOfTheOutlineAndOfTheContacts) {
  const ModelOf<2> model = with_sets({});
  const auto& contacts = model.contact_sets;
  std::size_t of_platens = 0, of_interfaces = 0;
  for (const Contact<2>& contact : model.contacts) of_platens += model.is_of_bearing(contact) ? 1 : 0;
  for (const std::string& name : model.interface_names)
    if (contacts.contains(name)) of_interfaces += contacts.at(name).size();
  EXPECT_EQ(of_interfaces, model.contacts.size());
  EXPECT_EQ(contacts.at("specimen").size(), model.contacts.size() - of_platens);
  EXPECT_EQ(contacts.at("bottom_platen").size() + contacts.at("top_platen").size(), of_platens);
  // a corner of the outline is of two sides, and once of the outline
  constexpr std::size_t kCorners = 4;
  EXPECT_EQ(model.set("outline").size() + kCorners, model.set("left").size() + model.set("right").size() +
                                                        model.set("bottom").size() + model.set("top").size());
  for (const auto& [name, set] : model.sets)
    EXPECT_EQ(std::set<int>(set.begin(), set.end()).size(), set.size()) << name;
}

TEST(Sets, TributaryAreasAreThoseOfTheFacesThatMeetNoBlock) {
  const ModelOf<2> model = with_sets({});
  const auto total = [&](const char* name) {
    std::vector<int> set = model.set(name);  // lists the gridpoints of both ends of each edge
    sort_unique(set);
    const auto areas = tributary_areas(set, faces_in(model, set));
    return std::accumulate(areas.begin(), areas.end(), 0.0);
  };
  EXPECT_NEAR(total("left"), 0.1 * 0.5, 1e-12);
  EXPECT_NEAR(total("top_platen_support"), 0.05 * 0.5, 1e-12);
  EXPECT_EQ(total("top"), 0.0);  // the platen lies on it
}

TEST(Sets, WhatIsWrongIsToldWithItsPlace) {
  const auto refusal = [](const SetParameters& set) { return message([&] { with_sets({set}); }); };
  const auto says = [](const std::string& told, const std::string& part) {
    EXPECT_NE(told.find(part), std::string::npos) << told;
  };
  says(refusal({.name = "far", .place = InBall{{{1.0, 1.0}}, 0.1}, .deck_place = "mine.toml:7"}),
       "mine.toml:7: set \"far\" is empty");
  says(refusal({.name = "left", .place = Everywhere{}}), "has the name of one");
  says(refusal({.name = "a", .within = "b", .place = Everywhere{}}),
       "no such set of gridpoints; there are aggregate, bottom");
}

}  // namespace
}  // namespace pyroclast
