#include "pyroclast/mechanics/law_pack.hpp"

#include <algorithm>
#include <memory>

#include <fmt/format.h>

#include "pyroclast/base/flat_array.hpp"
#include "pyroclast/mechanics/compiled_for_sets.hpp"
#include "pyroclast/mechanics/state.hpp"

namespace pyroclast {

namespace {

/// Eight faces of area 1 in one pack, normal to the first axis. Only their first contact points move.
template <int Dim>
class LawPack {
 public:
  LawPack(const LawTable& law, const PackFunctions<Dim>& functions)
      : functions_(functions),
        numbers_{static_cast<int>(law.internals(Dim).size()), static_cast<int>(law.losses.size()),
                 law.constants},
        faces_(1),
        points_(kPoints),
        first_point_(2),
        between_chunks_(1),
        displacement_(2 * kLanes),
        contact_force_(kPoints * kLanes),
        internals_(kPoints * law.internals(Dim).size()),
        loss_(kPoints * law.losses.size()),
        own_constants_(kPoints * static_cast<std::size_t>(law.constants)),
        contact_constants_(law.size),
        first_(2),
        losing_(kPoints),
        one_set_(1),
        face_sums_(1) {
    for (int t = 0; t + 1 < Dim; ++t) std::fill_n(faces_[0].tangent[t][t + 1], kLanes, 1.0);
    first_point_[1] = kPoints;
    for (int point = 0; point < kPoints; ++point)
      for (int lane = 0; lane < kLanes; ++lane) {
        points_[point].a[lane] = offset_of<Dim>(lane);
        points_[point].b[lane] = offset_of<Dim>(point == 0 ? kLanes + lane : lane);
      }
    state_.layout.faces = {faces_.data(), faces_.size()};
    state_.layout.points = {points_.data(), points_.size()};
    state_.layout.first_point = {first_point_.data(), first_point_.size()};
    state_.layout.between_chunks = {between_chunks_.data(), between_chunks_.size()};
    const auto see = [](auto& view, auto& array) { view = {array.data(), array.size()}; };
    see(state_.displacement, displacement_);
    see(state_.contact_force, contact_force_);
    see(state_.internals, internals_);
    see(state_.loss, loss_);
    see(state_.own_constants, own_constants_);
    see(state_.contact_constants, contact_constants_);
    for (auto* first : {&state_.first_internal, &state_.first_loss, &state_.first_constant,
                        &state_.set_of_faces, &state_.first_own_constant})
      see(*first, first_);
    see(state_.losing, losing_);
    see(state_.one_set, one_set_);
    see(state_.face_sums, face_sums_);
  }
  LawPack(const LawPack&) = delete;
  LawPack& operator=(const LawPack&) = delete;

  /// As LanesUpdate.
  LanesResponse update(const void* constants, const double* own, const double* jump, double* internals,
                       double* losses) {
    std::copy_n(static_cast<const std::byte*>(constants), contact_constants_.size(),
                contact_constants_.begin());
    one_set_[0] = own == nullptr;
    if (own) put(own, own_constants_, numbers_.constants);
    for (int lane = 0; lane < kLanes; ++lane)
      for (int i = 0; i < Dim; ++i) displacement_[kLanes + lane][i] = jump[i * kLanes + lane];
    LanesResponse r;
    // stored energies come as one sum, so once for each lane
    for (int lane = 0; lane < kLanes; ++lane) {
      std::fill_n(points_[0].area, kLanes, 0.0);
      points_[0].area[lane] = 1.0;
      run(internals, losses, true);
      r.stored[lane] = face_sums_[0].stored;
    }
    std::fill_n(points_[0].area, kLanes, 1.0);
    run(internals, losses, false);
    for (int i = 0; i < numbers_.internals; ++i)
      std::copy_n(internals_[i].number, kLanes, internals + i * kLanes);
    for (int i = 0; i < numbers_.losses; ++i) std::copy_n(loss_[i].number, kLanes, losses + i * kLanes);
    for (int lane = 0; lane < kLanes; ++lane) {
      r.normal_traction[lane] = contact_force_[lane][0];
      for (int t = 0; t + 1 < Dim; ++t) r.shear_traction[t][lane] = contact_force_[lane][t + 1];
    }
    r.changed = losing_[0] ? 1U : 0U;
    return r;
  }

 private:
  static constexpr int kPoints = Dim == 2 ? 2 : 1;

  static void put(const double* numbers, FlatArray<Line>& lines, int count) {
    for (int i = 0; i < count; ++i)
      for (int lane = 0; lane < kLanes; ++lane) {
        lines[i].number[lane] = numbers[i * kLanes + lane];
        if (kPoints == 2) lines[count + i].number[lane] = numbers[i * kLanes + lane];
      }
  }
  void run(const double* internals, const double* losses, bool measure) {
    put(internals, internals_, numbers_.internals);
    put(losses, loss_, numbers_.losses);
    functions_.update(state_, 0, 1, measure);
  }

  PackFunctions<Dim> functions_;
  struct {
    int internals, losses, constants;
  } numbers_;
  FlatArray<FacePack<Dim>> faces_;
  FlatArray<PointPack> points_;
  FlatArray<int> first_point_;
  FlatArray<bool> between_chunks_;
  FlatArray<Vec<Dim>> displacement_;  ///< side a at rest, then side b
  FlatArray<Vec<Dim>> contact_force_;
  FlatArray<Line> internals_, loss_, own_constants_;
  FlatArray<std::byte> contact_constants_;
  FlatArray<int> first_;  ///< zeros
  FlatArray<bool> losing_, one_set_;
  FlatArray<FaceSums> face_sums_;
  State<Dim> state_;
};

template <int Dim>
LanesUpdate lanes_of_pack(const LawTable& law, InstructionSet set) {
  if (!law.update(Dim)) return {};
  const auto pack = std::make_shared<LawPack<Dim>>(law, functions_of<Dim>(law, set));
  return [pack](const void* constants, const double* own, const double* jump, double* internals,
                double* losses) { return pack->update(constants, own, jump, internals, losses); };
}

}  // namespace

std::vector<KitLanes> lanes_of_step(const LawTable& law) {
  std::vector<KitLanes> all;
  for (const InstructionSet set : usable_instruction_sets())
    if (is_compiled(law, set))
      all.push_back({fmt::format("the step in {}", name(set)),
                     {lanes_of_pack<2>(law, set), lanes_of_pack<3>(law, set)}});
  return all;
}

}  // namespace pyroclast
