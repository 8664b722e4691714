// Parts of the step for this machine's processor. Compiled with its options, and so with an instruction set
// of its own name: a function that the library shares would be linked twice, once with other options.
#include "native_step.hpp"

#include "pyroclast/mechanics/step/step.hpp"

namespace bench {

using pyroclast::Bundle;
using pyroclast::Pass;
using pyroclast::State;

namespace {

#if defined(__AVX512F__) && defined(__AVX512DQ__) && defined(__AVX512VL__)
struct Native : pyroclast::Avx512 {};
#elif defined(__AVX2__)
struct Native : pyroclast::Avx2 {};
#else
struct Native : pyroclast::Portable {};
#endif

using NativeStep = pyroclast::Step<2, Native>;
constexpr auto kSmall = pyroclast::Kinematics::small;

int bundles(const State<2>& s) {
  return static_cast<int>(s.layout.bundles.size());
}

template <class... Laws>
constexpr NativeLaws packs(pyroclast::LawList<Laws...>) {
  return {
      {{pyroclast::Contacts<2, Native, Laws>::update, pyroclast::Contacts<2, Native, Laws>::place_stiffness,
        pyroclast::Contacts<2, Native, Laws>::update_lanes}...}};
}

void contacts(State<2>& s, double*) {
  pyroclast::for_each_law(s, 0, static_cast<int>(s.layout.faces.size()),
                          [&](const pyroclast::PackFunctions<2>& law, int first, int last) {
                            law.update(s, first, last, false);
                          });
}

[[gnu::flatten]] void gather(State<2>& s, double* memory) {
  NativeStep::Sums sums;
  for (const Bundle& bundle : s.layout.bundles)
    NativeStep::sum_weights_and_contacts<kSmall, false>(s, bundle, NativeStep::R::scratch_of(bundle, memory),
                                                        sums);
}

[[gnu::flatten]] void zones(State<2>& s, double* memory) {
  NativeStep::Sums sums;
  for (int b = 0; b < bundles(s); ++b)
    if (s.layout.bundles[b].kind == pyroclast::BundleKind::piece)
      NativeStep::Z::place_corner_forces<kSmall, false, false>(s, b, sums);
  for (int b = 0; b < bundles(s); ++b) {
    const Bundle& bundle = s.layout.bundles[b];
    const auto scratch = NativeStep::R::scratch_of(bundle, memory);
    NativeStep::take_displacements(s, bundle, scratch);
    NativeStep::Z::add_forces<kSmall, false, false>(s, b, scratch, sums);
  }
}

[[gnu::flatten]] void motion(State<2>& s, double* memory) {
  for (int b = 0; b < bundles(s); ++b) {
    const Bundle& bundle = s.layout.bundles[b];
    const auto scratch = NativeStep::R::scratch_of(bundle, memory);
    NativeStep::take_displacements(s, bundle, scratch);
    for (int i = 0; i < bundle.packs; ++i) scratch.sum[i] = s.force[bundle.first_pack + i];
    NativeStep::Sums sums;
    NativeStep::M::move_packs<Pass::move>(s, b, scratch, sums);
    NativeStep::M::keep<Pass::move>(s, b, sums);
  }
}

}  // namespace

const NativeLaws kNativeLaws = packs(pyroclast::BuiltInLaws());
const Part kParts[4] = {{"contacts", contacts}, {"gather", gather}, {"zones", zones}, {"motion", motion}};

}  // namespace bench
