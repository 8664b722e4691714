#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "pyroclast/base/state_visitor.hpp"
#include "pyroclast/deck/deck.hpp"
#include "pyroclast/simulation/records.hpp"
#include "pyroclast/simulation/stage.hpp"
#include "pyroclast/stages/peak.hpp"

namespace pyroclast {

/// A number that a stage makes of its records, or that is stated to make others of.
struct RecordResult {
  enum class Kind : std::uint8_t {
    given,    ///< a quantity of the deck
    peak,     ///< value of a record at the peak of its size
    largest,  ///< value of a record where its size is largest, peak or not
    last,     ///< value of a record at the end of the stage
    at_peak,  ///< value of a record at the peak of another
    work,     ///< of a force over a displacement or opening: the area under the curve, J
    formula   ///< of the results before it, in SI, and of what formulas know of the body
  };

  std::string name;
  Kind kind = Kind::given;
  RecordParameters record{}, other{};  ///< of which it is; over which, or at whose peak
  double value = 0.0;                  ///< given, SI
  std::string formula = "";
  std::string unit = "1";                   ///< in which it is told
  double unit_zero = 0.0, unit_size = 1.0;  ///< nothing, and one, of that unit, SI
};

/// The peak of the size of a record while a stage drives the body on, and its largest size.
class RecordPeak {
 public:
  /// \param of       the number of the record among `values`
  /// \param driven   time for which the body was driven on
  /// \param counts   whether the body is driven on now, and its motion is no noise: else there is no peak
  /// \param values   of all records, SI
  void take(std::size_t of, double driven, bool counts, double time, const std::vector<double>& values);

  /// See Peak::end.
  void end() { peak_.end(); }

  const Peak& peak() const { return peak_; }
  double time() const { return time_; }                          ///< of the peak, s
  const std::vector<double>& values() const { return values_; }  ///< of all records at the peak, SI
  double largest() const { return largest_; }                    ///< value where the size is largest, SI
  double largest_time() const { return largest_time_; }

  /// \param records  how many there are
  void visit_state(StateVisitor& visitor, std::size_t records);

 private:
  Peak peak_;
  double time_ = 0.0, largest_ = 0.0, largest_time_ = 0.0;
  std::vector<double> values_;
};

/// The peak of a size over the time for which the body is driven: it lasts for a tenth of the time to the
/// peak.
PeakRule rule_of_records(const Peak& so_far);

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

/// Peak and largest value of every record, and when they came; then what was asked for. A formula that has no
/// finite value gives none. Rows without a value of the record do not count.
///
/// \param peaks  of each record; empty before the stage
/// \param rows   of the stage
std::vector<Result> record_results(const std::vector<RecordParameters>& records,
                                   const std::vector<RecordPeak>& peaks,
                                   const std::vector<RecordResult>& asked, const BodyFigures& body,
                                   const History& history, RowRange rows);

/// Of each record whose peak was asked for and is none, a line.
std::vector<std::string> missing_peaks(const std::vector<RecordParameters>& records,
                                       const std::vector<RecordPeak>& peaks,
                                       const std::vector<RecordResult>& asked);

/// The results that were asked for, in words.
std::vector<std::string> lines_of(const std::vector<RecordResult>& asked, const std::vector<Result>& results);

}  // namespace pyroclast
