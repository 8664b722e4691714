#include "pyroclast/app/run_log.hpp"

#include <chrono>
#include <ctime>
#include <system_error>
#include <utility>
#include <vector>

#include <fmt/chrono.h>
#include <fmt/format.h>
#include <spdlog/sinks/basic_file_sink.h>
#include <spdlog/sinks/stdout_sinks.h>

#include "pyroclast/base/shown.hpp"

namespace pyroclast::app {

namespace {

/// Level of lines about the moment, below all others.
constexpr auto kProgress = spdlog::level::debug;

}  // namespace

RunLog::RunLog(std::filesystem::path file, Speech speech, std::uint64_t kept)
    : file_(std::move(file)), speech_(speech) {
  std::error_code none;
  if (std::filesystem::exists(file_) && std::filesystem::file_size(file_) > kept)
    std::filesystem::resize_file(file_, kept, none);
  std::vector<spdlog::sink_ptr> sinks;
  if (!file_.empty()) sinks.push_back(std::make_shared<spdlog::sinks::basic_file_sink_st>(file_.string()));
  if (speech != Speech::quiet) sinks.push_back(screen_ = std::make_shared<spdlog::sinks::stdout_sink_st>());
  logger_ = std::make_unique<spdlog::logger>("run", sinks.begin(), sinks.end());
  logger_->set_pattern("%v");
  logger_->set_level(kProgress);
  logger_->flush_on(kProgress);
  // the terminal may be gone, or the disk full: what a run says is not worth its end
  logger_->set_error_handler([](const std::string&) {});
}

void RunLog::say(const std::string& text) {
  logger_->info("{}", shown(text, true));
}

void RunLog::say_now(const std::string& text) {
  logger_->log(kProgress, "{:%H:%M:%S} {}", fmt::localtime(std::time(nullptr)), shown(text));
}

void RunLog::note(const std::string& text) {
  const auto level = screen_ ? screen_->level() : spdlog::level::off;
  if (screen_) screen_->set_level(spdlog::level::off);
  say(text);
  if (screen_) screen_->set_level(level);
}

void RunLog::keep_progress_off_screen(bool kept) {
  if (screen_) screen_->set_level(kept ? spdlog::level::info : kProgress);
}

std::uint64_t RunLog::bytes() const {
  std::error_code none;
  const auto size = std::filesystem::file_size(file_, none);
  return none ? 0 : size;
}

}  // namespace pyroclast::app
