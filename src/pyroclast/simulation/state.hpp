#pragma once

#include <cstdint>
#include <string_view>

namespace pyroclast {

/// Is shown every number that a moving thing keeps from one batch of steps to the next, under its name. It
/// may read or replace them.
class StateVisitor {
 public:
  virtual ~StateVisitor() = default;
  virtual void visit(std::string_view name, double& value) = 0;
  virtual void visit(std::string_view name, std::int64_t& value) = 0;
  virtual void visit(std::string_view name, bool& value) = 0;
};

}  // namespace pyroclast
