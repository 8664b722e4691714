#pragma once

#include <string>

namespace pyroclast {

/// Returns the SHA-256 of a text in hexadecimal, as `sha256sum` prints it.
std::string sha256(const std::string& text);

}  // namespace pyroclast
