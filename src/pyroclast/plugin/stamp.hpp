#pragma once

#include <cstddef>
#include <cstdint>
#include <string_view>
#include <type_traits>

#include "pyroclast/laws/table.hpp"
#include "pyroclast/mechanics/compiled_for_sets.hpp"
#include "pyroclast/mechanics/state.hpp"

/// Interface of a shared object with a contact law, seen from both sides. Only plain data and functions
/// cross; the stamp tells whether both sides mean the same by them.
extern "C" {

struct pyroclast_law {
  // the stamp: read before anything else is believed
  char magic[16];
  std::uint32_t table_version;
  std::uint32_t size;    ///< size of this struct, bytes
  const char* version;   ///< version of pyroclast
  std::uint64_t layout;  ///< hash of the data that cross
  std::uint32_t lanes;
  const char* compiler;  ///< compiler, recorded, not compared

  pyroclast::Dimensions dimensions;
  const pyroclast::LawTable* table;  ///< table, whose packs are those of `compiled`
  pyroclast::CompiledForSets compiled;
  pyroclast::ArithmeticProbe probe;  ///< probe that is compiled for any processor
  const void* device;                ///< place for a compilation for other processors; null so far
};

/// Function type of the one symbol of a shared object with a law.
using pyroclast_law_function = const pyroclast_law* (*)();

}  // extern "C"

namespace pyroclast {

inline constexpr char kLawMagic[16] = "pyroclast law";
inline constexpr std::uint32_t kLawTableVersion = 1;
inline constexpr const char* kLawSymbol = "pyroclast_law_v1";

/// FNV-1a hash over sizes, places and names.
class LayoutHash {
 public:
  template <class... N>
  void add(N... numbers) {
    (add_number(static_cast<std::uint64_t>(numbers)), ...);
  }
  void add(std::string_view name) {
    for (const char c : name) add_number(static_cast<unsigned char>(c));
  }
  std::uint64_t value() const { return hash_; }

 private:
  // not inline: unrolled for each of some hundred numbers it would take a compiler ten seconds
  [[gnu::noinline]] void add_number(std::uint64_t number) {
    for (int byte = 0; byte < 8; ++byte) hash_ = (hash_ ^ ((number >> (8 * byte)) & 0xff)) * 0x100000001b3U;
  }

  std::uint64_t hash_ = 0xcbf29ce484222325U;
};

/// Adds the view that the packs of a law have of a body: the place of every array and number, and the size of
/// their items.
/// \tparam S  the state; in tests another type
template <int Dim, class S = State<Dim>>
void add_state(LayoutHash& hash) {
  static_assert(std::is_trivially_copyable_v<S>);
  const S s{};
  const auto place = [&](const auto& member) {
    return reinterpret_cast<const char*>(&member) - reinterpret_cast<const char*>(&s);
  };
  const auto add_array = [&](const ArrayInfo& info, const auto& array) {
    using Item = typename std::decay_t<decltype(array)>::value_type;
    hash.add(std::string_view(info.name));
    hash.add(place(array), sizeof(array), sizeof(Item), alignof(Item));
  };
  hash.add(sizeof(s), sizeof(StepParameters<Dim>), place(s.gravity), place(s.time_step), place(s.kinematics),
           place(s.thickness), place(s.laws), sizeof(Kinematics), static_cast<int>(Kinematics::finite));
  for_each_array(add_array, s);
  for_each_array(add_array, s.layout);
  using Faces = FacePack<Dim>;
  hash.add(sizeof(Faces), offsetof(Faces, tangent), sizeof(VectorPack<Dim>), sizeof(Vec<Dim>));
  using Functions = PackFunctions<Dim>;
  hash.add(sizeof(Functions), offsetof(Functions, update), offsetof(Functions, place_stiffness),
           offsetof(Functions, update_lanes));
}

/// Returns a hash that differs where the two sides of a shared object would read each other's data wrongly.
inline std::uint64_t layout_hash() {
  LayoutHash hash;
  add_state<2>(hash);
  add_state<3>(hash);
  hash.add(sizeof(PointPack), offsetof(PointPack, area), offsetof(PointPack, a), offsetof(PointPack, b));
  hash.add(sizeof(FaceSums), offsetof(FaceSums, stored), offsetof(FaceSums, applied),
           offsetof(FaceSums, jump));
  hash.add(sizeof(Line), kLanes, kInstructionSets);
  hash.add(sizeof(LanesResponse), offsetof(LanesResponse, stored), sizeof(CompiledLaw),
           offsetof(CompiledLaw, packs), offsetof(ByDimension<PackFunctions>, in_2d),
           offsetof(ByDimension<PackFunctions>, in_3d), offsetof(CompiledLaw, probe),
           sizeof(CompiledForSets));
  hash.add(sizeof(LawTable), offsetof(LawTable, name), offsetof(LawTable, meaning),
           offsetof(LawTable, properties), offsetof(LawTable, choices), offsetof(LawTable, internals_of),
           offsetof(LawTable, losses), offsetof(LawTable, constants_size), offsetof(LawTable, constant_count),
           offsetof(LawTable, derive), offsetof(LawTable, numbers_of), offsetof(LawTable, check),
           offsetof(LawTable, stiffness), offsetof(LawTable, update_of), offsetof(LawTable, compiled));
  hash.add(sizeof(Unit), offsetof(Unit, si), offsetof(Unit, name), offsetof(Unit, example));
  hash.add(sizeof(Range), offsetof(Range, lower), offsetof(Range, upper), offsetof(Range, lower_inclusive),
           offsetof(Range, upper_inclusive));
  hash.add(sizeof(PropertyInfo), offsetof(PropertyInfo, key), offsetof(PropertyInfo, meaning),
           offsetof(PropertyInfo, unit), offsetof(PropertyInfo, range), offsetof(PropertyInfo, role),
           offsetof(PropertyInfo, of_option), static_cast<int>(Role::hidden_cracks));
  hash.add(sizeof(ChoiceInfo), offsetof(ChoiceInfo, key), offsetof(ChoiceInfo, meaning),
           offsetof(ChoiceInfo, options), sizeof(OptionInfo), ChoiceInfo::kMostOptions);
  hash.add(sizeof(InternalInfo), offsetof(InternalInfo, name), offsetof(InternalInfo, meaning),
           offsetof(InternalInfo, unit), offsetof(InternalInfo, what), offsetof(InternalInfo, when),
           offsetof(InternalInfo, in_files), static_cast<int>(Remembers::parameter));
  hash.add(sizeof(LossInfo), offsetof(LossInfo, name), offsetof(LossInfo, meaning), offsetof(LossInfo, unit));
  hash.add(sizeof(Objection), offsetof(Objection, key), offsetof(Objection, wanted),
           offsetof(Objection, bound));
  hash.add(sizeof(PointResponse), offsetof(PointResponse, normal_traction),
           offsetof(PointResponse, shear_traction), offsetof(PointResponse, stored),
           sizeof(ContactStiffness<double>));
  return hash.value();
}

/// Returns the data that a shared object hands over.
/// \param compiled  functions of the law by instruction set
template <class Law, Dimensions kDimensions>
pyroclast_law describe_law(const char* version, const CompiledForSets& compiled) {
  struct ForAnyProcessor;
  using P = Probes<ForAnyProcessor>;
  pyroclast_law law{};
  for (std::size_t i = 0; i < sizeof(law.magic); ++i) law.magic[i] = kLawMagic[i];
  law.table_version = kLawTableVersion;
  law.size = sizeof(pyroclast_law);
  law.version = version;
  law.layout = layout_hash();
  law.lanes = kLanes;
  law.compiler = __VERSION__;
  law.dimensions = kDimensions;
  law.table = &table_of<Law, kDimensions>();
  law.compiled = compiled;
  law.probe = P::functions();
  return law;
}

}  // namespace pyroclast
