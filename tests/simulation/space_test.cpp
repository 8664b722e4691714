// Code above the switch of dimension, on bodies in space: what it does in the plane other tests tell.

#include <cmath>
#include <numeric>
#include <vector>

#include <gtest/gtest.h>

#include "mechanics/bodies.hpp"
#include "messages.hpp"
#include "pyroclast/model/sets.hpp"
#include "pyroclast/simulation/acting/loads.hpp"
#include "pyroclast/simulation/acting/supports.hpp"
#include "pyroclast/simulation/watching/probe.hpp"
#include "pyroclast/thermal/conduction.hpp"
#include "pyroclast/thermal/temperature_field.hpp"

namespace pyroclast {
namespace {

constexpr double kEdge = 0.1;  ///< edge of a cube, m

/// A column of cubes with sets of its ends and some of their corners.
ModelOf<3> column_in_space(int cubes) {
  ModelOf<3> model = bodies::cubes(cubes, kEdge);
  const double height = cubes * kEdge;
  const auto line = [](double x, double y) { return Vec<3>{{x, y, 0.0}}; };
  add_sets(model, {{.name = "bottom", .place = InBox{{}, {{kEdge, kEdge, 0.0}}}},
                   {.name = "top", .place = InBox{{{0.0, 0.0, height}}, {{kEdge, kEdge, height}}}},
                   {.name = "corner", .place = NearestTo{line(0.0, 0.0)}},
                   {.name = "next", .place = NearestTo{line(kEdge, 0.0)}},
                   {.name = "all", .place = Everywhere{}}});
  return model;
}

TEST(Space, FacesThatAreJoinedAreNotOfTheOutline) {
  const ModelOf<3> model = column_in_space(3);
  const auto faces = faces_of(model);
  EXPECT_EQ(faces.size(), 2U * (2 + 3 * 4));  // two triangles a square
  const auto sum = [](double area, const Face& face) { return area + face.area; };
  EXPECT_NEAR(std::accumulate(faces.begin(), faces.end(), 0.0, sum), 14.0 * kEdge * kEdge, 1e-12);
  const auto top = faces_in(model, model.set("top"));
  ASSERT_EQ(top.size(), 2U);
  for (const Face& face : top) EXPECT_NEAR(face.normal[2], 1.0, 1e-12);
}

TEST(Space, TheExtentOfAContactIsItsArea) {
  const ModelOf<3> solid = column_in_space(2);
  double area = 0.0;
  for (int c = 0; c < solid.contact_count(); ++c) area += solid.extent(c);
  EXPECT_NEAR(area, kEdge * kEdge, 1e-12);
  ModelOf<2> plane = bodies::column(2, kEdge);
  double length = 0.0;
  for (int c = 0; c < plane.contact_count(); ++c) length += plane.extent(c);
  EXPECT_NEAR(length, kEdge, 1e-12);
}

TEST(Space, SupportsHinderSixMotions) {
  const ModelOf<3> model = column_in_space(2);
  Supports supports(model);
  const auto free = [&] { return supports.free_motion().value_or("none"); };
  EXPECT_EQ(free(), "moving along x and y and z, and turning");
  supports.hold("bottom", 2, {}, "");  // against z, and turning about x and y
  EXPECT_EQ(free(), "moving along x and y");
  supports.hold("corner", 0, {}, "");
  EXPECT_EQ(free(), "moving along y");
  supports.hold("corner", 1, {}, "");
  EXPECT_EQ(free(), "turning about an axis");
  supports.hold("next", 0, {}, "");  // along the line from the corner: no arm
  EXPECT_EQ(free(), "turning about an axis");
  supports.hold("next", 1, {}, "");
  EXPECT_EQ(free(), "none");
}

TEST(Space, AProbeReadsALinearFieldExactly) {
  const ModelOf<3> model = column_in_space(2);
  const auto field = [](const Vec<3>& x) { return 20.0 + 300.0 * x[0] - 200.0 * x[1] + 700.0 * x[2]; };
  std::vector<double> values;
  for (const auto& x : model.position) values.push_back(field(x));
  for (const Vec<3>& at : {Vec<3>{{0.0, 0.0, 0.0}}, {{0.03, 0.07, 0.11}}, {{0.1, 0.05, 0.2}}})
    EXPECT_NEAR(Probe(model, {"p", at}).read(values), field(at), 1e-11);
  expect_in("no zone of the specimen holds the point (0.05, 0.05, 0.3) m of probe p", message([&] {
              Probe(model, {"p", {{0.05, 0.05, 0.3}}});
            }));
}

TEST(Space, MeansOfAFieldAreOverVolumes) {
  const ModelOf<3> model = column_in_space(2);
  const HeatMaterial material{Curve::constant(2.0), Curve::constant(2e6)};
  auto solver = std::make_unique<Conduction<3>>(model, std::vector<std::optional<HeatMaterial>>{material},
                                                HeatParameters{.temperature_range = {0.0, 100.0},
                                                               .initial_temperature = 50.0,
                                                               .safety = 0.9,
                                                               .largest_change = 50.0,
                                                               .largest_step = 10.0});
  std::vector<double> temperature;
  for (const int g : solver->nodes().gridpoint) temperature.push_back(300.0 * model.position[g][2] + 10.0);
  solver->set_temperature(temperature);
  const TemperatureField field(model, std::move(solver));
  EXPECT_NEAR(field.mean(), 300.0 * kEdge + 10.0, 1e-11);
  for (int z = 0; z < model.zone_count(); ++z) {
    double height = 0.0;
    for (const int g : model.zones[z]) height += 0.25 * model.position[g][2];
    EXPECT_NEAR(field.zones()[z], 300.0 * height + 10.0, 1e-11);
  }
  for (int c = 0; c < model.contact_count(); ++c)
    EXPECT_NEAR(field.contacts()[c], 300.0 * kEdge + 10.0, 1e-11);
}

MotionOf<3> elastic_in_space(const ModelOf<3>& model) {
  return {model,
          {2400.0},
          by_interface(model, std::vector<ZoneProperties>(model.zones.size(), zone_properties<3>(3e10, 0.2)),
                       {bodies::elastic_contact()}),
          bodies::quasi_static<3>(),
          nullptr};
}

TEST(Space, APressureActsOnTheAreaOfItsFaces) {
  const ModelOf<3> model = column_in_space(2);
  MotionOf<3> motion = elastic_in_space(model);
  Loads loads(motion, kEdge);
  loads.set({{"top", {.force = {{10.0, 20.0, 0.0}}, .pressure = 1e6}}});
  const Vec<3> total = loads.total("top");
  EXPECT_NEAR(total[0], 10.0, 1e-9);
  EXPECT_NEAR(total[1], 20.0, 1e-9);
  EXPECT_NEAR(total[2], -1e6 * kEdge * kEdge, 1e-6);
  for (int g : model.set("bottom"))
    for (int i : {0, 1, 2}) motion.constraints().prescribe_velocity(g, i, 0.0);
  motion.advance(20000);
  const GridpointSet bottom = gridpoint_set(model, model.set("bottom"));
  for (int i : {0, 1, 2}) EXPECT_NEAR(motion.totals().total_force(bottom)[i], total[i], 1e-3);
}

TEST(Plane, AForceAcrossItIsRefused) {
  ModelOf<2> model = bodies::column(2, kEdge);
  model.sets["top"] = {6, 7};
  MotionOf<2> motion(
      model, {2400.0},
      by_interface(model, std::vector<ZoneProperties>(model.zones.size(), zone_properties<2>(3e10, 0.2)),
                   {bodies::elastic_contact()}),
      bodies::quasi_static<2>(), nullptr);
  Loads loads(motion, kEdge);
  expect_in("a force on set \"top\" acts across the plane of this body", message([&] {
              loads.set({{"top", {.force = {{0.0, 1.0, 1.0}}}}});
            }));
  auto parameters = bodies::quasi_static<2>();
  parameters.gravity = {{0.0, 0.0, -9.81}};
  expect_in("gravity acts across the plane of this body",
            message([&] { bodies::mechanics(model, bodies::elastic_contact(), parameters); }));
}

TEST(Space, CracksAreCountedByTheirAreas) {
  const ModelOf<3> model = bodies::five_tetrahedra();
  MotionOf<3> motion(
      model, {2400.0},
      by_interface(model, std::vector<ZoneProperties>(model.zones.size(), zone_properties<3>(3e10, 0.2)),
                   {mortar_contact()}),
      bodies::quasi_static<3>(), nullptr);
  // the inner one of the five, the last, is torn out of the others
  const double speed = 1e-4 / (500 * motion.time_step());
  for (int g = 0; g < model.gridpoint_count(); ++g)
    for (int i : {0, 1, 2})
      motion.constraints().prescribe_velocity(g, i, g / 4 == 4 ? speed * (i - 0.5) : 0.0);
  motion.advance(500);
  const auto kinds = motion.crack_kinds();
  const Cracks cracks = motion.totals().count_cracks(kinds);
  ASSERT_EQ(kinds.size(), 2U);
  for (std::size_t k = 0; k < kinds.size(); ++k) {
    CrackCount expected;
    for (int c = 0; c < model.contact_count(); ++c)
      if (const double damage = motion.read().remembered(c, kinds[k].damage); damage > 0.0)
        expected.add(damage >= 1.0, model.contacts[c].area);
    EXPECT_GT(expected.damaged, 0) << kinds[k].name;
    EXPECT_EQ(cracks.of_kind[k].damaged, expected.damaged) << kinds[k].name;
    EXPECT_EQ(cracks.of_kind[k].broken, expected.broken) << kinds[k].name;
    EXPECT_NEAR(cracks.of_kind[k].extent, expected.extent, 1e-12) << kinds[k].name;
  }
  EXPECT_GT(cracks.mean_opening, 0.0);
}

/// Moves all gridpoints of a body by a linear field, and tells whether zones have its strain and the stress
/// of Hooke's law with it.
template <int Dim>
void strains_by_hooke(const ModelOf<Dim>& model) {
  constexpr double young = 3e10, poisson = 0.2, shear = 0.5 * young / (1.0 + poisson);
  auto parameters = bodies::quasi_static<Dim>();
  parameters.time_step = 1e-5;
  MotionOf<Dim> motion(
      model, {2400.0},
      by_interface(model,
                   std::vector<ZoneProperties>(model.zones.size(), zone_properties<Dim>(young, poisson)),
                   {bodies::elastic_contact()}),
      parameters, nullptr);
  const double gradient[3][3] = {{1e-5, 3e-5, -1e-5}, {1e-5, -2e-5, 2e-5}, {4e-5, 0.0, 5e-6}};
  for (int g = 0; g < model.gridpoint_count(); ++g)
    for (int i = 0; i < Dim; ++i) {
      double moved = 0.0;
      for (int j = 0; j < Dim; ++j) moved += gradient[i][j] * model.position[g][j];
      motion.constraints().prescribe_velocity(g, i, moved / motion.time_step());
    }
  motion.advance(1);
  for (int g = 0; g < model.gridpoint_count(); ++g)
    for (int i = 0; i < Dim; ++i) motion.constraints().prescribe_velocity(g, i, 0.0);
  motion.advance(1);
  for (int z = 0; z < model.zone_count(); ++z) {
    const SymmetricTensor<3> s = motion.read().stress(z), e = motion.read().elastic_strain(z);
    constexpr int places[6][2] = {{0, 0}, {1, 1}, {2, 2}, {0, 1}, {1, 2}, {0, 2}};
    for (int k = 0; k < 6; ++k) {
      const auto [i, j] = places[k];
      if (j < Dim) {
        EXPECT_NEAR(e[k], 0.5 * (gradient[i][j] + gradient[j][i]), 1e-16) << k;
      }
      const double hooke =
          i == j ? (s[i] - poisson * (s[0] + s[1] + s[2] - s[i])) / young : s[k] / (2.0 * shear);
      EXPECT_NEAR(e[k], hooke, 1e-16) << k;
    }
    if (Dim == 2) {
      EXPECT_EQ(s[2], 0.0);
    }
  }
}

TEST(Plane, AZoneStrainsAcrossItAsPlaneStressHasIt) {
  strains_by_hooke(bodies::tessellated(20, 0.05, 0.05, 3));
}

TEST(Space, AZoneStrainsByHookesLaw) {
  strains_by_hooke(bodies::five_tetrahedra());
}

}  // namespace
}  // namespace pyroclast
