#include "pyroclast/deck/deck.hpp"

#include <fstream>
#include <iterator>
#include <system_error>
#include <utility>

#include "pyroclast/deck/record.hpp"

namespace pyroclast {
namespace {

std::string read_file(const std::filesystem::path& file) {
  const auto fail = [&](const std::string& message) {
    throw DeckError({Diagnostic{.file = file.string(), .message = message}});
  };
  std::error_code ignored;
  const std::filesystem::file_status status = std::filesystem::status(file, ignored);
  if (!std::filesystem::exists(status)) fail("no such file");
  if (std::filesystem::is_directory(status)) fail("is a directory; a deck is a TOML file");
  std::ifstream stream(file, std::ios::binary);
  std::string text{std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>()};
  if (!stream) fail("cannot be read");
  return text;
}

}  // namespace

Deck Deck::load(const std::filesystem::path& file) {
  return parse(read_file(file), file.string());
}

Deck Deck::parse(std::string text, std::string name) {
  return Deck(std::make_unique<DeckRecord>(std::move(text), std::move(name)));
}

Deck::Deck(std::unique_ptr<DeckRecord> record) : record_(std::move(record)) {}
Deck::Deck(Deck&&) noexcept = default;
Deck& Deck::operator=(Deck&&) noexcept = default;
Deck::~Deck() = default;

const std::string& Deck::name() const {
  return record_->name();
}
const std::string& Deck::text() const {
  return record_->text();
}
Section Deck::root() const {
  return {*record_, &record_->root()};
}

void Deck::finish() const {
  record_->root();  // so that a deck of which nothing was read is not taken for a good one
  std::vector<Diagnostic> diagnostics = record_->diagnostics();
  if (!diagnostics.empty()) throw DeckError(std::move(diagnostics));
}

}  // namespace pyroclast
