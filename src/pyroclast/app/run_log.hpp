#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>

#include <spdlog/common.h>
#include <spdlog/logger.h>

#include "pyroclast/app/commands.hpp"

namespace pyroclast::app {

/// Messages of a run: on the screen, and in `run.log` of its folder.
class RunLog {
 public:
  /// \param kept  number of bytes to keep of a log that is there
  RunLog(std::filesystem::path file, Speech speech, std::uint64_t kept = 0);

  Speech speech() const { return speech_; }

  /// Writes a text of one or more lines, without the last line's end.
  void say(const std::string& text);
  /// Writes a line with the time of day before it.
  void say_now(const std::string& text);
  /// Writes a text to the file alone.
  void note(const std::string& text);
  /// Sets whether lines with the time of day go to the file alone.
  void keep_progress_off_screen(bool kept);
  /// Returns the length of the file in bytes.
  std::uint64_t bytes() const;

 private:
  std::filesystem::path file_;
  Speech speech_;
  spdlog::sink_ptr screen_;  ///< sink of the screen; none where nothing is printed
  std::unique_ptr<spdlog::logger> logger_;
};

}  // namespace pyroclast::app
