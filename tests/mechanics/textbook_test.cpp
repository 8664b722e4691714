#include "textbook.hpp"

#include <gtest/gtest.h>

#include "bodies.hpp"
#include "model/small_specimen.hpp"
#include "pyroclast/model/concrete_model.hpp"

/// Mechanics<2> beside the textbook step: the same equations, written twice.
namespace pyroclast {
namespace {

using namespace bodies;

/// The same body in both codes, loaded and moved alike.
class Pair {
 public:
  Pair(const Model<2>& model, const std::vector<double>& densities, const BodyProperties& properties,
       const MechanicsParameters<2>& parameters)
      : mechanics_(model, densities, properties, parameters),
        textbook_(model, densities, properties, parameters) {}

  void prescribe_velocity(int gridpoint, int component, double velocity) {
    mechanics_.prescribe_velocity(gridpoint, component, velocity);
    textbook_.prescribe_velocity(gridpoint, component, velocity);
  }
  void break_contact(int contact) {
    mechanics_.break_contact(contact);
    textbook_.break_contact(contact);
  }
  void advance(int steps) {
    mechanics_.advance(steps);
    textbook_.advance(steps);
  }

  const Mechanics<2>& mechanics() const { return mechanics_; }
  const textbook::Body& textbook() const { return textbook_; }
  double time_step() const { return textbook_.time_step(); }

 private:
  Mechanics<2> mechanics_;
  textbook::Body textbook_;
};

/// Largest difference between the two codes over the largest value.
struct Difference {
  double largest = 0.0, value = 0.0;

  void add(double a, double b) {
    largest = std::max(largest, std::abs(a - b));
    value = std::max(value, std::abs(b));
  }
  double relative() const { return largest / value; }
};

Difference of_displacements(const Pair& pair) {
  Difference d;
  for (int g = 0; g < pair.mechanics().model().gridpoint_count(); ++g)
    for (int i : {0, 1})
      d.add(pair.mechanics().displacement()[g][i], pair.textbook().gridpoints()[g].displacement[i]);
  return d;
}

Difference of_velocities(const Pair& pair) {
  Difference d;
  for (int g = 0; g < pair.mechanics().model().gridpoint_count(); ++g)
    for (int i : {0, 1})
      d.add(pair.mechanics().velocity()[g][i], pair.textbook().gridpoints()[g].velocity[i]);
  return d;
}

Difference of_stresses(const Pair& pair) {
  Difference d;
  for (int z = 0; z < pair.mechanics().model().zone_count(); ++z)
    for (int i : {0, 1, 2}) d.add(pair.mechanics().stress()[z][i], pair.textbook().zones()[z].stress[i]);
  return d;
}

Difference of_tractions(const Pair& pair) {
  Difference d;
  for (int c = 0; c < pair.mechanics().model().contact_count(); ++c) {
    const auto& ours = pair.mechanics().contacts()[c];
    const auto& theirs = pair.textbook().contacts()[c];
    d.add(ours.normal_traction, theirs.normal_traction);
    d.add(ours.shear_traction[0], theirs.shear_traction);
  }
  return d;
}

/// Largest difference of a damage; damages lie between 0 and 1.
double of_damages(const Pair& pair) {
  double largest = 0.0;
  for (int c = 0; c < pair.mechanics().model().contact_count(); ++c) {
    const auto& ours = pair.mechanics().contacts()[c].history;
    const auto& theirs = pair.textbook().contacts()[c];
    largest = std::max({largest, std::abs(ours.tension_damage - theirs.tension_damage),
                        std::abs(ours.shear_damage - theirs.shear_damage)});
  }
  return largest;
}
void report(const char* name, int n, Pair& p) {
  double dt=0, ds=0; int broken=0;
  for (const auto& c : p.textbook().contacts()) { dt += c.tension_damage; ds += c.shear_damage; broken += c.tension_damage>0||c.shear_damage>0;}
  std::printf("%s %d u %.2e v %.2e s %.2e t %.2e D %.2e  damaged %d of %zu Dt %.2f Ds %.2f\n", name, n, of_displacements(p).relative(), of_velocities(p).relative(),
   of_stresses(p).relative(), of_tractions(p).relative(), of_damages(p), broken, p.textbook().contacts().size(), dt, ds);
}

Pair tess_pair(const Model<2>& model, double damping, DampingForm form, double viscous=0, MassChoice mass = MassChoice::scaled) {
    auto parameters = quasi_static<2>(damping);
    parameters.damping_form = form;
    parameters.viscous_damping = viscous; parameters.mass = mass;
    parameters.gravity = {{1.0, -9.81}};
  return Pair(model, {2400.0}, by_interface(model,
                   std::vector<ZoneProperties>(model.zones.size(), zone_properties<2>(29.4e9, 0.2, 1e-5)),
                   {mortar_contact()}), parameters);
}


TEST(Explore, Loads) {
  const Model<2> model = tessellated(120, 0.05, 0.05, 3);
  for (int mode : {0,2}) for (auto form : {DampingForm::local, DampingForm::combined}) {
    auto p = tess_pair(model, 0.8, form);
    auto q = tess_pair(model, 0.8, form);
    for (int g = 0; g < model.gridpoint_count(); ++g) {
      const double y = model.position[g][1];
      if (y == 0.0 || y == 0.05) {
        double vx = mode == 1 && y>0 ? 4e-3 : 0.0, vy = y == 0.0 ? 0.0 : mode==0? 2e-3: mode==1 ? 0.0: -8e-3;
        p.prescribe_velocity(g, 0, vx);
        p.prescribe_velocity(g, 1, vy);
        q.prescribe_velocity(g, 0, vx*(1+2.3e-16));
        q.prescribe_velocity(g, 1, vy*(1+2.3e-16));
      }
    }
    std::printf("mode %d form %d\n", mode, (int)form);
    for (int i = 0; i < 40; ++i) { p.advance(20); q.advance(20); report("", 20*(i+1), p); 
    Difference d, e; for (int g = 0; g < model.gridpoint_count(); ++g) for (int k : {0,1}) { d.add(p.textbook().gridpoints()[g].displacement[k], q.textbook().gridpoints()[g].displacement[k]);
     e.add(p.textbook().gridpoints()[g].velocity[k], q.textbook().gridpoints()[g].velocity[k]); }
     std::printf("     self u %.2e v %.2e\n", d.relative(), e.relative()); }
  }
}
}  // namespace
}  // namespace pyroclast
