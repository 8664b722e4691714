#include "pyroclast/simulation/watching/probe.hpp"

#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "heated_specimen.hpp"
#include "pyroclast/base/error.hpp"

namespace pyroclast {
namespace {

// Promise: linear interpolation, so a linear field is read as it is, inside zones, on their edges and at the
// corners of the specimen.
TEST(Probe, ReadsALinearFieldExactlyAnywhere) {
  const auto body = small_body(100);
  const auto field = [](const Vec<2>& x) { return 20.0 + 3e3 * x[0] - 1e3 * x[1]; };
  std::vector<double> values;
  for (const auto& x : body.position) values.push_back(field(x));
  for (const double x : {0.0, 0.013, kSpecimenWidth})
    for (const double y : {0.0, 0.04, kSpecimenHeight}) {
      const Vec<2> at{{x, y}};
      EXPECT_NEAR(Probe(body, {"p", resized<3>(at)}).read(values), field(at), 1e-9)
          << x << ", " << y;  // rounding of 1e2
    }
  for (std::size_t i = 0; i < body.set("specimen").size(); i += 97) {
    const int g = body.set("specimen")[i];
    EXPECT_NEAR(Probe(body, {"p", body.place(g)}).read(values), values[g], 1e-9);
  }
}

TEST(Probe, OutsideTheSpecimenIsRefusedWithItsPlace) {
  const auto body = small_body(100);
  try {
    Probe(body, {"p", {{1.5 * kSpecimenWidth, 0.0}}});
    FAIL() << "a point outside was accepted";
  } catch (const Error& e) {
    EXPECT_NE(std::string(e.what()).find("(0.075, 0)"), std::string::npos);
  }
}

}  // namespace
}  // namespace pyroclast
