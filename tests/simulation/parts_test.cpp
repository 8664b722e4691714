// Each chunk's part is made alone, from its own blocks and those that touch it, and must do what the chunk
// does in the whole body: the layout, the forces of every step and the sums, to the bit. So no part of a body
// needs to know the whole.

#include <algorithm>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "in_plane.hpp"
#include "part_of_body.hpp"
#include "pyroclast/mechanics/cracks.hpp"
#include "pyroclast/simulation/acting/loads.hpp"
#include "pyroclast/simulation/coupling.hpp"
#include "pyroclast/thermal/conduction.hpp"
#include "pyroclast/thermal/temperature_field.hpp"
#include "stages/small_runs.hpp"
#include "thermal/advance.hpp"

namespace pyroclast {
namespace {

using parts::Part;

constexpr int kBlocksOfAPart = 8;

/// A heated prism between platens; each zone and contact has a temperature of its own.
struct Whole {
  explicit Whole(const std::string& text) : setup(read(text)) {
    setup.moving->chunk_blocks = kBlocksOfAPart;
    simulation = make_simulation(setup);
    simulation->field().begin_exposure(setup.temperatures);
    simulation->field().advance(1000.0, 300.0);
    properties = properties_at(model(), simulation->materials(), simulation->field(), simulation->hottest());
    for (const BlockMaterial& material : simulation->materials().block_materials)
      densities.push_back(material.density(kReferenceTemperature));
    mechanics = std::make_unique<Mechanics<2>>(model(), densities, properties, setup.moving->mechanics);
  }
  const ModelOf<2>& model() const { return in_plane::model(simulation->model()); }

  Setup setup;
  std::unique_ptr<Simulation> simulation;
  BodyProperties properties;
  std::vector<double> densities;
  std::unique_ptr<Mechanics<2>> mechanics;
};

std::string heated_deck(const std::string& kinematics) {
  return with(deck(kSettle + kExpose + kHeatedFace), "mass = \"scaled\"",
              "mass = \"scaled\"\ngravity = \"9.81 m/s2\"\nkinematics = \"" + kinematics + "\"");
}

/// A part and its body.
struct OfPart {
  OfPart(Part<2> of, const Whole& whole)
      : part(std::move(of)),
        mechanics(part.model, whole.densities, parts::properties_in(part, whole.properties),
                  whole.setup.moving->mechanics) {}
  Part<2> part;
  Mechanics<2> mechanics;
};

std::vector<std::unique_ptr<OfPart>> bodies_of(const Whole& whole) {
  std::vector<std::unique_ptr<OfPart>> bodies;
  for (Part<2>& part : parts::all_parts(whole.model()))
    bodies.push_back(std::make_unique<OfPart>(std::move(part), whole));
  return bodies;
}

bool is_own(const Part<2>& part, int gridpoint) {
  const ChunkList chunks = part.model.gridpoint_chunks();
  return gridpoint >= chunks[part.chunk] && gridpoint < chunks[part.chunk + 1];
}

/// Gives every part what its neighbours did with their own gridpoints.
void exchange(std::vector<std::unique_ptr<OfPart>>& bodies, int gridpoints) {
  std::vector<Vec<2>> displacement(gridpoints), velocity(gridpoints);
  for (const auto& body : bodies)
    for (int g = 0; g < body->part.model.gridpoint_count(); ++g)
      if (is_own(body->part, g)) {
        displacement[body->part.gridpoint[g]] = body->mechanics.read().displacement(g);
        velocity[body->part.gridpoint[g]] = body->mechanics.read().velocity(g);
      }
  for (const auto& body : bodies)
    for (int g = 0; g < body->part.model.gridpoint_count(); ++g)
      if (!is_own(body->part, g)) {
        const int slot = body->mechanics.body().layout.gridpoint_slot[g];
        body->mechanics.body().state.displacement[slot] = displacement[body->part.gridpoint[g]];
        set_vector<2>(body->mechanics.body().state.velocity, slot, velocity[body->part.gridpoint[g]]);
      }
}

/// Holds the lower platen and pulls the upper one up and aside.
void drive(Mechanics<2>& mechanics, const std::vector<int>& bottom, const std::vector<int>& top) {
  for (const int g : bottom)
    for (int i : {0, 1}) mechanics.constraints().prescribe_velocity(g, i, 0.0);
  for (const int g : top)
    for (int i : {0, 1}) mechanics.constraints().prescribe_velocity(g, i, i == 0 ? 0.01 : 0.03);
}

constexpr int kSteps = 600;

void expect_same_layout(const Whole& whole, const OfPart& of, int chunk) {
  const Layout<2>&there = whole.mechanics->body().layout, &here = of.mechanics.body().layout;
  const Part<2>& part = of.part;
  const int own = part.chunk;
  const auto first_slot = [](const Layout<2>& layout, int of_chunk) {
    return slot_of(layout.bundles[layout.chunks.bundles[of_chunk]].first_pack, 0);
  };
  const auto first_zone = [](const Layout<2>& layout, int of_chunk) {
    return slot_of(layout.bundles[layout.chunks.bundles[of_chunk]].first_zone_pack, 0);
  };
  const auto first_point = [](const Layout<2>& layout, int of_chunk) {
    return slot_of(layout.first_point_of(layout.chunks.face_packs[of_chunk]), 0);
  };
  ASSERT_EQ(here.chunks.bundles[own + 1] - here.chunks.bundles[own],
            there.chunks.bundles[chunk + 1] - there.chunks.bundles[chunk]);
  ASSERT_EQ(here.chunks.face_packs[own + 1] - here.chunks.face_packs[own],
            there.chunks.face_packs[chunk + 1] - there.chunks.face_packs[chunk]);
  for (int g = here.chunks.gridpoints[own]; g < here.chunks.gridpoints[own + 1]; ++g)
    ASSERT_EQ(here.gridpoint_slot[g] - first_slot(here, own),
              there.gridpoint_slot[part.gridpoint[g]] - first_slot(there, chunk));
  for (int z = here.chunks.zones[own]; z < here.chunks.zones[own + 1]; ++z)
    ASSERT_EQ(here.zone_slot[z] - first_zone(here, own),
              there.zone_slot[part.zone[z]] - first_zone(there, chunk));
  ASSERT_EQ(here.chunks.contacts[own + 1] - here.chunks.contacts[own],
            there.chunks.contacts[chunk + 1] - there.chunks.contacts[chunk]);
  for (int i = here.chunks.contacts[own]; i < here.chunks.contacts[own + 1]; ++i) {
    const int c = here.contacts_by_chunk[i];
    ASSERT_EQ(part.contact[c],
              there.contacts_by_chunk[i - here.chunks.contacts[own] + there.chunks.contacts[chunk]]);
    ASSERT_EQ(here.contact_slot[c] - first_point(here, own),
              there.contact_slot[part.contact[c]] - first_point(there, chunk));
  }
}

void expect_same_state(const Whole& whole, const OfPart& of) {
  const Part<2>& part = of.part;
  const ChunkList chunks = part.model.gridpoint_chunks();
  for (int g = chunks[part.chunk]; g < chunks[part.chunk + 1]; ++g) {
    const int there = part.gridpoint[g];
    ASSERT_EQ(of.mechanics.read().displacement(g), whole.mechanics->read().displacement(there)) << there;
    ASSERT_EQ(of.mechanics.read().velocity(g), whole.mechanics->read().velocity(there)) << there;
    ASSERT_EQ(of.mechanics.read().force(g), whole.mechanics->read().force(there)) << there;
  }
  for (int c = 0; c < part.model.contact_count(); ++c) {
    const ContactState here = of.mechanics.read().contact(c),
                       there = whole.mechanics->read().contact(part.contact[c]);
    ASSERT_EQ(here.internals, there.internals) << part.contact[c];
    ASSERT_EQ(here.losses, there.losses) << part.contact[c];
  }
}

/// What is summed over a body, or over a set of its gridpoints.
struct Reading {
  std::string name;
  std::function<double(const Mechanics<2>&, const GridpointSet&)> read;
};

std::vector<Reading> readings(const std::vector<CrackKind>& kinds) {
  std::vector<Reading> all;
  const auto add = [&](const char* name, auto read) { all.push_back({name, read}); };
  using M = Mechanics<2>;
  using S = GridpointSet;
  add("zones", [](const M& m, const S&) { return m.totals().energy().zones; });
  add("contacts", [](const M& m, const S&) { return m.totals().energy().contacts; });
  add("kinetic", [](const M& m, const S&) { return m.totals().energy().kinetic; });
  add("loading", [](const M& m, const S&) { return m.totals().energy().loading; });
  add("local damping", [](const M& m, const S&) { return m.totals().energy().local_damping; });
  add("viscous damping", [](const M& m, const S&) { return m.totals().energy().viscous_damping; });
  add("gravity", [](const M& m, const S&) { return m.totals().energy().gravity; });
  for (const char* name : {"tension", "shear"})
    add(name, [name](const M& m, const S&) { return m.totals().energy().dissipated.of(name); });
  for (int i : {0, 1}) {
    add("total force", [i](const M& m, const S& s) { return m.totals().total_force(s)[i]; });
    add("net force", [i](const M& m, const S&) { return m.totals().net_force()[i]; });
  }
  add("weight", [](const M& m, const S& s) { return m.totals().total_weight(s)[1] / 9.81; });
  add("moving mass", [](const M& m, const S& s) { return m.totals().total_moving_mass(s); });
  for (std::size_t k = 0; k < kinds.size(); ++k) {
    add("damaged", [k, kinds](const M& m, const S&) {
      return static_cast<double>(count_cracks(m.body(), kinds).of_kind[k].damaged);
    });
    add("crack length",
        [k, kinds](const M& m, const S&) { return count_cracks(m.body(), kinds).of_kind[k].extent; });
  }
  return all;
}

class Parts : public testing::TestWithParam<std::string> {};
INSTANTIATE_TEST_SUITE_P(Kinematics, Parts, testing::Values("small", "finite"),
                         [](const auto& kinematics) { return kinematics.param; });

TEST_P(Parts, DoWhatTheirChunksDoInTheWhole) {
  const Whole whole(heated_deck(GetParam()));
  const ModelOf<2>& model = whole.model();
  auto bodies = bodies_of(whole);
  ASSERT_GT(bodies.size(), 7U);
  drive(*whole.mechanics, model.set("bottom_platen_support"), model.set("top_platen_support"));
  for (const auto& body : bodies)
    drive(body->mechanics, parts::set_in(body->part, model.set("bottom_platen_support")),
          parts::set_in(body->part, model.set("top_platen_support")));
  whole.mechanics->advance(kSteps);
  for (int step = 0; step < kSteps; ++step) {
    for (const auto& body : bodies) body->mechanics.advance(1);
    if (step + 1 < kSteps) exchange(bodies, model.gridpoint_count());
  }
  const auto kinds = crack_kinds(whole.mechanics->body());
  std::int64_t damaged = 0;
  for (const CrackCount& count : count_cracks(whole.mechanics->body(), kinds).of_kind)
    damaged += count.damaged;
  EXPECT_GT(damaged, model.contact_count() / 10);
  EXPECT_LT(damaged, model.contact_count());

  for (int chunk = 0; chunk < static_cast<int>(bodies.size()); ++chunk) {
    SCOPED_TRACE(testing::Message() << "chunk " << chunk);
    expect_same_layout(whole, *bodies[chunk], chunk);
    expect_same_state(whole, *bodies[chunk]);
  }
  for (const Reading& reading : readings(kinds)) {
    const auto set_of = [&](const ModelOf<2>& of, std::vector<int> set) {
      return gridpoint_set(of, std::move(set));
    };
    double sum = 0.0;
    for (const auto& body : bodies)
      sum += reading.read(body->mechanics,
                          set_of(body->part.model, parts::set_in(body->part, model.set("specimen"))));
    EXPECT_EQ(sum, reading.read(*whole.mechanics, set_of(model, model.set("specimen")))) << reading.name;
  }
}

// Means of a part are those of its own gridpoints.
TEST(Parts, MeansAreOfOwnGridpoints) {
  const Whole whole(heated_deck("small"));
  int with_specimen = 0;
  for (const auto& body : bodies_of(whole)) {
    const Part<2>& part = body->part;
    body->mechanics.advance(20);
    const GridpointSet all = gridpoint_set(part.model, parts::set_in(part, whole.model().set("specimen")));
    Vec<2> sum{};
    int own = 0;
    for (const int g : all.gridpoints)
      if (is_own(part, g)) {
        sum += body->mechanics.read().displacement(g);
        ++own;
      }
    if (own == 0) continue;  // a platen
    ++with_specimen;
    EXPECT_EQ(body->mechanics.totals().mean_displacement(all), sum * (1.0 / own));
  }
  EXPECT_GT(with_specimen, 5);
}

// Constraints and ties have one order, whatever the order in which they were made.
TEST(Constraints, HaveOneOrder) {
  const Whole whole(heated_deck("small"));
  const ModelOf<2>& model = whole.model();
  const auto body = [&](bool forwards) {
    Mechanics<2> m(model, whole.densities, whole.properties, whole.setup.moving->mechanics);
    std::vector<int> held = model.set("left");
    std::vector<std::vector<int>> tied{model.set("top_platen_support"), model.set("bottom_platen_support")};
    if (!forwards) {
      std::ranges::reverse(held);
      std::ranges::reverse(tied);
      for (auto& set : tied) std::ranges::reverse(set);
    }
    for (const int g : held) m.constraints().prescribe_velocity(g, 0, 1e-3 * (g % 7));
    for (const auto& set : tied)
      for (int i : {0, 1}) m.constraints().tie(set, forwards ? i : 1 - i);
    m.advance(50);
    return m;
  };
  const auto a = body(true), b = body(false);
  const auto bytes = [](const auto& array) {
    const auto* const first = reinterpret_cast<const char*>(array.data());
    return std::string(first, first + array.size() * sizeof(*array.data()));
  };
  EXPECT_EQ(bytes(a.body().state.constraints), bytes(b.body().state.constraints));
  EXPECT_EQ(bytes(a.body().state.constraint_packs), bytes(b.body().state.constraint_packs));
  EXPECT_EQ(bytes(a.body().state.constraints_of_bundle), bytes(b.body().state.constraints_of_bundle));
  EXPECT_EQ(bytes(a.body().state.ties), bytes(b.body().state.ties));
  EXPECT_EQ(bytes(a.body().state.tied_slots), bytes(b.body().state.tied_slots));
  EXPECT_EQ(bytes(a.body().state.displacement), bytes(b.body().state.displacement));
}

// -- Heat --------------------------------------------------------------------------------------------------

/// A step of forward Euler, and a power of two, so that its multiples are exact.
constexpr double kHeatStep = 0x1p-7;

/// Heat of a body with every kind of inflow, some of whose contacts part the temperatures of their sides.
std::unique_ptr<Conduction<2>> conduction_of(const ModelOf<2>& model, const std::vector<ContactGap>& gaps) {
  const auto material = [](double conductivity) {
    return HeatMaterial{Curve::table({0.0, 900.0}, {conductivity, 0.5}, temperature_axis()),
                        Curve::table({0.0, 900.0}, {2.2e6, 3e6}, temperature_axis())};
  };
  HeatParameters parameters{.temperature_range = {0.0, 900.0},
                            .initial_temperature = 20.0,
                            .scheme = HeatScheme::euler,
                            .safety = 0.9,
                            .largest_change = 50.0,
                            .largest_step = 10.0};
  parameters.gaps = GapHeat{4e4, Curve::constant(0.03), 1e-7, 0.9, 2e4};
  auto heat = std::make_unique<Conduction<2>>(
      model, std::vector<std::optional<HeatMaterial>>{material(2.0), material(1.5), std::nullopt},
      parameters);
  heat->set_gaps(gaps);
  const auto outer = heat->faces(on_plane<2>(0, 0.0, 1e-9));
  heat->apply(outer, Convection{Curve::constant(25.0), Curve::constant(600.0)});
  heat->apply(outer, Radiation{Curve::constant(0.8), Curve::constant(600.0)});
  heat->apply(outer, HeatFlux{Curve::constant(5e3)});
  heat->prescribe_temperature(heat->faces(on_plane<2>(0, 0.06, 1e-9)), Curve::constant(35.0));
  return heat;
}

/// Temperature at the start: any field.
double start(const Vec<2>& x) {
  return 50.0 + 4e3 * x[1] + 900.0 * x[0];
}

TEST(PartsOfHeat, DoWhatTheirChunksDoInTheWhole) {
  const Whole made(heated_deck("small"));
  const ModelOf<2>& model = made.model();
  std::vector<ContactGap> gaps(model.contacts.size());
  for (int c = 0; c < model.contact_count(); c += 5) gaps[c] = {0.9, 1e-5};
  const auto whole = conduction_of(model, gaps);
  const auto joined =
      join_through_contacts(model, {true, true, false});  // without gaps: the most that touches
  set_field(*whole, model, start);
  advance_to(*whole, kHeatStep);
  ASSERT_EQ(whole->work().steps, 1);
  ASSERT_EQ(whole->work().stages, 1);
  const double total = whole->state().stored_at_start, area = whole->gaps()->area();
  HeatByKind sums;
  double stored_at_start = 0.0, gap_area = 0.0;
  int nodes = 0;
  for (Part<2>& part : parts::all_parts(model, joined.of_gridpoint)) {
    if (part.model.is_of_bearing(part.model.chunk_blocks[part.chunk])) continue;
    const auto heat = conduction_of(part.model, parts::some_of(gaps, part.contact));
    set_field(*heat, part.model, start);
    advance_to(*heat, kHeatStep);
    ASSERT_EQ(heat->work().stages, 1);
    stored_at_start += heat->state().stored_at_start;
    gap_area += heat->gaps()->area();
    sums.add(1.0, heat->ledger().boundary);
    for (int node = 0; node < heat->nodes().count(); ++node) {
      const int g = heat->nodes().gridpoint[node];
      if (!is_own(part, g)) continue;
      ++nodes;
      EXPECT_EQ(heat->temperature()[node],
                whole->temperature()[whole->nodes().of_gridpoint[part.gridpoint[g]]]);
    }
  }
  EXPECT_EQ(nodes, whole->nodes().count());
  EXPECT_GT(area, 0.0);
  EXPECT_EQ(stored_at_start, total);
  EXPECT_EQ(gap_area, area);
  EXPECT_GT(sums.flux, 0.0);
  EXPECT_EQ(sums, whole->ledger().boundary);
}

// The mean of a part's field is that of its own zones.
TEST(PartsOfHeat, MeansAreOfOwnZones) {
  const Whole made(heated_deck("small"));
  const ModelOf<2>& model = made.model();
  const auto joined = join_through_contacts(model, {true, true, false});
  for (Part<2>& part : parts::all_parts(model, joined.of_gridpoint)) {
    if (part.model.is_of_bearing(part.model.chunk_blocks[part.chunk])) continue;
    auto heat = conduction_of(part.model, std::vector<ContactGap>(part.model.contacts.size()));
    set_field(*heat, part.model, start);
    const TemperatureField field(part.model, std::move(heat));
    const auto volume = zone_geometry(part.model).volume;
    const ChunkList zones = part.model.zone_chunks();
    double own = 0.0, heat_of_own = 0.0;
    for (int z = zones[part.chunk]; z < zones[part.chunk + 1]; ++z) {
      own += volume[z];
      heat_of_own += volume[z] * field.zones()[z];
    }
    EXPECT_EQ(field.mean(), heat_of_own / own);
  }
}

}  // namespace
}  // namespace pyroclast
