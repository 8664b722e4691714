#pragma once

#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <tuple>
#include <utility>
#include <vector>

#include "adapter.hpp"
#include "pyroclast/setup/setup.hpp"

namespace bench {

/// How far a sample is loaded when its step is timed.
enum class Loading { intact, cracked };

const char* name(Loading loading);

/// A body between rough ends, and all that a code needs to move it.
template <int Dim>
struct Sample {
  pyroclast::ModelOf<Dim> model;
  pyroclast::Vec<Dim> size;       ///< of the part that is compressed, from the origin, m; y is up
  std::vector<int> ends;          ///< gridpoints that do not widen: those of platens and at their faces
  std::vector<int> held, driven;  ///< gridpoints that stand still, and those that move downwards
  pyroclast::BodyProperties properties;
  std::vector<double> densities;
  pyroclast::MechanicsParameters parameters;
};

/// The bodies that are timed. Samples and loaded bodies are made when first asked for, and kept.
template <int Dim>
class Bodies {
 public:
  using Make = std::function<std::unique_ptr<Sample<Dim>>(int size)>;

  /// \param make      makes the sample of a size
  /// \param velocity  of the driven end, m/s
  Bodies(Make make, double velocity) : make_(std::move(make)), velocity_(velocity) {}

  /// The threads of all bodies of the library.
  pyroclast::Team& team() { return *team_; }
  double velocity() const { return velocity_; }  ///< m/s
  const Sample<Dim>& sample(int size);
  pyroclast::Mechanics<Dim>& mechanics(int size, Loading loading);
  textbook::Body<Dim>& textbook(int size, Loading loading);
  /// Of a step of `mechanics(size, loading)`, counted when first asked for.
  const StepCost& step_cost(int size, Loading loading);

 private:
  template <class Body>
  using Kept = std::map<std::tuple<int, Loading>, std::unique_ptr<Body>>;

  Make make_;
  double velocity_;
  std::shared_ptr<pyroclast::Team> team_ = std::make_shared<pyroclast::Team>(1, pyroclast::WhenCrowded::stay);
  std::map<int, std::unique_ptr<Sample<Dim>>> samples_;
  Kept<StepCost> costs_;
  Kept<pyroclast::Mechanics<Dim>> mechanics_;
  Kept<textbook::Body<Dim>> textbook_;
};

/// The deck of a compression between platens, whose specimens and materials are timed.
class Deck {
 public:
  explicit Deck(const std::filesystem::path& path);

  /// Specimens of the deck, by about how many zones they have.
  Bodies<2> specimens() const;
  /// Cubes of 100 mm of the deck's matrix without platens, by their number of blocks: raw Laguerre cells of
  /// seeds that keep their distance, with a spread of the radii of 0.3.
  Bodies<3> cubes() const;

 private:
  double velocity() const;

  pyroclast::Setup setup_;
};

extern template class Bodies<2>;
extern template class Bodies<3>;

}  // namespace bench
