#include "counting.hpp"

#include <algorithm>

#include "pyroclast/laws/built_in.hpp"
#include "pyroclast/laws/registry.hpp"
#include "pyroclast/mechanics/step/step.hpp"

namespace bench {

using pyroclast::Bundle;
using pyroclast::BundleKind;
using pyroclast::bytes_of;
using pyroclast::Pass;
using pyroclast::State;
using pyroclast::Touched;

namespace {

template <int Dim>
using CountingStep = pyroclast::Step<Dim, Counting>;

Operations counted;

template <int Dim, class Law>
void update_faces(State<Dim>& s, int first, int last, bool measure) {
  const auto before = Counted::operations;
  pyroclast::Contacts<Dim, Counting, Law>::update(s, first, last, measure);
  if (!measure) counted.faces += Counted::operations - before;
}

template <int Dim, class... Laws>
pyroclast::PackFunctions<Dim> packs(pyroclast::LawList<Laws...>, int law) {
  static constexpr std::array<pyroclast::PackFunctions<Dim>, sizeof...(Laws)> kPacks{
      {{update_faces<Dim, Laws>, pyroclast::Contacts<Dim, Counting, Laws>::place_stiffness,
        pyroclast::Contacts<Dim, Counting, Laws>::update_lanes}...}};
  return kPacks[static_cast<std::size_t>(law)];
}

template <int Dim>
pyroclast::PackFunctions<Dim> functions_of(const pyroclast::LawTable& law) {
  return packs<Dim>(pyroclast::BuiltInLaws(), pyroclast::index_of(law));
}

/// Calls a part of the step and counts its operations among those of bundles.
template <int Dim, auto kPart, class... Arguments>
void count_in_bundles(State<Dim>& s, int first, int last, Pass pass, Arguments... arguments) {
  const auto before = Counted::operations;
  kPart(s, first, last, pass, arguments...);
  if (pass == Pass::move) counted.bundles += Counted::operations - before;
}

/// Shares of the arrays that a step touches, as far as they hang on the body.
template <int Dim>
class Shares {
 public:
  Shares(const State<Dim>& s, const std::vector<const pyroclast::LawTable*>& laws)
      : held_(held_share(s, laws)), combined_(s.damping_form == pyroclast::DampingForm::combined) {
    int other_packs = 0;
    for (const Bundle& bundle : s.layout.bundles)
      if (bundle.kind != BundleKind::alike) other_packs += bundle.packs;
    const double of_others = static_cast<double>(other_packs) / static_cast<double>(s.velocity.size());
    alike_ = 1.0 - of_others;
    gathered_ = s.kinematics == pyroclast::Kinematics::finite ? 1.0 : of_others;
  }

  double of(Touched touched) const {
    switch (touched) {
      case Touched::none:
        return 0.0;
      case Touched::all:
        return 1.0;
      case Touched::alike:
        return alike_;
      case Touched::gathered:
        return gathered_;
      case Touched::held:
        return held_;
      case Touched::combined:
        return combined_ ? 1.0 : 0.0;
    }
    return 0.0;
  }

 private:
  /// Share of the internal variables that is always written.
  static double held_share(const State<Dim>& s, const std::vector<const pyroclast::LawTable*>& laws) {
    double all = 0.0, always = 0.0;
    for (int pack = 0; pack < static_cast<int>(s.layout.faces.size()); ++pack)
      for (const auto& info : laws[s.law_of_faces[pack]]->internals(Dim)) {
        all += 1.0;
        always += info.when == 0;
      }
    return all > 0.0 ? always / all : 0.0;
  }

  double held_, alike_, gathered_;
  bool combined_;
};

}  // namespace

template <int Dim>
pyroclast::StepFunctions<Dim> counting_step() {
  using Parts = CountingStep<Dim>;
  return {
      {count_in_bundles<Dim, Parts::place_corner_forces>, count_in_bundles<Dim, Parts::move_bundles>,
       count_in_bundles<Dim, Parts::move_tied_parts>, Parts::sum_stiffness,
       pyroclast::PorePressure<Dim, Counting>::add, nullptr, nullptr},  // first contacts alone are counted
      functions_of<Dim>};
}

template pyroclast::StepFunctions<2> counting_step();
template pyroclast::StepFunctions<3> counting_step();

Operations operations() {
  return counted;
}

void reset_operations() {
  counted = {};
}

template <int Dim>
Traffic traffic(const pyroclast::Mechanics<Dim>& body) {
  const State<Dim>& state = body.body().state;
  const Shares<Dim> shares(state, body.body().laws);
  Traffic traffic;
  const auto add = [&](const pyroclast::ArrayInfo& info, const auto& array) {
    const auto bytes = static_cast<double>(bytes_of(array));
    const double read = shares.of(info.read), written = shares.of(info.written);
    traffic.moved += bytes * (read + written);
    traffic.working_set += bytes * std::max(read, written);
  };
  for_each_array(add, state.layout);
  for_each_array(add, state);
  return traffic;
}

template Traffic traffic(const pyroclast::Mechanics<2>&);
template Traffic traffic(const pyroclast::Mechanics<3>&);

}  // namespace bench
