#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "pyroclast/base/state_visitor.hpp"
#include "pyroclast/deck/deck.hpp"
#include "pyroclast/simulation/loop/stage.hpp"
#include "pyroclast/simulation/watching/records.hpp"
#include "pyroclast/stages/peak.hpp"

namespace pyroclast {

/// Number that a stage computes from its records, or a given number from which others are computed.
struct RecordResult {
  enum class Kind : std::uint8_t {
    given,    ///< quantity of the deck
    peak,     ///< value of a record at the peak of its size
    largest,  ///< value of a record where its size is largest, peak or not
    last,     ///< value of a record at the end of the stage
    at_peak,  ///< value of a record at the peak of another
    work,     ///< work of a force over a displacement or opening: the area under the curve, J
    formula   ///< formula of the results before it, in SI, and of the figures of the body
  };

  std::string name;
  Kind kind = Kind::given;
  /// Record of the value; record over which it is taken, or at whose peak.
  RecordParameters record{}, other{};
  double value = 0.0;  ///< given value, SI
  std::string formula = "";
  std::string unit = "1";                   ///< unit of the result
  double unit_zero = 0.0, unit_size = 1.0;  ///< zero, and one, of that unit, SI
};

/// Peak of the size of a record while a stage drives the body on, and its largest size.
class RecordPeak {
 public:
  /// Takes the values at a step.
  /// \param of       number of the record among `values`
  /// \param driven   time for which the body was driven on
  /// \param counts   true where the body is driven on now, and its motion is no noise: else there is no peak
  /// \param values   values of all records, SI
  void take(std::size_t of, double driven, bool counts, double time, const std::vector<double>& values);

  /// Ends the search, see Peak::end.
  void end() { peak_.end(); }

  const Peak& peak() const { return peak_; }
  double time() const { return time_; }  ///< Returns the time of the peak, s.
  /// Returns the values of all records at the peak, SI.
  const std::vector<double>& values() const { return values_; }
  /// Returns the value where the size is largest, SI.
  double largest() const { return largest_; }
  double largest_time() const { return largest_time_; }

  /// \param records  number of records
  void visit_state(StateVisitor& visitor, std::size_t records);

 private:
  Peak peak_;
  double time_ = 0.0, largest_ = 0.0, largest_time_ = 0.0;
  std::vector<double> values_;
};

/// Returns the rule of the peak of a size over the time for which the body is driven: it must last for a
/// tenth of the time to the peak.
PeakRule rule_of_records(const Peak& so_far);

/// Figures of the specimen without its bearings that formulas may use beside results.
struct BodyFigures {
  double thickness = 0.0;  ///< thickness, of a solid its depth, m; not known of a cylinder
  double weight = 0.0;     ///< weight as it acts in the run, N

  void visit_state(StateVisitor& visitor);
};

BodyFigures figures_of(const Simulation& simulation);

/// Returns the record that a key names; none after an error, which lists the records.
std::optional<RecordParameters> find_record(const Section& s, std::string_view key, Meaning meaning,
                                            const std::vector<RecordParameters>& records);

/// Reads [[stages.results]] of a stage.
/// \param has_thickness  true where formulas may use the thickness of the body
std::vector<RecordResult> read_record_results(const Section& stage,
                                              const std::vector<RecordParameters>& records,
                                              bool has_thickness);

/// Returns the peak and the largest value of every record with their times, and then the results asked for. A
/// formula without a finite value gives no result. Rows without a value of the record do not count.
///
/// \param peaks  peak of each record; empty before the stage
/// \param rows   rows of the stage
std::vector<Result> record_results(const std::vector<RecordParameters>& records,
                                   const std::vector<RecordPeak>& peaks,
                                   const std::vector<RecordResult>& asked, const BodyFigures& body,
                                   const History& history, RowRange rows);

/// Returns a line for each record whose peak was asked for and is missing.
std::vector<std::string> missing_peaks(const std::vector<RecordParameters>& records,
                                       const std::vector<RecordPeak>& peaks,
                                       const std::vector<RecordResult>& asked);

/// Describes the results that were asked for in words.
std::vector<std::string> lines_of(const std::vector<RecordResult>& asked, const std::vector<Result>& results);

}  // namespace pyroclast
