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
#include "pyroclast/specimen/cells_file.hpp"
#include "pyroclast/specimen/convex_parts.hpp"
#include "pyroclast/specimen/from_cells.hpp"
#include "pyroclast/specimen/polygon.hpp"
#include "pyroclast/specimen/region.hpp"
#include "pyroclast/specimen/topology.hpp"

namespace pyroclast::specimen {
namespace {

/// Words of a .tess file, which may be broken into lines at will, with the line on which each stands.
class Words {
 public:
  Words(std::istream& stream, std::string name)
      : name_(std::move(name)), text_(std::istreambuf_iterator<char>(stream), {}) {
    constexpr std::string_view kByteOrderMark = "\xEF\xBB\xBF";
    if (text_.starts_with(kByteOrderMark)) at_ = kByteOrderMark.size();
  }

  /// Returns the next word without taking it; empty at the end of the file.
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

  /// Reads a whole number of things, at least `least`. Throws Error for more than the file has characters:
  /// such a number is a slip, not a request for memory.
  int count(std::string_view what, int least) {
    const int value = integer(what);
    if (value < least || static_cast<std::size_t>(value) > text_.size()) {
      fail(std::to_string(value),
           fmt::format("{}, at least {} and no more than the file can hold", what, least));
    }
    return value;
  }

  /// Reads the identifier of the next item. Throws Error where it is not the expected one: items count from 1
  /// without gaps.
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
    fail(fmt::format("expected {}, found {}.", expected,
                     found.empty() ? std::string("the end of the file") : fmt::format("'{}'", found)));
  }
  [[noreturn]] void fail(std::string_view message) const { fail_at(line_, message); }
  [[noreturn]] void fail_at(int line, std::string_view message) const {
    throw Error(fmt::format("{}, line {}: {}", name_, line, message));
  }

  /// Returns the line of the last word that was looked at.
  int line() const { return line_; }

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

/// Place in space, in the file's unit of length, with the line on which it stands.
struct Place {
  Vec<3> at;
  int line = 0;
};

/// Bounding box of the domain laid flat, in the file's unit of length.
struct Bounds {
  Vec<2> lower, upper;
};

/// Data taken from a file, in its own unit of length.
struct File {
  std::optional<int> cell_count;
  std::vector<int> group;  ///< group of each cell; empty where there is no *group
  int group_line = 0;
  std::vector<Place> vertices;
  std::vector<std::vector<int>> faces;  ///< vertices of each face; none for an empty cell
  std::vector<Place> domain;
};

Place read_point(Words& words, std::string_view what) {
  Place place;
  for (int i = 0; i < 3; ++i) place.at[i] = words.number(fmt::format("a coordinate of {}", what));
  place.line = words.line();
  return place;
}

void read_format(Words& words) {
  const std::string_view version = words.next();
  if (!version.starts_with("2.") && !version.starts_with("3."))
    words.fail(version, "a format version 2.x or 3.x");
}

void read_general(Words& words) {
  const int dimension = words.integer("the dimension");
  if (dimension == 3)
    words.fail(
        fmt::format("the tessellation is of space, and the blocks here are of the plane. {}.", kInSpace));
  if (dimension != 2) words.fail(std::to_string(dimension), "the dimension 2 (made by neper -T -dim 2)");
  const std::string_view type = words.next();
  if (type == "periodic")
    words.fail(
        "the tessellation is periodic: its cells stick out of the domain on one side and lack on the other, "
        "so "
        "they have no outline to load or heat. Make it without -periodicity.");
  if (type != "standard") words.fail(type, "the type 'standard'");
}

void read_cell(Words& words, File& file) {
  file.cell_count = words.count("the number of cells", 1);
  while (!words.peek().empty() && !words.peek().starts_with("**")) {
    if (words.next() != "*group") continue;
    if (!file.group.empty()) words.fail("*group", "one list '*group' alone");
    file.group_line = words.line();
    for (int cell = 1; cell <= *file.cell_count; ++cell)
      file.group.push_back(words.integer(fmt::format("the group of cell {}", cell)));
  }
}

std::vector<Place> read_vertices(Words& words) {
  std::vector<Place> vertices;
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
  const int corner_count = words.count("the number of vertices of a face", 0);
  if (corner_count == 1 || corner_count == 2)
    words.fail(std::to_string(corner_count), "three or more vertices of a face, or none of an empty cell");
  for (int i = 0; i < corner_count; ++i) {
    const int vertex = words.integer("a vertex of a face");
    if (vertex < 1 || vertex > vertex_count) {
      words.fail(std::to_string(vertex), fmt::format("a vertex of a face, 1 to {}", vertex_count));
    }
    // An edge that Neper's regularisation has deleted leaves the same vertex twice in a row.
    if (face.empty() || face.back() != vertex - 1) face.push_back(vertex - 1);
  }
  while (face.size() > 1 && face.front() == face.back()) face.pop_back();
  if (corner_count > 0 && face.size() < 3)
    words.fail(fmt::format("{} different ones", face.size()), "at least three vertices of a face");

  const int edge_count = words.count("the number of edges of a face", corner_count == 0 ? 0 : 3);
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

std::vector<Place> read_domain(Words& words) {
  words.expect("*general");
  words.next();  // the type says "cube" for a rectangle as well; the corners tell
  words.expect("*vertex");
  const int count = words.count("the number of domain vertices", 3);
  std::vector<Place> points;
  for (int i = 1; i <= count; ++i) {
    words.identifier("domain vertex", i);
    points.push_back(read_point(words, "a domain vertex"));
    words.next();  // label
    const int listed = words.count("the number of tessellation vertices of a domain vertex", 0);
    for (int j = 0; j < listed; ++j) words.integer("a tessellation vertex of a domain vertex");
  }
  return points;
}

File read(Words& words) {
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
    if (section == "**cell") read_cell(words, file);
    if (section == "**vertex") file.vertices = read_vertices(words);
    if (section == "**face") file.faces = read_faces(words, static_cast<int>(file.vertices.size()));
    if (section == "**domain") file.domain = read_domain(words);
    words.skip_to_section();
  }
  if (!file.cell_count) words.fail("***end", "a section '**cell' before it");
  if (file.faces.empty()) words.fail("***end", "a section '**face' before it");
  if (file.domain.empty()) words.fail("***end", "a section '**domain' before it");
  if (static_cast<std::size_t>(*file.cell_count) != file.faces.size()) {
    words.fail(fmt::format("{} cells and {} faces", *file.cell_count, file.faces.size()),
               "as many faces as cells");
  }
  if (std::ranges::all_of(file.faces, [](const std::vector<int>& face) { return face.empty(); }))
    words.fail("empty cells alone", "a face with vertices");
  return file;
}

Vec<3> cross_product(const Vec<3>& a, const Vec<3>& b) {
  return {{a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]}};
}

/// Plane in which a tessellation lies, with two directions in it.
struct PlaneOfFile {
  Vec<3> origin, x{{1.0, 0.0, 0.0}}, y{{0.0, 1.0, 0.0}};

  Vec<2> flat(const Place& place) const { return {{dot(place.at - origin, x), dot(place.at - origin, y)}}; }
};

/// Largest distance between a plane and a place in it, as a share of the size; files have twelve decimals.
constexpr double kOutOfPlane = 1e-6;
/// Largest length in a plane of a unit vector that counts as normal to the plane.
constexpr double kNormal = 1e-3;

/// Returns the places that cells and domain use.
std::vector<Place> used_places(const File& file) {
  std::vector<bool> is_used(file.vertices.size(), false);
  for (const auto& face : file.faces)
    for (const int v : face) is_used[v] = true;
  std::vector<Place> places = file.domain;
  for (std::size_t v = 0; v < is_used.size(); ++v)
    if (is_used[v]) places.push_back(file.vertices[v]);
  return places;
}

/// Returns the plane of a tessellation: that of its largest face. The plane's x is the file's x as far as it
/// lies in the plane, or the file's y where x is normal to the plane; its y points to where the file's y
/// does, or z. Throws Error for a place off the plane.
PlaneOfFile plane_of(const Words& words, const File& file) {
  const std::vector<Place> places = used_places(file);
  Vec<3> low = places.front().at, high = low;
  for (const Place& p : places)
    for (int i = 0; i < 3; ++i) {
      low[i] = std::min(low[i], p.at[i]);
      high[i] = std::max(high[i], p.at[i]);
    }
  const double slack = kOutOfPlane * norm(high - low);
  if (high[2] - low[2] <= slack) return {};  // coordinates stay as they are

  Vec<3> normal{}, on_plane{};
  for (const auto& face : file.faces) {
    Vec<3> twice{};
    for (std::size_t i = 1; i + 1 < face.size(); ++i) {
      const Vec<3>& corner = file.vertices[face[0]].at;
      twice += cross_product(file.vertices[face[i]].at - corner, file.vertices[face[i + 1]].at - corner);
    }
    if (norm(twice) <= norm(normal)) continue;
    normal = twice;
    on_plane = file.vertices[face[0]].at;
  }
  if (!(norm(normal) > 0.0)) words.fail("no cell has an area");
  normal *= 1.0 / norm(normal);
  for (const Place& p : places)
    if (const double distance = std::abs(dot(p.at - on_plane, normal)); distance > slack)
      words.fail_at(p.line,
                    fmt::format("({:.8g}, {:.8g}, {:.8g}) lies {:.3g} off the plane of the largest cell; the "
                                "cells must lie in one plane",
                                p.at[0], p.at[1], p.at[2], distance));
  PlaneOfFile plane{.origin = on_plane};
  const auto in_plane = [&](const Vec<3>& direction) { return direction - dot(direction, normal) * normal; };
  const Vec<3> x{{1.0, 0.0, 0.0}}, y{{0.0, 1.0, 0.0}};
  plane.x = norm(in_plane(x)) > kNormal ? in_plane(x) : in_plane(y);
  plane.x *= 1.0 / norm(plane.x);
  plane.y = cross_product(normal, plane.x);
  const double up = std::abs(plane.y[1]) > kNormal ? plane.y[1] : plane.y[2];
  if (up < 0.0) plane.y *= -1.0;
  return plane;
}

/// Returns the bounding box of the domain laid flat.
/// \param is_rectangle  true where the domain must be an upright rectangle; then throws Error for another one
Bounds bounds_of(const Words& words, const File& file, const PlaneOfFile& plane, bool is_rectangle) {
  const auto refuse = [&](std::string_view found) {
    words.fail_at(file.domain.back().line,
                  fmt::format("expected a domain that is an upright rectangle, found {}.", found));
  };
  std::vector<Vec<2>> points;
  for (const Place& p : file.domain) points.push_back(plane.flat(p));
  if (is_rectangle && points.size() != 4) refuse(fmt::format("{} corners", points.size()));
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
        refuse("a vertex off its corners");
      }
    }
    found |= 1 << corner;
  }
  if (found != 0b1111) refuse("fewer than four corners");
  return box;
}

/// Puts a point of the file into [0, width] x [0, height], exactly onto a side when it is nearly there.
Vec<2> scaled(const Vec<2>& point, const Bounds& domain, const Vec<2>& size) {
  // Files have twelve decimals; a domain of 1e-3 in the file's unit still resolves this share.
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

/// Tessellation, with the numbers that messages give to its cells.
struct Read {
  NeperTess tess;
  Numbering numbering;
};

/// Returns the cells of a file whose domain takes this size, m. A cell that bends inwards, as Neper's
/// regularisation leaves some, becomes its convex parts.
Read cells_of(const File& file, const PlaneOfFile& plane, const Bounds& domain, const Vec<2>& size) {
  Read read;
  Cells<2>& result = read.tess.cells;
  std::vector<int> number(file.vertices.size(), -1);
  std::vector<Vec<2>> polygon;
  for (std::size_t f = 0; f < file.faces.size(); ++f) {
    std::vector<int> cell;
    for (const int v : file.faces[f]) {
      int& n = number[static_cast<std::size_t>(v)];
      if (n < 0) {
        n = static_cast<int>(result.vertices.size());
        result.vertices.push_back(
            scaled(plane.flat(file.vertices[static_cast<std::size_t>(v)]), domain, size));
      }
      cell.push_back(n);
    }
    if (cell.empty()) {
      read.tess.empty.push_back(static_cast<int>(f) + 1);
      continue;
    }
    polygon.clear();
    for (const int v : cell) polygon.push_back(result.vertices[v]);
    if (area(polygon) < 0.0) {
      std::ranges::reverse(cell);
      std::ranges::reverse(polygon);
    }
    for (const std::vector<int>& part : convex_parts(polygon)) {
      auto& corners = result.cells.emplace_back();
      for (const int corner : part) corners.push_back(cell[corner]);
      read.numbering.in_file.push_back(static_cast<int>(f) + 1);
      if (!file.group.empty()) read.tess.group.push_back(file.group[f]);
    }
  }
  read.tess.group_line = file.group_line;
  return read;
}

std::ifstream opened(const std::filesystem::path& file) {
  require_regular_file(file);
  std::ifstream stream(file, std::ios::binary);
  if (!stream) throw Error(fmt::format("Cannot open the tessellation file {}.", file.string()));
  return stream;
}

}  // namespace

NeperTess read_neper_tess(const std::filesystem::path& file, double width, double height) {
  std::ifstream stream = opened(file);
  return read_neper_tess(stream, file.string(), width, height);
}

NeperTess read_neper_tess(std::istream& stream, const std::string& name, double width, double height) {
  Words words(stream, name);
  const File file = read(words);
  const PlaneOfFile plane = plane_of(words, file);
  const Bounds domain = bounds_of(words, file, plane, true);
  require_aspect_ratio(domain, width, height, name);
  Read result = cells_of(file, plane, domain, {{width, height}});
  require_valid(result.tess.cells, Region::rectangle(width, height), name, result.numbering);
  return std::move(result.tess);
}

NeperTess read_neper_tess(const std::filesystem::path& file, const TessSize& size) {
  std::ifstream stream = opened(file);
  return read_neper_tess(stream, file.string(), size);
}

NeperTess read_neper_tess(std::istream& stream, const std::string& name, const TessSize& size) {
  Words words(stream, name);
  const File file = read(words);
  const PlaneOfFile plane = plane_of(words, file);
  const Bounds domain = bounds_of(words, file, plane, false);
  const Vec<2> in_file = domain.upper - domain.lower;
  if (!(in_file[0] > 0.0 && in_file[1] > 0.0))
    throw Error(fmt::format("{}: the domain is {:.8g} x {:.8g}.", name, in_file[0], in_file[1]));
  Read result =
      cells_of(file, plane, domain, (size.unit > 0.0 ? size.unit : size.width / in_file[0]) * in_file);
  Cells<2>& cells = result.tess.cells;
  lay_on_sides(cells);
  try {
    require_valid(cells, outline_of(cells, result.numbering), name, result.numbering);
  } catch (const Error& error) {
    const std::string_view what = error.what();
    if (what.starts_with(name)) throw;
    throw Error(fmt::format("{}: {}", name, what));
  }
  return std::move(result.tess);
}

}  // namespace pyroclast::specimen
