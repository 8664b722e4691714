#include "pyroclast/specimen/neper_tess.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <fstream>
#include <functional>
#include <iterator>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "pyroclast/base/error.hpp"
#include "pyroclast/base/read_file.hpp"
#include "pyroclast/specimen/from_cells.hpp"
#include "pyroclast/specimen/polygon.hpp"
#include "pyroclast/specimen/region.hpp"
#include "pyroclast/specimen/topology.hpp"

namespace pyroclast::specimen {
namespace {

/// The words of a .tess file, which may be broken into lines at will, with the line each stands on.
class Words {
 public:
  Words(std::istream& stream, std::string name)
      : name_(std::move(name)), text_(std::istreambuf_iterator<char>(stream), {}) {
    constexpr std::string_view kByteOrderMark = "\xEF\xBB\xBF";
    if (text_.starts_with(kByteOrderMark)) at_ = kByteOrderMark.size();
  }

  /// The next word without taking it; empty at the end of the file.
  std::string_view peek() {
    while (at_ < text_.size() && is_space(text_[at_])) line_ += text_[at_++] == '\n' ? 1 : 0;
    std::size_t end = at_;
    while (end < text_.size() && !is_space(text_[end])) ++end;
    return std::string_view(text_).substr(at_, end - at_);
  }

  std::string_view next() {
    const std::string_view word = peek();
    at_ += word.size();
    return word;
  }

  void expect(std::string_view keyword) {
    const std::string_view word = next();
    if (word != keyword) fail(word, fmt::format("'{}'", keyword));
  }

  double number(std::string_view what) { return parse<double>(what); }
  int integer(std::string_view what) { return parse<int>(what); }

  /// A whole number of things, at least `least`. More than the file has characters is a slip, not a request
  /// for memory.
  int count(std::string_view what, int least) {
    const int value = integer(what);
    if (value < least || static_cast<std::size_t>(value) > text_.size()) {
      fail(std::to_string(value),
           fmt::format("{}, at least {} and no more than the file can hold", what, least));
    }
    return value;
  }

  /// The identifier of the item at this place; items count from 1 without gaps.
  void identifier(std::string_view what, int expected) {
    const int value = integer(fmt::format("the identifier of {} {}", what, expected));
    if (value != expected)
      fail(std::to_string(value), fmt::format("the identifier {} of a {}", expected, what));
  }

  /// Goes on to the next keyword of a section (two asterisks) or of the end (three).
  void skip_to_section() {
    while (!peek().empty() && !peek().starts_with("**")) next();
  }

  [[noreturn]] void fail(std::string_view found, std::string_view expected) const {
    throw Error(fmt::format("{}, line {}: expected {}, found {}.", name_, line_, expected,
                            found.empty() ? std::string("the end of the file") : fmt::format("'{}'", found)));
  }

 private:
  static bool is_space(char c) { return c == ' ' || (c >= '\t' && c <= '\r'); }

  template <class T>
  T parse(std::string_view what) {
    const std::string_view word = next();
    T value{};
    const auto [end, status] = std::from_chars(word.data(), word.data() + word.size(), value);
    if (word.empty() || status != std::errc() || end != word.data() + word.size()) fail(word, what);
    if constexpr (std::is_floating_point_v<T>) {
      if (!std::isfinite(value)) fail(word, fmt::format("{}, a finite number", what));
    }
    return value;
  }

  std::string name_;
  std::string text_;
  std::size_t at_ = 0;
  int line_ = 1;
};

/// Bounding box of the domain, in the file's unit of length.
struct Bounds {
  Vec<2> lower, upper;
};

/// What we take from a file, in its own unit of length.
struct File {
  std::optional<int> cell_count;
  std::vector<Vec<2>> vertices;
  std::vector<std::vector<int>> faces;
  std::optional<Bounds> domain;
};

Vec<2> read_point(Words& words, std::string_view what) {
  Vec<2> point;
  for (int i = 0; i < 2; ++i) point[i] = words.number(fmt::format("a coordinate of {}", what));
  words.number(fmt::format("the z coordinate of {}", what));
  return point;
}

void read_format(Words& words) {
  const std::string_view version = words.next();
  if (!version.starts_with("2.") && !version.starts_with("3."))
    words.fail(version, "a format version 2.x or 3.x");
}

void read_general(Words& words) {
  const int dimension = words.integer("the dimension");
  if (dimension != 2) words.fail(std::to_string(dimension), "the dimension 2 (made by neper -T -dim 2)");
  const std::string_view type = words.next();
  if (type != "standard") words.fail(type, "the type 'standard'");
}

std::vector<Vec<2>> read_vertices(Words& words) {
  std::vector<Vec<2>> vertices;
  const int count = words.count("the number of vertices", 3);
  for (int i = 1; i <= count; ++i) {
    words.identifier("vertex", i);
    vertices.push_back(read_point(words, "a vertex"));
    words.integer("the state of a vertex");
  }
  return vertices;
}

std::vector<int> read_face(Words& words, int vertex_count) {
  std::vector<int> face;
  const int corner_count = words.count("the number of vertices of a face", 3);
  for (int i = 0; i < corner_count; ++i) {
    const int vertex = words.integer("a vertex of a face");
    if (vertex < 1 || vertex > vertex_count) {
      words.fail(std::to_string(vertex), fmt::format("a vertex of a face, 1 to {}", vertex_count));
    }
    // An edge that Neper's regularisation has deleted leaves the same vertex twice in a row.
    if (face.empty() || face.back() != vertex - 1) face.push_back(vertex - 1);
  }
  while (face.size() > 1 && face.front() == face.back()) face.pop_back();
  if (face.size() < 3)
    words.fail(fmt::format("{} different ones", face.size()), "at least three vertices of a face");

  const int edge_count = words.count("the number of edges of a face", 3);
  for (int i = 0; i < edge_count; ++i) words.integer("an edge of a face");
  for (int i = 0; i < 4; ++i) words.number("a parameter of the plane of a face");
  words.integer("the state of a face");
  words.integer("the point of a face");
  for (int i = 0; i < 3; ++i) words.number("a coordinate of the point of a face");
  return face;
}

std::vector<std::vector<int>> read_faces(Words& words, int vertex_count) {
  if (vertex_count == 0) words.fail("**face", "**vertex before it");
  std::vector<std::vector<int>> faces;
  const int count = words.count("the number of faces", 1);
  for (int i = 1; i <= count; ++i) {
    words.identifier("face", i);
    faces.push_back(read_face(words, vertex_count));
  }
  return faces;
}

/// \param is_rectangle  it must be an upright one
Bounds read_domain(Words& words, bool is_rectangle) {
  words.expect("*general");
  words.next();  // The type says "cube" for a rectangle as well; the corners tell.
  words.expect("*vertex");
  const int count = words.count("the number of domain vertices", 3);
  if (is_rectangle && count != 4)
    words.fail(std::to_string(count), "4 domain vertices, those of a rectangle");
  std::vector<Vec<2>> points;
  for (int i = 1; i <= count; ++i) {
    words.identifier("domain vertex", i);
    points.push_back(read_point(words, "a domain vertex"));
    words.next();  // label
    const int listed = words.count("the number of tessellation vertices of a domain vertex", 0);
    for (int j = 0; j < listed; ++j) words.integer("a tessellation vertex of a domain vertex");
  }
  Bounds box{points[0], points[0]};
  for (const Vec<2>& p : points) {
    for (int i = 0; i < 2; ++i) {
      box.lower[i] = std::min(box.lower[i], p[i]);
      box.upper[i] = std::max(box.upper[i], p[i]);
    }
  }
  if (!is_rectangle) return box;
  const Vec<2> size = box.upper - box.lower;
  const double slack = 1e-6 * std::max(size[0], size[1]);
  int found = 0;  // one bit per corner of the box
  for (const Vec<2>& p : points) {
    int corner = 0;
    for (int i = 0; i < 2; ++i) {
      if (std::abs(p[i] - box.upper[i]) <= slack) {
        corner |= 1 << i;
      } else if (std::abs(p[i] - box.lower[i]) > slack) {
        words.fail("a vertex off its corners", "a domain that is an upright rectangle");
      }
    }
    found |= 1 << corner;
  }
  if (found != 0b1111) words.fail("fewer than four corners", "a domain that is an upright rectangle");
  return box;
}

File read(Words& words, bool is_rectangle) {
  File file;
  std::set<std::string, std::less<>> seen;
  words.expect("***tess");
  while (words.peek() != "***end") {
    const std::string_view section = words.next();
    if (!section.starts_with("**") || section.starts_with("***"))
      words.fail(section, "a section '**...' or '***end'");
    if (!seen.emplace(section).second) words.fail(section, fmt::format("one section '{}' alone", section));
    if (section == "**format") read_format(words);
    if (section == "**general") read_general(words);
    if (section == "**cell") file.cell_count = words.count("the number of cells", 1);
    if (section == "**vertex") file.vertices = read_vertices(words);
    if (section == "**face") file.faces = read_faces(words, static_cast<int>(file.vertices.size()));
    if (section == "**domain") file.domain = read_domain(words, is_rectangle);
    words.skip_to_section();
  }
  if (!file.cell_count) words.fail("***end", "a section '**cell' before it");
  if (file.faces.empty()) words.fail("***end", "a section '**face' before it");
  if (!file.domain) words.fail("***end", "a section '**domain' before it");
  if (static_cast<std::size_t>(*file.cell_count) != file.faces.size()) {
    words.fail(fmt::format("{} cells and {} faces", *file.cell_count, file.faces.size()),
               "as many faces as cells");
  }
  return file;
}

/// Puts a point of the file into [0, width] x [0, height], exactly onto a side when it is nearly there.
Vec<2> scaled(const Vec<2>& point, const Bounds& domain, const Vec<2>& size) {
  // Twelve decimals are written; a domain of 1e-3 in the file's unit still resolves this.
  constexpr double snap = 1e-9;
  Vec<2> result;
  for (int i = 0; i < 2; ++i) {
    const double share = (point[i] - domain.lower[i]) / (domain.upper[i] - domain.lower[i]);
    result[i] = std::abs(share) < snap ? 0.0 : std::abs(share - 1.0) < snap ? size[i] : share * size[i];
  }
  return result;
}

void require_aspect_ratio(const Bounds& domain, double width, double height, const std::string& name) {
  const Vec<2> size = domain.upper - domain.lower;
  if (!(size[0] > 0.0 && size[1] > 0.0) ||
      std::abs(size[0] * height - size[1] * width) > 1e-6 * size[1] * width) {
    throw Error(
        fmt::format("{}: the domain is {:.8g} x {:.8g}, whose aspect ratio is not that of the specimen, "
                    "{:.8g} m x {:.8g} m.",
                    name, size[0], size[1], width, height));
  }
}

/// Cells of a file whose domain takes this size, m.
Tessellation cells_of(const File& file, const Vec<2>& size) {
  Tessellation result;
  std::vector<int> number(file.vertices.size(), -1);
  std::vector<Vec<2>> polygon;
  for (const std::vector<int>& face : file.faces) {
    std::vector<int> cell;
    for (const int v : face) {
      int& n = number[static_cast<std::size_t>(v)];
      if (n < 0) {
        n = static_cast<int>(result.vertices.size());
        result.vertices.push_back(scaled(file.vertices[static_cast<std::size_t>(v)], *file.domain, size));
      }
      cell.push_back(n);
    }
    result.cells.push_back(std::move(cell));
    corners(result, result.cells.size() - 1, polygon);
    if (area(polygon) < 0.0) std::reverse(result.cells.back().begin(), result.cells.back().end());
  }
  return result;
}

std::ifstream opened(const std::filesystem::path& file) {
  require_regular_file(file);
  std::ifstream stream(file, std::ios::binary);
  if (!stream) throw Error(fmt::format("Cannot open the tessellation file {}.", file.string()));
  return stream;
}

}  // namespace

Tessellation read_neper_tess(const std::filesystem::path& file, double width, double height) {
  std::ifstream stream = opened(file);
  return read_neper_tess(stream, file.string(), width, height);
}

Tessellation read_neper_tess(std::istream& stream, const std::string& name, double width, double height) {
  Words words(stream, name);
  const File file = read(words, true);
  require_aspect_ratio(*file.domain, width, height, name);
  Tessellation result = cells_of(file, {{width, height}});
  require_valid(result, Region::rectangle(width, height), name);
  return result;
}

Tessellation read_neper_tess(const std::filesystem::path& file, double width) {
  std::ifstream stream = opened(file);
  return read_neper_tess(stream, file.string(), width);
}

Tessellation read_neper_tess(std::istream& stream, const std::string& name, double width) {
  Words words(stream, name);
  const File file = read(words, false);
  const Vec<2> size = file.domain->upper - file.domain->lower;
  if (!(size[0] > 0.0 && size[1] > 0.0))
    throw Error(fmt::format("{}: the domain is {:.8g} x {:.8g}.", name, size[0], size[1]));
  Tessellation result = cells_of(file, (width / size[0]) * size);
  require_valid(result, outline_of(result), name);
  return result;
}

}  // namespace pyroclast::specimen
