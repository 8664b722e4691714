#include "pyroclast/plugin/open_library.hpp"

#include <cstring>
#include <deque>
#include <limits>
#include <mutex>
#include <string_view>
#include <utility>

#include <dlfcn.h>
#include <fmt/format.h>

#ifdef __SSE__
#include <xmmintrin.h>
#endif

#include "pyroclast/base/error.hpp"
#include "pyroclast/mechanics/instruction_set.hpp"
#include "pyroclast/plugin/build_settings.hpp"
#include "pyroclast/plugin/stamp.hpp"

namespace pyroclast {

namespace {

/// Advice for a law that was compiled with other flags.
constexpr std::string_view kRemedy = "build it with pyroclast_add_law, which sets the flags";

unsigned control_word() {
#ifdef __SSE__
  return _mm_getcsr() & ~_MM_EXCEPT_MASK;
#else
  return 0;
#endif
}

void set_control_word([[maybe_unused]] unsigned word) {
#ifdef __SSE__
  _mm_setcsr(word);
#endif
}

class Opener {
 public:
  explicit Opener(const std::filesystem::path& file) : file_(file) {}

  OpenedLaw open() {
    const unsigned before = control_word();
    void* const object = dlopen(std::filesystem::absolute(file_).c_str(), RTLD_NOW | RTLD_LOCAL);
    const unsigned after = control_word();
    set_control_word(before);
    if (!object) refuse("cannot be loaded as a contact law: {}", dlerror());
    if (after != before)
      refuse(
          "switches the processor to other arithmetic when it is loaded (MXCSR {:#x} becomes {:#x}), as a "
          "library linked with -ffast-math does: numbers near zero would be flushed to zero; {}",
          before, after, kRemedy);
    auto* const function = reinterpret_cast<pyroclast_law_function>(dlsym(object, kLawSymbol));
    if (!function)
      refuse("has no symbol {}: it is no contact law of pyroclast {}", kLawSymbol, build_settings::kVersion);
    const pyroclast_law* const law = function();
    compare(law);
    examine(law->probe, "code for any processor");
    for (const InstructionSet set : usable_instruction_sets())
      if (const CompiledLaw* const compiled = law->compiled.of_set[static_cast<std::size_t>(set)])
        examine(compiled->probe, fmt::format("packs for the instruction set {}", name(set)));
    OpenedLaw opened{*law->table, law->dimensions, file_, {}, law->compiler};
    opened.table.compiled = &law->compiled;
    return opened;
  }

 private:
  template <class... Args>
  [[noreturn]] void refuse(fmt::format_string<Args...> what, Args&&... args) const {
    throw Error(fmt::format("{}: {}", file_.string(), fmt::format(what, std::forward<Args>(args)...)));
  }

  void compare(const pyroclast_law* law) const {
    if (!law || std::memcmp(law->magic, kLawMagic, sizeof(kLawMagic)) != 0)
      refuse("{} does not give a contact law of pyroclast", kLawSymbol);
    if (law->table_version != kLawTableVersion || law->size != sizeof(pyroclast_law))
      refuse(
          "hands over its law in form {} of {} bytes; this program takes form {} of {} bytes; build it again",
          law->table_version, law->size, kLawTableVersion, sizeof(pyroclast_law));
    if (std::string_view(law->version) != build_settings::kVersion)
      refuse("was built with pyroclast {}; this is pyroclast {}; build it again", law->version,
             build_settings::kVersion);
    if (law->layout != layout_hash() || law->lanes != static_cast<std::uint32_t>(kLanes))
      refuse(
          "was built for another layout of the data ({:016x} with {} lanes; this program has {:016x} with "
          "{}); "
          "build it again with the headers of this program",
          law->layout, law->lanes, layout_hash(), kLanes);
  }

  /// Throws Error where numbers are not those of IEEE 754.
  void examine(const ArithmeticProbe& probe, const std::string& where) const {
    constexpr double kSmall = 0x1p-30, kLarge = 0x1p60;
    if (const double rest = probe.product(kSmall); rest != 0.0)
      refuse(
          "its {} are compiled with contraction of a*b + c into one operation ((1 + e)(1 - e) - 1 gave {:g}, "
          "not 0), so results would hang on the optimizer; add -ffp-contract=off, or {}",
          where, rest, kRemedy);
    const double nan = std::numeric_limits<double>::quiet_NaN();
    if (probe.difference(kLarge, 1.0) != 0.0 || probe.is_number(nan))
      refuse(
          "its {} are compiled with -ffast-math or one of its parts (sums are taken in another order, or NaN "
          "is not foreseen); leave it out, or {}",
          where, kRemedy);
    constexpr double kLeast = std::numeric_limits<double>::min();
    if (probe.half(kLeast) == 0.0)
      refuse("its {} flush numbers near zero to zero ({:g} / 2 gave 0); {}", where, kLeast, kRemedy);
  }

  const std::filesystem::path& file_;
};

struct OpenedLibraries {
  std::mutex mutex;
  std::deque<OpenedLaw> laws;  // never moved: contacts point at their tables
};

OpenedLibraries& opened() {
  static OpenedLibraries all;
  return all;
}

}  // namespace

const OpenedLaw& open_law(const std::filesystem::path& shared_object,
                          std::vector<std::filesystem::path> headers) {
  const auto file = std::filesystem::weakly_canonical(shared_object);
  auto& [mutex, laws] = opened();
  const std::scoped_lock lock(mutex);
  for (const OpenedLaw& law : laws)
    if (law.shared_object == file) return law;
  OpenedLaw law = Opener(file).open();
  law.headers = std::move(headers);
  return laws.emplace_back(std::move(law));
}

std::vector<const OpenedLaw*> opened_laws() {
  auto& [mutex, laws] = opened();
  const std::scoped_lock lock(mutex);
  std::vector<const OpenedLaw*> all;
  for (const OpenedLaw& law : laws) all.push_back(&law);
  return all;
}

}  // namespace pyroclast
