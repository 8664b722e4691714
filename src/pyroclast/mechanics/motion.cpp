#include "pyroclast/mechanics/motion.hpp"

#include <utility>

#include <fmt/format.h>

#include "pyroclast/base/error.hpp"

namespace pyroclast {

template <int Dim>
MotionOf<Dim>::MotionOf(const ModelOf<Dim>& model, const std::vector<double>& densities,
                        BodyProperties properties, const MechanicsParameters& parameters,
                        std::shared_ptr<Team> team)
    : mechanics_(model, densities, std::move(properties), parameters, std::move(team)),
      constraints_(mechanics_),
      reader_(mechanics_),
      totals_(mechanics_) {}

template <int Dim>
ContactFrame<3> MotionOf<Dim>::ReaderOf::frame_of_forces(int contact) const {
  const ContactFrame<Dim> frame = read_.frame_of_forces(contact);
  ContactFrame<3> wide{resized<3>(frame.normal), {}};
  for (int t = 0; t + 1 < Dim; ++t) wide.tangents[t] = resized<3>(frame.tangents[t]);
  return wide;
}

template <int Dim>
ArrayInMemory MotionOf<Dim>::array_of(std::string_view name) const {
  const auto& arrays = mechanics_.body().arrays;
  const auto seen = [](const auto& array, std::vector<std::ptrdiff_t> of_each) {
    of_each.insert(of_each.begin(), static_cast<std::ptrdiff_t>(array.size()));
    return ArrayInMemory{reinterpret_cast<const double*>(array.data()), std::move(of_each)};
  };
  if (name == "displacement") return seen(arrays.displacement, {Dim});
  if (name == "velocity") return seen(arrays.velocity, {Dim, kLanes});
  if (name == "force") return seen(arrays.force, {Dim, kLanes});
  if (name == "internals") return seen(arrays.internals, {kLanes});
  throw Error(fmt::format("there is no \"{}\"", name));
}

std::unique_ptr<Motion> make_motion(const Model& model, const std::vector<double>& densities,
                                    BodyProperties properties, const MechanicsParameters& parameters,
                                    std::shared_ptr<Team> team) {
  return with_dimension(model, [&]<int Dim>(const ModelOf<Dim>& of_dimension) -> std::unique_ptr<Motion> {
    return std::make_unique<MotionOf<Dim>>(of_dimension, densities, std::move(properties), parameters,
                                           std::move(team));
  });
}

template class MotionOf<2>;
template class MotionOf<3>;

}  // namespace pyroclast
