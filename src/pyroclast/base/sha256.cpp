#include "pyroclast/base/sha256.hpp"

#include <sys/types.h>
// libmd's header needs sys/types.h before it
#include <array>
#include <cstdint>

#include <sha256.h>

namespace pyroclast {

std::string sha256(const std::string& text) {
  std::array<char, SHA256_DIGEST_STRING_LENGTH> digest{};
  SHA256Data(reinterpret_cast<const std::uint8_t*>(text.data()), text.size(), digest.data());
  return digest.data();
}

}  // namespace pyroclast
