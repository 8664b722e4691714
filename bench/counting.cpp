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

using CountingStep = pyroclast::Step<2, Counting>;

Operations counted;

template <class Law>
void update_faces(State<2>& s, int first, int last, bool measure) {
  const auto before = Counted::operations;
  pyroclast::Contacts<2, Counting, Law>::update(s, first, last, measure);
  if (!measure) counted.faces += Counted::operations - before;
}

template <class... Laws>
pyroclast::PackFunctions<2> packs(pyroclast::LawList<Laws...>, int law) {
  static constexpr std::array<pyroclast::PackFunctions<2>, sizeof...(Laws)> kPacks{
      {{update_faces<Laws>, pyroclast::Contacts<2, Counting, Laws>::place_stiffness,
        pyroclast::Contacts<2, Counting, Laws>::update_lanes}...}};
  return kPacks[static_cast<std::size_t>(law)];
}

pyroclast::PackFunctions<2> functions_of(const pyroclast::LawTable& law) {
  return packs(pyroclast::BuiltInLaws(), pyroclast::index_of(law));
}

/// Calls a part of the step and counts its operations among those of bundles.
template <auto kPart, class... Arguments>
void count_in_bundles(State<2>& s, int first, int last, Pass pass, Arguments... arguments) {
  const auto before = Counted::operations;
  kPart(s, first, last, pass, arguments...);
  if (pass == Pass::move) counted.bundles += Counted::operations - before;
}

/// Shares of the arrays that a step touches, as far as they hang on the body.
class Shares {
 public:
  Shares(const State<2>& s, const std::vector<const pyroclast::LawTable*>& laws)
      : held_(held_share(s, laws)), combined_(s.damping_form == pyroclast::DampingForm::combined) {
    int packs_of_pieces = 0;
    for (const Bundle& bundle : s.layout.bundles)
      if (bundle.kind != BundleKind::alike) packs_of_pieces += bundle.packs;
    const double of_pieces = static_cast<double>(packs_of_pieces) / static_cast<double>(s.velocity.size());
    alike_ = 1.0 - of_pieces;
    gathered_ = s.kinematics == pyroclast::Kinematics::finite ? 1.0 : of_pieces;
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
  static double held_share(const State<2>& s, const std::vector<const pyroclast::LawTable*>& laws) {
    double all = 0.0, always = 0.0;
    for (int pack = 0; pack < static_cast<int>(s.layout.faces.size()); ++pack)
      for (const auto& info : laws[s.law_of_faces[pack]]->internals(2)) {
        all += 1.0;
        always += info.when == 0;
      }
    return all > 0.0 ? always / all : 0.0;
  }

  double held_, alike_, gathered_;
  bool combined_;
};

}  // namespace

pyroclast::StepFunctions<2> counting_step() {
  return {{count_in_bundles<CountingStep::place_corner_forces>, count_in_bundles<CountingStep::move_bundles>,
           count_in_bundles<CountingStep::move_tied_parts>, CountingStep::sum_stiffness},
          functions_of};
}

Operations operations() {
  return counted;
}

void reset_operations() {
  counted = {};
}

Traffic traffic(const pyroclast::Mechanics<2>& body) {
  const State<2>& state = body.body().state;
  const Shares shares(state, body.body().laws);
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

}  // namespace bench
