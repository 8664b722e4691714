#pragma once

#include "pyroclast/mechanics/body.hpp"

namespace pyroclast {

/// Makes the data of found contacts of a body whose parameters ask for them. Throws Error where its
/// kinematics or the laws of its interfaces do not allow it.
template <int Dim>
void make_found(Body<Dim>& body);

}  // namespace pyroclast
