#include "pyroclast/deck/deck.hpp"

#include <algorithm>
#include <system_error>
#include <utility>

#include <fmt/format.h>

#include "pyroclast/base/read_file.hpp"
#include "pyroclast/deck/reading.hpp"

namespace pyroclast {
namespace {

std::string text_of(const std::filesystem::path& file) {
  const auto fail = [&](const std::string& message) {
    throw DeckError({Diagnostic{.file = file.string(), .message = message}});
  };
  std::error_code ignored;
  const std::filesystem::file_status status = std::filesystem::status(file, ignored);
  if (!std::filesystem::exists(status)) fail("no such file");
  if (std::filesystem::is_directory(status)) fail("is a directory; a deck is a TOML file");
  try {
    return read_named_file(file);
  } catch (const Error&) {
    fail("cannot be read");
  }
  return {};
}

/// Returns the text with a ? for each byte that is no printable character of ASCII.
std::string printable(std::string text) {
  for (char& c : text)
    if (c < ' ' || c > '~') c = '?';
  return text;
}

std::string trimmed(const std::string& text) {
  const auto first = text.find_first_not_of(' ');
  return first == std::string::npos ? "" : text.substr(first, text.find_last_not_of(' ') - first + 1);
}

/// Returns a deck with one more of its values changed, as `--set` has it.
/// \param changed  keys whose values are changed already; the key of this change is added
std::unique_ptr<DeckReading> with_change(const DeckReading& deck, const std::string& change,
                                         std::vector<std::string>& changed) {
  const auto equals = change.find('=');
  if (equals == std::string::npos)
    throw Error("--set " + change + ": write it as key=value, e.g. specimen.seed=2");
  changed.push_back(trimmed(change.substr(0, equals)));
  std::string text = deck.with_value(changed.back(), trimmed(change.substr(equals + 1)));
  try {
    return std::make_unique<DeckReading>(std::move(text), deck.from(), changed);
  } catch (const DeckError& error) {
    throw Error(fmt::format("--set {}: {}", printable(change), error.diagnostics().front().message));
  }
}

}  // namespace

Deck Deck::open(const std::filesystem::path& file, const std::vector<std::string>& changes,
                const Appendix& more) {
  return parse(text_of(file), file.string(), changes, more);
}

Deck Deck::parse(std::string text, std::string name, const std::vector<std::string>& changes,
                 const Appendix& more) {
  DeckSource from{.name = std::move(name)};
  if (!more.text.empty()) {
    from.appended_name = more.name;
    from.appended_lines = 1 + static_cast<int>(std::ranges::count(more.text, '\n'));
    text += "\n" + more.text;
  }
  std::vector<std::string> changed;
  auto reading = std::make_unique<DeckReading>(std::move(text), std::move(from));
  for (const std::string& change : changes) reading = with_change(*reading, change, changed);
  return Deck(std::move(reading));
}

Deck::Deck(std::unique_ptr<DeckReading> reading) : reading_(std::move(reading)) {}
Deck::Deck(Deck&&) noexcept = default;
Deck& Deck::operator=(Deck&&) noexcept = default;
Deck::~Deck() = default;

const std::string& Deck::name() const {
  return reading_->name();
}
const std::string& Deck::text() const {
  return reading_->text();
}
const std::vector<DeckFile>& Deck::files() const {
  return reading_->files();
}
std::string Deck::with(const std::vector<std::pair<std::string, std::string>>& values) const {
  std::string changed = text();
  for (const auto& [key, value] : values)
    changed = DeckReading(std::move(changed), DeckSource{name()}).with_value(key, value);
  return changed;
}
Section Deck::root() const {
  return {*reading_, &reading_->root()};
}

std::vector<Diagnostic> Deck::warnings() const {
  return in_file_order(reading_->warnings());
}

void Deck::finish_early() const {
  if (!reading_->reported().empty()) throw DeckError(reading_->reported());
}

void Deck::finish() const {
  reading_->root();  // so that a deck of which nothing was read is not taken for a good one
  std::vector<Diagnostic> diagnostics = reading_->diagnostics();
  if (!diagnostics.empty()) throw DeckError(std::move(diagnostics));
}

}  // namespace pyroclast
