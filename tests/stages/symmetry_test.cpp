// Promise: a half or a quarter of a body between planes of symmetry moves as the whole does, in the plane and
// in space, between platens and by drives; what cannot be such a plane is refused with its place in the deck.

#include <array>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <gtest/gtest.h>

#include "known.hpp"
#include "messages.hpp"
#include "own_folder.hpp"
#include "pyroclast/setup/setup.hpp"
#include "pyroclast/simulation/loop/run.hpp"
#include "stages/small_runs.hpp"

namespace pyroclast {
namespace {

constexpr double kBlock = 0.02;  ///< edge of a block, m
constexpr double kYoung = 30e9, kPoisson = 0.2, kFractureZone = 0.0016;

/// Cells of a plate of equal squares, as a deck reads them.
std::string squares(int across, int up) {
  std::vector<std::string> vertices, cells;
  for (int j = 0; j <= up; ++j)
    for (int i = 0; i <= across; ++i) vertices.push_back(fmt::format("[{}, {}]", i * kBlock, j * kBlock));
  const auto at = [&](int i, int j) { return j * (across + 1) + i; };
  for (int j = 0; j < up; ++j)
    for (int i = 0; i < across; ++i)
      cells.push_back(
          fmt::format("[{}, {}, {}, {}]", at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)));
  return fmt::format(R"({{"phases": ["mortar"], "vertices_m": [{}], "cells": [{}], "phase": [{}]}})",
                     fmt::join(vertices, ", "), fmt::join(cells, ", "),
                     fmt::join(std::vector<int>(cells.size(), 0), ", "));
}

/// The same of cubes, which are drawn out along z.
std::string cubes(int across, int up, int deep) {
  std::vector<std::string> vertices, faces, cells;
  for (int k = 0; k <= deep; ++k)
    for (int j = 0; j <= up; ++j)
      for (int i = 0; i <= across; ++i)
        vertices.push_back(fmt::format("[{}, {}, {}]", i * kBlock, j * kBlock, k * kBlock));
  const auto at = [&](const std::array<int, 3>& v) { return (v[2] * (up + 1) + v[1]) * (across + 1) + v[0]; };
  std::map<std::array<int, 4>, int> known;  // faces by lowest corner and direction
  const auto face = [&](std::array<int, 3> low, int axis) {
    const auto [entry, is_new] =
        known.try_emplace({low[0], low[1], low[2], axis}, static_cast<int>(faces.size()));
    if (is_new) {
      const int b = (axis + 1) % 3, c = (axis + 2) % 3;
      std::array<int, 3> second = low, third = low, fourth = low;
      ++second[b], ++third[b], ++third[c], ++fourth[c];
      faces.push_back(fmt::format("[{}, {}, {}, {}]", at(low), at(second), at(third), at(fourth)));
    }
    return entry->second;
  };
  for (int k = 0; k < deep; ++k)
    for (int j = 0; j < up; ++j)
      for (int i = 0; i < across; ++i) {
        std::vector<int> its;
        for (int axis = 0; axis < 3; ++axis)
          for (int side = 0; side < 2; ++side) {
            std::array<int, 3> low{i, j, k};
            low[axis] += side;
            its.push_back(face(low, axis));
          }
        cells.push_back(fmt::format("[{}]", fmt::join(its, ", ")));
      }
  const double w = across * kBlock, h = up * kBlock;
  return fmt::format(
      R"({{"phases": ["mortar"], "vertices_m": [{}], "faces": [{}], "cells": [{}], "phase": [{}],
"body": {{"axis": "z", "length_m": {}, "section_m": [[0, 0], [{}, 0], [{}, {}], [0, {}]],
"sides": ["bottom", "right", "top", "left"]}}}})",
      fmt::join(vertices, ", "), fmt::join(faces, ", "), fmt::join(cells, ", "),
      fmt::join(std::vector<int>(cells.size(), 0), ", "), deep * kBlock, w, w, h, h);
}

std::string material() {
  return fmt::format(R"([materials.mortar]
E = "{} Pa"
nu = {}
density = "2200 kg/m3"
expansion = "1e-5 1/K"
[materials.platen]
E = "200 GPa"
nu = 0.3
density = "7850 kg/m3"
[contacts]
t_b = "{} m"
t_b_scaling = "fixed"
platen_friction = 0.0
[contacts.mortar_mortar]
)",
                     kYoung, kPoisson, kFractureZone) +
         strong_bond() + resting_mechanics("9.81 m/s2");
}

const std::string kPress = R"([platens]
thickness = "10 mm"
[heat]
field = "uniform"
initial = "20 degC"
[coupling]
exchange_increment = "20 K"
unbalanced_ratio = 1e-4
platen_difference = "0.02 MPa"
least_cycles = 200
most_cycles = 20000
failure_strain = 0.01
predictor = true
[[stages]]
kind = "settle"
unbalanced_ratio = 1e-4
most_steps = 100000
[[stages]]
kind = "load"
stress = "3 MPa"
ramp_time = "20 ms"
unbalanced_ratio = 1e-5
most_steps = 100000
[[stages]]
kind = "heat"
to = "60 degC"
rate = "5 K/min"
platen = "force"
[output]
history_strain = 1e-5
frame_strain = 1e-3
)";

/// Blocks as a file, in the deck's own folder, and the table of the specimen made of it.
std::string specimen(const std::string& blocks, int dimension, const std::string& symmetry) {
  const auto file =
      own_folder() / fmt::format("symmetry_{}_{}.json", dimension, std::hash<std::string>()(blocks));
  std::ofstream(file) << blocks;
  return fmt::format("title = \"symmetry\"\n[specimen]\nshape = \"{}\"\nfile = \"{}\"\nsymmetry = [{}]\n",
                     dimension == 2 ? "cells" : "polyhedra", file.string(), symmetry);
}

struct Pressed {
  explicit Pressed(const std::string& table) {
    Setup setup = read_setup(Deck::parse(table + material() + kPress, "deck.toml"), ".");
    simulation = make_simulation(setup, std::make_shared<Team>(1));
    Run run(*simulation, std::move(setup.stages));
    EXPECT_EQ(run.run(), Outcome::completed);
    const auto change = [&](int stage, const char* column) {
      const auto at_end = [&](int s) {
        return run.history().cell(run.courses()[s].rows.last - 1, column).value();
      };
      return at_end(stage) - at_end(stage - 1);
    };
    loaded = change(1, "specimen_strain");
    widened = change(1, "lateral_strain");
    heated = change(2, "specimen_strain");
    widened_hot = change(2, "lateral_strain");
  }
  /// Largest displacement out of a plane of symmetry, m.
  double left_plane(const std::string& side) const {
    double most = 0.0;
    for (const PlaneOfSymmetry& plane : simulation->model().symmetry)
      if (plane.side == side)
        for (const int g : simulation->model().set(plane.set())) {
          most = std::max(most, std::abs(simulation->motion().read().displacement(g)[plane.component]));
          EXPECT_TRUE(simulation->motion().read().is_prescribed(g, plane.component));
        }
    return most;
  }

  std::unique_ptr<Simulation> simulation;
  double loaded = 0.0, widened = 0.0, heated = 0.0, widened_hot = 0.0;
};

void expect_alike(const Pressed& part, const Pressed& whole, int up, const std::string& what) {
  const double stress = 3e6, stiffness = kYoung / kFractureZone;
  const double strain = stress * (1.0 / kYoung + (up - 1) / (up * kBlock * stiffness));
  expect_known({fmt::format("Strain of {} under pressure, its planes of symmetry held", what),
                "blocks and contacts in series", "1"},
               part.loaded, strain, 1e-3 * strain);
  const double widening = stress * kPoisson / kYoung;
  EXPECT_NEAR(part.widened, widening, 2e-3 * widening);
  EXPECT_NEAR(part.loaded, whole.loaded, 1e-3 * strain);
  EXPECT_NEAR(part.widened, whole.widened, 2e-3 * widening);
  EXPECT_NEAR(part.heated, -4e-4, 2e-6);
  EXPECT_NEAR(part.widened_hot, 4e-4, 2e-6);
}

TEST(SymmetryVerification, AHalfInThePlaneIsAsTheWhole) {
  const Pressed whole(specimen(squares(4, 4), 2, "")), half(specimen(squares(2, 4), 2, "\"left\""));
  expect_alike(half, whole, 4, "half of a plate");
  EXPECT_LT(half.left_plane("left"), 1e-15);
  // platens end in the plane too, each with three rows
  EXPECT_EQ(half.simulation->model().set("left_symmetry").size(),
            half.simulation->model().set("left").size() + 2 * 3);
}

TEST(SymmetryVerification, AQuarterInSpaceIsAsTheWhole) {
  const Pressed whole(specimen(cubes(4, 3, 4), 3, ""));
  const Pressed quarter(specimen(cubes(2, 3, 2), 3, "\"left\", \"back\""));
  expect_alike(quarter, whole, 3, "a quarter of a block in space");
  EXPECT_LT(quarter.left_plane("left"), 1e-15);
  EXPECT_LT(quarter.left_plane("back"), 1e-15);
  const Pressed half(specimen(cubes(2, 3, 2), 3, "\"right\""));
  expect_alike(half, whole, 3, "half of a block in space");
}

const std::string kPulled = R"([[stages]]
kind = "drive"
duration = "0.2 s"
[[stages.drives]]
set = "bottom"
hold = ["y"]
)";

/// What reading a deck, or making its run, refuses.
std::string refused(const std::string& symmetry, const std::string& drives) {
  std::string text = specimen(cubes(2, 2, 2), 3, symmetry) + material() + drives;
  const std::string platen = "platen_friction = 0.0\n", steel = "[materials.platen]";
  text.erase(text.find(platen), platen.size());
  text.erase(text.find(steel), text.find("[contacts]") - text.find(steel));
  return message([&] {
    Setup setup = read_setup(Deck::parse(text, "deck.toml"), ".");
    const auto simulation = make_simulation(setup, std::make_shared<Team>(1));
    Run run(*simulation, std::move(setup.stages));
  });
}

TEST(Symmetry, CountsAsASupport) {
  EXPECT_EQ(refused("\"left\", \"front\"", kPulled), "no Error was thrown");
  EXPECT_NE(refused("\"left\"", kPulled).find("nothing holds the body against moving along z"),
            std::string::npos);
}

TEST(Symmetry, WhatActsAgainstItIsRefused) {
  const std::string moved = kPulled + "[[stages.drives]]\nset = \"left\"\n";
  EXPECT_NE(refused("\"left\", \"front\"", moved + "velocity = \"1 mm/s\"\ndirection = \"x\"\n")
                .find("set \"left_symmetry\" (deck.toml:5: specimen.symmetry)"),
            std::string::npos);
  EXPECT_NE(refused("\"left\", \"front\"",
                    kPulled + "[[stages.drives]]\nset = \"left_symmetry\"\nrelease = [\"x\"]\n")
                .find("lies in a plane of symmetry"),
            std::string::npos);
  EXPECT_NE(refused("\"left\", \"front\"", moved + "pressure = \"1 MPa\"\n").find("all of which is held"),
            std::string::npos);
}

TEST(Symmetry, WhatIsNoPlaneIsRefused) {
  EXPECT_NE(refused("\"rim\"", kPulled).find("must name sides, bottom, right, top, left, front, back"),
            std::string::npos);
  EXPECT_NE(refused("\"left\", \"right\"", kPulled).find("face each other"), std::string::npos);
  EXPECT_NE(refused("\"left\", \"left\"", kPulled).find("twice"), std::string::npos);
  const auto read = [](const std::string& text) {
    return message([&] { read_setup(Deck::parse(text + material() + kPress, "deck.toml"), "."); });
  };
  EXPECT_NE(read(specimen(squares(2, 2), 2, "\"top\"")).find("\"top\" is pressed by top_platen"),
            std::string::npos);
  const auto heated = [](const std::string& faces) {
    return message([&] {
      read_setup(Deck::parse(R"DECK(title = "wall"
[specimen]
width = "60 mm"
height = "40 mm"
seed = 1
symmetry = ["left"]
[blocks]
count = 20
shortest_edge = 0.2
[materials.mortar]
density = "2200 kg/m3"
conductivity = "1.5 W/(m K)"
specific_heat = "1000 J/(kg K)"
[heat]
field = "conduction"
initial = "20 degC"
[[heat.boundaries]]
faces = ")DECK" + faces + R"DECK("
kind = "temperature"
temperature = "30 degC"
[[stages]]
kind = "conduct"
duration = "1 h"
interval = "1 h"
[output]
frame_interval = "1 h"
)DECK",
                             "deck.toml"),
                 ".");
    });
  };
  EXPECT_NE(heated("left").find("no heat flows through \"left\""), std::string::npos);
  EXPECT_NE(heated("outline").find("name the other sides"), std::string::npos);
}

}  // namespace
}  // namespace pyroclast
