#pragma once

#include <stdexcept>

namespace pyroclast {

/// Error of the input or the environment, worded for the user: it names the thing, its value and what is
/// allowed. The application prints the error and exits with a non-zero status.
class Error : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

}  // namespace pyroclast
