#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "pyroclast/base/state_visitor.hpp"
#include "pyroclast/deck/deck.hpp"
#include "pyroclast/simulation/records.hpp"
#include "pyroclast/simulation/stage.hpp"

namespace pyroclast {

/// A number that a stage makes of its records, or that is stated to make others of.
struct RecordResult {
  enum class Kind : std::uint8_t {
    given,    ///< a quantity of the deck
    peak,     ///< value of a record where its size is largest
    last,     ///< value of a record at the end of the stage
    at_peak,  ///< value of a record where the size of another is largest
    work,     ///< of a force over a displacement or opening: the area under the curve, J
    formula   ///< of the results before it, in SI, and of what formulas know of the body
  };

  std::string name;
  Kind kind = Kind::given;
  RecordParameters record{}, other{};  ///< of which it is; over which, or at whose peak
  double value = 0.0;                  ///< given, SI
  std::string formula = "";
  std::string unit = "1";  ///< in which it is told
  double unit_size = 1.0;  ///< of that unit, SI
};

/// What formulas may use beside results: of the specimen without its bearings.
struct BodyFigures {
  double thickness = 0.0;  ///< m
  double weight = 0.0;     ///< as it acts in the run, N

  void visit_state(StateVisitor& visitor);
};

/// The record that a key names; none after an error, which tells what there is.
std::optional<RecordParameters> find_record(const Section& s, std::string_view key, Meaning meaning,
                                            const std::vector<RecordParameters>& records);

/// Reads [[stages.results]] of a stage.
std::vector<RecordResult> read_record_results(const Section& stage,
                                              const std::vector<RecordParameters>& records);

/// Peak of every record, and when it came; then what was asked for. A formula that has no finite value gives
/// none. Rows without a value of the record do not count.
/// \param rows  of the stage
std::vector<Result> record_results(const std::vector<RecordParameters>& records,
                                   const std::vector<RecordResult>& asked, const BodyFigures& body,
                                   const History& history, RowRange rows);

/// The results that were asked for, in words.
std::vector<std::string> lines_of(const std::vector<RecordResult>& asked, const std::vector<Result>& results);

}  // namespace pyroclast
