#include "pyroclast/specimen/neper_tess.hpp"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <regex>
#include <sstream>

#include <fmt/format.h>

#include "examples.hpp"
#include "pyroclast/specimen/blocks.hpp"
#include "pyroclast/specimen/from_cells.hpp"
#include "pyroclast/specimen/polygon.hpp"
#include "pyroclast/specimen/topology.hpp"

namespace pyroclast::specimen {
namespace {

/// A .tess file of the test's own, gone at the end.
class TessFile {
 public:
  explicit TessFile(const std::string& text) {
    // Named after the test, which may run beside others.
    std::string name = testing::UnitTest::GetInstance()->current_test_info()->name();
    std::replace(name.begin(), name.end(), '/', '_');
    path_ = std::filesystem::path(testing::TempDir()) / ("pyroclast_" + name + ".tess");
    std::ofstream(path_) << text;
  }
  ~TessFile() { std::filesystem::remove(path_); }
  TessFile(const TessFile&) = delete;
  TessFile& operator=(const TessFile&) = delete;
  const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

/// Two cells in a rectangle of 2 x 1, the second clockwise; sections that the reader skips are there too.
const std::string two_cells = R"(***tess
 **format
   3.5
 **general
   2 standard
 **cell
  2
  *id
   1 2
  *crysym
   cubic
  *seed
   1 0.5 0.5 0 0
   2 1.5 0.5 0 0
 **vertex
 6
   1  0 0 0     0
   2  0.8 0 0     0
   3  2.000000000000 -0.000000000000 0     0
   4  2 1 0     0
   5  1.2 1 0     1
   6  0.000000000000 1 0     0
 **edge
 7
   1  1 2 0
   2  2 3 0
   3  3 4 0
   4  4 5 0
   5  5 6 0
   6  6 1 0
   7  2 5 0
 **face
 2
   1 4 1 2 5 6
     4 1 7 5 6
    0 0 0 1
     0 -1 0 0 0
   2 4 2 5 4 3
     4 7 -4 -3 -2
    0 0 0 -1
     0 -1 0 0 0
 **domain
  *general
   cube
  *vertex
   4
   1  0 0 0 x0y0
      1 1
   2  2 0 0 x1y0
      1 3
   3  2 1 0 x1y1
      1 4
   4  0 1 0 x0y1
      1 6
  *edge
   4
   1 2 2 1
     line
     0
     y0
     2 1 2
***end
)";

std::string replaced(std::string text, const std::string& from, const std::string& to) {
  const std::size_t at = text.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  return text.replace(at, from.size(), to);
}

TEST(NeperTess, ReadsAndScalesToTheSpecimen) {
  const TessFile file(two_cells);
  const Cells<2> t = read_neper_tess(file.path(), 0.2, 0.1).cells;
  ASSERT_EQ(t.cells.size(), 2U);
  EXPECT_EQ(t.vertices.size(), 6U);
  EXPECT_TRUE(mismatched_cells(t, Region::rectangle(0.2, 0.1)).empty());
  std::vector<Vec<2>> polygon;
  for (std::size_t c = 0; c < 2; ++c) {
    corners(t, c, polygon);
    EXPECT_NEAR(area(polygon), 0.01, 1e-15) << "cells are turned counter-clockwise";
  }
}

TEST(NeperTess, CellsWithoutVerticesAreLeftOutAndNumbered) {
  std::string text = replaced(two_cells, "**cell\n  2", "**cell\n  4");
  text = replaced(text, "**face\n 2\n   1 4 1",
                  "**face\n 4\n   1 0\n     0\n    0 0 0 1\n     0 -1 0 0 0\n   2 4 1");
  text = replaced(text, "   2 4 2 5 4 3", "   3 0\n     0\n    0 0 0 1\n     0 -1 0 0 0\n   4 4 2 5 4 3");
  const TessFile file(text);
  const NeperTess read = read_neper_tess(file.path(), 0.2, 0.1);
  EXPECT_EQ(read.cells.cells.size(), 2U);
  EXPECT_EQ(read.empty, (std::vector<int>{1, 3}));
}

TEST(NeperTess, AVertexThatRegularisationRepeatsOrDropsIsNoTrouble) {
  // Neper's regularisation may leave a deleted edge as a repeated vertex of a face, and vertices that no face
  // uses.
  std::string text = replaced(two_cells, "1 4 1 2 5 6\n     4 1 7 5 6", "1 5 1 2 5 5 6\n     5 1 7 8 5 6");
  text = replaced(text, "**vertex\n 6", "**vertex\n 7");
  text = replaced(text, " **edge\n 7", "   7  1.1 0.9 0    -1\n **edge\n 8");
  text = replaced(text, "   7  2 5 0\n", "   7  2 5 0\n   8  5 7 -1\n");
  const TessFile file(text);
  const Cells<2> t = read_neper_tess(file.path(), 0.2, 0.1).cells;
  EXPECT_EQ(t.cells[0].size(), 4U);
  EXPECT_EQ(t.vertices.size(), 6U);
}

/// Writes a tessellation the way Neper does: twelve decimals, here in millimetres and off the origin.
std::string as_tess(const Cells<2>& t, const std::vector<Vec<2>>& domain) {
  const auto point = [](double x, double y) {
    return fmt::format("{:.12f} {:.12f} 0.000000000000", 1e3 * x - 20, 1e3 * y + 7);
  };
  std::string text =
      fmt::format("***tess\n **format\n   2.0\n **general\n   2 standard\n **cell\n {}\n **vertex\n {}\n",
                  t.cells.size(), t.vertices.size());
  for (std::size_t v = 0; v < t.vertices.size(); ++v) {
    text += fmt::format(" {} {} 0\n", v + 1, point(t.vertices[v][0], t.vertices[v][1]));
  }
  text += fmt::format(" **face\n {}\n", t.cells.size());
  for (std::size_t c = 0; c < t.cells.size(); ++c) {
    text += fmt::format(" {} {}", c + 1, t.cells[c].size());
    for (const int v : t.cells[c]) text += fmt::format(" {}", v + 1);
    text += fmt::format("\n {}", t.cells[c].size());
    for (std::size_t i = 0; i < t.cells[c].size(); ++i) text += " 1";  // edges are not read
    text += "\n 0 0 0 1\n 0 -1 0 0 0\n";
  }
  text += fmt::format(" **domain\n *general\n square\n *vertex\n {}\n", domain.size());
  for (std::size_t i = 0; i < domain.size(); ++i)
    text += fmt::format(" {} {} x{}\n 1 1\n", i + 1, point(domain[i][0], domain[i][1]), i);
  return text + "***end\n";
}

std::string as_tess(const Cells<2>& t, double width, double height) {
  return as_tess(t, {{{0.0, 0.0}}, {{width, 0.0}}, {{width, height}}, {{0.0, height}}});
}

TEST(NeperTess, ReadsBackWhatWeWrite) {
  BlockParameters p;
  p.count = 500;
  p.shortest_edge = 0.1;
  Random random(1);
  const Cells<2> ours = make_blocks(p, Region::rectangle(0.15, 0.3), random).cells;
  const TessFile file(as_tess(ours, 0.15, 0.3));
  const Cells<2> read = read_neper_tess(file.path(), 0.15, 0.3).cells;
  ASSERT_EQ(read.cells.size(), ours.cells.size());
  std::vector<Vec<2>> a;
  std::vector<Vec<2>> b;
  for (std::size_t c = 0; c < ours.cells.size(); ++c) {
    corners(ours, c, a);
    corners(read, c, b);
    ASSERT_EQ(a.size(), b.size());
    for (std::size_t i = 0; i < a.size(); ++i)
      EXPECT_LT(norm(a[i] - b[i]), 2e-15);  // 12 decimals of a millimetre
  }
}

// Promise: the outline of the file is that of the specimen, corners, round sides and holes.
TEST(NeperTess, OfAnyOutlineItIsThatOfTheSpecimen) {
  const std::vector<Vec<2>> corners{{{0.0, 0.0}},   {{0.2, 0.0}},  {{0.2, 0.08}},
                                    {{0.08, 0.08}}, {{0.08, 0.3}}, {{0.0, 0.3}}};
  const Region angle = Region::polygon(corners, {"a", "b", "c", "d", "e", "f"});
  const Hole hole{"bore", circle_corners({{0.0, 0.0}}, 0.06, 0.01), true};
  const auto rim = circle_corners({{0.0, 0.0}}, 0.2, 0.01);
  const Region ring = Region::polygon(rim, {"rim"}, true).with_holes(std::array{hole});
  for (const auto& [region, domain] : {std::pair{angle, corners}, std::pair{ring, rim}}) {
    BlockParameters p;
    p.count = 400;
    p.shortest_edge = 0.1;
    Random random(1);
    const double width = region.box().width();  // of a circle's polygon not quite its diameter
    const TessFile file(as_tess(make_blocks(p, region, random).cells, domain));
    const Cells<2> read = read_neper_tess(file.path(), TessSize{.width = width}).cells;
    EXPECT_EQ(read.cells.size(), 400U);
    const Region found = outline_of(read);
    EXPECT_NEAR(found.extent(), region.extent(), 1e-9 * region.extent());
    EXPECT_EQ(found.loops().size(), region.loops().size());
    EXPECT_NEAR(norm(found.box().low), 0.0, 1e-12);
    EXPECT_NEAR(found.box().width(), width, 1e-12);
    SpecimenParameters whole = paper_specimen(1);
    whole.outline = found;
    whole.blocks = p;
    whole.blocks.cells = read;
    const Specimen<2> specimen = make_specimen(whole);
    EXPECT_EQ(specimen.cells.cells.size(), 400U);
    EXPECT_GT(specimen.fraction.at(1), 0.1);
  }
}

/// With every place (x, y, z) of a text's vertices and domain turned: z is 0 before.
std::string turned(const std::string& text, const Vec<3>& x, const Vec<3>& y) {
  std::string result;
  std::istringstream lines(text);
  // A number, a place with z = 0, and what follows it: a state or a label.
  const std::regex place(R"(^( +\d+ +)([-0-9.]+) ([-0-9.]+) 0( +.*)$)");
  std::string section;
  for (std::string line; std::getline(lines, line);) {
    if (line.find('*') != std::string::npos) section = line;
    std::smatch found;
    if (section.find("*vertex") != std::string::npos && std::regex_match(line, found, place)) {
      const Vec<3> at = std::stod(found[2]) * x + std::stod(found[3]) * y + Vec<3>{{7.0, -3.0, 2.0}};
      line = fmt::format("{}{:.12f} {:.12f} {:.12f}{}", found[1].str(), at[0], at[1], at[2], found[4].str());
    }
    result += line + "\n";
  }
  return result;
}

// Promise: a slice through space has its own height, however it lies.
TEST(NeperTess, ATiltedPlaneIsLaidFlat) {
  const double half = std::sqrt(0.5);
  const Vec<3> x{{1, 0, 0}}, y{{0, 1, 0}}, z{{0, 0, 1}};
  for (const auto& [along, up] : {std::pair{x, half * (y + z)}, std::pair{half * (x + z), y}, std::pair{x, z},
                                  std::pair{y, z}, std::pair{half * (x - y), z}}) {
    const TessFile file(turned(two_cells, along, up));
    const Cells<2> flat = read_neper_tess(file.path(), 0.2, 0.1).cells;
    const TessFile straight(two_cells);
    const Cells<2> as_it_was = read_neper_tess(straight.path(), 0.2, 0.1).cells;
    ASSERT_EQ(flat.vertices.size(), as_it_was.vertices.size());
    for (std::size_t v = 0; v < flat.vertices.size(); ++v)
      EXPECT_LT(norm(flat.vertices[v] - as_it_was.vertices[v]), 1e-12);  // 12 decimals of a length of 2
  }
  const TessFile bent(replaced(two_cells, "4  2 1 0 ", "4  2 1 0.1 "));
  EXPECT_TRUE(says(message([&] { read_neper_tess(bent.path(), 0.2, 0.1); }),
                   "line [0-9]+: \\([-0-9., ]+\\) lies [0-9.]+ off the plane of the largest cell"));
}

TEST(NeperTess, HasTheGroupsOfItsCells) {
  const TessFile without(two_cells);
  EXPECT_TRUE(read_neper_tess(without.path(), 0.2, 0.1).group.empty());
  const TessFile file(replaced(two_cells, "  *crysym", "  *group\n   4 -1\n  *crysym"));
  const NeperTess read = read_neper_tess(file.path(), 0.2, 0.1);
  EXPECT_EQ(read.group, (std::vector<int>{4, -1}));
  EXPECT_EQ(read.group_line, 10);
  const TessFile few(replaced(two_cells, "  *crysym", "  *group\n   4\n  *crysym"));
  EXPECT_TRUE(
      says(message([&] { read_neper_tess(few.path(), 0.2, 0.1); }), "line 12: expected the group of cell 2"));
}

// Promise: cells that vanished in the file leave no block, and those behind them keep their groups.
TEST(NeperTess, EmptyCellsAreLeftOut) {
  std::string text = replaced(two_cells, "**cell\n  2", "**cell\n  3\n  *group\n   1 2 3");
  text = replaced(text, "**face\n 2", "**face\n 3");
  text = replaced(text, "   2 4 2 5 4 3", "   2 0\n     0\n    0 0 0 0\n     0 0 0 0 0\n   3 4 2 5 4 3");
  const TessFile file(text);
  const NeperTess read = read_neper_tess(file.path(), 0.2, 0.1);
  EXPECT_EQ(read.cells.cells.size(), 2U);
  EXPECT_EQ(read.group, (std::vector<int>{1, 3}));
  const TessFile short_face(replaced(text, "   2 0\n", "   2 2 1 2\n"));
  EXPECT_TRUE(says(message([&] { read_neper_tess(short_face.path(), 0.2, 0.1); }),
                   "three or more vertices of a face"));
}

// Promise: a cell that regularisation has dented becomes convex blocks, all of its group.
TEST(NeperTess, ACellThatBendsInwardsIsCutIntoConvexParts) {
  std::string text = replaced(two_cells, "**cell\n  2", "**cell\n  2\n  *group\n   8 9");
  text = replaced(text, "**vertex\n 6", "**vertex\n 7");
  text = replaced(text, " **edge\n 7", "   7  1.5 0.5 0     2\n **edge\n 7");
  text = replaced(text, "1 4 1 2 5 6\n     4 1 7 5 6", "1 5 1 2 7 5 6\n     5 1 7 8 5 6");
  text = replaced(text, "2 4 2 5 4 3\n     4 7 -4 -3 -2", "2 5 2 7 5 4 3\n     5 7 8 -4 -3 -2");
  const TessFile file(text);
  const NeperTess read = read_neper_tess(file.path(), 0.2, 0.1);
  ASSERT_EQ(read.cells.cells.size(), 3U);
  EXPECT_EQ(read.group, (std::vector<int>{8, 9, 9}));
  EXPECT_NO_THROW(require_valid(read.cells, Region::rectangle(0.2, 0.1), "cells"));
  EXPECT_EQ(read_neper_tess(file.path(), TessSize{.unit = 1e-3}).cells.cells.size(), 3U);
}

TEST(NeperTess, IsAsLargeAsItsUnitSays) {
  const TessFile file(two_cells);
  const Cells<2> t = read_neper_tess(file.path(), TessSize{.unit = 0.1}).cells;
  EXPECT_DOUBLE_EQ(outline_of(t).box().width(), 0.2);
  EXPECT_DOUBLE_EQ(outline_of(t).box().height(), 0.1);
}

// Promise: cells count from 1, as the file does.
TEST(NeperTess, MessagesCountAsTheFileDoes) {
  const TessFile file(replaced(two_cells, "2 4 2 5 4 3", "2 4 2 4 5 3"));
  EXPECT_TRUE(says(message([&] { read_neper_tess(file.path(), 0.2, 0.1); }), "cell [12] .from 1."));
  EXPECT_TRUE(says(message([&] { read_neper_tess(file.path(), TessSize{.width = 0.2}); }),
                   "^" + file.path().string() + ".*cell [12] .from 1."));
}

/// The paper's aggregates on 500 blocks that were written to a file and read back.
Specimen<2> from_tess(double shortest_edge) {
  BlockParameters p;
  p.count = 500;
  Random random(1);
  const TessFile file(as_tess(make_blocks(p, Region::rectangle(0.15, 0.3), random).cells, 0.15, 0.3));
  SpecimenParameters parameters = paper_specimen(1);
  parameters.blocks.cells = read_neper_tess(file.path(), 0.15, 0.3).cells;
  parameters.blocks.shortest_edge = shortest_edge;
  return make_specimen(parameters);
}

TEST(NeperTess, IsRegularisedLikeOurOwn) {
  const Specimen<2> s = from_tess(0.1);
  EXPECT_EQ(s.cells.cells.size(), 500U);
  EXPECT_GT(s.metrics.vertices_merged, 0);
  EXPECT_EQ(s.metrics.seeds_redrawn, 0);
  EXPECT_EQ(s.metrics.edges_left_short, 0);
  EXPECT_GE(s.metrics.shortest_edge, 0.1 * s.metrics.mean_edge * (1 - 1e-12));
}

// Promise: edges that stay short, since no removal leaves the blocks fit, are told.
TEST(NeperTess, TellsOfEdgesThatAreLeftShort) {
  const Specimen<2> s = from_tess(0.5);
  EXPECT_GT(s.metrics.edges_left_short, 0);
  EXPECT_LT(s.metrics.shortest_edge, 0.5 * s.metrics.mean_edge);
}

struct Fault {
  const char* name;
  std::string from, to;
  const char* message;  ///< regular expression
};

class Malformed : public testing::TestWithParam<Fault> {};

TEST_P(Malformed, IsNamedWithFileAndLine) {
  const Fault& fault = GetParam();
  const TessFile file(replaced(two_cells, fault.from, fault.to));
  const std::string said = message([&] { read_neper_tess(file.path(), 0.2, 0.1); });
  EXPECT_EQ(said.find(file.path().string()), 0U) << said;
  EXPECT_TRUE(says(said, fault.message));
}

INSTANTIATE_TEST_SUITE_P(
    NeperTess, Malformed,
    testing::Values(
        Fault{"start", "***tess\n", "***tesr\n", "line 1: expected '\\*\\*\\*tess', found '\\*\\*\\*tesr'"},
        Fault{"version", "3.5", "1.9", "line 3: expected a format version 2.x or 3.x, found '1.9'"},
        Fault{"dimension", "2 standard", "1 standard", "line 5: expected the dimension 2"},
        Fault{"space", "2 standard", "3 standard",
              "line 5: the tessellation is of space.*\"polyhedra\" and file"},
        Fault{"type", "2 standard", "2 periodic",
              "line 5: the tessellation is periodic: .* Make it without -periodicity"},
        Fault{"other type", "2 standard", "2 raster", "line 5: expected the type 'standard'"},
        Fault{"number", "0.8 0 0     0", "0.8 O 0     0",
              "line 18: expected a coordinate of a vertex, found 'O'"},
        Fault{"infinite", "0.8 0 0     0", "inf 0 0     0", "line 18: .*finite"},
        Fault{"order", "   2  0.8", "   3  0.8", "line 18: expected the identifier 2 of a vertex, found '3'"},
        Fault{"count", "**vertex\n 6", "**vertex\n 7",
              "line 23: expected the identifier of vertex 7, found '\\*\\*edge'"},
        Fault{"huge", "**vertex\n 6", "**vertex\n 2000000000", "line 16: expected the number of vertices"},
        Fault{"reference", "1 4 1 2 5 6", "1 4 1 2 5 9",
              "line 34: expected a vertex of a face, 1 to 6, found '9'"},
        Fault{"degenerate", "1 4 1 2 5 6", "1 4 1 2 2 1", "at least three vertices"},
        Fault{"truncated", "     0 -1 0 0 0\n **domain", "     0 -1", "found '\\*general'"},
        Fault{"cells", "**cell\n  2", "**cell\n  3",
              "expected as many faces as cells, found '3 cells and 2 faces'"},
        Fault{"overlap", "2 4 2 5 4 3", "2 3 2 5 4", "cells do not fit together"},
        Fault{"stray", " **edge\n", " **vertex 6 edge\n", "line 23"},
        Fault{"second", " **edge\n", " **vertex\n", "line 23: expected one section '\\*\\*vertex' alone"},
        Fault{"domain", "2  2 0 0 x1y0", "2  2.1 0.2 0 x1y0",
              "expected a domain that is an upright rectangle"},
        Fault{"no domain", " **domain", " **dominion", "a section '\\*\\*domain'"},
        Fault{"no end", "***end\n", "", "found the end of the file"}),
    [](const auto& instance) { return std::regex_replace(instance.param.name, std::regex(" "), "_"); });

TEST(NeperTess, AnotherAspectRatioIsAnError) {
  const TessFile file(two_cells);
  EXPECT_TRUE(says(message([&] { read_neper_tess(file.path(), 0.2, 0.11); }), "aspect ratio"));
}

TEST(NeperTess, AMissingFileIsAnError) {
  EXPECT_TRUE(says(message([] { read_neper_tess("no/such.tess", 1, 1); }), "Cannot open"));
}

}  // namespace
}  // namespace pyroclast::specimen
