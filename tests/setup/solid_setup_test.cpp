// Promise: a deck becomes one of a solid by its depth or as a cylinder, its places have three coordinates or
// stand for all z, and what a solid cannot have is refused with the line to write.
#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "decks.hpp"
#include "messages.hpp"
#include "pyroclast/model/sets.hpp"
#include "pyroclast/setup/setup.hpp"
#include "pyroclast/simulation/loop/run.hpp"
#include "pyroclast/specimen/stone_fit.hpp"
#include "stages/result_of.hpp"

namespace pyroclast {
namespace {

Setup read(const std::string& deck) {
  return read_setup(Deck::parse(deck, "deck.toml"), ".");
}

std::string message(const std::string& text) {
  return pyroclast::message([&] { read(text); });
}

/// The starter of few blocks, as it stands in the plane.
std::string plane() {
  return with(shipped_case("starter"), "count = 1000", "count = 60");
}

/// The same as a solid: one line is another.
std::string solid() {
  return with(plane(), "thickness = \"1 m\"", "depth = \"150 mm\"");
}

std::string cylinder() {
  return with(with(with(plane(), "thickness = \"1 m\"", "shape = \"cylinder\""), "width", "diameter"),
              "seed = 1", "seed = 2");
}

std::string with_more(const std::string& deck, const std::string& tables) {
  return deck + "\n" + tables;
}

/// Corners of a body, each three digits in m.
std::string corners(const std::string& digits) {
  std::string list;
  for (std::size_t i = 0; i + 2 < digits.size(); i += 4)
    list += fmt::format("[\"{} m\", \"{} m\", \"{} m\"], ", digits[i], digits[i + 1], digits[i + 2]);
  return "corners = [" + list + "]";
}

/// The solid with a body of its own.
std::string with_body(const std::string& shape) {
  return with_more(with(solid(), "safety = 0.9", "safety = 0.9\ncontacts = \"found\""),
                   "[[bodies]]\nname = \"body\"\nfriction = 0.3\n" + shape + "\n");
}

/// A deck whose stones have a shape.
std::string shaped(const std::string& deck, const std::string& shape) {
  return with(deck, "[blocks]", "[aggregates.grain_shape]\n" + shape + "\n\n[blocks]");
}

// Promise: a deck whose blocks follow stones of a shape makes a body with the stones' volume, each of its own
// blocks.
TEST(SolidDeck, BlocksFollowStonesOfAShape) {
  for (const char* const shape : {"kind = \"ellipse\"\nelongation = [1.2, 1.6]\nflatness = [1, 1.3]",
                                  "kind = \"harmonics\"\nelongation = [1, 1.4]\nroughness = [0.02, 0.05]"}) {
    std::string deck = shaped(shipped_case("starter_3d"), shape);
    const auto begin = deck.find("rule = \"each\"");
    deck.replace(begin, std::string("rule = \"each\"").size(), "rule = \"follow\"");
    const auto simulation = make_simulation(read(with(deck, "count = 3000", "count = 1000")));
    const auto& made = std::get<specimen::Specimen<3>>(*simulation->specimen());
    EXPECT_EQ(made.cells.cells.size(), 1000U) << shape;
    EXPECT_NEAR(made.fraction_of_stones, made.fraction_placed, 0.03 * made.fraction_placed) << shape;
    EXPECT_TRUE(std::ranges::all_of(made.stones, [](const auto& stone) { return stone.shape != nullptr; }));
    for (const auto& fit : specimen::fits_of(made)) EXPECT_GE(fit.blocks, 1) << shape;
  }
}

// Promise: where vertices that lie nearly in one place are joined, so that a cell meets a corner twice or
// cannot be cut into zones, its seed is drawn anew.
TEST(SolidDeck, SeedsOfCellsThatCannotBeBlocksAreDrawnAnew) {
  std::string deck = with(shipped_case("cube_3d"), "rule = \"each\"", "rule = \"follow\"");
  for (const char* const side : {"width", "height", "depth"})
    deck = with(deck, std::string(side) + " = \"100 mm\"", std::string(side) + " = \"60 mm\"");
  deck = with(deck, "d_min = \"16 mm\"", "d_min = \"22 mm\"");
  deck = with(deck, "sieves = [\"20 mm\"]", "sieves = []");
  deck = with(deck, "count = 1900", "count = 400");
  for (const int seed : {35, 37}) {
    const auto simulation = make_simulation(read(with(deck, "seed = 1", "seed = " + std::to_string(seed))));
    const auto& made = std::get<specimen::Specimen<3>>(*simulation->specimen());
    EXPECT_GE(made.metrics.seeds_redrawn, 1) << seed;
    EXPECT_NEAR(made.fraction_of_stones, made.fraction_placed, 0.03 * made.fraction_placed) << seed;
  }
}

// Promise: where surfaces of two stones come together, no edge is left that is far shorter than a block.
TEST(SolidDeck, StonesThatNearlyTouchLeaveNoFlatZones) {
  std::string deck = with(shipped_case("compression_3d"), "rule = \"area\"", "rule = \"follow\"");
  deck = with(deck, "covered_fraction = 0.46", "");
  deck = with(deck, "fraction = 0.34", "fraction = 0.31");
  deck = with(deck, "\"12.5 mm\", \"16 mm\", \"20 mm\", \"25 mm\"", "");
  deck = with(deck, "diameter = \"75 mm\"", "diameter = \"40 mm\"");
  deck = with(deck, "height = \"150 mm\"", "height = \"40 mm\"");
  deck = with(deck, "count = 10000", "count = 300");
  deck = with(deck, "d_max = \"32 mm\"", "d_max = \"12 mm\"");
  for (const int seed : {2, 3}) {
    const auto simulation = make_simulation(read(with(deck, "seed = 1", "seed = " + std::to_string(seed))));
    const auto& made = std::get<specimen::Specimen<3>>(*simulation->specimen());
    EXPECT_GT(made.metrics.lowest_zone, 2e-3 * 0.0055) << seed;  // blocks are of 5.5 mm
  }
}

TEST(SolidDeck, OneLineMakesASolidOfADeckWithoutPlaces) {
  for (const char* const name : {"starter", "compression", "hot_compression", "hot_strength"}) {
    const std::string deck = shipped_case(name);
    const auto line = deck.find("thickness = \"1 m\"");
    ASSERT_NE(line, std::string::npos) << name;
    const auto setup = read(with(deck, "thickness = \"1 m\"", "depth = \"150 mm\""));
    EXPECT_EQ(setup.specimen.dimension(), 3) << name;
    EXPECT_NEAR(setup.specimen.extent(), 0.15 * 0.3 * 0.15, 1e-15) << name;
    EXPECT_EQ(specimen::names_of(setup.specimen.sides()),
              (std::vector<std::string>{"bottom", "right", "top", "left", "front", "back"}));
  }
}

TEST(SolidDeck, ACylinderHasTheAreaOfItsCircle) {
  const auto setup = read(cylinder());
  const double circle = 0.25 * std::numbers::pi * 0.15 * 0.15;
  EXPECT_NEAR(setup.specimen.extent(), circle * 0.3, 1e-12 * circle);
  EXPECT_GE(setup.specimen.prism()->section().pieces().size(), 24U);
  EXPECT_EQ(specimen::names_of(setup.specimen.sides()), (std::vector<std::string>{"rim", "bottom", "top"}));
  // of fine blocks the sides are about a block long
  const auto fine = read(with(cylinder(), "count = 60", "size = \"2 mm\""));
  EXPECT_NEAR(0.15 * std::numbers::pi / fine.specimen.prism()->section().pieces().size(), 2e-3, 5e-5);
}

TEST(SolidDeck, DiscsAndPolygonsAreDrawnOut) {
  const auto of_shape = [](const std::string& shape) {
    return with(with(solid(), "width = \"150 mm\"", shape), "height = \"300 mm\"", "");
  };
  const auto without_platens = [](std::string deck) {
    deck = deck.substr(0, deck.find("[[stages]]"));
    deck.erase(deck.find("[materials.platen]"), deck.find("[contacts]") - deck.find("[materials.platen]"));
    return with(deck, "platen_friction = 0.0", "#") +
           "[[stages]]\nkind = \"drive\"\nduration = \"1 ms\"\n[[stages.drives]]\nset = \"front\"\n"
           "hold = [\"x\", \"y\", \"z\"]\n[output]\n";
  };
  const auto disc = read(without_platens(of_shape("shape = \"disc\"\ndiameter = \"150 mm\"")));
  EXPECT_NEAR(disc.specimen.extent(), 0.25 * std::numbers::pi * 0.15 * 0.15 * 0.15, 1e-12);
  const auto triangle =
      read(without_platens(of_shape("shape = \"polygon\"\ncorners = [[\"0 mm\", \"0 mm\"], [\"200 mm\", \"0 "
                                    "mm\"], [\"0 mm\", \"150 mm\"]]")));
  EXPECT_NEAR(triangle.specimen.extent(), 0.5 * 0.2 * 0.15 * 0.15, 1e-15);
  EXPECT_EQ(triangle.specimen.sides().back().name, "back");
}

TEST(SolidDeck, BlocksAreToldByTheirNumberOrTheirSize) {
  EXPECT_EQ(read(with(solid(), "count = 60", "size = \"15 mm\"")).specimen.blocks.count, 2000);
  EXPECT_NEAR(read(with(solid(), "count = 60", "count = 2000")).specimen.block_size(), 0.015, 1e-12);
}

TEST(SolidDeck, WhatItCannotHaveIsRefusedWithItsPlace) {
  struct Refused {
    std::string deck;
    std::vector<const char*> words;
  };
  const std::string notch =
      "[[specimen.notches]]\nmouth = [\"75 mm\", \"0 mm\"]\ntip = [\"75 mm\", \"50 mm\"]\n";
  const std::string ring = "shape = \"ring\"\ndiameter = \"200 mm\"\ninner_diameter = \"50 mm\"";
  const std::vector<Refused> all{
      {with(plane(), "seed = 1", "seed = 1\ndepth = \"150 mm\""), {"specimen.thickness", "beside depth"}},
      {with(cylinder(), "shape = \"cylinder\"", "shape = \"cylinder\"\nthickness = \"1 m\""),
       {"specimen.thickness", "a cylinder is a solid"}},
      {with(cylinder(), "shape = \"cylinder\"", "shape = \"cylinder\"\ndepth = \"1 m\""),
       {"specimen.depth", "diameter and a height"}},
      {with(with(solid(), "width = \"150 mm\"", ring), "height = \"300 mm\"", ""),
       {"specimen.depth", "hole"}},
      {with(cylinder(), "[aggregates]", notch + "[aggregates]"), {"specimen.notches", "shape = \"disc\""}},
      {with(solid(), "[aggregates]", notch + "[aggregates]"),
       {"specimen.notches[0].width", "must be above 0 in a solid"}},
      {with(solid(), "relaxation = 0", "relaxation = 5"), {"blocks.relaxation", "relaxation = 0"}},
      {with(solid(), "count = 60", "file = \"a.tess\""), {"blocks.file", "count or size"}},
      {shaped(solid(), "kind = \"ellipse\"\nelongation = [1, 2]"),
       {"superposition.rule", "rule = \"follow\" or rule = \"centroid\""}},
      {shaped(solid(), "kind = \"polygon\"\nelongation = [1, 2]\ncorners = [3, 8]"),
       {"aggregates.grain_shape.corners", "4"}},
      {shaped(solid(), "kind = \"ellipse\"\nelongation = [1, 2]\norientation = [\"0 deg\", \"9 deg\"]"),
       {"aggregates.grain_shape.orientation", "leave the key out"}},
      {with(plane(), "[blocks]", "[aggregates.surfaces]\nobj = \"a.obj\"\n\n[blocks]"),
       {"aggregates.surfaces", "a plane takes outlines"}},
      {with(solid(), "[blocks]", "[aggregates.outlines]\ncsv = \"a.csv\"\n\n[blocks]"),
       {"aggregates.outlines", "a solid takes surfaces"}},
      {shaped(plane(), "kind = \"ellipse\"\nelongation = [1, 2]\nflatness = [1, 2]"),
       {"aggregates.grain_shape.flatness", "stones of a solid"}},
      {with_body(corners("000 100 010")),
       {"bodies[0].corners", "a list of 4 or more places, [[\"150 mm\", \"150 mm\", \"150 mm\"], ...]"}},
      {with_body(corners("000 100 010 110")), {"bodies[0].corners", "must not all lie in one plane"}},
      {with_body(corners("000 900 090 221 009")),
       {"bodies[0].corners", "number 4 (from 1), (2, 2, 1) m, lies in the hull of the others"}},
      {with_body("centre = [\"0 m\", \"0 m\"]\ndiameter = \"1 m\""), {"bodies[0].centre", "\"0.075 m\"]"}},
      {with_more(solid(),
                 "[[bearings]]\nname = \"strip\"\nat = [\"0 mm\", \"150 mm\"]\nwidth = \"20 mm\"\n"
                 "thickness = \"10 mm\"\nmaterial = \"platen\"\ncontact = \"glued\"\n"),
       {"bearings[0].at", "all of bottom, right, top, left, front, back"}},
      {with_more(solid(),
                 "[[bearings]]\nname = \"strip\"\nat = [\"0 mm\", \"1 mm\", \"2 mm\", \"3 mm\"]\n"
                 "width = \"20 mm\"\nthickness = \"10 mm\"\ncontact = \"glued\"\n"),
       {"bearings[0].at", "[\"150 mm\", \"150 mm\", \"150 mm\"] is needed, not a list of 4"}},
      {with_more(plane(),
                 "[[bearings]]\nname = \"strip\"\nat = [\"0 mm\", \"1 mm\", \"2 mm\"]\nwidth = \"20 mm\"\n"
                 "thickness = \"10 mm\"\ncontact = \"glued\"\n"),
       {"bearings[0].at", "no z"}},
      {with_more(cylinder(),
                 "[[bearings]]\nname = \"band\"\nside = \"rim\"\nthickness = \"10 mm\"\n"
                 "contact = \"glued\"\n"),
       {"bearings[0].side", "one of bottom, top"}},
      {with_more(solid(),
                 "[[bearings]]\nname = \"more\"\nside = \"top\"\nthickness = \"10 mm\"\n"
                 "contact = \"glued\"\n"),
       {"bearings[0].side", "lies on \"top\" already"}},
      {with_more(solid(), "[[record]]\nname = \"c\"\nkind = \"crack_length\"\nset = \"cracks\"\n"),
       {"record[0].kind", "kind = \"crack_area\""}},
      {with_more(plane(), "[[record]]\nname = \"c\"\nkind = \"crack_area\"\nset = \"cracks\"\n"),
       {"record[0].kind", "kind = \"crack_length\""}},
      {with_more(plane(),
                 "[[record]]\nname = \"u\"\nkind = \"displacement\"\nset = \"top\"\ndirection = \"z\"\n"),
       {"record[0].direction", "\"x\""}},
      {with_more(solid(), "[[sets]]\nname = \"a\"\nnearest = [\"75 mm\", \"150 mm\"]\n"),
       {"sets[0].nearest", "nearest = [\"0.075 m\", \"0.15 m\", \"0.075 m\"]"}},
      {with_more(solid(), "[[sets]]\nname = \"a\"\ncentre = [\"75 mm\", \"150 mm\"]\nradius = \"9 mm\"\n"),
       {"sets[0].centre", "centre = [\"0.075 m\", \"0.15 m\", \"0.075 m\"]"}},
      {with_more(solid(),
                 "[[sets]]\nname = \"a\"\nbox = [[\"0 mm\", \"0 mm\"], [\"9 mm\", \"9 mm\", \"9 mm\"]]\n"),
       {"sets[0].box", "all z"}},
      {with_more(plane(), "[[sets]]\nname = \"a\"\nnearest = [\"75 mm\", \"150 mm\", \"0 mm\"]\n"),
       {"sets[0].nearest", "no z"}},
  };
  for (const auto& [deck, words] : all) {
    const std::string complaint = message(deck);
    expect_in("deck.toml:", complaint);
    for (const char* const word : words) expect_in(word, complaint);
  }
  EXPECT_EQ(message(solid()), "no Error was thrown");
  EXPECT_EQ(message(cylinder()), "no Error was thrown");
}

TEST(SolidDeck, AnUnknownShapeIsTheOnlyError) {
  const std::string complaint = message(with(cylinder(), "shape = \"cylinder\"", "shape = \"cone\""));
  expect_in("specimen.shape = \"cone\": must be one of", complaint);
  EXPECT_EQ(std::ranges::count(complaint, '\n'), 0) << complaint;
}

TEST(SolidDeck, FormulasKnowADepthButNoThicknessOfACylinder) {
  const std::string drive =
      "[[stages]]\nkind = \"drive\"\nduration = \"1 ms\"\n[[stages.drives]]\nset = \"front\"\n"
      "hold = [\"x\", \"y\", \"z\"]\n[[stages.results]]\nname = \"X\"\nkind = \"formula\"\n"
      "formula = \"thickness\"\nunit = \"m\"\n[output]\n";
  const auto of = [&](std::string deck) {
    deck = deck.substr(0, deck.find("[[stages]]"));
    deck.erase(deck.find("[materials.platen]"), deck.find("[contacts]") - deck.find("[materials.platen]"));
    return with(deck, "platen_friction = 0.0", "#") + drive;
  };
  auto setup = read(with(of(solid()), "depth = \"150 mm\"", "depth = \"80 mm\""));
  const auto simulation = make_simulation(setup);
  pyroclast::Run run(*simulation, std::move(setup.stages));
  ASSERT_EQ(run.run(), Outcome::completed);
  const auto report = run.stages()[0]->report(run.history(), run.courses()[0].rows, Outcome::completed);
  EXPECT_NEAR(number(report, "X_m"), 0.08, 1e-12);
  const std::string of_cylinder = message(with(of(cylinder()), "set = \"front\"", "set = \"bottom\""));
  expect_in("stages[0].results[0].formula", of_cylinder);
  expect_in("thickness", of_cylinder);
}

TEST(SolidDeck, ABearingLiesOnTheRimOfADisc) {
  std::string deck = with(shipped_case("brazilian"), "thickness = \"300 mm\"", "depth = \"60 mm\"");
  deck = with(with(deck, "count = 2000", "count = 150"), "fraction = 0.34", "fraction = 0.0");
  const auto simulation = make_simulation(read(deck));
  const Model& model = simulation->model();
  const auto area_of = [&](const char* set) {
    double area = 0.0;
    for (const Face& face : faces_in(model, model.set(set))) area += face.area;
    return area;
  };
  // the seat is two chords of the circle, and belongs to the rim too
  for (const char* const strip : {"lower_strip", "upper_strip"}) {
    double seat = 0.0;
    for (const int c : model.contact_sets.at(strip)) seat += model.joint(c).area;
    EXPECT_NEAR(seat, 0.015 * 0.06, 0.02 * seat);
    for (const int g : model.set(std::string(strip) + "_seat"))
      EXPECT_TRUE(std::ranges::binary_search(model.set("rim"), g));
    for (const int g : model.set(std::string(strip) + "_support"))
      EXPECT_NEAR(std::abs(model.place(g)[1]), std::abs(model.place(model.set(strip).back())[1]), 1e-12);
  }
  EXPECT_GT(area_of("rim"), 0.9 * (std::numbers::pi * 0.15 - 2 * 0.015) * 0.06);
}

// Promise: in space the middle of a seat has three coordinates; of a pair z is the middle of the depth.
TEST(SolidDeck, TheMiddleOfASeatMayHaveThreeCoordinates) {
  const std::string deck = with(shipped_case("brazilian"), "thickness = \"300 mm\"", "depth = \"60 mm\"");
  const std::string pair = "at = [\"0 mm\", \"-75 mm\"]";
  ASSERT_NE(deck.find(pair), std::string::npos);
  const auto at = [&](const char* z) {
    return with(deck, pair, fmt::format("at = [\"0 mm\", \"-75 mm\", \"{}\"]", z));
  };
  EXPECT_EQ(message(at("30 mm")), "no Error was thrown");
  const auto sides = [](const std::string& of) { return specimen::names_of(read(of).specimen.sides()); };
  EXPECT_EQ(sides(at("30 mm")), sides(deck));
  expect_in("bearings[0].at", message(at("10 mm")));
  expect_in("over all of the depth, so the z of its middle is 0.03 m; got 0.01 m", message(at("10 mm")));
}

TEST(SolidDeck, ShortEdgesStayUnlessTheyAreToBeRemoved) {
  const auto blocks = [](const std::string& lines) {
    return read(with(solid(), "shortest_edge = 0.2", lines)).specimen.blocks;
  };
  EXPECT_EQ(blocks("").shortest_edge, 0.0);
  EXPECT_EQ(blocks("shortest_edge = 0.35").shortest_edge, 0.35);
  EXPECT_NEAR(blocks("shortest_edge = 0.35").largest_bend, std::numbers::pi / 9.0, 1e-15);
  EXPECT_NEAR(blocks("shortest_edge = 0.35\nlargest_bend = \"5 deg\"").largest_bend, std::numbers::pi / 36.0,
              1e-15);
  for (const char* const bend : {"31 deg", "-1 deg", "1 mm"})
    expect_in("blocks.largest_bend",
              message(with(solid(), "shortest_edge = 0.2",
                           fmt::format("shortest_edge = 0.2\nlargest_bend = \"{}\"", bend))));
  expect_in("blocks.shortest_edge", message(with(solid(), "shortest_edge = 0.2", "shortest_edge = 0.6")));
  expect_in("is for solids",
            message(with(plane(), "shortest_edge = 0.2", "shortest_edge = 0.2\nlargest_bend = \"5 deg\"")));
  const auto warnings = read(with(solid(), "shortest_edge = 0.2", "largest_bend = \"5 deg\"")).warnings;
  EXPECT_TRUE(std::ranges::any_of(warnings, [](const Diagnostic& w) {
    return w.key == "blocks.largest_bend" && w.message.find("faces stay plane") != std::string::npos;
  }));
}

// Promise: without short edges density scaling needs less than a quarter of the moving mass at the same time
// step, and the stable step of heat is over 100 times longer.
TEST(SolidDeck, WithoutShortEdgesLessMassIsAddedAndStepsOfHeatAreLonger) {
  const auto edges = [](const std::string& deck, double shortest) {
    return with(deck, "[blocks]", fmt::format("[blocks]\nshortest_edge = {}", shortest));
  };
  const std::string pressed =
      with(with(shipped_case("starter_3d"), "count = 3000", "count = 300"), "shortest_edge = 0.35", "");
  std::string heated = with(shipped_case("thermal_wall"), "thickness = \"1 m\"", "depth = \"150 mm\"");
  heated.erase(heated.find("[[probes]]"), heated.find("[output]") - heated.find("[[probes]]"));
  heated = with(with(with(heated, "shortest_edge = 0.2", ""), "count = 2000", "count = 300"),
                "d_min = \"4.75 mm\"", "d_min = \"20 mm\"");
  heated = with(heated, "[\"8 mm\", \"12.5 mm\", \"16 mm\", \"20 mm\", \"25 mm\"]", "[\"25 mm\"]");
  const auto mass_ratio = [](const std::string& deck) {
    return make_simulation(read(deck))->motion().mass_ratio();
  };
  const auto step_of_heat = [](const std::string& deck) {
    return make_simulation(read(deck))->field().conduction()->step_limit().step;
  };
  EXPECT_LT(mass_ratio(edges(pressed, 0.35)), 0.25 * mass_ratio(pressed));
  EXPECT_GT(step_of_heat(edges(heated, 0.35)), 100.0 * step_of_heat(heated));
}

/// The gridpoints of a set in a model of the deck.
std::vector<Vec<3>> places_of(const std::string& deck, const std::string& set) {
  const auto simulation = make_simulation(read(deck));
  std::vector<Vec<3>> places;
  for (const int g : simulation->model().set(set)) places.push_back(simulation->model().place(g));
  return places;
}

TEST(SolidDeck, PairsStandForAllZ) {
  const auto box = [](const char* corners) {
    return places_of(with_more(solid(), fmt::format("[[sets]]\nname = \"a\"\nbox = [{}]\n", corners)), "a");
  };
  const auto whole = box(R"(["0 mm", "0 mm"], ["150 mm", "100 mm"])");
  const auto front = box(R"(["0 mm", "0 mm", "0 mm"], ["150 mm", "100 mm", "40 mm"])");
  const auto at_back = [](const std::vector<Vec<3>>& places) {
    return std::ranges::count_if(places, [](const Vec<3>& x) { return x[2] > 0.1; });
  };
  EXPECT_GT(at_back(whole), 0);
  EXPECT_EQ(at_back(front), 0);
  EXPECT_GT(whole.size(), front.size());
  for (const Vec<3>& x : whole) EXPECT_LE(x[1], 0.1 + 1e-9);
  // a line of pairs is the plane through it; some blocks without short edges touch it in an edge alone
  const auto side =
      places_of(with_more(solid(),
                          "[[sets]]\nname = \"a\"\nwithin = \"specimen\"\nline = [[\"0 mm\", \"0 mm\"], "
                          "[\"0 mm\", \"300 mm\"]]\n"),
                "a");
  EXPECT_EQ(side, places_of(solid(), "left"));
}

TEST(SolidDeck, AProbeHasThreeCoordinates) {
  std::string deck = with(shipped_case("thermal_wall"), "thickness = \"1 m\"", "depth = \"100 mm\"");
  deck.erase(deck.find("[[probes]]"), deck.find("[output]") - deck.find("[[probes]]"));
  const std::string probe = "[[probes]]\nname = \"p\"\nx = \"20 mm\"\ny = \"20 mm\"\n";
  expect_in("z = \"0.05 m\"", message(with_more(deck, probe)));
  EXPECT_EQ(message(with_more(deck, probe + "z = \"20 mm\"\n")), "no Error was thrown");
  expect_in("probes", message(with_more(deck, probe + "z = \"200 mm\"\n")));
}

/// Adds finer blocks to a deck of blocks of a size.
std::string finer(const std::string& deck, const std::string& near,
                  const std::string& sizes = "size = \"12 mm\"\ndistance = \"15 mm\"\n") {
  return with_more(deck, "[[blocks.finer]]\n" + near + "\n" + sizes);
}

/// The solid, and the cylinder, by the size of their blocks.
std::string sized_solid() {
  return with(solid(), "count = 60", "size = \"20 mm\"");
}
std::string sized_cylinder() {
  return with(cylinder(), "count = 60", "size = \"20 mm\"");
}

TEST(FinerBlocksOfSolids, CountIsOfAllAndSizeOfThoseFarAway) {
  const auto by_size = read(finer(sized_solid(), "near = \"top\"")).specimen;
  EXPECT_EQ(by_size.largest_block_size(), 20e-3);
  // 844 blocks of 20 mm; the fine layer alone has 15 mm x 150 mm x 150 mm, 195 of 12 mm in the place of 42
  EXPECT_GT(by_size.blocks.count, 844 + 150);
  EXPECT_LT(by_size.blocks.count, 844 + 450);
  const auto by_count =
      read(finer(with(solid(), "count = 60", fmt::format("count = {}", by_size.blocks.count)),
                 "near = \"top\""))
          .specimen;
  EXPECT_EQ(by_count.blocks.count, by_size.blocks.count);
  EXPECT_NEAR(by_count.blocks.largest_size, 20e-3, 0.05e-3);  // the count is rounded
}

// Promise: a part of a solid is a face of it, a seat, a set, or a place; a pair stands for all z.
TEST(FinerBlocksOfSolids, StandNearWhateverHasANameOrAPlace) {
  const auto part = [](const std::string& deck, const std::string& near) {
    return read(finer(deck, near)).specimen.blocks.finer.front();
  };
  const auto top = part(sized_solid(), "near = \"top\"");
  ASSERT_EQ(top.pieces.size(), 1U);
  ASSERT_EQ(top.pieces[0].size(), 4U);
  for (const Vec<3>& corner : top.pieces[0]) EXPECT_EQ(corner[1], 0.3);
  EXPECT_EQ(part(sized_solid(), "near = \"outline\"").pieces.size(), 6U);
  const auto rim = part(sized_cylinder(), "near = \"rim\"");
  EXPECT_GE(rim.pieces.size(), 24U);
  for (const auto& piece : rim.pieces) EXPECT_EQ(piece.size(), 4U);
  const auto end = part(sized_cylinder(), "near = \"bottom\"");
  ASSERT_EQ(end.pieces.size(), 1U);
  EXPECT_GE(end.pieces[0].size(), 24U);
  const auto along = part(sized_solid(), "at = [\"75 mm\", \"150 mm\"]");
  EXPECT_TRUE(along.is_along_z);
  const auto point = part(sized_solid(), "at = [\"75 mm\", \"150 mm\", \"75 mm\"]");
  EXPECT_FALSE(point.is_along_z);
  EXPECT_EQ(point.pieces, (std::vector<specimen::FinerPiece>{{{{0.075, 0.15, 0.075}}}}));
  const auto line = part(sized_solid(), "line = [[\"0 mm\", \"0 mm\"], [\"9 mm\", \"9 mm\"]]");
  EXPECT_TRUE(line.is_along_z);
  const auto box =
      part(sized_solid(), "box = [[\"0 mm\", \"0 mm\", \"0 mm\"], [\"9 mm\", \"9 mm\", \"9 mm\"]]");
  EXPECT_EQ(box.box->back(), (Vec<3>{{9e-3, 9e-3, 9e-3}}));
  const std::string set = "[[sets]]\nname = \"a\"\nbox = [[\"0 mm\", \"0 mm\"], [\"9 mm\", \"9 mm\"]]\n";
  const auto of_set = part(with_more(sized_solid(), set), "near = \"a\"");
  EXPECT_TRUE(of_set.is_along_z);
  EXPECT_EQ(of_set.box->back(), (Vec<3>{{9e-3, 9e-3}}));
  const auto unused = read(finer(with_more(sized_solid(), set), "near = \"a\"")).unused_sets;
  EXPECT_TRUE(unused.empty());
}

// Promise: the seats of a disc are parts, and sides of its rim are about as long as the blocks there; those
// of a cylinder as the largest blocks along them, so that a fine end leaves them as they are.
TEST(FinerBlocksOfSolids, RoundBodiesHaveSidesAboutAsLongAsTheirBlocks) {
  const std::string disc = with(with(with(shipped_case("disc_3d"), "count = 2700", "size = \"10 mm\""),
                                     "fraction = 0.28", "fraction = 0.0"),
                                "diameter = \"150 mm\"\ndepth", "diameter = \"150 mm\"\ndepth");
  const std::string sizes = "size = \"5 mm\"\ndistance = \"10 mm\"\n";
  const auto even = read(disc).specimen, fine = read(finer(disc, "near = \"upper_strip\"", sizes)).specimen;
  EXPECT_NEAR(fine.extent(), even.extent(), 1e-12);
  const auto sides_above = [](const specimen::SpecimenParameters& specimen, double height) {
    return std::ranges::count_if(specimen.prism()->section().pieces(), [&](const specimen::Piece& piece) {
      return height > 0.0 ? piece.from[1] > height : piece.from[1] < height;
    });
  };
  EXPECT_GT(sides_above(fine, 0.06), 1.4 * sides_above(even, 0.06));
  EXPECT_EQ(sides_above(fine, -0.06), sides_above(even, -0.06));
  EXPECT_EQ(fine.blocks.finer[0].pieces.size(), 2U);  // the seat's chords
  const auto sides = [](const std::string& deck) {
    return read(deck).specimen.prism()->section().pieces().size();
  };
  const std::string cylinder = with(sized_cylinder(), "size = \"20 mm\"", "size = \"12 mm\"");
  EXPECT_EQ(sides(finer(cylinder, "near = \"top\"", sizes)), sides(cylinder));
  EXPECT_GT(sides(finer(cylinder, "near = \"rim\"", sizes)), 2 * sides(cylinder));
}

TEST(FinerBlocksOfSolids, WrongOnesAreRefusedWithTheirPlace) {
  const auto says = [](const std::string& deck, const char* const key, const char* const words) {
    const std::string complaint = message(deck);
    expect_in("deck.toml:", complaint);
    expect_in(key, complaint);
    expect_in(words, complaint);
  };
  const std::string distance = "distance = \"12 mm\"\n";
  says(finer(sized_solid(), "near = \"tpo\""), "blocks.finer[0].near", "did you mean \"top\"?");
  says(finer(sized_cylinder(), "near = \"left\""), "blocks.finer[0].near", "must be one of");
  says(finer(sized_solid(), "near = \"top\"", "size = \"20 mm\"\n" + distance), "blocks.finer[0].size",
       "must be less than the size of the other blocks, 20 mm");
  says(finer(solid(), "near = \"top\""), "blocks.count", "take more, or a smaller distance");
  says(finer(sized_solid(), "near = \"top\"\nat = [\"0 mm\", \"0 mm\"]"), "blocks.finer[0]", "not several");
  says(finer(sized_solid(), "box = [[\"0 mm\", \"0 mm\"], [\"9 mm\", \"9 mm\", \"9 mm\"]]"),
       "blocks.finer[0].box", "two pairs, which stand for all z");
  says(finer(sized_solid(), "box = [[\"0 mm\", \"0 mm\", \"9 mm\"], [\"9 mm\", \"9 mm\", \"0 mm\"]]"),
       "blocks.finer[0].box", "inside out");
  says(finer(with(plane(), "count = 60", "size = \"20 mm\""), "at = [\"0 mm\", \"0 mm\", \"0 mm\"]"),
       "blocks.finer[0].at", "no z");
  says(finer(sized_solid(), "near = \"top\"", "size = \"1 um\"\n" + distance), "blocks.size", "blocks");
}

// Promise: contacts are as much stiffer as blocks are smaller, so that the modulus stays.
TEST(FinerBlocksOfSolids, ContactsFollowTheirSizeSoThatTheModulusStays) {
  const std::string even =
      with(with(solid(), "count = 60", "count = 500"), "fraction = 0.34", "fraction = 0.0");
  const auto graded = finer(even, "near = \"bottom\"", "size = \"14 mm\"\ndistance = \"10 mm\"\n");
  const auto modulus = [](const std::string& deck) {
    const auto simulation = make_simulation(read(deck));
    return estimate_modulus(simulation->model(), simulation->materials());
  };
  // 0.9 % in the cube of docs/validation/solids.md
  EXPECT_NEAR(modulus(graded), modulus(even), 0.02 * modulus(even));
}

}  // namespace
}  // namespace pyroclast
