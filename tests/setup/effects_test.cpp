// Promise: what a deck states acts on something, or the check refuses it with its place.
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "messages.hpp"
#include "stages/drives.hpp"

namespace pyroclast {
namespace {

void expect_contains(const std::string& text, const std::vector<std::string>& parts) {
  for (const std::string& part : parts) expect_in(part, text);
}

const std::string kConduct = "[[stages]]\nkind = \"conduct\"\nduration = \"1 min\"\ninterval = \"1 min\"\n";

std::string conducting(const std::string& stages) {
  return with(deck(stages + kHeatedFace), "frame_strain = 1e-3\n",
              "frame_strain = 1e-3\nframe_interval = \"1 min\"\n");
}

/// What is said of a deck when it is read and its body is made.
std::string refused(const std::string& text) {
  return message([&] { const Trial trial(text); });
}

TEST(Effects, TemperaturesThatNobodyHandsOverAreRefused) {
  const auto complaint = refused(conducting(kSettle + kConduct + kCompress));
  expect_contains(complaint,
                  {"deck.toml:", "stages[2].kind = \"compress\"",
                   "nobody has handed over to it the temperatures of stage 2 (conduct)", "\"expose\""});
  EXPECT_EQ(refused(conducting(kSettle + kConduct + kExpose + kCompress)), "no Error was thrown");
}

// What `conduct` reached and left again counts as T_max at the next exchange: what heat took does not come
// back.
TEST(Effects, TheHottestThatConductReachedIsNotForgotten) {
  const auto strength = [&](const std::string& hottest) {
    const std::string up_and_down = "{ table = [[\"0 s\", \"20 degC\"], [\"2 min\", \"" + hottest +
                                    "\"], [\"10 min\", \"" + hottest +
                                    "\"], [\"12 min\", \"30 degC\"], [\"31 min\", \"30 degC\"]] }";
    const Finished run(
        with(with(conducting(kSettle + with(kConduct, "duration = \"1 min\"", "duration = \"30 min\"") +
                             with(kExpose, "6 min", "1 min") + kFailure),
                  "{ from = \"20 degC\", rate = \"10 K/min\", to = \"70 degC\" }", up_and_down),
             "on_cooling = \"reversible\"", "on_cooling = \"irreversible\""));
    return run.result(3, "f_c_MPa").value();
  };
  EXPECT_LT(strength("520 degC"), 0.75 * strength("30 degC"));
}

TEST(Effects, HeatThatCannotFlowIsRefused) {
  expect_contains(refused(conducting(kSettle + kCompress)), {"heat.boundaries", "no stage lets heat flow"});
}

TEST(Effects, ABoundaryWithoutAFaceIsRefused) {
  const std::string inside =
      "[[sets]]\nname = \"inside\"\nbox = [[\"20 mm\", \"40 mm\"], [\"40 mm\", \"80 mm\"]]\n"
      "[[heat.boundaries]]\nfaces = \"inside\"\nkind = \"convection\"\ncoefficient = \"25 W/(m2 K)\"\n"
      "gas_temperature = \"40 degC\"\n";
  expect_contains(refused(conducting(kSettle + kExpose) + inside),
                  {"deck.toml:", "no face of the outline lies wholly in \"inside\""});
}

TEST(Effects, AReferenceThatNoFigureDrawsIsRefused) {
  const auto with_reference = [](const std::string& text, const std::string& name) {
    return with(text, "frame_strain = 1e-3\n", "frame_strain = 1e-3\nreference = \"" + name + "\"\n");
  };
  const std::string heated = deck(kUniform + kSettle + load("stress = \"0.5 MPa\"") + heat("220 degC"));
  expect_contains(refused(with_reference(heated, "compression")),
                  {"output.reference = \"compression\"", "no figure of this run draws it",
                   "temperature_degC,stress_MPa"});
  EXPECT_EQ(refused(with_reference(heated, "transient_strain")), "no Error was thrown");
  expect_contains(refused(with_reference(deck(kUniform + kSettle + kCompress), "transient_strain")),
                  {"no figure of this run draws it; they draw \"strain,stress_MPa\""});
}

TEST(Effects, ASetThatNoTableNamesIsTold) {
  const std::string sets =
      "[[sets]]\nname = \"mine\"\nwithin = \"left\"\n[[sets]]\nname = \"used\"\nwithin = \"top\"\n" +
      record("u", "displacement", "set = \"used\"\ndirection = \"y\"");
  EXPECT_EQ(read(deck(kUniform + kSettle + sets)).unused_sets, std::vector<std::string>{"mine"});
}

TEST(Effects, WhatIsNearestToAPlaceFarFromTheBodyIsRefused) {
  const auto nearest = [](const std::string& place) {
    return deck(kUniform + kSettle) + "[[sets]]\nname = \"spot\"\nnearest = " + place + "\n";
  };
  EXPECT_EQ(refused(nearest("[\"62 mm\", \"60 mm\"]")), "no Error was thrown");
  expect_contains(refused(nearest("[\"600 mm\", \"60 mm\"]")),
                  {"deck.toml:", "set \"spot\"", "0.54 m from the body"});
}

}  // namespace
}  // namespace pyroclast
