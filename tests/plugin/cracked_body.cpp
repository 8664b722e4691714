// Presses a body until it cracks, and prints what came out of it: a hash of every bit, and the rate. Compiled
// twice: with the cohesive law of the program, and without it for the same law from a shared object.
#include <chrono>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <string>

#include <fmt/format.h>

#include "mechanics/bodies.hpp"
#include "pyroclast/base/sha256.hpp"
#include "pyroclast/plugin/open_library.hpp"

namespace pyroclast {
namespace {

/// Of the paper's contact, in the order of its properties, weaker where it is hot.
std::vector<double> numbers(double weakness) {
  auto p = mortar_contact();
  p.tensile_strength *= weakness;
  p.cohesion *= weakness;
  p.compressive_limit *= weakness;
  std::vector<double> list(count_of<Cohesive::Properties<double>>());
  put(p, list.data());
  return list;
}

ContactProperties contact(const LawTable& law, double weakness) {
  auto list = numbers(weakness);
  list.resize(law.properties.size());  // what the law has beyond the paper's is zero
  return {law, list, std::vector<int>(law.choices.size())};
}

/// Bits of all that is common to both laws.
std::string bits(const Mechanics<2>& body) {
  std::string all;
  const auto add = [&](double number) { all.append(reinterpret_cast<const char*>(&number), sizeof(number)); };
  for (const auto& v : body.read().displacements()) add(v[0]), add(v[1]);
  for (const auto& v : body.read().velocities()) add(v[0]), add(v[1]);
  for (const auto& c : body.read().contacts()) {
    add(c.normal_traction), add(c.shear_traction[0]), add(c.stored);
    for (int i = 0; i < count_of<Cohesive::Internals<2, double>>(); ++i) add(c.internals[i]);
    for (int i = 0; i < count_of<Cohesive::Losses<double>>(); ++i) add(c.losses[i]);
  }
  const auto energy = body.totals().energy();
  add(energy.dissipated.total()), add(energy.contacts), add(energy.error());
  return all;
}

int drive(int argc, char** argv) {
#ifdef OWN_LAW
  const LawTable& law = open_law(argv[1]).table;
#else
  const LawTable& law = table_of<Cohesive>();
#endif
  const bool own = argc > 2 && std::strcmp(argv[2], "own") == 0;
  const int blocks = argc > 3 ? std::atoi(argv[3]) : 200;
  const int steps = argc > 4 ? std::atoi(argv[4]) : 400;

  const double width = 0.1, height = 0.2;
  const auto model = bodies::tessellated(blocks, width, height, 1);
  BodyProperties properties;
  properties.zones.assign(model.zones.size(), zone_properties<2>(30e9, 0.2));
  constexpr int kTemperatures = 50;
  for (int i = 0; i < (own ? kTemperatures : 1); ++i) properties.contacts.add(contact(law, 1.0 - 0.01 * i));
  for (int c = 0; c < model.contact_count(); ++c)
    properties.of_contact.push_back(own ? (7 * c) % kTemperatures : 0);
  for (const InstructionSet set : usable_instruction_sets()) {
    MechanicsParameters parameters;
    parameters.local_damping = 0.7;
    parameters.safety = 0.8;
    parameters.instructions = set;
    Mechanics<2> body(model, {2300.0}, properties, parameters);
    // a uniform compression, which the body then goes on with by itself
    const double rate = 5e-3 / (0.5 * steps * body.time_step());
    for (int g = 0; g < model.gridpoint_count(); ++g) {
      body.constraints().prescribe_velocity(g, 0, 0.2 * rate * (model.position[g][0] - 0.5 * width));
      body.constraints().prescribe_velocity(g, 1, -rate * model.position[g][1]);
    }
    body.advance(1);
    for (int g = 0; g < model.gridpoint_count(); ++g) {
      const double y = model.position[g][1];
      body.constraints().release(g, 0);
      if (y > 1e-9 * height && y < (1.0 - 1e-9) * height) body.constraints().release(g, 1);
    }
    body.advance(steps / 2);
    const auto begin = std::chrono::steady_clock::now();
    body.advance(steps / 2);
    const std::chrono::duration<double> took = std::chrono::steady_clock::now() - begin;
    int damaged = 0;
    for (const auto& c : body.read().contacts())
      damaged += c.remembered("tension_damage") + c.remembered("shear_damage") > 0.0;
    fmt::print("{} {} damaged {:.3f}\n", name(set), sha256(bits(body)),
               static_cast<double>(damaged) / model.contact_count());
    fmt::print(stderr, "{} {:.4g} million contact updates a second\n", name(set),
               1e-6 * model.contact_count() * (steps / 2) / took.count());
  }
  return 0;
}

}  // namespace
}  // namespace pyroclast

int main(int argc, char** argv) {
  try {
    return pyroclast::drive(argc, argv);
  } catch (const std::exception& e) {
    fmt::print(stderr, "{}\n", e.what());
    return 1;
  }
}
