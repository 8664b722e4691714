#pragma once

#include <filesystem>
#include <fstream>
#include <string>

namespace pyroclast {

/// Writes a whole file: all of it appears under its name, or none (see publish). Throws Error naming the
/// file.
void write_text_file(const std::filesystem::path& path, const std::string& text);

/// A text file that grows line by line, each line handed to the system before the next. Throws Error naming
/// the file when a line cannot be written.
class LineFile {
 public:
  /// \param text  with which it begins: in place of what stands there, whole or not at all
  LineFile(std::filesystem::path path, const std::string& text);
  void line(const std::string& text);

 private:
  std::filesystem::path path_;
  std::ofstream stream_;
};

}  // namespace pyroclast
