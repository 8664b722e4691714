#include "pyroclast/specimen/from_cells.hpp"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "examples.hpp"
#include "pyroclast/specimen/blocks.hpp"
#include "pyroclast/specimen/cells_file.hpp"
#include "pyroclast/specimen/polyhedron.hpp"
#include "pyroclast/specimen/topology.hpp"
#include "solid_bodies.hpp"

namespace pyroclast::specimen {
namespace {

/// Three by three squares of 1 m without the middle one, the first of them clockwise.
Cells<2> ring_of_squares() {
  Cells<2> t;
  for (int y = 0; y < 4; ++y)
    for (int x = 0; x < 4; ++x) t.vertices.push_back({{1.0 * x, 1.0 * y}});
  for (int y = 0; y < 3; ++y)
    for (int x = 0; x < 3; ++x)
      if (x != 1 || y != 1) t.cells.push_back({4 * y + x, 4 * y + x + 1, 4 * y + x + 5, 4 * y + x + 4});
  std::ranges::reverse(t.cells.front());
  return t;
}

/// Reads cells of the plane.
GivenCells<2> in_plane(const std::string& text, const ToMetres& to_metres = {}) {
  return std::get<GivenCells<2>>(cells_from(text, "mine.json", to_metres));
}

TEST(SpecimenFromCells, FindsTheOutlineAndItsHoles) {
  std::vector<int> phase(8, 0);
  phase[3] = 1;
  const Specimen<2> specimen = specimen_from(completed({ring_of_squares(), {"mortar", "stone"}, phase}));
  EXPECT_DOUBLE_EQ(specimen.outline.extent(), 8.0);
  ASSERT_EQ(specimen.outline.sides().size(), 5U);
  EXPECT_EQ(specimen.outline.sides()[specimen.outline.side_of({{1.0, 0.0}}, {{2.0, 0.0}}).value()].name,
            "bottom");
  EXPECT_EQ(specimen.outline.sides()[specimen.outline.side_of({{3.0, 1.0}}, {{3.0, 2.0}}).value()].name,
            "right");
  EXPECT_EQ(specimen.outline.sides()[specimen.outline.side_of({{1.0, 1.0}}, {{2.0, 1.0}}).value()].name,
            "hole_1");
  EXPECT_DOUBLE_EQ(specimen.fraction[0], 7.0 / 8.0);
  EXPECT_DOUBLE_EQ(specimen.fraction[1], 1.0 / 8.0);
  EXPECT_NO_THROW(require_valid(specimen.cells, specimen.outline, "cells"));
}

TEST(SpecimenFromCells, GivesBackWhatWasTessellated) {
  SpecimenParameters p = paper_specimen(1);
  p.blocks.count = 200;
  p.outline = Region::polygon({{{0.0, 0.0}}, {{0.3, 0.0}}, {{0.3, 0.2}}, {{0.15, 0.3}}, {{0.0, 0.2}}},
                              {"side_1", "side_2", "side_3", "side_4", "side_5"});
  const Specimen<2> made = make_specimen(p);
  const Specimen<2> again = specimen_from(completed({made.cells, made.phases, made.phase}));
  EXPECT_EQ(again.cells.cells, made.cells.cells);
  EXPECT_NEAR(again.outline.extent(), p.extent(), 1e-12);
  for (std::size_t i = 0; i < 5; ++i) EXPECT_EQ(again.outline.pieces()[i].from, p.region()->pieces()[i].from);
  EXPECT_NEAR(again.fraction[0], made.fraction[0], 1e-12);
  EXPECT_EQ(again.metrics.mean_edge, made.metrics.mean_edge);
}

TEST(SpecimenFromCells, WhatDoesNotFitIsToldByCell) {
  const auto refused = [](auto change) {
    Cells<2> t = ring_of_squares();
    std::vector<int> phase(8, 0);
    change(t, phase);
    return message([&] { specimen_from(completed({t, {"mortar"}, phase})); });
  };
  EXPECT_TRUE(says(refused([](auto& t, auto&) { t.cells[2][1] = 99; }), "cell 2 .from 0. names vertex 99"));
  EXPECT_TRUE(says(refused([](auto& t, auto&) { t.cells[2][2] = t.cells[2][0]; }),
                   "cell 2 .from 0. names vertex [0-9]+ .from 0. twice"));
  EXPECT_TRUE(says(refused([](auto&, auto& phase) { phase[5] = 1; }), "cell 5 .from 0. is of phase 1"));
  EXPECT_TRUE(says(refused([](auto&, auto& phase) { phase.pop_back(); }), "8 cells, but the phases of 7"));
  EXPECT_TRUE(says(refused([](auto& t, auto&) { t.cells[1].resize(2); }), "cell 1 .from 0. has 2 vertices"));
  EXPECT_TRUE(says(refused([](auto& t, auto&) {
                     t.vertices[3] = {{NAN, 0.0}};
                   }),
                   "vertex 3 .from 0. is not finite"));
  EXPECT_TRUE(says(refused([](auto& t, auto& phase) {
                     t.cells.erase(t.cells.begin() + 1);
                     t.cells.erase(t.cells.begin() + 2);
                     phase.resize(6);
                   }),
                   "meet in one point|2 pieces"));
  EXPECT_TRUE(says(refused([](auto& t, auto&) {
                     t.vertices[5] = {{2.5, 2.5}};
                   }),
                   "more than one outer outline|pieces|not convex"));
  const Cells<2> flat{{{{0, 0}}, {{1, 0}}, {{2, 0}}}, {{0, 1, 2}}};
  EXPECT_TRUE(says(message([&] { specimen_from(completed({flat, {"mortar"}, {0}})); }), "enclose no area"));
}

// Promise: cells count from 0 in every message, as arrays and files of cells do.
TEST(SpecimenFromCells, ADentedCellIsToldByItsNumberFromZero) {
  Cells<2> t = ring_of_squares();
  t.vertices[0] = {{0.9, 0.9}};  // a corner of cell 0 alone
  EXPECT_TRUE(says(message([&] {
                     specimen_from(completed({t, {"mortar"}, std::vector<int>(8, 0)}));
                   }),
                   "cell 0 .from 0. near .* is not convex"));
}

/// A box of 60 mm: a lower half under two blocks side by side, as in a tessellation of tessellations. Two
/// corners of the upper blocks stand on edges of the lower one's sides.
/// \param first  corner with which those sides begin
GivenCells<3> two_blocks_on_one(std::size_t first) {
  constexpr double a = 0.06, h = 0.03;
  const std::vector<Vec<3>> at = {
      {{0, 0, 0}}, {{a, 0, 0}}, {{a, a, 0}}, {{0, a, 0}}, {{0, 0, h}}, {{h, 0, h}}, {{a, 0, h}}, {{0, a, h}},
      {{h, a, h}}, {{a, a, h}}, {{0, 0, a}}, {{h, 0, a}}, {{a, 0, a}}, {{0, a, a}}, {{h, a, a}}, {{a, a, a}}};
  std::vector<std::vector<int>> faces = {
      {0, 1, 6, 5, 4}, {2, 3, 7, 8, 9}, {0, 3, 2, 1},     {0, 4, 7, 3},    {1, 2, 9, 6},   {4, 5, 8, 7},
      {5, 6, 9, 8},    {5, 11, 14, 8},  {4, 5, 11, 10},   {5, 6, 12, 11},  {7, 13, 14, 8}, {8, 14, 15, 9},
      {4, 10, 13, 7},  {6, 9, 15, 12},  {10, 11, 14, 13}, {11, 12, 15, 14}};
  for (const std::size_t side : {0, 1})
    std::rotate(faces[side].begin(), faces[side].begin() + static_cast<std::ptrdiff_t>(first),
                faces[side].end());
  Cells<3> cells{.vertices = at, .faces = {}, .cells = {}};
  for (const auto& corners : faces) cells.faces.push_back({corners});
  cells.cells = {{0, 1, 2, 3, 4, 5, 6}, {5, 7, 8, 10, 12, 14}, {6, 7, 9, 11, 13, 15}};
  return {.cells = cells, .phases = {"mortar"}, .phase = {0, 0, 0}, .outline = cuboid(a, a, a)};
}

// Promise: a corner on an edge of a face makes no zone without a volume, whichever corner the face begins
// with.
TEST(SpecimenFromCells, CornersMayStandOnEdgesOfFacesInSpace) {
  for (std::size_t first = 0; first < 5; ++first) {
    const Specimen<3> made = specimen_from(completed(two_blocks_on_one(first)));
    EXPECT_NEAR(made.fraction[0], 1.0, 1e-12);
    for (std::size_t cell = 0; cell < 3; ++cell) EXPECT_LT(flatness(made.cells, cell, 0.03), 1e4);
  }
}

TEST(SpecimenFromCells, AFileSaysTheUnitOfItsVertices) {
  const auto of_list = [](const std::string& lists) {
    return R"({"phases": ["a"], "cells": [[0, 1, 2]], "phase": [0])" + lists + "}";
  };
  const std::string text = of_list(R"(, "vertices_mm": [[0, 0], [100, 0], [0, 100]])");
  const ToMetres of_mm = [](const std::string& unit) {
    if (unit != "mm") throw Error("no unit of length");
    return [](double x) { return 1e-3 * x; };
  };
  EXPECT_EQ(in_plane(text, of_mm).cells.vertices[1], (Vec<2>{{1e-3 * 100.0, 0.0}}));
  EXPECT_TRUE(says(message([&] { cells_from(of_list(R"(, "vertices_kg": [])"), "mine.json", of_mm); }),
                   "mine.json: \"vertices_kg\": no unit of length"));
  EXPECT_TRUE(says(message([&] { cells_from(of_list(""), "mine.json"); }),
                   "mine.json: there is no list \"vertices_m\""));
  EXPECT_TRUE(
      says(message([&] { cells_from(of_list(R"(, "vertices_m": [], "vertices_mm": [])"), "mine.json"); }),
           "\"vertices_m\" and \"vertices_mm\"; only one is allowed"));
}

TEST(SpecimenFromCells, AFileKeepsTheSizesOfBlocks) {
  const auto of_list = [](const std::string& lists) {
    return R"({"phases": ["a"], "cells": [[0, 1, 2]], "phase": [0], "vertices_m": [[0, 0], [1, 0], [0, 1]])" +
           lists + "}";
  };
  const Specimen<2> made = specimen_from(in_plane(of_list(R"(, "block_size_m": [0.25])")));
  EXPECT_EQ(made.size, std::vector<double>{0.25});
  const std::string text = cells_text(made);
  EXPECT_EQ(in_plane(text).size, made.size);
  EXPECT_TRUE(in_plane(of_list("")).size.empty());
  EXPECT_TRUE(says(message([&] { cells_from(of_list(R"(, "block_size_mm": [1])"), "mine.json"); }),
                   "\"block_size_mm\"; beside \"vertices_m\" it must be \"block_size_m\""));
  EXPECT_TRUE(says(message([&] { cells_from(of_list(R"(, "block_size_m": [1, 2])"), "mine.json"); }),
                   "there are 1 cells, but the sizes of 2"));
  EXPECT_TRUE(says(message([&] { cells_from(of_list(R"(, "block_size_m": [-1])"), "mine.json"); }),
                   "it must be greater than 0"));
}

TEST(SpecimenFromCells, AFileKeepsTheStonesOfBlocks) {
  const auto file = [](const std::string& stones) {
    return R"({"phases": ["a", "b"], "cells": [[0, 1, 2], [1, 3, 2]], "phase": [1, 0], "stone": )" + stones +
           R"(, "vertices_m": [[0, 0], [1, 0], [0, 1], [1, 1]]})";
  };
  const GivenCells<2> read = in_plane(file("[7, -1]"));
  SpecimenParameters asked;
  asked.cells = read;
  EXPECT_EQ(phases_of_stones(asked), std::vector<std::string>{"b"});
  const Specimen<2> made = specimen_from(read);
  EXPECT_EQ(made.stone, (std::vector<int>{7, -1}));
  const std::string text = cells_text(made);
  EXPECT_EQ(in_plane(text).stone, made.stone);
  EXPECT_TRUE(
      says(message([&] { cells_from(file("[7]"), "mine.json"); }), "there are 2 cells, but the stones of 1"));
  EXPECT_TRUE(says(message([&] { cells_from(file("[7, -2]"), "mine.json"); }),
                   "must be the number of a stone, from 0, or -1 for none"));
}

TEST(SpecimenFromCells, ANumberTooLargeIsToldWithItsFile) {
  EXPECT_TRUE(says(message([] { cells_from(R"({"phase": [1e999]})", "mine.json"); }),
                   "^mine.json: number overflow parsing '1e999'$"));
}

}  // namespace
}  // namespace pyroclast::specimen
