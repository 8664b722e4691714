#include "pyroclast/setup/read_outline.hpp"

#include <string_view>
#include <utility>

#include <fmt/format.h>

#include "pyroclast/base/error.hpp"
#include "pyroclast/setup/cells_in_metres.hpp"

namespace pyroclast {

namespace {

std::vector<Vec<2>> vecs(const std::vector<std::pair<double, double>>& places) {
  std::vector<Vec<2>> result;
  for (const auto& [x, y] : places) result.push_back({{x, y}});
  return result;
}

Vec<2> read_place(const Section& s, std::string_view key, Meaning meaning) {
  const auto [x, y] = s.place(key, unit::length, meaning).value_or(std::pair{0.0, 0.0});
  return {{x, y}};
}

/// Usual range of a specimen's lengths, m.
constexpr Range kSize = Range::positive().usually(0.01, 10.0);

/// Reads the file that holds all of a specimen; returns none after an error.
std::optional<specimen::FileOfCells> read_blocks_file(const Section& s, const std::filesystem::path& folder,
                                                      bool is_solid, double join) {
  const std::string name = s.text("file",
                                  "of shape \"cells\" or \"polyhedra\": JSON with the blocks, see "
                                  "[Blocks made elsewhere](../do/bodies.md#blocks-made-elsewhere)");
  if (!s.has("file")) return std::nullopt;
  s.names_file("file", folder / name);
  try {
    auto cells = cells_in_metres(folder / name, join);
    if (std::holds_alternative<specimen::GivenCells<3>>(cells) == is_solid) return cells;
    s.error("file",
            is_solid
                ? fmt::format("{}: holds cells of the plane, without \"faces\" and \"body\", and is read "
                              "as blocks in space. Cells of the plane come by [specimen] shape = \"cells\"",
                              (folder / name).string())
                : fmt::format("{}: holds blocks of space, with \"faces\" or \"body\", and is read as cells "
                              "of the plane. {}",
                              (folder / name).string(), specimen::kInSpace));
  } catch (const Error& error) {
    const bool is_tess = std::filesystem::path(name).extension() == ".tess";
    s.error(
        "file",
        fmt::format("{}{}", error.what(),
                    is_tess ? "; a tessellation of Neper, which is of the plane, is blocks.file, and shape = "
                              "\"tessellation\" takes its outline"
                            : ""));
  }
  return std::nullopt;
}

/// Reads the distance within which the cells of a file are joined, m.
double read_join(const Section& s) {
  return s.quantity(
      "join", unit::length, Range::non_negative(), 0.0,
      "vertices of the file nearer to each other than this become one; in the plane those nearer to an edge "
      "of "
      "a cell become a corner of it, and in space faces with the same corners become one. 0: cells share the "
      "vertices, and faces, that the file says");
}

/// Reads the unit of a file's coordinates, m; returns 0 after an error.
double read_unit(const Section& s) {
  const std::string name = s.text(
      "unit", "of length, of the coordinates in `blocks.file`: the specimen is as large as the file says");
  try {
    return metres_of(name);
  } catch (const Error& error) {
    s.error("unit", error.what());
    return 0.0;
  }
}

}  // namespace

ReadOutline read_outline(const Section& s, const std::filesystem::path& folder, const DeckSpace& space) {
  ReadOutline o;
  o.shape = space.shape;
  if (o.shape == Shape::rectangle) {
    o.width = s.quantity("width", unit::length, kSize, "of the specimen");
    o.height = s.quantity("height", unit::length, kSize, "of the specimen");
  } else if (o.shape == Shape::polygon) {
    o.corners = vecs(s.places("corners", unit::length, 3, "of the specimen, in either sense"));
  } else if (o.shape == Shape::tessellation) {
    if (s.has("unit")) {
      o.unit = read_unit(s);
      s.know({"width"});
    } else {
      o.width = s.quantity("width", unit::length, kSize, "of the specimen; the height follows from the file");
    }
    s.know({"holes", "notches"});
  } else if (o.shape == Shape::cells || o.shape == Shape::polyhedra) {
    o.cells = read_blocks_file(s, folder, space.is_solid(), read_join(s));
    s.know({"seed", "holes", "notches"});
  } else if (o.shape == Shape::cylinder) {
    o.diameter = s.quantity("diameter", unit::length, kSize, "of the specimen");
    o.height = s.quantity("height", unit::length, kSize, "of the specimen");
  } else {
    o.diameter = s.quantity("diameter", unit::length, kSize, "of the specimen");
    if (o.shape == Shape::ring) {
      o.inner_diameter = s.quantity("inner_diameter", unit::length, kSize, "of the bore");
      if (s.ok() && o.inner_diameter >= o.diameter) s.error("inner_diameter", "must be less than diameter");
    }
  }
  s.know({"width", "height", "corners", "diameter", "inner_diameter", "file", "join", "unit"});
  if (o.shape == Shape::cells || o.shape == Shape::polyhedra || o.shape == Shape::tessellation) return o;
  if (o.shape == Shape::cylinder) {
    for (const char* const cuts : {"holes", "notches"})
      if (s.has(cuts))
        s.error(cuts,
                "a cylinder stands, and holes and notches go along z: shape = \"disc\" with a depth lies");
    return o;
  }
  int number = 0;
  for (const Section& h : s.optional_sections(
           "holes", "holes in the specimen, any number; in a solid they go through all of its depth")) {
    ReadOutline::Hole hole;
    hole.name = h.text("name", fmt::format("hole_{}", ++number), "of its side");
    if (h.has("corners")) {
      hole.corners =
          vecs(h.places("corners", unit::length, 3, "of a hole that is not round, in either sense"));
      h.know({"centre", "diameter"});
    } else {
      hole.centre = read_place(h, "centre", "of a round hole");
      hole.diameter = h.quantity("diameter", unit::length, Range::positive(), "of a round hole");
    }
    o.holes.push_back(std::move(hole));
  }
  number = 0;
  for (const Section& n : s.optional_sections(
           "notches", "straight cuts from the outline, any number; in a solid through all of its depth")) {
    specimen::Notch notch;
    notch.place = fmt::format("{}: {}", n.where("width"), n.path());
    notch.name = n.text("name", fmt::format("notch_{}", ++number), "of its side");
    notch.mouth = read_place(n, "mouth", "where the notch begins, on the outline");
    notch.tip = read_place(n, "tip", "where the notch ends, in the specimen; a corner of blocks");
    notch.width =
        n.quantity("width", unit::length, Range::non_negative(), 0.0,
                   "of a slot, which ends in a point at the tip; 0, not in a solid: the blocks on both sides "
                   "touch, and nothing holds them together");
    if (space.is_solid() && notch.width == 0.0)
      n.error("width", "must be above 0 in a solid, such as \"2 mm\"");
    o.notches.push_back(std::move(notch));
  }
  return o;
}

void check_outline(const Section& s, const ReadOutline& outline,
                   const specimen::SpecimenParameters& specimen) {
  if (!s.ok()) return;
  const auto key = [&]() -> std::string_view {
    switch (outline.shape) {
      case Shape::polygon:
        return "corners";
      case Shape::tessellation:
        return outline.unit > 0.0 ? "unit" : "width";
      case Shape::cells:
      case Shape::polyhedra:
        return "file";
      default:
        return {};
    }
  }();
  const Vec<3> size = specimen.high() - specimen.low();
  const double width = size[0], height = size[1];
  const bool is_told =
      outline.shape == Shape::tessellation && !kSize.is_usual(outline.width) && outline.unit == 0.0;
  if (key.empty() || is_told || (kSize.is_usual(width) && kSize.is_usual(height))) return;
  s.warn(key, fmt::format("the outline is {:.6g} m wide and {:.6g} m high, but usual are {}{}", width, height,
                          kSize.describe_usual("m"),
                          outline.shape == Shape::cells
                              ? "; are the coordinates in another unit? `vertices_mm` in the file says so"
                              : ""));
}

}  // namespace pyroclast
