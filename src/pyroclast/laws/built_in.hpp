#pragma once

#include "pyroclast/laws/cohesive.hpp"
#include "pyroclast/laws/elastic.hpp"
#include "pyroclast/laws/frictional.hpp"
#include "pyroclast/laws/mixed_mode.hpp"
#include "pyroclast/laws/remembers.hpp"

namespace pyroclast {

template <class... Laws>
struct LawList {
  static constexpr int count = sizeof...(Laws);
};

/// Laws that are part of the program, one line for each.
using BuiltInLaws = LawList<Cohesive,    //
                            Elastic,     //
                            Frictional,  //
                            MixedMode,   //
                            CohesiveWithMemory, MixedModeWithMemory>;

}  // namespace pyroclast
