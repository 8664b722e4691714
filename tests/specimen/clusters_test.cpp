// Promise: stones that bear on each other without mortar between are told of.
#include "pyroclast/specimen/clusters.hpp"

#include "examples.hpp"
#include "pyroclast/specimen/from_cells.hpp"

namespace pyroclast::specimen {
namespace {

/// Squares of 1 m in rows, by phase: '#' aggregate, '.' mortar.
Specimen squares(const std::vector<std::string>& rows) {
  Cells cells;
  cells.phases = {"aggregate", "mortar"};
  const int columns = static_cast<int>(rows[0].size()), count = static_cast<int>(rows.size());
  for (int y = 0; y <= count; ++y)
    for (int x = 0; x <= columns; ++x)
      cells.tessellation.vertices.push_back({{static_cast<double>(x), static_cast<double>(y)}});
  for (int y = 0; y < count; ++y)
    for (int x = 0; x < columns; ++x) {
      const int low = y * (columns + 1) + x, high = low + columns + 1;
      cells.tessellation.cells.push_back({low, low + 1, high + 1, high});
      cells.phase.push_back(rows[y][x] == '#' ? 0 : 1);
    }
  Specimen specimen = specimen_from(std::move(cells));
  specimen.matrix = 1;
  return specimen;
}

TEST(Clusters, HangTogetherByEdgesAndNotByCorners) {
  const Specimen specimen = squares({"##..",  //
                                     "..#.",  //
                                     "####"});
  const Cluster cluster = largest_cluster(specimen);
  EXPECT_EQ(cluster.phase, 0);
  EXPECT_DOUBLE_EQ(cluster.area, 5.0);
  EXPECT_DOUBLE_EQ(cluster.share, 5.0 / 7.0);
}

TEST(Clusters, TheMatrixIsNone) {
  EXPECT_EQ(largest_cluster(squares({"..", ".."})).phase, -1);
}

TEST(Clusters, ASkeletonIsLargerThanAFewStones) {
  Specimen specimen = squares({"#..#",  //
                               "####",  //
                               "...."});
  EXPECT_EQ(skeleton(specimen), "") << "without stones that are known nothing tells a stone from many";
  specimen.aggregates = {{{{0.5, 0.5}}, 1.0}};
  EXPECT_TRUE(
      says(skeleton(specimen), "100 % of the aggregate is one cluster of blocks that touch, 8 times"));
  specimen.aggregates = {{{{0.5, 0.5}}, 2.5}};
  EXPECT_EQ(skeleton(specimen), "");
  specimen.matrix = -1;
  EXPECT_EQ(skeleton(specimen), "");
}

// The paper's specimen has stones in mortar; a fraction of 0.45 in 1,000 blocks can have a skeleton.
TEST(Clusters, CoarseBlocksOfManyStonesAreASkeleton) {
  EXPECT_EQ(skeleton(make_specimen(paper_specimen(1))), "");
  SpecimenParameters coarse = paper_specimen(4);
  coarse.aggregates.fraction = 0.45;
  coarse.aggregates.attempts = 100000;
  coarse.blocks.count = 1000;
  coarse.superposition = Superposition::fit;
  EXPECT_TRUE(says(skeleton(make_specimen(coarse)), "stones form a skeleton"));
}

}  // namespace
}  // namespace pyroclast::specimen
