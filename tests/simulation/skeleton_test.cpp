// Promise: stones that no crack can part are told of, in the plane and in space, by the contacts that they
// have.
#include "pyroclast/simulation/skeleton.hpp"

#include <algorithm>
#include <cstddef>
#include <utility>

#include <gtest/gtest.h>

#include "pyroclast/laws/elastic.hpp"
#include "pyroclast/model/concrete_model.hpp"
#include "pyroclast/model/part.hpp"
#include "pyroclast/specimen/from_cells.hpp"
#include "ranks_in_threads.hpp"
#include "specimen/solid_bodies.hpp"

namespace pyroclast {
namespace {

/// Interfaces of which that between aggregate and mortar also joins two stones.
std::vector<InterfaceParameters> apart() {
  std::vector<InterfaceParameters> interfaces(2);
  interfaces[0].name = "mortar_mortar";
  interfaces[0].between = {{"mortar", "mortar"}};
  interfaces[1].name = "transition";
  interfaces[1].between = {{"aggregate", "mortar"}};
  interfaces[1].between_stones = {"aggregate"};
  return interfaces;
}

/// Squares of 1 m in rows: digits are stones, '.' is mortar.
specimen::Specimen<2> squares(const std::vector<std::string>& rows) {
  specimen::GivenCells<2> cells;
  cells.phases = {"aggregate", "mortar"};
  const int columns = static_cast<int>(rows[0].size()), count = static_cast<int>(rows.size());
  std::vector<int> stone;
  for (int y = 0; y <= count; ++y)
    for (int x = 0; x <= columns; ++x)
      cells.cells.vertices.push_back({{static_cast<double>(x), static_cast<double>(y)}});
  for (int y = 0; y < count; ++y)
    for (int x = 0; x < columns; ++x) {
      const int low = y * (columns + 1) + x, high = low + columns + 1;
      cells.cells.cells.push_back({low, low + 1, high + 1, high});
      cells.phase.push_back(rows[y][x] == '.' ? 1 : 0);
      stone.push_back(rows[y][x] == '.' ? -1 : rows[y][x] - '0');
    }
  specimen::Specimen<2> made = specimen::specimen_from(specimen::completed(std::move(cells)));
  made.stone = std::move(stone);
  return made;
}

/// Materials of the contacts of a model: elastic between blocks of aggregate, and cohesive elsewhere.
std::vector<ContactMaterial> contacts_of(const Model& model) {
  std::vector<ContactMaterial> contacts;
  for (const std::string& name : model.interface_names)
    contacts.emplace_back(name == "aggregate_aggregate" ? table_of<Elastic>() : table_of<Cohesive>());
  return contacts;
}

Skeleton of_squares(const specimen::Specimen<2>& specimen,
                    const std::vector<InterfaceParameters>& interfaces) {
  const auto model = make_model(specimen, 0.5, interfaces);
  return largest_skeleton(model, specimen.stone, contacts_of(model));
}

TEST(Skeleton, HangsTogetherByEdgesAndNotByCorners) {
  const Skeleton found = of_squares(squares({"01..",  //
                                             "..2.",  //
                                             "3334"}),
                                    {});
  EXPECT_EQ(found.stones, 3);
  EXPECT_DOUBLE_EQ(found.volume, 0.5 * 5.0);
  EXPECT_DOUBLE_EQ(found.share, 5.0 / 7.0);
}

TEST(Skeleton, EndsWhereStonesHaveContactsThatPart) {
  const Skeleton found = of_squares(squares({"01..",  //
                                             "..2.",  //
                                             "3334"}),
                                    apart());
  EXPECT_EQ(found.stones, 1);
  EXPECT_DOUBLE_EQ(found.share, 3.0 / 7.0);
}

TEST(Skeleton, IsLargerThanAFewStones) {
  const auto line = [](const std::vector<std::string>& rows,
                       const std::vector<InterfaceParameters>& interfaces) {
    const auto made = squares(rows);
    const auto model = make_model(made, 1.0, interfaces);
    return skeleton(model, made.stone, contacts_of(model));
  };
  const std::vector<std::string> small{"0..1", "2345", "...."}, large{"0..0", "0000", "1..."};
  EXPECT_NE(line(small, {}).find("100 % of their area is one cluster of 6 stones whose blocks touch"),
            std::string::npos);
  EXPECT_EQ(line(small, apart()), "");
  EXPECT_EQ(line(large, {}), "") << "one stone and a small one";
}

// A specimen can have blocks of aggregate that are of no stone; they part from none.
TEST(Skeleton, BlocksOfNoStoneHoldTogether) {
  const auto interfaces_of = [](std::vector<int> stone) {
    auto row = squares({"0123"});
    row.stone = std::move(stone);
    const auto model = make_model(row, 1.0, apart());
    std::vector<std::string> names;
    for (int face = 0; face < model.face_count(); ++face)
      names.push_back(model.interface_names[model.joint(model.face_contacts[face]).interface]);
    return std::pair(std::ranges::count(names, "transition"),
                     std::ranges::count(names, "aggregate_aggregate"));
  };
  EXPECT_EQ(interfaces_of({0, 1, 2, 3}), std::pair(std::ptrdiff_t{3}, std::ptrdiff_t{0}));
  EXPECT_EQ(interfaces_of({0, 1, -1, -1}), std::pair(std::ptrdiff_t{1}, std::ptrdiff_t{2}));
}

TEST(Skeleton, IsNotKnownWithoutStones) {
  const auto model = make_model(squares({"0123"}), 1.0);
  EXPECT_EQ(skeleton(model, {}, contacts_of(model)), "");
}

// In space a quarter of stones hangs together, where in the plane half would not.
TEST(Skeleton, OfBallsRunsThroughASolid) {
  specimen::SpecimenParameters p;
  p.seed = 1;
  p.aggregates = {.fraction = 0.28,
                  .d_min = 0.016,
                  .d_max = 0.025,
                  .fuller_exponent = 0.45,
                  .sieves = {0.016, 0.025},
                  .minimum_gap = 5e-4,
                  .attempts = 10000};
  p.blocks.count = 1000;
  p.blocks.radius_spread = 0.3;
  p.superposition = specimen::Superposition::fit;
  const specimen::Specimen<3> solid = specimen::made_in(p, specimen::cuboid(0.08, 0.08, 0.08));
  const auto joined = make_model(solid);
  const Skeleton found = largest_skeleton(joined, solid.stone, contacts_of(joined));
  EXPECT_GT(found.share, 0.8);
  EXPECT_GT(found.stones, std::ssize(solid.stones) / 2);
  EXPECT_NE(skeleton(joined, solid.stone, contacts_of(joined)).find("of their volume is one cluster of"),
            std::string::npos);
  auto in_chunks = joined;
  in_chunks.cut_into_chunks(100);
  RanksInThreads::run(3, [&](const std::shared_ptr<Ranks>& ranks) {
    const auto part = part_of(in_chunks, ranks);
    const Skeleton on_ranks = largest_skeleton(*part, solid.stone, contacts_of(*part));
    EXPECT_EQ(on_ranks.stones, ranks->is_first() ? found.stones : 0);
    EXPECT_EQ(on_ranks.volume, ranks->is_first() ? found.volume : 0.0);
    EXPECT_EQ(on_ranks.of_largest, ranks->is_first() ? found.of_largest : 0.0);
  });
  const auto parted = make_model(solid, 1.0, apart());
  EXPECT_EQ(largest_skeleton(parted, solid.stone, contacts_of(parted)).stones, 1);
  EXPECT_EQ(skeleton(parted, solid.stone, contacts_of(parted)), "");
}

}  // namespace
}  // namespace pyroclast
