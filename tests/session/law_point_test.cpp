#include "pyroclast/session/law_point.hpp"

#include <string>

#include <gtest/gtest.h>

#include "pyroclast/base/error.hpp"
#include "pyroclast/laws/registry.hpp"

namespace pyroclast {
namespace {

const std::vector<std::string> kElastic{"K_n=10 GPa/m", "K_s=4 GPa/m"};

const LawTable& elastic() {
  return find_law("elastic", {}, LawSources::of_environment());
}

std::size_t place(const LawPoint& point, const std::string& column) {
  const auto columns = point.columns();
  for (std::size_t i = 0; i < columns.size(); ++i)
    if (columns[i].name == column) return i;
  ADD_FAILURE() << "no column " << column;
  return 0;
}

TEST(LawPoint, ALegIsCutIntoStepsAndEndsAtItsPoint) {
  LawPoint point(stated_material(elastic(), kElastic));
  const std::size_t opening = place(point, "u_n_m"), stress = place(point, "sigma_Pa");
  std::vector<double> openings;
  point.go({2e-6, 0.0}, 4, [&] { openings.push_back(point.values()[opening]); });
  EXPECT_EQ(openings, (std::vector<double>{0.5e-6, 1e-6, 1.5e-6, 2e-6}));
  EXPECT_DOUBLE_EQ(point.values()[stress], 10e9 * 2e-6);
  EXPECT_EQ(point.columns().size(), point.values().size());
}

TEST(LawPoint, WhatALawRefusesNamesTheWordOfTheCommandLine) {
  try {
    stated_material(elastic(), {"K_n=-1 GPa/m", "K_s=4 GPa/m"});
    ADD_FAILURE();
  } catch (const Error& error) {
    EXPECT_STREQ(
        error.what(),
        "--set K_n=-1 GPa/m: K_n of the contact law \"elastic\" must be greater than 0; it is -1e+09");
  }
}

// Promise: a point begins at the temperature of its body, whose strength it has.
TEST(LawPoint, BeginsAtItsTemperature) {
  ContactMaterial material = stated_material(elastic(), kElastic);
  material["K_n"] = Curve::table({20.0, 600.0}, {10e9, 4e9}, temperature_axis());
  LawPoint point(material, OnCooling::irreversible, 600.0);
  EXPECT_EQ(point.temperature(), 600.0);
  const MeasuredTable path = MeasuredTable::parse("u_n [um]\n0\n1\n", "path.csv", 1);
  for (const JumpPathPoint& to : jump_path(path, point.temperature())) point.go(to);
  EXPECT_DOUBLE_EQ(point.values()[place(point, "sigma_Pa")], 4e9 * 1e-6);
  point.go({1e-6, 0.0, 20.0});
  EXPECT_DOUBLE_EQ(point.values()[place(point, "sigma_Pa")], 4e9 * 1e-6);  // it does not come back
  LawPoint made_hot(material, OnCooling::irreversible, 20.0, 600.0);
  made_hot.go({1e-6, 0.0});
  EXPECT_DOUBLE_EQ(made_hot.values()[place(made_hot, "sigma_Pa")], 4e9 * 1e-6);
}

// Promise: a point goes to no temperature that a run of its law could not have.
TEST(LawPoint, RefusesTemperaturesThatALawCannotHave) {
  ContactMaterial material = stated_material(elastic(), kElastic);
  material["K_n"] = Curve::table({20.0, 600.0}, {10e9, 0.0}, temperature_axis());
  LawPoint point(material);
  EXPECT_THROW(point.go({1e-6, 0.0, -10.0}), Error);
  EXPECT_THROW(point.go({1e-6, 0.0, 700.0}), Error);
  EXPECT_THROW(point.go({1e-6, 0.0, 600.0}), Error);
  EXPECT_NO_THROW(point.go({1e-6, 0.0, 500.0}));
}

// Promise: a point goes the road of a run: what heat took does not come back on cooling, and cooling may take
// more.
TEST(LawPoint, KeepsTheStrengthOfItsHighestTemperature) {
  ContactMaterial material = stated_material(elastic(), kElastic);
  material["K_n"] = Curve::table({20.0, 600.0}, {10e9, 4e9}, temperature_axis());
  const auto stiffness = [&](OnCooling on_cooling) {
    LawPoint point(material, on_cooling);
    for (const double temperature : {600.0, 20.0}) point.go({1e-6, 0.0, temperature});
    return point.values()[place(point, "sigma_Pa")] / 1e-6;
  };
  EXPECT_DOUBLE_EQ(stiffness(OnCooling::irreversible), 4e9);
  EXPECT_DOUBLE_EQ(stiffness(OnCooling::reversible), 10e9);
  material.residual_ratios[0] = Curve::table({20.0, 600.0}, {1.0, 0.8}, temperature_axis());
  EXPECT_NEAR(stiffness(OnCooling::irreversible), 0.8 * 4e9, 1.0);
}

TEST(LawPoint, EveryPropertyMustBeStatedAndNoOther) {
  EXPECT_THROW(stated_material(elastic(), {kElastic.front()}), Error);
  EXPECT_THROW(stated_material(elastic(), {"K_n=10 GPa/m", "K_s=4 GPa"}), Error);
  EXPECT_THROW(stated_material(elastic(), {"K_n=10 GPa/m", "K_s=4 GPa/m", "f_t=1 MPa"}), Error);
}

}  // namespace
}  // namespace pyroclast
