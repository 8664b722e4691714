#pragma once

#include <functional>
#include <string>

#include <gtest/gtest.h>

#include "pyroclast/base/error.hpp"

namespace pyroclast {

/// Of the Error that an action throws.
inline std::string message(const std::function<void()>& action) {
  try {
    action();
  } catch (const Error& error) {
    return error.what();
  }
  return "no Error was thrown";
}

inline void expect_in(const std::string& part, const std::string& text) {
  EXPECT_NE(text.find(part), std::string::npos) << text;
}

inline void expect_out(const std::string& part, const std::string& text) {
  EXPECT_EQ(text.find(part), std::string::npos) << text;
}

}  // namespace pyroclast
