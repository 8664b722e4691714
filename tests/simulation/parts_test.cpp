// The part of each rank is made from its own chunks and the blocks that touch them, and must do what these
// chunks do in the whole body: the layout, the forces of every step and the sums, to the bit. So no part of a
// body needs to know the whole.

#include <algorithm>
#include <atomic>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "in_plane.hpp"
#include "pyroclast/mechanics/cracks.hpp"
#include "pyroclast/mechanics/found/found_points.hpp"
#include "pyroclast/model/part.hpp"
#include "pyroclast/simulation/acting/loads.hpp"
#include "pyroclast/simulation/body_on_ranks.hpp"
#include "pyroclast/simulation/coupling.hpp"
#include "pyroclast/thermal/conduction.hpp"
#include "pyroclast/thermal/temperature_field.hpp"
#include "ranks_in_threads.hpp"
#include "small_chunks.hpp"
#include "stages/small_runs.hpp"
#include "thermal/advance.hpp"

namespace pyroclast {
namespace {

constexpr int kBlocksOfAPart = 8;

/// A heated prism between platens; each zone and contact has a temperature of its own.
struct Whole {
  explicit Whole(const std::string& text) : setup(read(text)) {
    const SmallChunks chunks(kBlocksOfAPart);
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

/// \param kinematics  "found": finite, and contacts are found
std::string heated_deck(const std::string& kinematics) {
  const std::string with_found = "finite\"\ncontacts = \"found";
  return with(deck(kSettle + kExpose + kHeatedFace), "mass = \"scaled\"",
              "mass = \"scaled\"\ngravity = \"9.81 m/s2\"\nkinematics = \"" +
                  (kinematics == "found" ? with_found : kinematics) + "\"");
}

/// The same things of the whole, in the order of a part.
template <class T>
std::vector<T> some_of(const std::vector<T>& all, const std::vector<int>& numbers) {
  std::vector<T> some;
  for (const int number : numbers) some.push_back(all[number]);
  return some;
}

/// A part of a rank and its body.
struct OfPart {
  OfPart(ModelOf<2> of, const Whole& whole)
      : model(std::move(of)),
        mechanics(model, whole.densities, properties(whole.properties), whole.setup.moving->mechanics) {}

  BodyProperties properties(const BodyProperties& of_whole) const {
    BodyProperties own;
    own.contacts = of_whole.contacts;
    own.zones = some_of(of_whole.zones, model.part->zone);
    own.of_contact = some_of(of_whole.of_contact, model.part->contact);
    own.of_interface = of_whole.of_interface;
    if (!of_whole.creep.empty()) own.creep = some_of(of_whole.creep, model.part->zone);
    return own;
  }
  /// Places of own chunks in the part.
  std::vector<int> own_chunks() const {
    std::vector<int> own;
    for (int c = 0; c < model.chunks().count(); ++c)
      if (!model.chunks().is_foreign(c)) own.push_back(c);
    return own;
  }

  ModelOf<2> model;
  Mechanics<2> mechanics;
};

/// Calls `f(part)` on each rank, a thread of its own.
void on_ranks(int count, const Whole& whole, const std::function<void(OfPart&)>& f) {
  RanksInThreads::run(count, [&](const std::shared_ptr<Ranks>& ranks) {
    const ForeignBlocks foreign = foreign_blocks(whole.setup.moving);
    OfPart part(part_of(whole.model(), ranks, ranks_of_chunks(whole.model(), count), {}, foreign), whole);
    f(part);
  });
}

constexpr int kSteps = 600;

/// Holds the lower platen, and pulls the upper one up and aside. Where contacts are found, pulls it apart,
/// and drives it down again in the second half of the steps.
void drive(Mechanics<2>& mechanics, const ModelOf<2>& model) {
  const bool meets = mechanics.body().parameters.found.is_on;
  for (const int g : model.set("bottom_platen_support"))
    for (int i : {0, 1}) mechanics.constraints().prescribe_velocity(g, i, 0.0);
  for (const double up : {meets ? 0.1 : 0.03, meets ? -0.6 : 0.03}) {
    for (const int g : model.set("top_platen_support"))
      for (int i : {0, 1}) mechanics.constraints().prescribe_velocity(g, i, i == 0 ? 0.01 : up);
    mechanics.advance(kSteps / 2);
  }
}

/// \param own  place of an own chunk in the part
void expect_same_layout(const Whole& whole, const OfPart& of, int own) {
  const Layout<2>&there = whole.mechanics->body().layout, &here = of.mechanics.body().layout;
  const PartOfBody& part = *of.model.part;
  const int chunk = part.chunk[own];
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
  const PartOfBody& part = *of.model.part;
  for (auto [g, last] = of.model.gridpoint_chunks().own(); g < last; ++g) {
    const int there = part.gridpoint[g];
    ASSERT_EQ(of.mechanics.read().displacement(g), whole.mechanics->read().displacement(there)) << there;
    ASSERT_EQ(of.mechanics.read().velocity(g), whole.mechanics->read().velocity(there)) << there;
    ASSERT_EQ(of.mechanics.read().force(g), whole.mechanics->read().force(there)) << there;
  }
  for (int c = 0; c < of.model.contact_count(); ++c) {
    const auto is_own = [&](int g) { return of.model.gridpoint_chunks().is_own(g); };
    if (!is_own(of.model.contacts[c].a) && !is_own(of.model.contacts[c].b)) continue;
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

std::vector<std::string> names_of(const std::vector<CrackKind>& kinds) {
  std::vector<std::string> names;
  for (const CrackKind& kind : kinds) names.push_back(kind.name);
  return names;
}

class Parts : public testing::TestWithParam<std::string> {};
INSTANTIATE_TEST_SUITE_P(Kinematics, Parts, testing::Values("small", "finite", "found"),
                         [](const auto& kinematics) { return kinematics.param; });

TEST_P(Parts, DoWhatTheirChunksDoInTheWhole) {
  const Whole whole(heated_deck(GetParam()));
  const ModelOf<2>& model = whole.model();
  const int chunks = model.chunks().count();
  ASSERT_GT(chunks, 7);
  drive(*whole.mechanics, model);
  const auto kinds = crack_kinds(whole.mechanics->body());
  std::int64_t damaged = 0;
  for (const CrackCount& count : count_cracks(whole.mechanics->body(), kinds).of_kind)
    damaged += count.damaged;
  EXPECT_GT(damaged, model.contact_count() / 10);
  EXPECT_LT(damaged, (GetParam() == "found" ? 2 : 1) * model.contact_count());  // of several kinds
  const auto points = found_points(whole.mechanics->body());
  const std::vector<int> chunk_of = model.chunks().of_items();
  const auto are_of_two_chunks = [&](const FoundPoint& p) {
    return chunk_of[p.blocks[0]] != chunk_of[p.blocks[1]];
  };
  EXPECT_EQ(std::ranges::count_if(points, are_of_two_chunks) > 5, GetParam() == "found") << points.size();
  const auto readings_of = [&](const ModelOf<2>& of, const Mechanics<2>& mechanics) {
    const GridpointSet set = gridpoint_set(of, of.set("specimen"));
    std::vector<double> numbers;
    for (const Reading& reading : readings(kinds)) numbers.push_back(reading.read(mechanics, set));
    return numbers;
  };
  const std::vector<double> of_whole = readings_of(model, *whole.mechanics);

  for (const int count : {chunks, 3})  // ranks of one chunk, and of several
    on_ranks(count, whole, [&](OfPart& part) {
      EXPECT_EQ(names_of(crack_kinds(part.mechanics.body())), names_of(kinds));
      drive(part.mechanics, part.model);
      for (const int chunk : part.own_chunks()) expect_same_layout(whole, part, chunk);
      expect_same_state(whole, part);
      EXPECT_EQ(readings_of(part.model, part.mechanics), of_whole);
    });
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
  const auto joined = join_through_contacts(
      model, blocks_of(model, {true, true, false}));  // without gaps: the most that touches
  set_field(*whole, model, start);
  advance_to(*whole, kHeatStep);
  ASSERT_EQ(whole->work().steps, 1);
  ASSERT_EQ(whole->work().stages, 1);
  EXPECT_GT(whole->gaps()->area(), 0.0);
  EXPECT_GT(whole->ledger().boundary.flux, 0.0);
  constexpr int kRanks = 5;
  std::atomic<int> nodes{0};
  RanksInThreads::run(kRanks, [&](const std::shared_ptr<Ranks>& ranks) {
    const ModelOf<2> part = part_of(model, ranks, ranks_of_chunks(model, kRanks), joined.of_gridpoint);
    const auto heat = conduction_of(part, some_of(gaps, part.part->contact));
    set_field(*heat, part, start);
    advance_to(*heat, kHeatStep);
    ASSERT_EQ(heat->work().stages, 1);
    EXPECT_EQ(heat->state().stored_at_start, whole->state().stored_at_start);
    EXPECT_EQ(heat->gaps()->area(), whole->gaps()->area());
    EXPECT_EQ(heat->ledger().boundary, whole->ledger().boundary);
    for (int node = 0; node < heat->nodes().count(); ++node) {
      const int g = heat->nodes().gridpoint[node];
      if (!part.gridpoint_chunks().is_own(g)) continue;
      ++nodes;
      EXPECT_EQ(heat->temperature()[node],
                whole->temperature()[whole->nodes().of_gridpoint[part.part->gridpoint[g]]]);
    }
  });
  EXPECT_EQ(nodes, whole->nodes().count());
}

}  // namespace
}  // namespace pyroclast
