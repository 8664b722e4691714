#pragma once

#include <array>
#include <cmath>

#include "pyroclast/base/vec.hpp"
#include "pyroclast/laws/law.hpp"

/// Frames of faces that turn with finite kinematics, and the forces of their turn.
///
/// A face has a gradient A, a column for each tangent: a sum over the gridpoints of both sides of their
/// places times constant weights, whose sum is 0. In 2D that is the mean edge of the two sides; in 3D it is
/// the gradient of least squares of their mean places by the first places along the face. The tangents are A
/// (A^T A)^(-1/2), the columns nearest to those of A that are orthonormal. So a rigid turn turns the frame
/// alike, and the frame follows both sides, and every corner, without a choice.
namespace pyroclast {

/// Directions of a contact.
template <int Dim, class Real = double>
struct ContactFrame {
  Vec<Dim, Real> normal;                         ///< unit normal, from a to b
  std::array<Vec<Dim, Real>, Dim - 1> tangents;  ///< unit tangents
};

/// Work of the tractions of a face as its frame turns, for each turn by one, J.
template <int Dim, class Real>
struct WorkOfTurn {
  Tangential<Dim, Real> tilt{};  ///< as the normal turns towards a tangent
  Real spin = 0.0;               ///< as the first tangent turns towards the second; 3D only

  /// Adds a point.
  /// \param normal, shear  its force in the frame, N
  void add(const Real& normal, const Tangential<Dim, Real>& shear, const Real& opening,
           const Tangential<Dim, Real>& jump) {
    for (int t = 0; t + 1 < Dim; ++t) tilt[t] += shear[t] * opening - normal * jump[t];
    if constexpr (Dim == 3) spin += shear[1] * jump[0] - shear[0] * jump[1];
  }
};

template <int Dim, class Real = double>
class TurningFrame : public ContactFrame<Dim, Real> {
 public:
  using Columns = std::array<Vec<Dim, Real>, Dim - 1>;

  /// \param gradient  A
  explicit TurningFrame(const Columns& gradient) {
    using std::sqrt;
    if constexpr (Dim == 2) {
      length_ = norm(gradient[0]);
      const Vec<2, Real> t = gradient[0] * (1.0 / length_);
      this->tangents = {t};
      this->normal = {{t[1], -t[0]}};
    } else {
      const auto& [first, second] = gradient;
      const Real c11 = dot(first, first), c12 = dot(first, second), c22 = dot(second, second);
      const Real determinant = sqrt(c11 * c22 - c12 * c12);
      const Real over = 1.0 / sqrt(c11 + c22 + 2.0 * determinant);
      u11_ = (c11 + determinant) * over;
      u12_ = c12 * over;
      u22_ = (c22 + determinant) * over;
      over_determinant_ = 1.0 / determinant;
      this->tangents = {(first * u22_ - second * u12_) * over_determinant_,
                        (second * u11_ - first * u12_) * over_determinant_};
      this->normal = cross(this->tangents[0], this->tangents[1]);
    }
  }

  /// Returns minus the derivative of the energy of the face's points by A, as far as it comes from the turn
  /// of the frame. Times the weights of a gridpoint it is a force on it, N: so all forces of a face are minus
  /// the gradient of its energy, and neither their sum nor their moment is more than round-off.
  Columns minus_derivative(const WorkOfTurn<Dim, Real>& work) const {
    if constexpr (Dim == 2) {
      return {this->normal * -(work.tilt[0] / length_)};
    } else {
      const Real along_first = (u22_ * work.tilt[0] - u12_ * work.tilt[1]) * over_determinant_;
      const Real along_second = (u11_ * work.tilt[1] - u12_ * work.tilt[0]) * over_determinant_;
      const Real spin = work.spin / (u11_ + u22_);
      return {this->tangents[1] * spin - this->normal * along_first,
              -(this->tangents[0] * spin) - this->normal * along_second};
    }
  }

 private:
  Real length_ = 0.0;                       ///< of the mean edge, m; 2D
  Real u11_ = 0.0, u12_ = 0.0, u22_ = 0.0;  ///< (A^T A)^(1/2); 3D
  Real over_determinant_ = 0.0;             ///< one over its determinant; 3D
};

}  // namespace pyroclast
