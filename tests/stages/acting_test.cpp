// What holds and loads a body: sets that share gridpoints, loads that share a set, and what records say of
// them.
#include <algorithm>
#include <cmath>
#include <fstream>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "messages.hpp"
#include "stages/drives.hpp"

namespace pyroclast {
namespace {

const std::string kForces = record("bottom_x", "force", "set = \"bottom\"\ndirection = \"x\"") +
                            record("bottom_y", "force", "set = \"bottom\"\ndirection = \"y\"") +
                            record("left_x", "force", "set = \"left\"\ndirection = \"x\"") +
                            record("left_y", "force", "set = \"left\"\ndirection = \"y\"") +
                            record("corner_x", "displacement", "set = \"corner\"\ndirection = \"x\"");
const std::string kCorner =
    "[[sets]]\nname = \"corner\"\nwithin = \"bottom\"\nnearest = [\"0 mm\", \"0 mm\"]\n";
const std::string kAtRest = "duration = \"2 s\"\nunbalanced_ratio = 1e-9";
const std::string kBottom = does("bottom", "hold = [\"x\", \"y\"]");
const std::string kPush = does("right", "pressure = \"0.1 MPa\"\nramp_time = \"20 ms\"");

std::string body(const std::string& stages) {
  return free_deck(kUniform + kCorner + kForces + stages);
}

std::string refused(const std::string& stages) {
  return message([&] { const Trial trial(body(stages)); });
}

bool says(const std::string& text, const std::string& words) {
  return text.find(words) != std::string::npos;
}

// Promise: loads on one set add up, as vectors, in any order; as they would on two sets of the same faces.
TEST(Acting, LoadsOnOneSetAddUp) {
  const std::string top2 = "[[sets]]\nname = \"top2\"\nwithin = \"top\"\n";
  const auto bottom = [&](const std::string& one, const std::string& other) {
    const Finished run(body(top2 + drive(kAtRest, kBottom + one + other)));
    return std::pair(run.last("bottom_x_N"), run.last("bottom_y_N"));
  };
  const auto pressure = [](const std::string& set, int size) {
    return does(set, fmt::format("pressure = \"{} MPa\"\nramp_time = \"20 ms\"", size));
  };
  const double both = 3e6 * kWidth;
  EXPECT_NEAR(bottom(pressure("top", 1), pressure("top", 2)).second, both, 1e-4 * both);
  EXPECT_NEAR(bottom(pressure("top", 2), pressure("top", 1)).second, both, 1e-4 * both);
  EXPECT_NEAR(bottom(pressure("top", 1), pressure("top2", 2)).second, both, 1e-4 * both);
  const std::string down = "force = \"20 kN\"\ndirection = [0, -1]\nramp_time = \"20 ms\"";
  const std::string aslant = "force = \"10 kN\"\ndirection = [1, -1]\nramp_time = \"20 ms\"";
  const double share = 10e3 / std::sqrt(2.0);
  for (const auto& [x, y] :
       {bottom(does("top", down), does("top", aslant)), bottom(does("top", aslant), does("top", down)),
        bottom(does("top", down), does("top2", aslant))}) {
    EXPECT_NEAR(x, -share, 1e-4 * share);
    EXPECT_NEAR(y, 20e3 + share, 3.0);
  }
  EXPECT_NEAR(bottom(does("top", down), does("top", down)).second, 40e3, 4.0);
}

// Promise: a later stage takes the place of what it states, along its directions; what stands across them
// stays.
TEST(Acting, ALaterLoadTakesThePlaceOfEarlierOnesAlongIt) {
  const auto force = [](const std::string& size, const std::string& direction) {
    return does("top", "force = \"" + size + "\"\ndirection = " + direction + "\nramp_time = \"20 ms\"");
  };
  const Finished run(body(drive(kAtRest, kBottom + force("20 kN", "[0, -1]") + force("10 kN", "[1, 0]")) +
                          drive(kAtRest, force("5 kN", "[0, -1]") + force("1 kN", "[0, -1]"))));
  EXPECT_NEAR(run.last("bottom_x_N"), -10e3, 2.0);
  EXPECT_NEAR(run.last("bottom_y_N"), 6e3, 2.0);
}

// Promise: a component of a gridpoint is held while any set holds it, whoever else lets go of it.
TEST(Acting, ACornerIsHeldWhileOneOfItsSetsHoldsIt) {
  const std::string left = does("left", "hold = [\"x\"]"), release = does("left", "release = [\"x\"]");
  const Finished one(body(drive("duration = \"20 ms\"", kBottom + left) + drive(kAtRest, release + kPush)));
  const Finished other(body(drive("duration = \"20 ms\"", left + kBottom) + drive(kAtRest, kPush + release)));
  EXPECT_EQ(one.last("corner_x_m"), 0.0);
  EXPECT_NEAR(one.last("bottom_x_N"), 1e5 * kHeight, 20.0);
  for (const auto* name : {"bottom_x_N", "bottom_y_N", "corner_x_m"})
    EXPECT_EQ(other.last(name), one.last(name));
}

// Promise: what contradicts itself is refused with both places, in one stage or over several.
TEST(Acting, UnlikeHoldsAreRefused) {
  const std::string moved = does("left", "velocity = \"0.1 mm/s\"\ndirection = \"x\"");
  const std::string up = does("top", "hold = [\"y\"]");
  for (const std::string& text :
       {refused(drive("duration = \"1 s\"", kBottom + moved)),
        refused(drive("duration = \"1 s\"", moved + kBottom)),
        refused(drive("duration = \"1 s\"", kBottom) + drive("duration = \"1 s\"", moved))}) {
    EXPECT_TRUE(says(text, "and both are held or driven along x, in different ways")) << text;
    EXPECT_EQ(std::ranges::count(text, '('), 1) << text;
    EXPECT_TRUE(says(text, "deck.toml:")) << text;
  }
  // what moves alike, and what came to rest, is no contradiction
  EXPECT_EQ(refused(drive("duration = \"1 s\"",
                          up + moved + does("corner", "velocity = \"0.1 mm/s\"\ndirection = \"x\""))),
            "no Error was thrown");
  EXPECT_EQ(refused(drive("duration = \"1 s\"", up + moved) + drive("duration = \"1 s\"", kBottom)),
            "no Error was thrown");
  EXPECT_TRUE(says(refused(drive("duration = \"1 s\"", does("left", "release = [\"x\"]") + kBottom)),
                   "is neither held nor driven so: nothing holds it"));
  EXPECT_TRUE(says(refused(drive("duration = \"1 s\"", kBottom) +
                           drive("duration = \"1 s\"", does("corner", "release = [\"x\"]"))),
                   "another set holds the body there (deck.toml:"));
  EXPECT_TRUE(says(
      refused(drive("duration = \"1 s\"", kBottom + does("left", "force = \"1 kN\"\ndirection = [1, 0]")) +
              drive("duration = \"1 s\"", does("left", "velocity = \"1 mm/s\"\ndirection = \"x\""))),
      "end the force by one of 0 N"));
}

// Promise: what a later stage cannot do is refused before the first.
TEST(Acting, APressureWithoutAFaceIsRefusedBeforeTheRun) {
  const std::string inside =
      "[[sets]]\nname = \"inside\"\nbox = [[\"20 mm\", \"40 mm\"], [\"40 mm\", \"80 mm\"]]\n";
  EXPECT_TRUE(says(refused(inside + drive("duration = \"1 s\"", kBottom) +
                           drive("duration = \"1 s\"", does("inside", "pressure = \"1 MPa\""))),
                   "a pressure acts on faces that meet no other block, but set \"inside\" has none"));
}

// Promise: a reaction belongs to the sets that hold the component, alike to several; those of all sets are
// all there is.
TEST(Acting, ReactionsAreShared) {
  const std::string left = does("left", "hold = [\"x\"]");
  const auto check = [&](const std::string& held, bool left_shares) {
    const Finished run(
        body(drive(kAtRest, held + kPush + does("top", "pressure = \"2 MPa\"\nramp_time = \"20 ms\""))));
    const Motion& motion = run.simulation->motion();
    Vec<2> all{};
    for (int g = 0; g < run.simulation->model().gridpoint_count(); ++g)
      for (const int c : {0, 1})
        if (motion.read().is_prescribed(g, c)) all[c] -= motion.read().force(g)[c];
    EXPECT_NEAR(run.last("bottom_x_N") + run.last("left_x_N"), all[0], 1e-12 * std::abs(all[0]));
    EXPECT_NEAR(run.last("bottom_y_N") + run.last("left_y_N"), all[1], 1e-12 * std::abs(all[1]));
    EXPECT_NEAR(all[0], 1e5 * kHeight, 5.0);
    EXPECT_EQ(run.last("left_y_N"), 0.0);  // the corner's belongs to the bottom, which holds it
    const int corner = run.simulation->model().set("corner").front();
    const double bottom_alone = -motion.read().force(corner)[0];
    if (left_shares) {
      EXPECT_EQ(run.simulation->supports().holders(corner, 0), 2);
      EXPECT_NE(bottom_alone, 0.0);
    }
  };
  check(kBottom + left, true);
  check(does("bottom", "hold = [\"y\"]") + left, false);
}

/// 60 mm by 20 mm of cells: 20 columns of 0.5 mm, then 5 of 10 mm; where they stand.
std::string graded_cells() {
  std::vector<double> x;
  for (int i = 0; i <= 20; ++i) x.push_back(5e-4 * i);
  for (int i = 2; i <= 6; ++i) x.push_back(1e-2 * i);
  std::string vertices, cells, phases;
  for (int row = 0; row <= 2; ++row)
    for (const double at : x)
      vertices += fmt::format("{}[{}, {}]", vertices.empty() ? "" : ", ", at, 1e-2 * row);
  const int width = static_cast<int>(x.size());
  for (int row = 0; row < 2; ++row)
    for (int i = 0; i + 1 < width; ++i) {
      const int first = row * width + i;
      cells += fmt::format("{}[{}, {}, {}, {}]", cells.empty() ? "" : ", ", first, first + 1,
                           first + width + 1, first + width);
      phases += phases.empty() ? "0" : ", 0";
    }
  const std::string path = ::testing::TempDir() + "graded.json";
  std::ofstream(path) << "{\"phases\": [\"mortar\"], \"vertices_m\": [" << vertices << "], \"cells\": ["
                      << cells << "], \"phase\": [" << phases << "]}";
  return path;
}

// Promise: the mean of a set is that over its area or its length, however fine its blocks are in one place.
// Records of temperature are there where nothing moves, too; others are refused there.
TEST(Acting, MeansAreOverAreaOrLength) {
  const std::string text = fmt::format(R"DECK(title = "heat"
[specimen]
shape = "cells"
file = "{}"
[materials.mortar]
density = "2200 kg/m3"
conductivity = "1.5 W/(m K)"
specific_heat = "1000 J/(kg K)"
[heat]
field = "conduction"
[[heat.boundaries]]
faces = "left"
kind = "temperature"
temperature = "20 degC"
[[heat.boundaries]]
faces = "right"
kind = "temperature"
temperature = "120 degC"
[[stages]]
kind = "conduct"
duration = "10 h"
interval = "5 h"
[output]
frame_interval = "10 h"
)DECK",
                                       graded_cells());
  const std::string records = record("whole", "temperature", "set = \"specimen\"") +
                              record("side", "temperature", "set = \"top\"") +
                              record("points", "temperature", "set = \"top\"\nover = \"gridpoints\"");
  const Finished run(text + records);
  EXPECT_NEAR(run.last("whole_degC"), 70.0, 1e-3);
  EXPECT_NEAR(run.last("side_degC"), 70.0, 1e-3);
  EXPECT_LT(run.last("points_degC"), 45.0);
  EXPECT_TRUE(says(message([&] {
                     const Trial trial(text +
                                       record("u", "displacement", "set = \"top\"\ndirection = \"x\""));
                   }),
                   "no stage moves the body"));
  EXPECT_TRUE(
      says(message([&] { const Trial trial(text + record("w", "temperature", "set = \"nonsense\"")); }),
           "there is no such set of gridpoints"));
}

}  // namespace
}  // namespace pyroclast
