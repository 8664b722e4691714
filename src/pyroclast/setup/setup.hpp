#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "pyroclast/deck/deck.hpp"
#include "pyroclast/deck/survey.hpp"
#include "pyroclast/material/curve_reader.hpp"
#include "pyroclast/material/thermal_strain.hpp"
#include "pyroclast/plugin/find_law.hpp"
#include "pyroclast/setup/read_references.hpp"
#include "pyroclast/simulation/simulation.hpp"
#include "pyroclast/stages/registry.hpp"

namespace pyroclast {

/// Choice of the moments at which a run keeps its state.
struct CheckpointChoice {
  double interval = 600.0;  ///< interval of wall time, s; 0: after every batch of steps
  bool keep_stages = true;  ///< true: keeps the state at the end of each stage, for forks
};

/// Content of a deck, in its parts and in SI.
struct Setup {
  std::string title;
  specimen::SpecimenParameters specimen;
  double thickness = 1.0;                      ///< thickness out of plane, m; of a solid 1
  std::vector<BlockMaterial> block_materials;  ///< by phase of the specimen, then those of bearings
  ExpansionReading expansion_reading = ExpansionReading::secant;
  std::vector<ReadCurve> curves;  ///< properties over the temperature, as the deck gave them
  /// Temperatures to which the run may come, °C; its curves must cover them.
  Interval temperatures;
  double exposure = 0.0;                 ///< time for which boundaries act, s
  std::optional<MovingBody> moving;      ///< empty where no stage moves the body
  std::vector<SetParameters> sets;       ///< sets beside those that every model has
  std::vector<std::string> unused_sets;  ///< sets that no table names: for scripts and ParaView
  /// Lines about properties of materials that no temperature of the run needs.
  std::vector<std::string> unused_properties;
  HeatConditions heat;  ///< heat; uniform at the reference temperature without [heat]
  std::vector<ProbePosition> probes;
  std::vector<RecordParameters> records;
  std::vector<std::unique_ptr<Stage>> stages;
  std::vector<std::string> stage_names;
  CheckpointChoice checkpoints;
  /// Explanations of code that the user did not allow: the keys of contacts with it were then not checked,
  /// and the body cannot be made. See require_code.
  std::vector<std::string> code_not_allowed;
  bool has_fields = true;             ///< true where frames of the fields are written
  std::vector<Reference> references;  ///< references beside the results
  /// Warnings of the deck: values that are allowed, but most likely not meant.
  std::vector<Diagnostic> warnings;
};

/// Reads a deck. A relative file name in it is taken from `folder`. Throws DeckError with every error of the
/// deck.
/// \param kinds  kinds of stages that the deck may ask for
/// \param laws   sources of contact laws that are not part of the program
Setup read_setup(const Deck& deck, const std::filesystem::path& folder, const StageRegistry& kinds = {},
                 LawSources laws = LawSources::of_environment());

/// Throws CodeNotAllowed where the deck names code that may not run.
void require_code(const Setup& setup);

/// Returns everything that `read_setup` asks of a deck.
DeckSchema deck_schema(const StageRegistry& kinds = {});

/// Makes specimen, model, field and mechanics. Throws Error when they cannot be made, see Simulation and
/// make_checked_specimen.
/// \param team   threads of the run; without a team the calling thread works alone
/// \param ranks  ranks that hold the body, each of which calls this; null: one
std::unique_ptr<Simulation> make_simulation(const Setup& setup, std::shared_ptr<Team> team = nullptr,
                                            std::shared_ptr<Ranks> ranks = nullptr);
/// Makes model, field and mechanics of a specimen that is made already. It has the phases of the deck, and
/// the sides that the deck names.
std::unique_ptr<Simulation> make_simulation(const Setup& setup, MadeSpecimen specimen,
                                            std::shared_ptr<Team> team = nullptr,
                                            std::shared_ptr<Ranks> ranks = nullptr);

/// Makes field and mechanics of a body that was made of this deck's inputs, see BodyFile.
std::unique_ptr<Simulation> make_simulation(const Setup& setup, SpecimenBody body, std::shared_ptr<Team> team,
                                            std::shared_ptr<Ranks> ranks);

/// Returns the block size that a deck foresees, m; where the tessellation is read from a file, the size at
/// which t_b holds.
double expected_block_size(const specimen::SpecimenParameters& specimen, const ContactParameters& contacts);

}  // namespace pyroclast
