#pragma once

#include <filesystem>
#include <map>
#include <memory>
#include <tuple>

#include "adapter.hpp"
#include "pyroclast/setup/setup.hpp"

namespace bench {

/// How far a specimen is loaded when its step is timed.
enum class Loading { intact, cracked };

const char* name(Loading loading);

/// A specimen between platens, and all that a body is made from.
struct Specimen {
  /// \param blocks  instead of the deck's
  Specimen(const pyroclast::Setup& setup, int blocks);

  pyroclast::specimen::Specimen made;
  pyroclast::ModelOf<2> model;
  double width, height;  ///< m
  pyroclast::BodyProperties properties;
  std::vector<double> densities;
  pyroclast::MechanicsParameters parameters;
};

/// The bodies that are timed. Specimens and loaded bodies are made when first asked for, and kept.
class Bodies {
 public:
  /// \param deck  of a compression between platens; the number of its blocks is replaced
  explicit Bodies(const std::filesystem::path& deck);

  /// The threads of all bodies of the library.
  pyroclast::Team& team() { return *team_; }
  /// Of the upper platen in the deck, m/s, downwards.
  double velocity() const { return velocity_; }
  /// The specimen with about so many zones.
  const Specimen& specimen(int zones);
  pyroclast::Mechanics<2>& mechanics(int zones, Loading loading);
  textbook::Body& textbook(int zones, Loading loading);
  /// Of a step of `mechanics(zones, loading)`, counted when first asked for.
  const StepCost& step_cost(int zones, Loading loading);

 private:
  template <class Body>
  using Kept = std::map<std::tuple<int, Loading>, std::unique_ptr<Body>>;

  pyroclast::Setup setup_;
  std::shared_ptr<pyroclast::Team> team_ = std::make_shared<pyroclast::Team>(1, pyroclast::WhenCrowded::stay);
  double velocity_;
  std::map<int, std::unique_ptr<Specimen>> specimens_;
  Kept<StepCost> costs_;
  Kept<pyroclast::Mechanics<2>> mechanics_;
  Kept<textbook::Body> textbook_;
};

}  // namespace bench
