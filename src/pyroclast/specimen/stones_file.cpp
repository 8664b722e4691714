#include "pyroclast/specimen/stones_file.hpp"

#include <algorithm>
#include <charconv>
#include <memory>
#include <string_view>
#include <utility>

#include <fmt/format.h>

#include "pyroclast/base/error.hpp"
#include "pyroclast/base/read_file.hpp"
#include "pyroclast/specimen/shell.hpp"
#include "pyroclast/specimen/stone.hpp"

namespace pyroclast::specimen {
namespace {

/// Reader of the lines of a file.
class ObjReader {
 public:
  ObjReader(const std::filesystem::path& file, double unit, const std::string& phase)
      : text_(read_file(file)), file_(file.string()), unit_(unit), phase_(phase), phase_here_(phase) {}

  std::vector<KnownStone<3>> stones() {
    for (std::string_view rest = text_; !rest.empty();) {
      ++line_;
      const std::size_t end = std::min(rest.find('\n'), rest.size());
      read(rest.substr(0, end));
      rest.remove_prefix(std::min(end + 1, rest.size()));
    }
    finish();
    if (stones_.empty()) throw Error(fmt::format("{}: it has no faces (lines f)", file_));
    return std::move(stones_);
  }

 private:
  [[noreturn]] void fail(int line, std::string_view what) const {
    throw Error(fmt::format("{}:{}: {}", file_, line, what));
  }

  static std::string_view next_word(std::string_view& line) {
    constexpr std::string_view kBlank = " \t\r";
    line.remove_prefix(std::min(line.find_first_not_of(kBlank), line.size()));
    const std::string_view word = line.substr(0, line.find_first_of(kBlank));
    line.remove_prefix(word.size());
    return word;
  }

  void read(std::string_view line) {
    const std::string_view kind = next_word(line);
    if (kind == "o") {
      finish();
      begin_ = line_;
      phase_here_ = phase_;
      is_smooth_ = false;
    } else if (kind == "usemtl") {
      phase_here_ = next_word(line);
    } else if (kind == "s") {
      const std::string_view group = next_word(line);
      is_smooth_ = group != "off" && group != "0";
    } else if (kind == "v") {
      Vec<3> at;
      for (double& x : at.c) x = unit_ * number<double>(next_word(line));
      vertices_.push_back(at);
    } else if (kind == "f") {
      std::vector<int> corners;
      for (std::string_view word = next_word(line); !word.empty(); word = next_word(line))
        corners.push_back(vertex(number<int>(word.substr(0, word.find('/')))));
      if (corners.size() < 3) fail(line_, "a face has three vertices or more");
      for (std::size_t i = 1; i + 1 < corners.size(); ++i)
        triangles_.push_back({corners[0], corners[i], corners[i + 1]});
    }
  }

  template <class T>
  T number(std::string_view word) const {
    T value{};
    const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
    if (error != std::errc() || end != word.data() + word.size())
      fail(line_, fmt::format("\"{}\" is not a number", word));
    return value;
  }

  int vertex(int number) const {
    const int count = static_cast<int>(vertices_.size());
    const int index = number < 0 ? count + number : number - 1;
    if (index < 0 || index >= count)
      fail(line_, fmt::format("there is no vertex {}: {} lines v stand before", number, count));
    return index;
  }

  /// Makes a stone of the triangles since the last object began.
  void finish() {
    if (triangles_.empty()) return;
    std::vector<int> number(vertices_.size(), -1);
    std::vector<Vec<3>> own;
    for (auto& triangle : triangles_)
      for (int& v : triangle) {
        if (number[v] < 0) {
          number[v] = static_cast<int>(own.size());
          own.push_back(vertices_[v]);
        }
        v = number[v];
      }
    try {
      const auto shell =
          std::make_shared<const Shell>(std::move(own), std::exchange(triangles_, {}), is_smooth_);
      stones_.push_back(
          {shell->given_centre(), shell->width(), phase_here_, fmt::format("{}:{}", file_, begin_), shell});
    } catch (const Error& error) {
      fail(begin_, error.what());
    }
  }

  std::string text_, file_;
  double unit_;
  std::string phase_, phase_here_;
  bool is_smooth_ = false;
  int line_ = 0, begin_ = 1;  ///< lines, from 1: the one that is read, and the one where the stone begins
  std::vector<Vec<3>> vertices_;
  std::vector<Shell::Triangle> triangles_;
  std::vector<KnownStone<3>> stones_;
};

}  // namespace

std::vector<KnownStone<3>> read_stones_obj(const std::filesystem::path& file, double unit,
                                           const std::string& phase) {
  return ObjReader(file, unit, phase).stones();
}

std::string stones_obj(std::span<const Stone<3>> stones, std::span<const std::string> phases) {
  std::string text = "# stones as they were placed, in m: an object each, of the phase that usemtl names\n";
  int first = 1;
  for (std::size_t i = 0; i < stones.size(); ++i) {
    const Stone<3>& stone = stones[i];
    const auto* shell = dynamic_cast<const Shell*>(stone.shape.get());
    const Shell ball = shell ? *shell : ball_of_shell(0.5 * stone.diameter);
    if (!shell) shell = &ball;
    text += fmt::format("o stone_{}\nusemtl {}\ns {}\n", i, phases[stone.phase], shell->is_smooth() ? 1 : 0);
    const std::vector<Vec<3>> vertices = shell->vertices();
    for (const Vec<3>& v : vertices) {
      const Vec<3> at = stone.centre + v;
      text += fmt::format("v {:.9g} {:.9g} {:.9g}\n", at[0], at[1], at[2]);
    }
    for (const auto& [a, b, c] : shell->triangles())
      text += fmt::format("f {} {} {}\n", first + a, first + b, first + c);
    first += static_cast<int>(vertices.size());
  }
  return text;
}

}  // namespace pyroclast::specimen
