#include "pyroclast/simulation/acting/press.hpp"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "known.hpp"
#include "mechanics/bodies.hpp"
#include "pyroclast/base/error.hpp"

namespace pyroclast {
namespace {

constexpr double kYoung = 30e9, kPoisson = 0.2, kDensity = 2400.0;

/// Gridpoints with a component at a place.
template <int Dim>
std::vector<int> at(const ModelOf<Dim>& model, int component, double place) {
  std::vector<int> set;
  for (int g = 0; g < model.gridpoint_count(); ++g)
    if (std::abs(model.position[g][component] - place) < 1e-12) set.push_back(g);
  return set;
}

/// A body of height 1 that is its own platens: a press that grips it.
template <int Dim>
ModelOf<Dim> gripped(ModelOf<Dim> model, double width) {
  const int axis = Dim == 2 ? 1 : 2;
  for (const char* name : {"bottom", "bottom_platen_face", "bottom_platen_support"})
    model.sets[name] = at(model, axis, 0.0);
  for (const char* name : {"top", "top_platen_face", "top_platen_support"})
    model.sets[name] = at(model, axis, 1.0);
  model.sets["left"] = at(model, 0, 0.0);
  model.sets["right"] = at(model, 0, width);
  if (Dim == 3) {
    model.sets["front"] = at(model, 1, 0.0);
    model.sets["back"] = at(model, 1, width);
  }
  for (int g = 0; g < model.gridpoint_count(); ++g) model.sets["specimen"].push_back(g);
  for (const char* name : {"bottom_platen", "top_platen"}) model.sets[name] = {};
  return model;
}

template <int Dim>
MotionOf<Dim> elastic(const ModelOf<Dim>& model) {
  std::vector<ZoneProperties> zones(model.zones.size(), zone_properties<Dim>(kYoung, kPoisson, 0.0));
  MechanicsParameters parameters;
  parameters.local_damping = 0.8;
  parameters.damping_form = DampingForm::combined;
  parameters.mass = MassChoice::scaled;
  parameters.time_step = 1e-5;
  parameters.safety = 0.9;
  return {model,
          {kDensity},
          by_interface(model, std::move(zones), {bodies::elastic_contact()}),
          parameters,
          nullptr};
}

/// The section of a body of height 1 whose widths are 0.5, across the axis on which it stands.
template <int Dim>
Press::Specimen section(const ModelOf<Dim>& model) {
  return {Dim - 1, 1.0, std::pow(0.5, Dim - 1) * model.thickness, std::vector<double>(Dim - 1, 0.5)};
}

ModelOf<2> square() {
  return gripped(bodies::lattice(4, 4, [](double x, double y) { return Vec<2>{{0.5 * x, y}}; }), 0.5);
}

/// Two cubes, one on top of the other.
ModelOf<3> tower() {
  return gripped(bodies::cubes(2, 0.5), 0.5);
}

/// Presses to a stress, and tells what the press reads and what the body bears.
template <int Dim>
void carries_what_it_is_loaded_with(const ModelOf<Dim>& model) {
  auto motion = elastic(model);
  Press press(motion, section(model));
  press.control_by_force();
  press.hold(1e6);
  motion.advance(20000);
  EXPECT_LT(motion.totals().unbalanced_ratio(), 1e-6);
  EXPECT_NEAR(press.stress_top(), 1e6, 1.0);
  EXPECT_NEAR(press.stress_bottom(), 1e6, 1.0);
  EXPECT_EQ(press.stress_held(), 1e6);
  // Sides that the platens hold at their ends stiffen it; contacts between blocks soften it.
  const double strain = press.strain();
  EXPECT_GT(strain, 0.0);
  EXPECT_DOUBLE_EQ(strain, press.specimen_strain());
  EXPECT_EQ(press.gap(), 0.0);
  EXPECT_GT(press.lateral_strain(), 0.0);
  EXPECT_LT(press.lateral_strain(), strain);

  press.begin_stage();
  EXPECT_EQ(press.stage_strain(), 0.0);
  press.set_zero();
  EXPECT_NEAR(press.strain(), 0.0, 1e-18);
  EXPECT_NEAR(press.lateral_strain(), 0.0, 1e-18);

  press.control_by_motion(1e-4);
  EXPECT_EQ(press.stress_held(), 0.0);
  const double before = press.strain(), time = 100.0 * motion.time_step();
  motion.advance(100);
  EXPECT_NEAR(press.strain() - before, 1e-4 * time, 1e-9 * time);
  press.move_platen(0.0);
  motion.advance(20000);
  expect_known({Dim == 2 ? "Stress of an elastic body between platens, after a motion, 2D"
                         : "Stress of an elastic body between platens, after a motion, 3D",
                "load and strain in proportion", "Pa"},
               press.stress(), 1e6 * (1.0 + 1e-4 * time / strain), 1e3);
}

TEST(PressVerification, CarriesWhatItIsLoadedWithIn2d) {
  carries_what_it_is_loaded_with(square());
}

TEST(PressVerification, CarriesWhatItIsLoadedWithIn3d) {
  carries_what_it_is_loaded_with(tower());
}

/// Strains the body evenly: every gridpoint moves by the strain times its place, and no faster after.
template <int Dim>
void strains_evenly(const ModelOf<Dim>& model) {
  auto motion = elastic(model);
  Press press(motion, section(model));
  const Press::EvenMotion strain{.axial = 1e-6, .lateral = 2e-6};
  press.move_evenly(strain, 1.0, false);
  motion.advance(1);
  press.move_evenly(strain, 0.0, false);
  motion.advance(1);
  press.end_even_motion(false);
  for (int g = 0; g < model.gridpoint_count(); ++g) {
    const Vec<3> u = motion.read().displacement(g), x = model.place(g);
    for (int i = 0; i < Dim; ++i) {
      const double expected = i == Dim - 1 ? 1e-6 * x[i] : 2e-6 * (x[i] - 0.25);
      EXPECT_NEAR(u[i], expected, 1e-18);
      EXPECT_EQ(motion.read().velocity(g)[i], 0.0);
    }
  }
  EXPECT_NEAR(press.specimen_strain(), -1e-6, 1e-18);
  EXPECT_NEAR(press.lateral_strain(), 2e-6, 1e-18);
}

TEST(Press, StrainsABodyEvenlyIn2d) {
  strains_evenly(square());
}

TEST(Press, StrainsABodyEvenlyIn3d) {
  strains_evenly(tower());
}

TEST(Press, RefusesAPlatenOfSeveralBlocks) {
  const auto model = gripped(bodies::five_tetrahedra(), 1.0);
  auto motion = elastic(model);
  Press press(motion, Press::Specimen{2, 1.0, 1.0, {1.0, 1.0}});
  EXPECT_THROW(press.control_by_force(), Error);
}

TEST(Press, RefusesAnAxisThatIsNone) {
  const auto model = square();
  auto motion = elastic(model);
  Press::Specimen across = section(model);
  across.axis = 2;
  EXPECT_THROW(Press(motion, across), Error);
}

TEST(Press, NamesASetThatTheModelDoesNotHave) {
  auto model = square();
  model.sets.erase("top_platen_support");
  auto motion = elastic(model);
  try {
    Press(motion, section(model));
    FAIL() << "a press without an upper support";
  } catch (const Error& e) {
    EXPECT_NE(std::string(e.what()).find("\"top_platen_support\""), std::string::npos);
  }
}

}  // namespace
}  // namespace pyroclast
