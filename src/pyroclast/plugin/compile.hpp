#pragma once

#include <filesystem>
#include <functional>
#include <string>

#include "pyroclast/mechanics/instruction_set.hpp"
#include "pyroclast/plugin/law_text.hpp"

namespace pyroclast {

/// Compiler that makes a law's header into a shared object.
struct LawCompiler {
  std::string program = "c++";  ///< the system's compiler
  /// Folder of the shared objects that were compiled before; only its owner may read and write it.
  std::filesystem::path cache;
  /// Instruction set for which the packs are compiled.
  InstructionSet instructions = best_instruction_set();
  int dimension = 2;  ///< dimension of the bodies for which the law is compiled
  /// Function that is shown the command before the command runs.
  std::function<void(const std::string& command)> tell = [](const std::string&) {};
  /// Function that is called many times a second while the compiler runs; an exception from it ends the
  /// compiler.
  std::function<void()> poll = [] {};
};

/// Returns the type of the law in a preprocessed text, such as "mine::Law": the struct that holds `static
/// constexpr const char* name`. Throws Error when there is none, or more than one.
/// \param file  header of the text, for messages
std::string law_type(const std::filesystem::path& file, const std::string& text);

/// Returns the text that the preprocessor makes of a law's header; no precompiled header is read. Throws
/// Error with the compiler's words where the preprocessor refuses the header.
LawText preprocess_law(const std::filesystem::path& header, const LawCompiler& compiler);

/// Returns the shared object of a law, from the cache where the same law was compiled before: the same text,
/// wherever the header lies, compiler, flags and layout. Throws Error with the compiler's words where the law
/// does not compile, and where the assembler reads a file, which no hash covers.
///
/// \param type  type of the law, as C++ names it
std::filesystem::path compile_law(const LawText& law, const std::string& type, const LawCompiler& compiler);

}  // namespace pyroclast
