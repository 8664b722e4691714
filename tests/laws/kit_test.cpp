#include "pyroclast/laws/kit.hpp"

#include <algorithm>
#include <string>
#include <string_view>

#include <gtest/gtest.h>

#include "pyroclast/laws/cohesive.hpp"
#include "pyroclast/laws/elastic.hpp"
#include "pyroclast/laws/registry.hpp"
#include "pyroclast/mechanics/lanes_of_step.hpp"
#include "pyroclast/mechanics/step/contacts.hpp"

namespace pyroclast {
namespace {

// -- every law holds every property -----------------------------------------------------------------

class EveryLaw : public testing::TestWithParam<const LawTable*> {};
INSTANTIATE_TEST_SUITE_P(Kit, EveryLaw, testing::ValuesIn(built_in_laws().begin(), built_in_laws().end()),
                         [](const auto& tried) { return std::string(tried.param->name); });

TEST_P(EveryLaw, HoldsEveryProperty) {
  KitOptions options;
#ifndef __OPTIMIZE__
  options.paths = 1000;  // under the sanitizers; optimized builds take all
#endif
  options.lanes = lanes_of_step(*GetParam());
  EXPECT_GE(options.lanes.size(), 1U);
  const KitReport report = verify(*GetParam(), options);
  for (const KitFinding& f : report.findings) {
    EXPECT_TRUE(f.passed()) << f.property << "\n" << report.text();
    const bool may_have_none = f.property == std::string_view("objections");  // a law need not object
    EXPECT_TRUE(f.checks > 0 || may_have_none) << f.property;
  }
}

TEST(Kit, TakesTheSamePathsForTheSameSeed) {
  KitOptions options;
  options.paths = 64;
  const LawTable& law = table_of<Cohesive>();
  const std::string first = verify(law, options).text();
  EXPECT_EQ(verify(law, options).text(), first);
  options.seed = 2;
  EXPECT_NE(verify(law, options).text(), first);
}

// -- laws that are wrong in one way each are found out by the property that says so ------------------

/// The step's lanes of a law that is not compiled for every instruction set.
template <class Law>
KitLanes lanes_of_law() {
  return {"portable lanes",
          {Contacts<2, Portable, Law>::update_lanes, Contacts<3, Portable, Law>::update_lanes}};
}

/// What the kit says of a law about one property: empty when it holds.
std::string complaint(const LawTable& law, const char* property, std::vector<KitLanes> lanes = {}) {
  KitOptions options;
  options.paths = 200;
  options.lanes = std::move(lanes);
  const KitReport report = verify(law, options);
  const auto finding = std::ranges::find_if(
      report.findings, [&](const KitFinding& f) { return std::string_view(f.property) == property; });
  EXPECT_NE(finding, report.findings.end()) << "no such property";
  if (finding->passed()) return {};
  EXPECT_NE(finding->first, "");
  return report.text();
}

template <class Law>
std::string complaint(const char* property, std::vector<KitLanes> lanes = {}) {
  return complaint(table_of<Law>(), property, std::move(lanes));
}

/// The paper's law, spoilt after each update.
template <class Spoilt>
struct Cohesively : Cohesive {
  static constexpr const char* name = "spoilt";

  template <int Dim, class Real, class Number, class Sum>
  static ContactResponse<Dim, Real> update(const Constants<Number>& constants, const Real& opening,
                                           const Tangential<Dim, Real>& tangential,
                                           Internals<Dim, Real>& internals, Losses<Sum>& losses) {
    const Internals<Dim, Real> before = internals;
    auto response = Cohesive::update<Dim, Real>(constants, opening, tangential, internals, losses);
    Spoilt::template spoil<Dim>(constants, opening, tangential, before, internals, losses, response);
    return response;
  }
};

struct HoldsEnergyAtRest : Cohesively<HoldsEnergyAtRest> {
  template <int Dim>
  static void spoil(const auto&, const auto&, const auto&, const auto&, auto&, auto&, auto& response) {
    response.stored += 1.0;
  }
};
TEST(Kit, FindsALawThatHoldsEnergyAtRest) {
  EXPECT_NE(complaint<HoldsEnergyAtRest>("rest"), "");
}

struct DividesByZero : Cohesively<DividesByZero> {
  template <int Dim>
  static void spoil(const auto&, const auto& opening, const auto&, const auto&, auto&, auto&,
                    auto& response) {
    using Real = std::decay_t<decltype(opening)>;
    response.normal_traction += select(opening > 1e-5, opening - opening, Real(0.0)) / (opening - opening);
  }
};
TEST(Kit, FindsANumberThatIsNotFinite) {
  EXPECT_NE(complaint<DividesByZero>("finite"), "");
}

struct Heals : Cohesively<Heals> {
  template <int Dim>
  static void spoil(const auto&, const auto& opening, const auto&, const auto&, auto& internals, auto&,
                    auto& response) {
    internals.tension_damage *= select(opening < 0.0, 0.999 + 0.0 * opening, 1.0 + 0.0 * opening);
    response.changed |= info::kDamaged;
  }
};
TEST(Kit, FindsADamageThatHeals) {
  EXPECT_NE(complaint<Heals>("damages"), "");
}

struct BreaksTwice : Cohesively<BreaksTwice> {
  template <int Dim>
  static void spoil(const auto&, const auto&, const auto&, const auto&, auto& internals, auto&, auto&) {
    internals.tension_damage =
        select(internals.tension_damage > 0.9, internals.tension_damage + 0.2, internals.tension_damage);
  }
};
TEST(Kit, FindsADamageBeyondOne) {
  EXPECT_NE(complaint<BreaksTwice>("damages"), "");
}

struct GainsInFriction : Cohesively<GainsInFriction> {
  template <int Dim>
  static void spoil(const auto&, const auto& opening, const auto&, const auto&, auto&, auto& losses, auto&) {
    losses.friction += select(opening < 0.0, 1e-3 * opening, 0.0 * opening);
  }
};
TEST(Kit, FindsANegativeLoss) {
  EXPECT_NE(complaint<GainsInFriction>("losses"), "");
}

struct StoresLessThanNothing : Cohesively<StoresLessThanNothing> {
  template <int Dim>
  static void spoil(const auto&, const auto&, const auto&, const auto&, auto&, auto&, auto& response) {
    response.stored *= -1.0;
  }
};
TEST(Kit, FindsNegativeStoredEnergy) {
  EXPECT_NE(complaint<StoresLessThanNothing>("stored"), "");
}

struct Creeps : Cohesively<Creeps> {
  template <int Dim>
  static void spoil(const auto&, const auto& opening, const auto&, const auto&, auto& internals, auto&,
                    auto& response) {
    internals.closure += select(opening < 0.0, 1e-9 + 0.0 * opening, 0.0 * opening);
    response.changed |= info::kDamaged;
  }
};
TEST(Kit, FindsAnAnswerThatChangesWhenAskedAgain) {
  EXPECT_NE(complaint<Creeps>("repeated"), "");
}

struct LanesDisturbEachOther : Cohesively<LanesDisturbEachOther> {
  template <int Dim>
  static void spoil(const auto&, const auto& opening, const auto&, const auto&, auto&, auto&,
                    auto& response) {
    if (any(opening > 0.0)) response.stored *= 1.0 + 1e-12;
  }
};
TEST(Kit, FindsLanesThatDisturbEachOther) {
  EXPECT_NE(complaint<LanesDisturbEachOther>("lanes", {lanes_of_law<LanesDisturbEachOther>()}), "");
}

struct KeepsSilent : Cohesively<KeepsSilent> {
  template <int Dim>
  static void spoil(const auto&, const auto&, const auto&, const auto&, auto&, auto&, auto& response) {
    response.changed = 0;
  }
};
TEST(Kit, FindsALawThatDoesNotSayWhatChanged) {
  EXPECT_NE(complaint<KeepsSilent>("lanes", {lanes_of_law<KeepsSilent>()}), "");
}

TEST(Kit, FindsAnInstructionSetThatGivesOtherBits) {
  auto lanes = lanes_of_step(table_of<Cohesive>());
  const auto right = lanes.front().update_of;
  for (std::size_t i = 0; i < 2; ++i)
    lanes.front().update_of[i] = [&right, i](const void* constants, const Line* own, const Line* jump,
                                             Line* internals, Line* losses) {
      LanesResponse r = right[i](constants, own, jump, internals, losses);
      r.normal_traction.number[3] *= 1.0 + 1e-15;
      return r;
    };
  const std::string text = complaint(table_of<Cohesive>(), "lanes", {lanes.front()});
  EXPECT_NE(text.find("lane 3 of the step in portable"), std::string::npos) << text;
}

struct KnowsLeftFromRight : Cohesively<KnowsLeftFromRight> {
  template <int Dim>
  static void spoil(const auto&, const auto&, const auto& tangential, const auto&, auto&, auto&,
                    auto& response) {
    using Real = std::decay_t<decltype(tangential[0])>;
    response.shear_traction[0] *= select(tangential[0] > 0.0, Real(1.0 + 1e-6), Real(1.0));
  }
};
TEST(Kit, FindsALawThatKnowsLeftFromRight) {
  EXPECT_NE(complaint<KnowsLeftFromRight>("frame"), "");
}

struct LosesTooLittle : Cohesively<LosesTooLittle> {
  template <int Dim>
  static void spoil(const auto& c, const auto&, const auto&, const auto& before, auto& internals,
                    auto& losses, auto&) {
    losses.tension += 1e-4 * c.mode_1_energy * (internals.tension_damage - before.tension_damage);
  }
};
TEST(Kit, FindsALossThatIsOffByAPartInTenThousand) {
  EXPECT_NE(complaint<LosesTooLittle>("balance, one axis"), "");
}

/// Shear traction that grows with the opening, with the energy of it but without its part in the normal
/// traction: along either axis alone from where nothing is sheared all is well.
struct NotOfAPotential : Elastic {
  static constexpr const char* name = "not of a potential";

  template <int Dim, class Real, class Number, class Sum>
  static ContactResponse<Dim, Real> update(const Constants<Number>& c, const Real& opening,
                                           const Tangential<Dim, Real>& tangential, Internals<Dim, Real>& h,
                                           Losses<Sum>& losses) {
    auto r = Elastic::update<Dim, Real>(c, opening, tangential, h, losses);
    const Real share = smaller(abs_of(opening) * 1e4, Real(0.5));
    r.shear_traction *= 1.0 - share;
    r.stored -= 0.5 * share * c.shear_stiffness * dot(tangential, tangential);
    return r;
  }
  template <class Real>
  static Real abs_of(const Real& a) {
    return larger(a, 0.0 - a);
  }
};
TEST(Kit, FindsWorkThatDependsOnTheWay) {
  EXPECT_NE(complaint<NotOfAPotential>("balance"), "");
  EXPECT_EQ(complaint<NotOfAPotential>("balance, one axis"), "");
}

/// Books the damage before the step over the whole of it.
struct LagsBehind : Cohesively<LagsBehind> {
  template <int Dim>
  static void spoil(const auto&, const auto&, const auto&, const auto& before, auto& internals, auto&,
                    auto&) {
    internals.tension_damage = 0.5 * (before.tension_damage + internals.tension_damage);
  }
};
TEST(Kit, FindsAnAnswerThatDependsOnTheSteps) {
  EXPECT_NE(complaint<LagsBehind>("steps, one axis"), "");
}

/// Loses with the root of a step, so that more cuts lose more.
struct NeverConverges : Cohesively<NeverConverges> {
  template <int Dim>
  static void spoil(const auto& c, const auto&, const auto&, const auto& before, auto& internals,
                    auto& losses, auto&) {
    using std::sqrt;
    const auto slid = internals.slip[0] - before.slip[0];
    losses.friction += 1e-3 * c.mode_2_energy * sqrt(larger(slid, 0.0 - slid) * 1e6);
  }
};
TEST(Kit, FindsEnergiesThatDoNotConverge) {
  EXPECT_NE(complaint<NeverConverges>("steps"), "");
}

/// As stiff as its bound says it is not.
template <int kPercent>
struct OtherBound : Cohesive {
  static constexpr const char* name = "other bound";
  template <class Real>
  static ContactStiffness<Real> stiffness(const Constants<Real>& c) {
    return {c.normal_stiffness, kPercent / 100.0 * c.shear_stiffness};
  }
};
TEST(Kit, FindsABoundThatIsNone) {
  EXPECT_NE(complaint<OtherBound<99>>("stiffness"), "");
}
TEST(Kit, FindsABoundThatNothingReaches) {
  EXPECT_NE(complaint<OtherBound<300>>("bound reached"), "");
}

/// Each axis alone keeps to the bound, both together are half as stiff again.
struct Coupled : Elastic {
  static constexpr const char* name = "coupled";
  template <int Dim, class Real, class Number, class Sum>
  static ContactResponse<Dim, Real> update(const Constants<Number>& c, const Real& opening,
                                           const Tangential<Dim, Real>& tangential, Internals<Dim, Real>& h,
                                           Losses<Sum>& losses) {
    auto r = Elastic::update<Dim, Real>(c, opening, tangential, h, losses);
    r.normal_traction += 0.5 * c.normal_stiffness * tangential[0];
    r.shear_traction[0] += 0.5 * c.shear_stiffness * opening;
    return r;
  }
};
TEST(Kit, FindsACouplingThatIsStifferThanBothBounds) {
  EXPECT_NE(complaint<Coupled>("stiffness"), "");
}

struct SoftAtFirst : Cohesively<SoftAtFirst> {
  template <int Dim>
  static void spoil(const auto&, const auto&, const auto&, const auto&, auto&, auto&, auto& response) {
    response.normal_traction *= 0.99;
  }
};
TEST(Kit, FindsANewContactThatIsSofterThanItsProperty) {
  EXPECT_NE(complaint<SoftAtFirst>("first stiffness"), "");
}

struct Leaps : Cohesively<Leaps> {
  template <int Dim>
  static void spoil(const auto& c, const auto& opening, const auto&, const auto&, auto&, auto&,
                    auto& response) {
    using Real = std::decay_t<decltype(opening)>;
    response.normal_traction += select(opening > 0.0, Real(0.1 * c.tensile_strength), Real(0.0));
  }
};
TEST(Kit, FindsATractionThatLeaps) {
  EXPECT_NE(complaint<Leaps>("continuity"), "");
}

template <int kKind>
struct Objects : Cohesive {
  static constexpr const char* name = "objects";
  static Objection check(const Properties<double>& p) {
    const Objection objection = Cohesive::check(p);
    if (!objection.key) return {};
    if (kKind == 0) return {"no key of mine", "anything else"};
    return {objection.key, objection.wanted, 2.0 * objection.bound + 1.0};
  }
};
TEST(Kit, FindsObjectionsThatNameNothingOrAWrongBound) {
  EXPECT_NE(complaint<Objects<0>>("objections"), "");
  EXPECT_NE(complaint<Objects<1>>("objections"), "");
}

struct TakesNothing : Cohesive {
  static constexpr const char* name = "takes nothing";
  static Objection check(const Properties<double>&) { return {"K_n", "something else"}; }
};
TEST(Kit, RefusesALawThatTakesNoProperties) {
  EXPECT_ANY_THROW(verify(table_of<TakesNothing>()));
}

}  // namespace
}  // namespace pyroclast
