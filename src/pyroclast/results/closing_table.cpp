#include "pyroclast/results/closing_table.hpp"

#include <bit>

#include <xxhash.h>

namespace pyroclast {

static_assert(std::endian::native == std::endian::little, "files hold numbers little end first");

namespace {

/// Last bytes of a file.
struct Trailer {
  std::uint64_t begin = 0, size = 0, hash = 0;
  ClosingTable::Mark mark{};
};

}  // namespace

std::string ClosingTable::bytes(std::uint64_t begin, std::string text, const Mark& mark) {
  const Trailer trailer{begin, text.size(), XXH3_64bits(text.data(), text.size()), mark};
  return text.append(reinterpret_cast<const char*>(&trailer), sizeof(trailer));
}

ClosingTable ClosingTable::read(const File& file, const Mark& mark,
                                const std::function<void(const std::string& what)>& fail) {
  const std::uint64_t size = file.size();
  Trailer trailer;
  if (size < sizeof(trailer) || !file.read(size - sizeof(trailer), &trailer, sizeof(trailer)) ||
      trailer.mark != mark || trailer.size > size || trailer.begin > size ||
      trailer.begin + trailer.size + sizeof(trailer) != size)
    fail("is cut short, or damaged at its end");
  ClosingTable table{trailer.begin, std::string(trailer.size, '\0'), trailer.hash};
  if (!file.read(table.begin, table.text.data(), table.text.size()) ||
      XXH3_64bits(table.text.data(), table.text.size()) != table.hash)
    fail("is damaged: its table has another hash");
  return table;
}

ClosingTable::Mark ClosingTable::mark_of(const File& file) {
  Mark mark{};
  if (const std::uint64_t size = file.size();
      size < mark.size() || !file.read(size - mark.size(), &mark, mark.size()))
    return {};
  return mark;
}

}  // namespace pyroclast
