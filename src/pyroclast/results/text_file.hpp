#pragma once

#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

namespace pyroclast {

/// Returns the path of a file in a folder; empty where the folder is: then another rank writes the file.
inline std::filesystem::path file_in(const std::filesystem::path& folder, const std::filesystem::path& name) {
  return folder.empty() ? folder : folder / name;
}

/// Writes a whole file: all of it appears under its name, or none (see publish). Throws Error naming the
/// file. With an empty path it writes nothing.
void write_text_file(const std::filesystem::path& path, const std::string& text);

/// A file that is to be written, whole.
struct TextFile {
  std::filesystem::path path;
  std::string text;
};

/// Writes several files: where the disk does not take all texts, the files are as they were. Throws Error
/// naming the file.
void write_text_files(const std::vector<TextFile>& files);

/// Text file that grows line by line; each line is handed to the system before the next. Throws Error naming
/// the file when a line cannot be written.
class LineFile {
 public:
  /// \param path  empty: nothing is written
  /// \param text  first text of the file, which replaces an earlier file, whole or not at all
  LineFile(std::filesystem::path path, const std::string& text);
  void line(const std::string& text) { lines(text + '\n'); }
  /// Writes whole lines, each with its end.
  void lines(const std::string& text);

 private:
  std::filesystem::path path_;
  std::ofstream stream_;
};

}  // namespace pyroclast
