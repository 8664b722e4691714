#include "pyroclast/specimen/pieces.hpp"

#include <gtest/gtest.h>

#include "examples.hpp"
#include "pyroclast/specimen/from_cells.hpp"

namespace pyroclast::specimen {
namespace {

/// Two squares of 10 mm beside each other; the second has corners of its own where they meet.
/// \param gap  between them, m
GivenCells<2> apart(double gap) {
  const double a = 0.01, b = a + gap;
  return {{{{{0, 0}}, {{a, 0}}, {{a, a}}, {{0, a}}, {{b, 0}}, {{b + a, 0}}, {{b + a, a}}, {{b, a}}},
           {{0, 1, 2, 3}, {4, 5, 6, 7}}},
          {"mortar"},
          {0, 0}};
}

/// A square of 20 mm beside two of 10 mm, which share vertices with it where they have the same.
/// \param off  of the vertex that hangs on its side, m, to the right
GivenCells<2> hanging_node(double off) {
  const double a = 0.01;
  return {{{{{0, 0}},
            {{2 * a, 0}},
            {{2 * a, 2 * a}},
            {{0, 2 * a}},
            {{2 * a + off, a}},
            {{3 * a, 0}},
            {{3 * a, a}},
            {{3 * a, 2 * a}}},
           {{0, 1, 2, 3}, {1, 5, 6, 4}, {4, 6, 7, 2}}},
          {"mortar"},
          {0, 0, 0}};
}

std::string refusal(const GivenCells<2>& cells) {
  return message([&] { specimen_from(completed(cells)); });
}

TEST(Pieces, AreCountedAndOneIsNamedWithItsPlace) {
  GivenCells<2> cells = apart(1e-3);
  EXPECT_TRUE(says(refusal(cells),
                   "the cells are 2 pieces .* cell 0 \\(from 0\\) at \\(0.005, 0.005\\) m is of a piece of 1 "
                   "cell; no vertices coincide, "));
  cells.cells.vertices.push_back({{-0.01, 0.0}});
  cells.cells.cells.push_back({8, 0, 3});
  cells.phase.push_back(0);
  EXPECT_TRUE(says(refusal(cells), "cell 1 \\(from 0\\) at \\(0.016, 0.005\\) m is of a piece of 1 cell;"));
}

TEST(Pieces, WhatCouldBeJoinedIsToldAndJoinedOnRequest) {
  EXPECT_TRUE(says(refusal(apart(0.0)),
                   "2 vertices coincide with others, and 0 lie in an edge .*join = \"2e-08 m\""));
  for (const double gap : {0.0, 1e-7, -1e-7}) {
    const Specimen<2> made = specimen_from(completed(apart(gap), 1e-6));
    EXPECT_EQ(made.cells.vertices.size(), 6U);
    EXPECT_NEAR(made.outline.extent(), 2e-4, 1e-8);
    EXPECT_EQ(made.outline.sides().size(), 4U);
  }
  EXPECT_TRUE(says(refusal(joined(apart(1e-5), 1e-6)), "2 pieces"));
}

// Promise: a hanging node is moved into the side and becomes a corner of the cell there.
TEST(Pieces, HangingNodesBecomeCornersOnRequest) {
  EXPECT_TRUE(
      says(refusal(hanging_node(0.0)), "2 pieces .*0 vertices coincide with others, and 1 lies in an edge"));
  for (const double off : {0.0, 1e-7, -1e-7}) {
    const Specimen<2> made = specimen_from(completed(hanging_node(off), 1e-6));
    EXPECT_EQ(made.cells.cells[0].size(), 5U);
    EXPECT_NEAR(made.outline.extent(), 6e-4, 1e-15);
  }
}

// Promise: where cells hang together around them, hanging nodes and parted vertices are told too.
TEST(Pieces, WhatCouldBeJoinedIsToldOfOnePieceToo) {
  GivenCells<2> cells = hanging_node(0.0);  // with a row of cells above, which holds both together
  auto& t = cells.cells;
  t.vertices.insert(t.vertices.end(), {{{0.0, 0.03}}, {{0.02, 0.03}}, {{0.03, 0.03}}});
  t.cells.insert(t.cells.end(), {{3, 2, 9, 8}, {2, 7, 10, 9}});
  cells.phase = {0, 0, 0, 0, 0};
  EXPECT_TRUE(says(refusal(cells), "1 lies in an edge of a cell .*join = \"3e-08 m\""));
  EXPECT_EQ(specimen_from(completed(cells, 1e-6)).outline.sides().size(), 4U);
  t.vertices.insert(t.vertices.end(), {{{0.02, -0.01}}, {{0.0, -0.01}}, {{0.03, -0.01}}});
  t.cells.insert(t.cells.end(), {{0, 12, 11, 1}, {1, 11, 13, 5}});  // and below: a gap without an area inside
  cells.phase = {0, 0, 0, 0, 0, 0, 0};
  EXPECT_TRUE(says(refusal(cells), "1 lies in an edge of a cell"));
  EXPECT_NEAR(specimen_from(completed(cells, 1e-6)).outline.extent(), 12e-4, 1e-15);
}

// Promise: without a distance nothing changes, and vertices that are joined leave no trace.
TEST(Pieces, WithoutADistanceCellsStayAsTheyAre) {
  const GivenCells<2> cells = hanging_node(0.0);
  EXPECT_EQ(joined(cells, 0.0).cells.cells, cells.cells.cells);
  EXPECT_EQ(joined(cells, 0.0).cells.vertices, cells.cells.vertices);
}

TEST(Pieces, ADistanceThatACellDoesNotOutlastIsRefusedByItsName) {
  EXPECT_TRUE(
      says(message([] { joined(apart(0.0), 0.02); }), "cell 0 \\(from 0\\) has two corners .*join less"));
}

}  // namespace
}  // namespace pyroclast::specimen
