#include "pyroclast/stages/registry.hpp"

#include <algorithm>
#include <utility>

#include <fmt/format.h>

#include "pyroclast/base/error.hpp"
#include "pyroclast/stages/compress.hpp"
#include "pyroclast/stages/conduct.hpp"
#include "pyroclast/stages/drive.hpp"
#include "pyroclast/stages/expose.hpp"
#include "pyroclast/stages/heat.hpp"
#include "pyroclast/stages/load.hpp"
#include "pyroclast/stages/settle.hpp"

namespace pyroclast {

StageRegistry::StageRegistry() {
  for (StageKind (*kind)() :
       {settle_kind, load_kind, compress_kind, drive_kind, heat_kind, expose_kind, conduct_kind})
    add(kind());
}

void StageRegistry::add(StageKind kind) {
  if (std::ranges::any_of(kinds_, [&](const StageKind& other) { return other.name == kind.name; }))
    throw Error(fmt::format("there is a kind of stage \"{}\" already", kind.name));
  kinds_.push_back(std::move(kind));
}

}  // namespace pyroclast
