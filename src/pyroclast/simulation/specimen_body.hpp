#pragma once

#include <map>
#include <memory>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "pyroclast/base/team.hpp"
#include "pyroclast/model/model.hpp"
#include "pyroclast/model/sets.hpp"
#include "pyroclast/simulation/acting/press.hpp"
#include "pyroclast/simulation/moving_body.hpp"
#include "pyroclast/specimen/specimen.hpp"

namespace pyroclast {

/// Specimen that was made, in the plane or in space.
using MadeSpecimen = std::variant<specimen::Specimen<2>, specimen::Specimen<3>>;

/// Returns the names of the phases that its blocks can have.
const std::vector<std::string>& phases(const MadeSpecimen& specimen);
/// Returns the stone of each block, -1: of none; empty where stones are not known.
const std::vector<int>& stones(const MadeSpecimen& specimen);
/// Returns what a user should know of a specimen that differs from the request, one line each.
std::vector<std::string> warnings(const MadeSpecimen& specimen);

/// Returns an upper estimate of the memory that a run of a specimen needs, bytes.
/// \param conducts_heat  whether the run solves heat conduction
double estimate_memory(const specimen::SpecimenParameters& asked, bool conducts_heat);

/// Makes a specimen. Throws Error when the specimen cannot be made, or a run of it would not fit into the
/// free memory.
/// \param team           threads that make it; without a team the calling thread works alone
/// \param conducts_heat  whether the run solves heat conduction
MadeSpecimen make_checked_specimen(const specimen::SpecimenParameters& asked, Team* team = nullptr,
                                   bool conducts_heat = false);

/// Numbers of a specimen that materials, heat and exchanges ask for.
struct SpecimenNumbers {
  std::vector<double> fraction;  ///< share of each phase, in the order of the materials of blocks
  double mean_size = 0.0;        ///< mean size of its blocks, m, see specimen::Metrics
  double block_size = 0.0;  ///< size of a block that counts for fracture zones, m, see specimen::block_size
  /// Side of the square of its area, m, against which lengths of the body are measured; of a solid the edge
  /// of the cube of its volume.
  double size = 0.0;
  int dimension = 2;
};

SpecimenNumbers numbers_of(const MadeSpecimen& specimen);

/// Words and files by which a run tells of its specimen, where the specimen itself is not there any more.
struct SpecimenTold {
  std::string text;                          ///< description for the screen
  std::vector<std::string> warnings;         ///< see warnings
  std::vector<int> stone;                    ///< stone of each block, see skeleton; may be empty
  std::string facts;                         ///< facts for the summary, as JSON
  std::map<std::string, std::string> files;  ///< files of the folder specimen/, by name
};

/// Body of a simulation, in the plane or in space: the model of a specimen and what is known of it. Its
/// gridpoints have a set "specimen"; between platens they have the sets of Press.
struct SpecimenBody {
  std::unique_ptr<Model> model;
  SpecimenNumbers numbers;
  std::vector<specimen::Notch> notches;  ///< a notch without width parts the contacts of its name
  std::optional<Press::Specimen> between_platens;
  /// Null where the specimen tells of itself, or nothing does.
  std::shared_ptr<const SpecimenTold> told = {};
};

/// Component of a position along which the press of a deck stands.
inline constexpr int kVertical = 1;

/// Makes the model of a specimen, with the bearings and interfaces of `moving`.
/// \param thickness  thickness of a specimen in the plane, m; of a solid not used
/// \param moving     empty where nothing moves: then there are no bearings
std::unique_ptr<Model> make_model(const MadeSpecimen& specimen, double thickness,
                                  const std::optional<MovingBody>& moving);

/// Makes a specimen into a body, with sets beside those that every model has.
SpecimenBody make_body(const MadeSpecimen& specimen, double thickness, const std::vector<SetParameters>& sets,
                       const std::optional<MovingBody>& moving);

}  // namespace pyroclast
