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

template <int Dim>
using NativeStep = pyroclast::Step<Dim, Native>;
constexpr auto kSmall = pyroclast::Kinematics::small;

template <int Dim>
int bundles(const State<Dim>& s) {
  return static_cast<int>(s.layout.bundles.size());
}

template <int Dim, class... Laws>
constexpr NativeLaws<Dim> packs(pyroclast::LawList<Laws...>) {
  return {{{pyroclast::Contacts<Dim, Native, Laws>::update,
            pyroclast::Contacts<Dim, Native, Laws>::place_stiffness,
            pyroclast::Contacts<Dim, Native, Laws>::update_lanes}...}};
}

template <int Dim>
void contacts(State<Dim>& s, double*) {
  pyroclast::for_each_law(s, 0, static_cast<int>(s.layout.faces.size()),
                          [&](const pyroclast::PackFunctions<Dim>& law, int first, int last) {
                            law.update(s, first, last, false);
                          });
}

template <int Dim>
[[gnu::flatten]] void gather(State<Dim>& s, double* memory) {
  typename NativeStep<Dim>::Sums sums;
  for (const Bundle& bundle : s.layout.bundles)
    NativeStep<Dim>::template sum_weights_and_contacts<kSmall, false>(
        s, bundle, NativeStep<Dim>::R::scratch_of(bundle, memory), sums);
}

template <int Dim>
[[gnu::flatten]] void zones(State<Dim>& s, double* memory) {
  typename NativeStep<Dim>::Sums sums;
  for (int b = 0; b < bundles(s); ++b)
    if (s.layout.bundles[b].kind == pyroclast::BundleKind::piece)
      NativeStep<Dim>::Z::template place_corner_forces<kSmall, false, false>(s, b, sums);
  for (int b = 0; b < bundles(s); ++b) {
    const Bundle& bundle = s.layout.bundles[b];
    const auto scratch = NativeStep<Dim>::R::scratch_of(bundle, memory);
    NativeStep<Dim>::take_displacements(s, bundle, scratch);
    NativeStep<Dim>::Z::template add_forces<kSmall, false, false>(s, b, scratch, sums);
  }
}

template <int Dim>
[[gnu::flatten]] void motion(State<Dim>& s, double* memory) {
  for (int b = 0; b < bundles(s); ++b) {
    const Bundle& bundle = s.layout.bundles[b];
    const auto scratch = NativeStep<Dim>::R::scratch_of(bundle, memory);
    NativeStep<Dim>::take_displacements(s, bundle, scratch);
    for (int i = 0; i < bundle.packs; ++i) scratch.sum[i] = s.force[bundle.first_pack + i];
    typename NativeStep<Dim>::Sums sums;
    NativeStep<Dim>::M::template move_packs<false>(s, b, true, scratch, sums);
    NativeStep<Dim>::M::template keep<false>(s, b, true, sums);
  }
}

}  // namespace

template <int Dim>
const NativeLaws<Dim>& native_laws() {
  static constexpr NativeLaws<Dim> kLaws = packs<Dim>(pyroclast::BuiltInLaws());
  return kLaws;
}

template <int Dim>
const std::array<Part<Dim>, 4>& parts() {
  static constexpr std::array<Part<Dim>, 4> kParts{
      {{"contacts", contacts<Dim>}, {"gather", gather<Dim>}, {"zones", zones<Dim>}, {"motion", motion<Dim>}}};
  return kParts;
}

template const NativeLaws<2>& native_laws();
template const NativeLaws<3>& native_laws();
template const std::array<Part<2>, 4>& parts();
template const std::array<Part<3>, 4>& parts();

}  // namespace bench
