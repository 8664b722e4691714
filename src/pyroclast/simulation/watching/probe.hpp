#pragma once

#include <optional>
#include <string>
#include <vector>

#include "pyroclast/model/model.hpp"

namespace pyroclast {

/// Point of the specimen at which a run watches the temperature.
struct ProbePosition {
  std::string name;
  Vec<3> position{};  ///< position from the specimen's lower left corner, m
};

/// Probe: reads a field of the gridpoints at a point, linearly within the zone that holds the point.
class Probe {
 public:
  /// Throws Error when the point lies outside the specimen.
  Probe(const Model& model, const ProbePosition& at);

  /// Returns a probe for each point that lies in the specimen, m; none for the others: a collective.
  static std::vector<std::optional<Probe>> at(const Model& model, const std::vector<Vec<3>>& points);
  /// Reads the field by several probes: one collective.
  static std::vector<double> read_all(const std::vector<Probe>& probes,
                                      const std::vector<double>& gridpoints);

  const std::string& name() const { return name_; }
  /// Returns a corner of the zone that holds the point.
  int gridpoint() const { return gridpoints_.front(); }

  /// Reads the field: a collective.
  /// \param gridpoints  value of each gridpoint
  double read(const std::vector<double>& gridpoints) const;

 private:
  Probe() = default;

  std::string name_;
  std::vector<int> gridpoints_;  ///< corners of the zone
  std::vector<double> weights_;  ///< weight of each corner
  Ranks* ranks_ = &one_rank();
  int rank_ = 0;  ///< rank that holds the zone
};

}  // namespace pyroclast
