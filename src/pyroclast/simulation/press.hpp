#pragma once

#include <array>
#include <functional>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "pyroclast/base/state_visitor.hpp"
#include "pyroclast/mechanics/mechanics.hpp"

namespace pyroclast {

/// A press with a fixed lower and a movable upper platen, and the specimen between them.
///
/// It holds, drives and watches named sets of the model's gridpoints (Model::sets): `bottom_platen_support`
/// and `top_platen_support`, the outer faces of the platens; `bottom_platen_face` and `top_platen_face`,
/// their inner faces; `bottom`, `top`, `left`, `right` and in 3D `front`, `back`, the sides of the specimen;
/// `specimen`, `bottom_platen` and `top_platen`, all gridpoints of those.
///
/// Stress and strain are positive in compression, lateral strain in expansion.
template <int Dim>
class Press {
 public:
  /// Motion of the whole specimen that leaves its contacts their jumps.
  struct EvenMotion {
    double axial = 0.0, lateral = 0.0;  ///< strains, expansion positive; the lower end stays where it is
    double lift = 0.0;                  ///< of the specimen as a whole along the axis, m
    double tilt = 0.0;                  ///< 2D only: rise of the specimen over its width
    double platen_lift = 0.0;           ///< of the upper platen beside the end that it lies on, m
  };

  /// Holds the lower platen, and the upper one across the axis.
  /// \param mechanics  kept by reference; must outlive this
  /// \param axis       along which the platens stand: the component of a position
  /// \param height     of the specimen along the axis, m
  /// \param widths     across the axis, in the order of the other components, m
  Press(Mechanics<Dim>& mechanics, int axis, double height, const std::array<double, Dim - 1>& widths);

  // What the upper platen does.

  /// Lets it lie on the specimen, and tilt.
  void let_go();
  /// Moves it by its force only, without tilting. Where it was controlled by motion, it keeps the force that
  /// it bore.
  void control_by_force();
  /// Moves it down at a velocity, m/s; the force on it ends.
  void control_by_motion(double velocity);
  /// Another velocity while it is controlled by motion, m/s downwards.
  void move_platen(double velocity);
  /// The force on it over the area of the specimen, Pa, from the next step on.
  void hold(double stress);
  double stress_held() const { return kept_.stress_held; }

  // Readings at the displacements and forces of the last step.

  /// Takes the present length and width for those from which strains count.
  void set_zero();
  /// Takes the present strain for that from which the strain of a stage counts.
  void begin_stage();
  /// Approach of the platens' inner faces since the zero over the height.
  double strain() const;
  /// The same since `begin_stage`.
  double stage_strain() const { return strain() - kept_.stage_first_strain; }
  /// Approach of the specimen's own ends since the zero over the height.
  double specimen_strain() const;
  /// Mean widening since the zero over the width, mean of all directions across the axis.
  double lateral_strain() const;
  /// Reaction of the upper platen over the area, Pa.
  double stress_top() const;
  double stress_bottom() const;
  double stress() const { return 0.5 * (stress_top() + stress_bottom()); }
  /// Whether the lower platen carries what rests on it, but for a fifth: the specimen's weight and the force
  /// held. True where that is nothing.
  bool is_supported() const;
  /// What the upper platen can sink until both platens touch the specimen, m. Ends that are rough are
  /// touched where they stand out most.
  double gap() const;
  double height() const { return height_; }
  double volume() const;  ///< of the specimen, m³
  /// Sets the specimen down on the lower platen, in 2D so that it stands on two points on either side of its
  /// middle, and the upper platen on the specimen.
  EvenMotion to_touch() const;
  /// The largest way that a gridpoint of the specimen makes in a motion without strain, m.
  double way(const EvenMotion& motion) const;
  const GridpointSet& specimen() const { return summed("specimen"); }

  // Even motion

  /// Moves the whole specimen evenly in the next step, and halts it there in the step after one with `speed`
  /// 0.
  /// \param speed           share of the motion to come in one step
  /// \param platen_follows  the upper platen moves with the end it lies on
  void move_evenly(const EvenMotion& motion, double speed, bool platen_follows);
  /// Lets the specimen move freely again.
  void end_even_motion(bool platen_follows);

  void visit_state(StateVisitor& visitor);

 private:
  const std::vector<int>& set(std::string_view name) const { return mechanics_.model().set(name); }
  const GridpointSet& summed(std::string_view name) const { return summed_.find(name)->second; }
  double shortening(std::string_view top, std::string_view bottom) const;
  double widening(int direction) const;
  double area() const;
  double rise_of_stand() const;
  struct Clearances {
    double below = 0.0, above = 0.0;
  };
  template <class Up>
  Clearances clearances(const Up& up) const;

  Mechanics<Dim>& mechanics_;
  int axis_;
  double height_;
  std::array<double, Dim - 1> widths_;
  std::array<int, Dim - 1> across_;                          ///< components across the axis
  std::map<std::string, GridpointSet, std::less<>> summed_;  ///< sets that are read, in the order of sums

  /// All that lasts from one batch to the next.
  struct Kept {
    bool is_driven = true;                           ///< controlled by motion
    double stress_held = 0.0;                        ///< Pa
    double shortening_at_zero = 0.0;                 ///< of the distance of the platens, m
    double specimen_shortening_at_zero = 0.0;        ///< m
    std::array<double, Dim - 1> widening_at_zero{};  ///< m
    double stage_first_strain = 0.0;
  } kept_;
};

extern template class Press<2>;
extern template class Press<3>;

}  // namespace pyroclast
