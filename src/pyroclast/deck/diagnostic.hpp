#pragma once

#include <string>
#include <vector>

#include "pyroclast/base/error.hpp"

namespace pyroclast {

/// One error of a deck, or one warning.
struct Diagnostic {
  std::string file = {};
  int line = 0;    ///< line, from 1; 0 if the error is the file's as a whole
  int column = 0;  ///< column, from 1, in characters
  bool is_changed =
      false;  ///< true for a value of the command line; its place is then in the changed deck, not the file
  std::string key =
      {};  ///< full path, such as "contacts.mortar_mortar.f_t" or "stages[0].rate"; may be empty
  std::string value = {};    ///< value as written in the deck; may be empty
  std::string message = {};  ///< text that says what is wrong and what is allowed
  std::string hint = {};     ///< text that says what is probably meant; may be empty
  bool is_missing = false;   ///< true for a key or table that is needed and not there
  std::string meant = {};    ///< full path of the key that an unknown key most likely means; may be empty
};

/// Returns `file:line:column: key = value: message; hint`, without the parts that are empty.
std::string to_string(const Diagnostic& diagnostic);

/// Sorts diagnostics by their place in the file. Missing keys come last: an unknown key may be one of them.
std::vector<Diagnostic> in_file_order(std::vector<Diagnostic> diagnostics);

/// Returns the text of `to_string` from the key on, which does not depend on the place of the deck.
std::string without_place(const Diagnostic& diagnostic);

/// Error that holds everything that is wrong with a deck. `what()` has one line for each diagnostic, in the
/// order of the file.
class DeckError : public Error {
 public:
  explicit DeckError(std::vector<Diagnostic> diagnostics);

  const std::vector<Diagnostic>& diagnostics() const { return diagnostics_; }

 private:
  std::vector<Diagnostic> diagnostics_;
};

}  // namespace pyroclast
