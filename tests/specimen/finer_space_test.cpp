// Promise: blocks of a solid are as fine near its parts as asked for, in raw and in merged cells, and their
// contacts know it.
#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <map>
#include <numbers>

#include <gtest/gtest.h>

#include "pyroclast/model/concrete_model.hpp"
#include "pyroclast/specimen/cells_file.hpp"
#include "pyroclast/specimen/from_cells.hpp"
#include "pyroclast/specimen/polyhedron.hpp"
#include "pyroclast/specimen/specimen.hpp"
#include "solid_bodies.hpp"

namespace pyroclast::specimen {
namespace {

constexpr double kFineInSpace = 5e-3, kLargestInSpace = 10e-3, kReachInSpace = 12e-3;
/// With which blocks grow by a fifth from middle to middle.
constexpr double kSlopeInSpace = 0.4 / 2.2;
constexpr double kGrowingInSpace = (kLargestInSpace - kFineInSpace) / kSlopeInSpace;  // 27.5 mm

/// Asks for blocks of mortar that are finer near a part.
SpecimenParameters finer_near(FinerPart part, const Prism& body, std::uint64_t seed, double shortest_edge) {
  SpecimenParameters p;
  p.seed = seed;
  p.aggregates.phase = p.matrix;
  part.size = kFineInSpace;
  part.distance = kReachInSpace;
  p.blocks.finer = {part};
  p.blocks.largest_size = kLargestInSpace;
  p.blocks.count =
      static_cast<int>(std::lround(SizedExtent(room_in(body), p.blocks.finer).blocks(kLargestInSpace)));
  p.blocks.radius_spread = 0.3;
  p.blocks.shortest_edge = shortest_edge;
  p.blocks.largest_bend = 20.0 * std::numbers::pi / 180.0;
  return p;
}

/// The part by the face of a body on a side.
FinerPart on_side(const Prism& body, const std::string& side) {
  FinerPart part;
  for (const FlatPart& flat : body.flat_parts())
    if (body.sides()[flat.side].name == side) part.pieces.push_back(flat.corners);
  return part;
}

/// Extents and numbers of blocks by band.
using Bands = std::map<int, std::array<double, 2>>;

template <class Band>
void add_to_bands(const Specimen<3>& s, Bands& bands, Band band_of) {
  for (std::size_t cell = 0; cell < s.cells.cells.size(); ++cell) {
    const int band = band_of(zone_cell(s.cells, cell).gridpoints.back());
    bands[band][0] += extent(s.cells, cell);
    ++bands[band][1];
  }
}

double size_in(const Bands& bands, int band) {
  return std::cbrt(bands.at(band)[0] / bands.at(band)[1]);
}

// Bands of 7 mm beside the left side: up to the distance, over the growth, and beyond.
TEST(FinerBlocksOfSolids, HaveTheirSizesNearAndFarAndFillTheBody) {
  const Prism body = cuboid(0.1, 0.06, 0.06);
  constexpr double kBand = 7e-3;
  for (const double shortest_edge : {0.0, 0.35}) {
    Bands bands;
    for (std::uint64_t seed = 1; seed <= 4; ++seed) {
      const auto p = finer_near(on_side(body, "left"), body, seed, shortest_edge);
      const Specimen<3> s = made_in(p, body);
      require_valid(s.cells, body, "finer blocks");
      EXPECT_EQ(std::ssize(s.cells.cells), p.blocks.count);
      ASSERT_EQ(std::ssize(s.size), p.blocks.count);
      for (std::size_t cell = 0; cell < s.size.size(); ++cell) {
        const double x = zone_cell(s.cells, cell).gridpoints.back()[0];
        EXPECT_NEAR(
            s.size[cell],
            std::clamp(kFineInSpace + kSlopeInSpace * (x - kReachInSpace), kFineInSpace, kLargestInSpace),
            1e-12);
      }
      add_to_bands(s, bands, [&](const Vec<3>& place) { return static_cast<int>(place[0] / kBand); });
    }
    for (int band = 0; band < 10; ++band) {
      const double middle = (band + 0.5) * kBand;
      const double size =
          std::clamp(kFineInSpace + kSlopeInSpace * (middle - kReachInSpace), kFineInSpace, kLargestInSpace);
      EXPECT_NEAR(size_in(bands, band), size, 0.1 * size) << band;
    }
    // from the first of the bands that grow to the last, by the blocks between them
    const int first = 2, last = static_cast<int>((kReachInSpace + kGrowingInSpace) / kBand) - 1;
    double blocks = 0.0;
    for (int band = first; band < last; ++band)
      blocks += kBand / (0.5 * (size_in(bands, band) + size_in(bands, band + 1)));
    // 1.2, and the scatter of the seeds
    EXPECT_LT(std::pow(size_in(bands, last) / size_in(bands, first), 1.0 / blocks), 1.22);
  }
}

// Promise: the outside of a cylinder, its end, a line and a point are parts too.
TEST(FinerBlocksOfSolids, StandNearTheOutsideOfACylinderItsEndALineAndAPoint) {
  const Prism body = cylinder(0.09, 0.07);
  const Vec<3> middle{{0.045, 0.035, 0.045}};
  const auto from_axis = [&](const Vec<3>& p) { return std::hypot(p[0] - middle[0], p[2] - middle[2]); };
  struct Case {
    FinerPart part;
    std::function<double(const Vec<3>&)> distance;
  };
  const std::vector<Case> cases{
      {on_side(body, "rim"), [&](const Vec<3>& p) { return 0.045 - from_axis(p); }},
      {on_side(body, "bottom"), [&](const Vec<3>& p) { return p[1]; }},
      {{.pieces = {{{{middle[0], 0.0, middle[2]}}, {{middle[0], 0.07, middle[2]}}}}}, from_axis},
      {{.pieces = {{middle}}}, [&](const Vec<3>& p) { return norm(p - middle); }}};
  for (std::size_t i = 0; i < cases.size(); ++i) {
    Bands bands;
    add_to_bands(made_in(finer_near(cases[i].part, body, 1, 0.35), body), bands,
                 [&](const Vec<3>& place) { return cases[i].distance(place) < kReachInSpace ? 0 : 1; });
    EXPECT_NEAR(size_in(bands, 0), kFineInSpace, 0.1 * kFineInSpace) << i;
    EXPECT_GT(size_in(bands, 1), 1.25 * kFineInSpace) << i;
  }
}

// Promise: edges of fine blocks are merged where they are short against those of blocks of their size.
TEST(FinerBlocksOfSolids, LoseEdgesThatAreShortForTheirSize) {
  const Prism body = cuboid(0.1, 0.06, 0.06);
  const Specimen<3> s = made_in(finer_near(on_side(body, "left"), body, 1, 0.35), body);
  EXPECT_LT(s.metrics.edges_left_short, 20);
  EXPECT_LE(s.metrics.largest_bend, 20.0 + 1e-9);
  std::array<double, 2> sum{}, count{};
  int short_ones = 0;
  for (const Facet<3>& face : s.cells.faces)
    for (std::size_t i = 0; i < face.corners.size(); ++i) {
      const Vec<3>&a = s.cells.vertices[face.corners[i]],
            &b = s.cells.vertices[face.corners[(i + 1) % face.corners.size()]];
      const double x = 0.5 * (a + b)[0];
      const int band = x < kReachInSpace ? 0 : x > kReachInSpace + kGrowingInSpace ? 1 : -1;
      if (band < 0) continue;
      sum[band] += norm(b - a);
      ++count[band];
      if (band == 0 && norm(b - a) < 0.35 * 0.5 * kLargestInSpace) ++short_ones;
    }
  // Edges of both are as long over the size of their blocks; a limit for the mean of all would merge many
  // more of the fine ones.
  const double fine = sum[0] / count[0] / kFineInSpace, coarse = sum[1] / count[1] / kLargestInSpace;
  EXPECT_NEAR(fine / coarse, 1.0, 0.1);
  EXPECT_GT(short_ones, 50);
}

// Promise: each contact knows the mean size of its two blocks, one at a bearing that of the block there; a
// file keeps the sizes to the bit.
TEST(FinerBlocksOfSolids, TellContactsAndFilesTheirSizes) {
  const Prism body = cuboid(0.1, 0.06, 0.06);
  const Specimen<3> s = made_in(finer_near(on_side(body, "top"), body, 1, 0.35), body);
  const ModelOf<3> model = make_model(s, 1.0, {}, platens(0.02));
  const int first = model.block_of(model.set("specimen").front());
  for (int c = 0; c < model.contact_count(); ++c) {
    const Joint& joint = model.joint(c);
    const auto size = [&](int block) { return s.size[static_cast<std::size_t>(block - first)]; };
    const int a = model.block_of(joint.a), b = model.block_of(joint.b);
    const double expected = model.is_of_bearing(a)   ? size(b)
                            : model.is_of_bearing(b) ? size(a)
                                                     : 0.5 * (size(a) + size(b));
    EXPECT_EQ(joint.block_size, expected);
  }
  auto read = std::get<GivenCells<3>>(cells_from(cells_text(s), "blocks.json"));
  EXPECT_EQ(read.size, s.size);
  EXPECT_EQ(read.stone, s.stone);
  EXPECT_EQ(specimen_from(std::move(read)).size, s.size);
}

TEST(FinerBlocksOfSolids, StonesAreSmallBesideTheBlocksAroundThem) {
  const Prism body = cuboid(0.1, 0.06, 0.06);
  auto p = finer_near(on_side(body, "left"), body, 1, 0.0);
  p.aggregates = {.phase = "aggregate",
                  .fraction = 0.1,
                  .d_min = 0.0169,
                  .d_max = 0.0171,
                  .fuller_exponent = 0.5,
                  .sieves = {0.0169, 0.0171},
                  .minimum_gap = 0.0005,
                  .attempts = 100000};
  p.superposition = Superposition::each;
  const Specimen<3> s = made_in(p, body);
  const auto far =
      std::ranges::count_if(s.stones, [](const Stone<3>& ball) { return ball.centre[0] > 0.02; });
  EXPECT_GE(s.small_stones, far);
  EXPECT_LT(s.small_stones, std::ssize(s.stones));
  EXPECT_NE(warnings(s).front().find("smaller than 3 blocks there"), std::string::npos);
}

}  // namespace
}  // namespace pyroclast::specimen
