#pragma once

#include <string>
#include <vector>

#include "pyroclast/base/error.hpp"

namespace pyroclast {

/// One thing that is wrong with a deck.
struct Diagnostic {
  std::string file = {};
  int line = 0;    ///< from 1; 0 if the error is the file's as a whole
  int column = 0;  ///< from 1, in characters
  bool is_changed =
      false;  ///< the value comes from the command line: place of the changed deck, none of the file
  std::string key =
      {};  ///< full path, such as "contacts.mortar_mortar.f_t" or "stages[0].rate"; may be empty
  std::string value = {};    ///< as written in the deck; may be empty
  std::string message = {};  ///< what is wrong and what is allowed
  std::string hint = {};     ///< what is probably meant; may be empty
  bool is_missing = false;   ///< a key or table that is needed and not there
  std::string meant = {};  ///< of an unknown key: full path of that which is most likely meant; may be empty
};

/// `file:line:column: key = value: message; hint`, without the parts that are empty.
std::string to_string(const Diagnostic& diagnostic);

/// What is missing comes last: a key that is unknown may be it.
std::vector<Diagnostic> in_file_order(std::vector<Diagnostic> diagnostics);

/// The same from the key on: it does not depend on where the deck stands.
std::string without_place(const Diagnostic& diagnostic);

/// Everything that is wrong with a deck. `what()` has one line per diagnostic, in the order of the file.
class DeckError : public Error {
 public:
  explicit DeckError(std::vector<Diagnostic> diagnostics);

  const std::vector<Diagnostic>& diagnostics() const { return diagnostics_; }

 private:
  std::vector<Diagnostic> diagnostics_;
};

}  // namespace pyroclast
