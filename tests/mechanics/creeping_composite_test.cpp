#include <algorithm>
#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "bodies.hpp"
#include "known.hpp"
#include "model/small_specimen.hpp"
#include "phases.hpp"
#include "pyroclast/material/concrete.hpp"
#include "pyroclast/material/mixture.hpp"
#include "pyroclast/mechanics/mechanics.hpp"

/// Inclusions in a matrix that creeps, or that shrinks on cooling by a slope of its own.
// of its own, as tests of a module are one unit
namespace pyroclast::creeping_composite_test {
namespace {

using namespace bodies;

constexpr double nu = 0.2, nu_L = 0.3;
constexpr double inclusion_young = 70e9, matrix_young = 29.4e9;

// ---- A disc in a ring, heated: how much of the misfit's stress the ring relaxes

constexpr int kAround = 36, kRings = 27, kInnerRings = 15;
constexpr double outer = 18e-3, inner = outer * kInnerRings / kRings;  ///< radii, m
constexpr double misfit = 15e-6;                                       ///< inclusion less matrix, 1/K
constexpr double rise = 280.0;                                         ///< K

/// Rate of creep in compression, 1/(Pa K), after so many kelvins: that of concrete about.
double rate(double kelvins) {
  return 1.2e-12 * (1.0 + kelvins / 300.0);
}
double integral_of_rate(double kelvins) {
  return 1.2e-12 * kelvins * (1.0 + kelvins / 600.0);
}

/// The same by rings alone: stresses sigma_r and sigma_theta over the radius in plane stress, explicit in
/// time.
class Rings {
 public:
  Rings(int rings, double tension) : tension_(tension), step_(outer / rings), zones_(rings) {}

  void heat(double increment) {
    for (double done = 0.0; done < rise - 1e-9; done += increment) {
      const double a = rate(done + 0.5 * increment) * increment;
      for (std::size_t i = 0; i < zones_.size(); ++i) {
        Zone& z = zones_[i];
        z.expanded += is_inclusion(i) ? misfit * increment : 0.0;
        if (is_inclusion(i)) continue;
        const auto part = [&](double s) { return s < 0.0 ? s : tension_ * s; };
        const double r = part(z.radial), t = part(z.hoop);
        z.crept_radial += a * (r - nu_L * t);
        z.crept_hoop += a * (t - nu_L * r);
      }
      solve();
    }
  }

  /// Mean of the hoop stress over the area between two radii, Pa.
  double mean_hoop(double from, double to) const {
    double sum = 0.0, area = 0.0;
    for (std::size_t i = 0; i < zones_.size(); ++i) {
      if (middle(i) < from || middle(i) > to) continue;
      sum += zones_[i].hoop * middle(i);
      area += middle(i);
    }
    return sum / area;
  }

 private:
  struct Zone {
    double expanded = 0.0, crept_radial = 0.0, crept_hoop = 0.0, radial = 0.0, hoop = 0.0;
  };

  double middle(std::size_t i) const { return (static_cast<double>(i) + 0.5) * step_; }
  bool is_inclusion(std::size_t i) const { return middle(i) < inner; }
  double young(std::size_t i) const { return is_inclusion(i) ? inclusion_young : matrix_young; }

  /// Displacements at the nodes between the rings by their equilibrium, and the stresses.
  void solve() {
    const std::size_t n = zones_.size();
    std::vector<double> diagonal(n + 1), above(n + 1), load(n + 1), u(n + 1);
    for (std::size_t i = 0; i < n; ++i) {
      const double r = middle(i), k = young(i) / (1.0 - nu * nu) * r * step_;
      const double dr[2] = {-1.0 / step_, 1.0 / step_}, dt = 0.5 / r;
      const double radial = zones_[i].expanded + zones_[i].crept_radial,
                   hoop = zones_[i].expanded + zones_[i].crept_hoop;
      for (std::size_t a : {0U, 1U}) {
        load[i + a] += k * (dr[a] * (radial + nu * hoop) + dt * (hoop + nu * radial));
        diagonal[i + a] += k * (dr[a] * dr[a] + 2.0 * nu * dr[a] * dt + dt * dt);
      }
      above[i] += k * (dr[0] * dr[1] + nu * (dr[0] + dr[1]) * dt + dt * dt);
    }
    // the middle stays where it is
    for (std::size_t i = 2; i <= n; ++i) {
      const double share = above[i - 1] / diagonal[i - 1];
      diagonal[i] -= share * above[i - 1];
      load[i] -= share * load[i - 1];
    }
    for (std::size_t i = n; i > 0; --i) u[i] = (load[i] - (i < n ? above[i] * u[i + 1] : 0.0)) / diagonal[i];
    for (std::size_t i = 0; i < n; ++i) {
      Zone& z = zones_[i];
      const double radial = (u[i + 1] - u[i]) / step_ - z.expanded - z.crept_radial;
      const double hoop = 0.5 * (u[i + 1] + u[i]) / middle(i) - z.expanded - z.crept_hoop;
      const double k = young(i) / (1.0 - nu * nu);
      z.radial = k * (radial + nu * hoop);
      z.hoop = k * (hoop + nu * radial);
    }
  }

  double tension_, step_;
  std::vector<Zone> zones_;
};

/// One block: a fan around the middle, then rings of squares, each cut into four zones.
ModelOf<2> disc() {
  std::vector<Vec<2>> x{{{0.0, 0.0}}};
  std::vector<std::array<int, 3>> zones;
  const auto at = [&](double radius, double angle) {
    return Vec<2>{{radius * std::cos(angle), radius * std::sin(angle)}};
  };
  const double turn = 2.0 * std::numbers::pi / kAround, step = outer / kRings;
  const auto corner = [&](int ring, int i) { return 1 + (ring - 1) * kAround + i % kAround; };
  for (int ring = 1; ring <= kRings; ++ring)
    for (int i = 0; i < kAround; ++i) x.push_back(at(ring * step, i * turn));
  for (int i = 0; i < kAround; ++i) zones.push_back({0, corner(1, i), corner(1, i + 1)});
  for (int ring = 1; ring < kRings; ++ring)
    for (int i = 0; i < kAround; ++i) {
      const int middle = static_cast<int>(x.size());
      const std::array<int, 4> square{corner(ring, i), corner(ring + 1, i), corner(ring + 1, i + 1),
                                      corner(ring, i + 1)};
      Vec<2> sum{};
      for (int g : square) sum += x[g];
      x.push_back(sum * 0.25);
      for (int n = 0; n < 4; ++n) zones.push_back({square[n], square[(n + 1) % 4], middle});
    }
  ModelOf<2> model;
  model.material_names = {"mortar"};
  model.interface_names = {"mortar-mortar"};
  model.add_block(x, zones, 0);
  return model;
}

/// Zones of a ring, counted from 0.
std::pair<int, int> zones_of(int ring) {
  return ring == 0 ? std::pair(0, kAround) : std::pair(kAround * (4 * ring - 3), kAround * (4 * ring + 1));
}

/// Hoop stress of the first ring of the matrix, Pa.
double hoop_around_disc(const Mechanics<2>& m) {
  const ModelOf<2>& model = m.model();
  const auto geometry = zone_geometry(model);
  double sum = 0.0, volume = 0.0;
  const auto [first, last] = zones_of(kInnerRings);
  for (int z = first; z < last; ++z) {
    Vec<2> middle{};
    for (int g : model.zones[z]) middle += model.position[g] * (1.0 / 3.0);
    const double c = middle[0] / norm(middle), s = middle[1] / norm(middle);
    const auto stress = m.read().stress(z);
    sum += geometry.volume[z] * (s * s * stress[0] + c * c * stress[1] - 2.0 * s * c * stress[2]);
    volume += geometry.volume[z];
  }
  return sum / volume;
}

/// Hoop stress of the first ring of the matrix when the disc was heated in increments, Pa.
double hoop_of_disc(const ModelOf<2>& model, double increment, const CreepIncrement& choices) {
  auto parameters = quasi_static<2>(0.0);
  parameters.viscous_damping = 3.0 / (60 * parameters.time_step);
  const int inclusion_zones = zones_of(kInnerRings).first;
  const auto properties = [&](double before, double now) {
    std::vector<ZoneProperties> zones(model.zones.size(), zone_properties<2>(matrix_young, nu));
    for (int z = 0; z < inclusion_zones; ++z)
      zones[z] = zone_properties<2>(inclusion_young, nu, misfit * now);
    auto p = by_interface(model, zones, {elastic_contact()});
    p.creep.assign(model.zones.size(), choices);
    for (int z = inclusion_zones; z < model.zone_count(); ++z)
      p.creep[z].compliance = integral_of_rate(now) - integral_of_rate(before);
    return p;
  };
  Mechanics<2> m(model, {2400.0}, properties(0.0, 0.0), parameters);
  for (double done = 0.0; done < rise - 1e-9; done += increment) {
    m.set_properties(properties(done, done + increment));
    m.advance(400);
    m.commit_creep();
  }
  return hoop_around_disc(m);
}

TEST(CreepVerification, RelaxesTheMisfitOfADiscInARing) {
  const ModelOf<2> model = disc();
  const double width = outer / kRings;
  for (const double tension : {1.0, 0.0}) {
    Rings rings(27 * 8, tension);
    rings.heat(0.1);
    const double known = rings.mean_hoop(inner, inner + width);
    const double found = hoop_of_disc(model, 4.0, {.poisson = nu_L, .tension = tension, .confinement = 0.0});
    const std::string what = tension > 0.0 ? "creep in tension as in compression" : "no creep in tension";
    expect_known({"Hoop stress of a creeping ring around a disc that expands more, " + what,
                  "rings over the radius, explicit, 0.1 K", "Pa"},
                 found, known, 0.02 * known);
  }
}

// ---- The same, heated and cooled: a ring that shrinks by more than it grew

TEST(CoolingVerification, LeavesTheMisfitOfADiscInARing) {
  const ModelOf<2> model = disc();
  BlockMaterial inclusion, ring;
  inclusion.thermal_strain = Curve::table({20.0, 420.0}, {0.0, 4.8e-3}, temperature_axis());
  ring.thermal_strain = Curve::table({20.0, 420.0}, {0.0, 4e-3}, temperature_axis());
  ring.contraction = 14e-6;
  const auto properties = [&](double now, double hottest) {
    std::vector<ZoneProperties> zones(model.zones.size(),
                                      zone_properties<2>(matrix_young, nu, ring.free_strain(now, hottest)));
    for (int z = 0; z < zones_of(kInnerRings).first; ++z)
      zones[z].thermal_strain = inclusion.free_strain(now, hottest);
    return by_interface(model, zones, {elastic_contact()});
  };
  auto parameters = quasi_static<2>(0.0);
  parameters.viscous_damping = 3.0 / (60 * parameters.time_step);
  Mechanics<2> m(model, {2400.0}, properties(20.0, 20.0), parameters);
  double hottest = 20.0;
  for (const auto& [T, misfit_left] :
       {std::pair{420.0, 0.8e-3}, {220.0, 2.4e-3 - 1.2e-3}, {20.0, 1.6e-3}, {320.0, 3.6e-3 - 2.6e-3}}) {
    hottest = std::max(hottest, T);
    m.set_properties(properties(T, hottest));
    m.advance(1500);
    // Lamé's ring: p (1 + b^2 / r^2) a^2 / (b^2 - a^2), with p = E misfit (1 - a^2 / b^2) / 2; its mean over
    // the ring
    const double a = inner, b = outer, c = inner + outer / kRings;
    const double mean = 1.0 + 2.0 * b * b * std::log(c / a) / (c * c - a * a);
    const double known = 0.5 * matrix_young * misfit_left * a * a / (b * b) * mean;
    expect_known({"Hoop stress of a ring around a disc, heated to 420 degC and cooled",
                  "Lame, with the misfit of the slope on cooling", "Pa"},
                 hoop_around_disc(m), known, 0.01 * known);
  }
}

// ---- A specimen under load: R

TEST(CreepVerification, OfASpecimenIsThatOfItsMatrixTimesR) {
  const specimen::Specimen<2> specimen = small_specimen(1200);
  const ModelOf<2> model = make_model(specimen, 1.0);
  const double size = specimen.metrics.mean_size, layer = 1.6e-3;
  const double with_contacts = 1.0 + layer / size;
  const double inclusions = specimen.fraction[aggregate_material];
  const Mixture<2> mixture({1.0 - inclusions, matrix_young / with_contacts, nu},
                           {{inclusions, inclusion_young / with_contacts, nu}});
  const auto blocks = zone_blocks(model);
  const auto properties = [&](double compliance) {
    BodyProperties p;
    for (int z = 0; z < model.zone_count(); ++z) {
      const bool creeps = model.block_material[blocks[z]] == mortar_material;
      p.zones.push_back(zone_properties<2>(creeps ? matrix_young : inclusion_young, nu));
      p.creep.push_back({.compliance = creeps ? compliance : 0.0, .poisson = nu_L});
    }
    std::vector<ContactProperties> interfaces;
    for (const std::string& name : model.interface_names) {
      const double young = name == "aggregate_aggregate" ? inclusion_young : matrix_young;
      interfaces.emplace_back(Elastic::Properties<double>{young / layer, 0.5 * young / (1.0 + nu) / layer});
    }
    auto contacts = by_interface(model, p.zones, interfaces);
    contacts.creep = p.creep;
    return contacts;
  };
  auto parameters = quasi_static<2>(0.0);
  parameters.viscous_damping = 3.0 / (250 * parameters.time_step);
  Mechanics<2> m(model, {2400.0, 2400.0}, properties(0.0), parameters);
  // a uniform traction on both ends
  const double stress = -1e6;
  std::vector<double> force(model.position.size());
  for (int z = 0; z < model.zone_count(); ++z)
    for (const double end : {0.0, 0.1})
      for (int n = 0; n < 3; ++n) {
        const int a = model.zones[z][n], b = model.zones[z][(n + 1) % 3];
        if (std::abs(model.position[a][1] - end) > 1e-9 || std::abs(model.position[b][1] - end) > 1e-9)
          continue;
        const double half = 0.5 * stress * std::abs(model.position[a][0] - model.position[b][0]);
        for (int g : {a, b}) force[g] += end > 0.0 ? half : -half;
      }
  for (int g = 0; g < model.gridpoint_count(); ++g) m.constraints().apply_force(g, {{0.0, force[g]}});
  const auto strain = [&] {
    const auto mean = [&](const char* side) {
      return m.totals().mean_displacement(gridpoint_set(model, model.set(side)))[1];
    };
    return (mean("top") - mean("bottom")) / 0.1;
  };
  m.advance(4000);
  const double elastic = strain();
  const double of_matrix = with_contacts / matrix_young;  // as much as the matrix gives way elastically
  const auto creep_by = [&](double compliance, int exchanges) {
    for (int i = 0; i < exchanges; ++i) {
      m.set_properties(properties(compliance / exchanges));
      m.advance(2000);
      m.commit_creep();
    }
    return strain() - elastic;
  };
  const std::string what = "R: creep of a specimen over that of its mortar, " +
                           std::to_string(inclusions).substr(0, 5) + " aggregate, mortar crept by ";
  const double once = mixture.creep_share(1.0, nu_L), often = mixture.creep_share(10.0, nu_L);
  expect_known({what + "its elastic strain", "self-consistent scheme", "1"},
               creep_by(of_matrix, 5) / (stress * of_matrix), once, 0.03 * once);
  expect_known({what + "ten times that", "self-consistent scheme", "1"},
               creep_by(9.0 * of_matrix, 15) / (10.0 * stress * of_matrix), often, 0.05 * often);
}

}  // namespace
}  // namespace pyroclast::creeping_composite_test
