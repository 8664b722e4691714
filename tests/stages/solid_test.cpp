// Stages, press, gauges and fields on a body in space: the same code as in the plane, and a stage of one's
// own.

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <memory>
#include <numbers>

#include <gtest/gtest.h>

#include "mechanics/bodies.hpp"
#include "messages.hpp"
#include "pyroclast/base/random.hpp"
#include "pyroclast/results/field_files.hpp"
#include "pyroclast/simulation/watching/fields.hpp"
#include "shake.hpp"
#include "stages/small_runs.hpp"

namespace pyroclast {
namespace {

constexpr int kCubes = 4;
constexpr double kEdge = 0.03;  ///< edge of a cube, m

/// A column of cubes of mortar along y, between two cubes of steel, with the materials of a deck.
SpecimenBody column_between_platens(const Setup& setup) {
  auto model = std::make_unique<ModelOf<3>>(bodies::cubes(kCubes + 2, kEdge));
  for (auto& x : model->position) x = {{x[1], x[2] - kEdge, x[0]}};  // turned, its lower end at y = 0
  for (auto& c : model->contacts) {
    const auto turned = [](const Vec<3>& v) { return Vec<3>{{v[1], v[2], v[0]}}; };
    c.normal = turned(c.normal);
    for (auto& t : c.tangents) t = turned(t);
  }
  const auto in_plane = make_simulation(setup);
  const Model& flat = in_plane->model();
  model->material_names = flat.material_names;
  model->interface_names = flat.interface_names;
  model->bearing_materials = flat.bearing_materials;
  model->bearing_interfaces = flat.bearing_interfaces;
  const auto number_of = [](const auto& names, const char* name) {
    return static_cast<int>(std::ranges::find(names, name) - names.begin());
  };
  for (int b = 0; b < kCubes + 2; ++b)
    model->block_material[b] =
        number_of(flat.material_names, b == 0 || b == kCubes + 1 ? "platen" : "mortar");
  for (auto& c : model->contacts)
    c.interface = c.face == 0 || c.face == kCubes ? static_cast<int>(flat.interface_names.size()) - 1
                                                  : number_of(flat.interface_names, "mortar_mortar");
  model->cut_into_chunks(blocks_of_a_chunk(3));
  const double height = kCubes * kEdge;
  const auto put = [&](const char* name, int first_block, int last_block, auto holds) {
    for (int g = model->block_gridpoints[first_block]; g < model->block_gridpoints[last_block]; ++g)
      if (holds(model->position[g])) model->sets[name].push_back(g);
  };
  const auto at = [](int axis, double place) {
    return [=](const Vec<3>& x) { return std::abs(x[axis] - place) < 1e-9; };
  };
  const auto anywhere = [](const Vec<3>&) { return true; };
  put("bottom_platen", 0, 1, anywhere);
  put("bottom_platen_support", 0, 1, at(1, -kEdge));
  put("bottom_platen_face", 0, 1, at(1, 0.0));
  put("specimen", 1, kCubes + 1, anywhere);
  put("bottom", 1, kCubes + 1, at(1, 0.0));
  put("top", 1, kCubes + 1, at(1, height));
  put("left", 1, kCubes + 1, at(0, 0.0));
  put("right", 1, kCubes + 1, at(0, kEdge));
  put("front", 1, kCubes + 1, at(2, 0.0));
  put("back", 1, kCubes + 1, at(2, kEdge));
  put("top_platen", kCubes + 1, kCubes + 2, anywhere);
  put("top_platen_face", kCubes + 1, kCubes + 2, at(1, height));
  put("top_platen_support", kCubes + 1, kCubes + 2, at(1, height + kEdge));
  return {std::move(model),
          {{0.0, 1.0}, kEdge, kEdge, kEdge * std::cbrt(kCubes)},
          {},
          Press::Specimen{1, height, kEdge * kEdge, {kEdge, kEdge}}};
}

/// A deck whose stages are run on the column.
struct Solid {
  explicit Solid(const std::string& text, const StageRegistry& kinds = {})
      : setup(read(text, kinds)),
        simulation(column_between_platens(setup), setup.block_materials, setup.heat, {}, {}, setup.moving,
                   std::make_shared<Team>()),
        run(simulation, std::move(setup.stages)) {}
  double at_end_of(int stage, const char* column) const {
    return run.history().cell(run.courses()[stage].rows.last - 1, column).value();
  }

  Setup setup;
  Simulation simulation;
  Run run;
};

// In a column the stress is even, so that the estimate of even stress is its modulus, and it expands freely.
TEST(Solid, GoesThroughTheStagesOfAHotTest) {
  Solid solid(deck(kUniform + kSettle + load("level = 0.1\nf_c = \"30 MPa\"") + heat("60 degC") + kCompress));
  ASSERT_EQ(solid.run.run(), Outcome::completed);
  const Simulation& s = solid.simulation;
  const double cold = estimate_modulus(s.model(), s.materials());
  EXPECT_NEAR(solid.at_end_of(1, "stress_MPa"), 3.0, 0.005);  // some 4 kPa of it are weight
  const double loaded = solid.at_end_of(1, "specimen_strain") - solid.at_end_of(0, "specimen_strain");
  EXPECT_NEAR(loaded, 3e6 / cold, 2e-3 * loaded);
  const double hot = estimate_modulus(s.model(), s.materials(), 60.0);
  const double heated = solid.at_end_of(2, "specimen_strain") - solid.at_end_of(1, "specimen_strain");
  EXPECT_NEAR(heated, 3e6 * (1.0 / hot - 1.0 / cold) - 40.0 * 1e-5, 2e-3 * 4e-4);
  EXPECT_NEAR(solid.at_end_of(2, "lateral_strain") - solid.at_end_of(1, "lateral_strain"), 4e-4, 4e-6);
  const double stress = solid.at_end_of(3, "stress_MPa") - solid.at_end_of(2, "stress_MPa");
  const double strain = solid.at_end_of(3, "specimen_strain") - solid.at_end_of(2, "specimen_strain");
  EXPECT_NEAR(1e6 * stress / strain, hot, 0.01 * hot);
}

TEST(Solid, CracksOfAnAreaAreTold) {
  Solid solid(deck(kUniform + kSettle + kCompress));
  ASSERT_EQ(solid.run.run(), Outcome::completed);
  EXPECT_TRUE(solid.run.history().has("tension_mortar_mortar_area_m2"));
  EXPECT_FALSE(solid.run.history().has("tension_mortar_mortar_length_m"));
  const auto fields = fields_of(solid.simulation);
  const auto displacement = std::ranges::find(fields, "displacement", &Field::name);
  const auto values = values_of({*displacement}, solid.simulation).front();
  EXPECT_EQ(values.size(), 3U * solid.simulation.model().gridpoint_count());
  const auto stress =
      std::ranges::find_if(fields, [](const Field& f) { return f.name == "stress" && f.item == Item::zone; });
  const auto tensors = values_of({*stress}, solid.simulation).front();
  EXPECT_NEAR(tensors[6 * 12 + 1], -1e6 * solid.run.history().last("stress_MPa").value(), 2e4);  // of zone 12
}

// Promise: a stage of one's own that knows no dimension serves both.
TEST(Solid, AStageOfOnesOwnServesIt) {
  Solid solid(deck(kUniform + kSettle + kShake + kCompress), with_shake());
  EXPECT_EQ(solid.run.run(), Outcome::completed);
  const auto strain = solid.run.history().values("stage_strain", solid.run.courses()[1].rows);
  ASSERT_EQ(strain.size(), 4U);
  EXPECT_GT(strain[0], strain[1]);
  EXPECT_LT(strain[1], strain[2]);
}

/// A cylinder of concrete, 60 mm x 120 mm, between the platens of a deck.
SpecimenBody cylinder_between_platens(const Setup& setup) {
  constexpr double kDiameter = 0.06, kHeight = 0.12;
  const auto section = specimen::Region::polygon(
      specimen::circle_corners({{0.5 * kDiameter, 0.5 * kDiameter}}, kDiameter, kDiameter / 8.0), {"rim"},
      true);
  auto parameters = setup.specimen;
  parameters.blocks.count = 120;
  parameters.superposition = specimen::Superposition::each;
  parameters.outline = specimen::Prism(section, specimen::Prism::Axis::y, kHeight);
  return make_body(specimen::make_specimen<3>(parameters), 1.0, {}, setup.moving);
}

// Promise: the stress of a cylinder of polyhedra is the force over the area of a circle, and its lateral
// strain is that of its diameter. As long as nothing cracks the estimate of even stress is a lower bound of
// its modulus, a tight one.
TEST(Solid, ACylinderOfConcreteHasItsStressAndModulus) {
  auto setup = read(deck(kUniform + kSettle + kCompress));
  Simulation simulation(cylinder_between_platens(setup), setup.block_materials, setup.heat, {}, {},
                        setup.moving, std::make_shared<Team>());
  pyroclast::Run run(simulation, std::move(setup.stages));
  ASSERT_EQ(run.run(), Outcome::completed);
  const Model& model = simulation.model();
  const Press& press = simulation.press();
  const double force =
      simulation.motion().totals().total_force(gridpoint_set(model, model.set("top_platen_support")))[1];
  const double circle = 0.25 * std::numbers::pi * 0.06 * 0.06;
  EXPECT_NEAR(press.stress_top(), force / circle, 1e-9 * std::abs(press.stress_top()));
  EXPECT_NEAR(press.volume(), circle * 0.12, 1e-9 * circle);
  const auto& history = run.history();
  const auto rows = run.courses()[1].rows;
  const auto change = [&](const char* column) {
    const auto values = history.values(column, rows);
    return values.back() - values.front();
  };
  const double modulus = 1e6 * change("stress_MPa") / change("specimen_strain");
  const double estimate = estimate_modulus(model, simulation.materials());
  EXPECT_GT(modulus, 0.99 * estimate);
  EXPECT_LT(modulus, 1.06 * estimate);
  const double poisson = change("lateral_strain") / change("specimen_strain");
  EXPECT_GT(poisson, 0.15);
  EXPECT_LT(poisson, 0.25);
  EXPECT_TRUE(history.has("tension_mortar_mortar_area_m2"));
}

// Promise: a cylinder that hovers, tilted and with a rough end, is set down on three points of its end around
// the middle, no point comes below the platen, and the upper platen comes to lie on it.
TEST(Solid, IsSetDownOnThreePoints) {
  auto setup = read(deck(kUniform + kSettle));
  Simulation simulation(cylinder_between_platens(setup), setup.block_materials, setup.heat, {}, {},
                        setup.moving, std::make_shared<Team>());
  Press& press = simulation.press();
  Motion& motion = simulation.motion();
  const Model& model = simulation.model();
  press.move_evenly({.lift = 2e-5, .tilt = {1e-4, -3e-4}}, 1.0, false);
  Random random(7);
  for (int g : model.set("bottom"))
    motion.constraints().prescribe_velocity(
        g, 1, (4e-5 + 1e-4 * model.place(g)[0] + 5e-7 * random.uniform()) / motion.time_step());
  motion.advance(1);
  const Press::EvenMotion touch = press.to_touch();
  EXPECT_LT(std::abs(touch.tilt[0] + 1e-4), 0.5e-4);
  EXPECT_LT(std::abs(touch.tilt[1]), 0.5e-4) << "the end itself is tilted along x alone";
  press.move_evenly(touch, 1.0, true);
  motion.advance(1);
  constexpr double kMoved =
      1e-11;  // the platens are elastic: they move by 1e-12 m meanwhile, ends are rough by 5e-7 m
  std::vector<Vec<3>> touching;
  Vec<3> middle{};
  for (int g : model.set("bottom")) {
    const double up = motion.read().displacement(g)[1];
    EXPECT_GT(up, -kMoved);
    if (up < kMoved) touching.push_back(model.place(g));
    middle += model.place(g) * (1.0 / static_cast<double>(model.set("bottom").size()));
  }
  ASSERT_EQ(touching.size(), 3U);
  const auto turn = [&](int from, int to) {
    const Vec<3> a = touching[from] - middle, b = touching[to] - middle;
    return a[0] * b[2] - a[2] * b[0] > 0.0;
  };
  EXPECT_TRUE(turn(0, 1) == turn(1, 2) && turn(1, 2) == turn(2, 0)) << "the middle is not among them";
  EXPECT_LT(press.gap(), kMoved);
}

TEST(Solid, ABodyThatIsNoneIsRefused) {
  const auto setup = read(deck(kUniform + kSettle));
  const auto refusal = [&](auto change) {
    SpecimenBody body = column_between_platens(setup);
    change(body);
    return message([&] {
      Simulation(std::move(body), setup.block_materials, setup.heat, {}, {}, setup.moving,
                 std::make_shared<Team>());
    });
  };
  expect_in("without blocks", refusal([](auto& body) { body.model = nullptr; }));
  expect_in("thickness", refusal([](auto& body) { body.model->thickness = 0.5; }));
  expect_in("phases", refusal([](auto& body) { body.numbers.fraction.resize(9); }));
  expect_in("2 widths", refusal([](auto& body) { body.between_platens->widths.pop_back(); }));
  expect_in("axis", refusal([](auto& body) { body.between_platens->axis = 3; }));
}

/// Corners of the cells by which files show the contacts of a body, before it moves.
std::vector<Vec<3>> corners_of_contacts(const Model& model) {
  std::vector<Vec<3>> corners;
  for (int contact = 0; contact < model.contact_count(); ++contact)
    for (int end = 0; end < ends_of_contact(model.dimension()); ++end)
      corners.push_back(at_end(model, contact, end, [&](int c) { return model.place(model.joint(c).a); }));
  return corners;
}

double area_of(const std::vector<Vec<3>>& x, std::size_t first) {
  return 0.5 * norm(cross(x[first + 2] - x[first], x[first + 3] - x[first + 1]));
}

// Promise: the cells of a face's contacts fill the face, whatever its corners.
TEST(Solid, ContactsAreShownByCellsThatFillTheirFaces) {
  auto setup = read(deck(kUniform + kSettle));
  const SpecimenBody body = cylinder_between_platens(setup);
  const Model& model = *body.model;
  const auto corners = corners_of_contacts(model);
  ASSERT_EQ(corners.size(), 4U * model.contact_count());
  double shown = 0.0, area = 0.0;
  for (int contact = 0; contact < model.contact_count(); ++contact) {
    shown += area_of(corners, 4U * contact);
    area += model.joint(contact).area;
  }
  EXPECT_NEAR(shown, area, 1e-9 * area);
  for (int face = 0; face < model.face_count(); ++face) {
    double of_face = 0.0, of_contacts = 0.0;
    for (int c = model.face_contacts[face]; c < model.face_contacts[face + 1]; ++c) {
      of_face += area_of(corners, 4U * c);
      of_contacts += model.joint(c).area;
    }
    ASSERT_NEAR(of_face, of_contacts, 1e-9 * area) << face;
  }
}

TEST(Solid, ItsFramesShowBlocksAndContacts) {
  Solid solid(deck(kUniform + kSettle));
  solid.run.run();
  const std::filesystem::path folder = std::filesystem::path(testing::TempDir()) / "solid_fields";
  FrameRows frames;
  FieldFiles files(folder, solid.simulation, solid.run.history(), frames);
  files.write(solid.simulation, solid.run.history(), frames);
  EXPECT_TRUE(std::filesystem::exists(folder / "mesh.h5"));
  EXPECT_TRUE(std::filesystem::exists(folder / "blocks_0000.hdf"));
  EXPECT_TRUE(std::filesystem::exists(folder / "contacts_0000.hdf"));
  std::filesystem::remove_all(folder);
}

}  // namespace
}  // namespace pyroclast
