#pragma once

#include <array>
#include <functional>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "pyroclast/base/state_visitor.hpp"
#include "pyroclast/mechanics/motion.hpp"

namespace pyroclast {

/// Press with a fixed lower and a movable upper platen, and the specimen between them.
///
/// The press holds, drives and watches named sets of the model's gridpoints (Model::sets):
/// `bottom_platen_support` and `top_platen_support`, the outer faces of the platens; `bottom_platen_face` and
/// `top_platen_face`, their inner faces; `bottom` and `top`, the ends of the specimen, and its sides across
/// the axis (Specimen::sides); `specimen`, `bottom_platen` and `top_platen`, all gridpoints of these bodies.
///
/// Stress and strain are positive in compression, lateral strain in expansion.
class Press {
 public:
  /// Motion of the whole specimen that does not change the jumps of its contacts.
  struct EvenMotion {
    double axial = 0.0, lateral = 0.0;  ///< strains, expansion positive; the lower end stays where it is
    double lift = 0.0;                  ///< lift of the specimen as a whole along the axis, m
    /// Slopes to which the specimen is tilted, along each component across the axis; in 2D the second is 0.
    std::array<double, 2> tilt{};
    double platen_lift = 0.0;  ///< lift of the upper platen beyond the end that it lies on, m
  };

  /// Specimen between the platens.
  struct Specimen {
    int axis = 1;                ///< component of a position along which the platens stand
    double height = 0.0;         ///< height of the specimen along the axis, m
    double area = 0.0;           ///< area across the axis, m²
    std::vector<double> widths;  ///< widths across the axis, in the order of the other components, m
    /// Sets of the lower and the upper side across each of these components, between which the widths lie.
    std::vector<std::array<std::string, 2>> sides{{"left", "right"}, {"front", "back"}};
  };

  /// Holds the lower platen, and the upper one across the axis. Throws Error for an axis or widths that the
  /// body cannot have.
  /// \param motion  motion, kept by reference; must outlive this object
  Press(Motion& motion, Specimen between);

  // Control of the upper platen.

  /// Lets the upper platen lie on the specimen, and tilt.
  void let_go();
  /// Moves the upper platen by its force only, without tilting. A platen that was controlled by motion keeps
  /// the force that it bore.
  void control_by_force();
  /// Moves the upper platen down at a velocity, m/s; the force on it ends.
  void control_by_motion(double velocity);
  /// Changes the velocity of a platen that is controlled by motion, m/s downwards.
  void move_platen(double velocity);
  /// Sets the force on the upper platen over the area of the specimen, Pa, from the next step on.
  void hold(double stress);
  double stress_held() const { return kept_.stress_held; }

  // Readings at the displacements and forces of the last step.

  /// Takes the present length and width as those from which strains count.
  void set_zero();
  /// Takes the present strain as that from which the strain of a stage counts.
  void begin_stage();
  /// Returns the approach of the platens' inner faces since the zero over the height.
  double strain() const;
  /// Returns the approach of the platens' inner faces since `begin_stage` over the height.
  double stage_strain() const { return strain() - kept_.stage_first_strain; }
  /// Returns the approach of the specimen's own ends since the zero over the height.
  double specimen_strain() const;
  /// Returns the mean widening since the zero over the width, mean of all directions across the axis.
  double lateral_strain() const;
  /// Returns the reaction of the upper platen over the area, Pa.
  double stress_top() const;
  double stress_bottom() const;
  double stress() const { return 0.5 * (stress_top() + stress_bottom()); }
  /// Tells whether the lower platen carries at least four fifths of what rests on it: the specimen's weight
  /// and the force held. True where nothing rests on it.
  bool is_supported() const;
  /// Returns the way that the upper platen can sink until both platens touch the specimen, m. Rough ends are
  /// touched where they stand out most.
  double gap() const;
  int axis() const { return between_.axis; }
  double height() const { return between_.height; }
  double volume() const;  ///< Returns the volume of the specimen, m³.
  /// Returns the motion that sets the specimen down on the lower platen, and the upper platen on the
  /// specimen. The specimen then stands on two points on either side of its middle, in 3D on three around it;
  /// it tilts towards no plane of symmetry.
  EvenMotion to_touch() const;
  /// Returns the largest way that a gridpoint of the specimen goes in a motion without strain, m.
  double way(const EvenMotion& motion) const;
  const GridpointSet& specimen() const { return summed("specimen"); }

  // Even motion.

  /// Moves the whole specimen evenly in the next step. A call with `speed` 0 halts it there in the step
  /// after.
  /// \param speed           share of the motion to come in one step
  /// \param platen_follows  true: the upper platen moves with the end that it lies on
  void move_evenly(const EvenMotion& motion, double speed, bool platen_follows);
  /// Lets the specimen move freely again.
  void end_even_motion(bool platen_follows);

  void visit_state(StateVisitor& visitor);

 private:
  const std::vector<int>& set(std::string_view name) const { return motion_.model().set(name); }
  const GridpointSet& summed(std::string_view name) const { return summed_.find(name)->second; }
  double shortening(std::string_view top, std::string_view bottom) const;
  double widening(std::size_t direction) const;
  double rise_of_stand(std::size_t direction) const;
  std::array<double, 2> slopes_of_stand() const;
  std::array<double, 2> middle_across() const;
  const PlaneOfSymmetry* symmetry_across(std::size_t direction) const;
  struct Clearances {
    double below = 0.0, above = 0.0;
  };
  template <class Up>
  Clearances clearances(const Up& up) const;

  Motion& motion_;
  Specimen between_;
  std::vector<int> across_;                                  ///< components across the axis
  double bottom_ = 0.0;                                      ///< place of the lower end along the axis, m
  std::array<double, 2> middle_{};                           ///< see middle_across
  std::map<std::string, GridpointSet, std::less<>> summed_;  ///< sets that are read, in the order of sums

  /// All that lasts from one batch to the next.
  struct Kept {
    bool is_driven = true;                     ///< true while controlled by motion
    double stress_held = 0.0;                  ///< Pa
    double shortening_at_zero = 0.0;           ///< shortening of the distance of the platens, m
    double specimen_shortening_at_zero = 0.0;  ///< m
    std::array<double, 2> widening_at_zero{};  ///< m; in 2D the second is not used
    double stage_first_strain = 0.0;
  } kept_;
};

}  // namespace pyroclast
