#include "pyroclast/base/utf8.hpp"

namespace pyroclast {

std::size_t utf8_length(std::string_view text) {
  const auto in = [&](std::size_t i, unsigned char least, unsigned char greatest) {
    return i < text.size() && least <= static_cast<unsigned char>(text[i]) &&
           static_cast<unsigned char>(text[i]) <= greatest;
  };
  const auto continues = [&](std::size_t i) { return in(i, 0x80, 0xBF); };
  if (in(0, 0x00, 0x7F)) return 1;
  if (in(0, 0xC2, 0xDF)) return continues(1) ? 2 : 0;
  if (in(0, 0xE0, 0xEF)) {
    const unsigned char least = in(0, 0xE0, 0xE0) ? 0xA0 : 0x80;     // no longer than needed
    const unsigned char greatest = in(0, 0xED, 0xED) ? 0x9F : 0xBF;  // no surrogates
    return in(1, least, greatest) && continues(2) ? 3 : 0;
  }
  if (in(0, 0xF0, 0xF4)) {
    const unsigned char least = in(0, 0xF0, 0xF0) ? 0x90 : 0x80;
    const unsigned char greatest = in(0, 0xF4, 0xF4) ? 0x8F : 0xBF;  // up to U+10FFFF
    return in(1, least, greatest) && continues(2) && continues(3) ? 4 : 0;
  }
  return 0;
}

}  // namespace pyroclast
