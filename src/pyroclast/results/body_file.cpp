#include "pyroclast/results/body_file.hpp"

#include <algorithm>
#include <array>
#include <numeric>
#include <set>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <xxhash.h>

#include "pyroclast/base/error.hpp"
#include "pyroclast/base/physics_version.hpp"
#include "pyroclast/base/place_in.hpp"
#include "pyroclast/base/read_file.hpp"
#include "pyroclast/base/sha256.hpp"
#include "pyroclast/base/shell_words.hpp"
#include "pyroclast/model/part.hpp"
#include "pyroclast/results/closing_table.hpp"
#include "pyroclast/results/hdf5_file.hpp"
#include "pyroclast/results/specimen_files.hpp"

namespace pyroclast {

namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;

constexpr int kBodyFormat = 1;
constexpr const char* kBodyFile = "body.h5";
constexpr std::string_view kHdf5Begin = "\x89HDF\r\n\x1a\n";
constexpr ClosingTable::Mark kBodyEnd{'p', 'y', 'r', 'o', 'b', 'o', 'd', 'y'};

/// Tables of a deck that shape its body.
constexpr const char* kTablesOfBody[] = {"specimen", "aggregates", "inclusions", "blocks", "superposition",
                                         "sets",     "bearings",   "bodies",     "platens"};
/// Keys of bearings that do not.
constexpr const char* kOfContact[] = {"contact", "friction", "K_n", "K_s"};

/// Adds the values below a table, by the paths of their keys.
void add_values(const Json& json, const std::string& path, BodyInputs& inputs) {
  if (json.is_object())
    for (const auto& [key, value] : json.items()) add_values(value, path + "." + key, inputs);
  else if (json.is_array() && !json.empty() && json.front().is_object())
    for (std::size_t i = 0; i < json.size(); ++i) add_values(json[i], fmt::format("{}[{}]", path, i), inputs);
  else
    inputs[path] = json.dump();
}

/// Writer of the arrays of a body, and of their part of the table.
struct ArrayWriter {
  Hdf5File& file;
  Json arrays = Json::object();

  /// \param begins  first row of each chunk, and the number of rows
  template <class T>
  void add(const std::string& name, const std::vector<T>& values, int columns,
           const std::vector<int>& begins) {
    file.dataset(name, values, columns);
    const std::size_t row = sizeof(T) * static_cast<std::size_t>(std::max(columns, 1));
    const auto* const bytes = reinterpret_cast<const char*>(values.data());
    Json hashes = Json::array();
    for (std::size_t c = 0; c + 1 < begins.size(); ++c)
      hashes.push_back(XXH3_64bits(bytes + begins[c] * row, (begins[c + 1] - begins[c]) * row));
    arrays[name] = {{"place", file.place_of(name)}, {"row", row}, {"begins", begins}, {"hashes", hashes}};
  }
};

/// Returns the hash of all bytes but those of arrays: of what HDF5 itself wrote.
/// \param size  end of what HDF5 wrote
std::uint64_t hash_of_rest(const Json& arrays, std::uint64_t size, const File& file) {
  std::vector<std::pair<std::uint64_t, std::uint64_t>> places{{size, 0}};
  for (const auto& [name, array] : arrays.items())
    if (const std::uint64_t rows = array.at("begins").back(); rows > 0)
      places.emplace_back(array.at("place"), rows * array.at("row").get<std::uint64_t>());
  std::ranges::sort(places);
  std::string rest;
  std::uint64_t at = 0;
  for (const auto& [place, length] : places) {
    const std::size_t before = rest.size();
    rest.resize(before + place - at);
    file.read(at, rest.data() + before, place - at);
    at = place + length;
  }
  return XXH3_64bits(rest.data(), rest.size());
}

std::vector<int> counts(const std::vector<int>& begins) {
  std::vector<int> of(begins.size() - 1);
  for (std::size_t i = 0; i < of.size(); ++i) of[i] = begins[i + 1] - begins[i];
  return of;
}

/// Writes named lists by chunk: rows of the list's number, the place in it and the item.
void add_sets(ArrayWriter& to, const std::string& name, const NamedSets& sets,
              const std::vector<int>& chunk_of, int chunks) {
  std::vector<std::vector<int>> by_chunk(static_cast<std::size_t>(chunks));
  int number = 0;
  for (const auto& [of, items] : sets) {
    for (std::size_t i = 0; i < items.size(); ++i) {
      auto& rows = by_chunk[static_cast<std::size_t>(chunk_of[items[i]])];
      rows.insert(rows.end(), {number, static_cast<int>(i), items[i]});
    }
    ++number;
  }
  std::vector<int> all, begins{0};
  for (const auto& rows : by_chunk) {
    all.insert(all.end(), rows.begin(), rows.end());
    begins.push_back(static_cast<int>(all.size() / 3));
  }
  to.add(name, all, 3, begins);
}

template <int Dim>
void add_model(ArrayWriter& to, const ModelOf<Dim>& model) {
  const int chunks = model.chunks().count();
  for (const char* group : {"blocks", "gridpoints", "zones", "faces", "contacts", "sets"})
    to.file.group(group);
  to.add("blocks/gridpoints", counts(model.block_gridpoints), 0, model.chunk_blocks);
  to.add("blocks/zones", counts(model.block_zones), 0, model.chunk_blocks);
  to.add("blocks/material", model.block_material, 0, model.chunk_blocks);
  const auto flat = [](const auto& items, auto number) {
    std::vector<decltype(number)> all;
    for (const auto& item : items)
      for (const auto one : item) all.push_back(one);
    return all;
  };
  std::vector<double> position;
  for (const Vec<Dim>& p : model.position) position.insert(position.end(), p.c.begin(), p.c.end());
  to.add("gridpoints/position", position, Dim, model.gridpoint_chunks().begins());
  to.add("zones/gridpoints", flat(model.zones, 0), Dim + 1, model.zone_chunks().begins());

  // a face stands in the earlier of its two chunks; all of its contacts have one frame
  const std::vector<int> chunk_of = model.gridpoint_chunks().of_items();
  std::vector<std::vector<int>> faces(static_cast<std::size_t>(chunks));
  std::vector<int> chunk_of_contact(model.contacts.size());
  for (int f = 0; f < model.face_count(); ++f) {
    const Contact<Dim>& first = model.contacts[model.face_contacts[f]];
    const int chunk = std::min(chunk_of[first.a], chunk_of[first.b]);
    faces[static_cast<std::size_t>(chunk)].push_back(f);
    for (int c = model.face_contacts[f]; c < model.face_contacts[f + 1]; ++c) chunk_of_contact[c] = chunk;
  }
  std::vector<int> numbers, face_begins{0}, gridpoints, contact_begins{0};
  std::vector<double> frames, areas;
  for (const auto& of_chunk : faces) {
    for (const int f : of_chunk) {
      const int begin = model.face_contacts[f], end = model.face_contacts[f + 1];
      const Contact<Dim>& first = model.contacts[begin];
      numbers.insert(numbers.end(), {f, begin, end - begin, first.interface});
      frames.push_back(first.block_size);
      frames.insert(frames.end(), first.normal.c.begin(), first.normal.c.end());
      for (const auto& t : first.tangents) frames.insert(frames.end(), t.c.begin(), t.c.end());
      for (int c = begin; c < end; ++c) {
        gridpoints.insert(gridpoints.end(), {model.contacts[c].a, model.contacts[c].b});
        areas.push_back(model.contacts[c].area);
      }
    }
    face_begins.push_back(static_cast<int>(numbers.size() / 4));
    contact_begins.push_back(static_cast<int>(areas.size()));
  }
  to.add("faces/numbers", numbers, 4, face_begins);
  to.add("faces/frame", frames, 1 + Dim * Dim, face_begins);
  to.add("contacts/gridpoints", gridpoints, 2, contact_begins);
  to.add("contacts/area", areas, 0, contact_begins);
  add_sets(to, "sets/gridpoints", model.sets, chunk_of, chunks);
  add_sets(to, "sets/contacts", model.contact_sets, chunk_of_contact, chunks);
}

std::vector<std::string> keys_of(const NamedSets& sets) {
  std::vector<std::string> names;
  for (const auto& [name, items] : sets) names.push_back(name);
  return names;
}

/// Fills named lists from rows of `add_sets`.
/// \param here  function that returns the number of an item of the whole here, -1 where it is not here
template <class Here>
void fill_sets(const Json& names, const std::vector<int>& rows, Here here, NamedSets& sets) {
  std::vector<std::vector<std::pair<int, int>>> members(names.size());
  for (std::size_t i = 0; i < rows.size(); i += 3)
    if (const int item = here(rows[i + 2]); item >= 0)
      members[static_cast<std::size_t>(rows[i])].emplace_back(rows[i + 1], item);
  for (std::size_t i = 0; i < members.size(); ++i) {
    std::ranges::sort(members[i]);
    std::vector<int>& set = sets[names[i].get<std::string>()];
    for (const auto& [place, item] : members[i]) set.push_back(item);
  }
}

std::vector<int> up_to(std::size_t count) {
  std::vector<int> all(count);
  std::iota(all.begin(), all.end(), 0);
  return all;
}

}  // namespace

BodyInputs body_inputs(const Deck& deck, const Setup& setup) {
  BodyInputs inputs;
  for (const char* const table : kTablesOfBody) {
    const Json json = Json::parse(deck.root().json(table, "", "null", ""));
    if (!json.is_null()) add_values(json, table, inputs);
  }
  std::erase_if(inputs, [](const auto& entry) {
    const std::string key = entry.first.substr(entry.first.rfind('.') + 1);
    return entry.first.starts_with("bearings[") && std::ranges::find(kOfContact, key) != std::end(kOfContact);
  });
  std::string named;
  for (const DeckFile& file : deck.files()) {
    if (!file.key.empty()) named = file.key;
    const bool shapes =
        std::ranges::any_of(kTablesOfBody, [&](std::string_view table) { return named.starts_with(table); });
    if (!shapes) continue;
    const std::string content = fmt::format("file of hash {}{}", sha256(read_file(file.file)), file.rest);
    file.key.empty() ? inputs[named] += ", " + content : inputs[named] = content;
  }
  if (!setup.specimen.is_of_file()) inputs["specimen.seed"] = std::to_string(setup.specimen.seed);
  inputs["the blocks of a chunk (PYROCLAST_CHUNK_BLOCKS)"] =
      std::to_string(blocks_of_a_chunk(setup.specimen.dimension()));
  inputs["the physics version"] = std::to_string(kPhysicsVersion);
  inputs["whether a stage moves the body"] = setup.moving ? "yes" : "no";
  if (!setup.moving) {
    std::erase_if(inputs, [](const auto& entry) {
      return entry.first.starts_with("bearings[") || entry.first.starts_with("platens.");
    });
    return inputs;
  }
  std::vector<std::string> names;
  for (const InterfaceParameters& interface : setup.moving->contacts.interfaces) {
    names.push_back(interface.name);
    inputs[fmt::format("contacts.{}.between", interface.name)] =
        fmt::format("{} {}", interface.between, interface.between_stones);
  }
  inputs["the order of contacts"] = fmt::format("{}", names);
  for (const Bearing& bearing : setup.moving->bearings)
    inputs[fmt::format("the material of {}", bearing.name)] = bearing.material;
  return inputs;
}

std::string first_difference(const BodyInputs& was, const BodyInputs& is) {
  const auto stated = [](const BodyInputs& of, const std::string& key) {
    const auto found = of.find(key);
    return found == of.end() ? std::string("not stated") : found->second;
  };
  std::set<std::string> keys;
  for (const auto* of : {&was, &is})
    for (const auto& [key, value] : *of) keys.insert(key);
  for (const std::string& key : keys)
    if (stated(was, key) != stated(is, key))
      return fmt::format("{} was {}, and is {} here", key, stated(was, key), stated(is, key));
  return {};
}

SpecimenTold told_of(const MadeSpecimen& made, const specimen::SpecimenParameters& asked, std::string text) {
  return {std::move(text), warnings(made), stones(made), specimen_facts(made).dump(),
          specimen_files(made, asked)};
}

void write_body(const fs::path& folder, const BodyInputs& inputs, const SpecimenBody& body) {
  const Model& model = *body.model;
  Hdf5File file(folder / kBodyFile);
  ArrayWriter arrays{file};
  with_dimension(model, [&](const auto& of_dimension) { add_model(arrays, of_dimension); });
  const SpecimenTold& told = *body.told;
  const std::string text = nlohmann::ordered_json{
      {"text", told.text},
      {"warnings", told.warnings},
      {"facts", told.facts},
      {"files", told.files}}.dump();
  arrays.file.group("specimen");
  arrays.add("specimen/told", std::vector<std::uint8_t>(text.begin(), text.end()), 0,
             {0, static_cast<int>(text.size())});
  arrays.add("specimen/grain", told.stone, 0, {0, static_cast<int>(told.stone.size())});
  const SpecimenNumbers& n = body.numbers;
  Json table{{"format", kBodyFormat},
             {"inputs", inputs},
             {"dimension", model.dimension()},
             {"thickness", model.thickness},
             {"materials", model.material_names},
             {"interfaces", model.interface_names},
             {"bearing_materials", model.bearing_materials},
             {"bearing_interfaces", model.bearing_interfaces},
             {"sets", keys_of(model.sets)},
             {"contact_sets", keys_of(model.contact_sets)},
             {"neighbours", neighbours_of_chunks(model)},
             {"numbers", {n.fraction, n.mean_size, n.block_size, n.size, n.dimension}},
             {"arrays", std::move(arrays.arrays)}};
  if (const auto& press = body.between_platens)
    table["press"] = {press->axis, press->height, press->area, press->widths, press->sides};
  file.append([&](const File& written) {
    const std::uint64_t begin = written.size();
    table["rest"] = hash_of_rest(table["arrays"], begin, written);
    return ClosingTable::bytes(begin, table.dump(), kBodyEnd);
  });
  file.close();
}

BodyFile::BodyFile(const fs::path& folder) : path_(folder / kBodyFile) {
  const auto fail = [&](const std::string& what) {
    throw Error(fmt::format("{}: {}; make it anew: pyroclast specimen DECK -o {}", path_.string(), what,
                            shell_path(folder)));
  };
  if (!fs::is_regular_file(path_)) fail("there is no body");
  const File file = File::to_read(path_);
  std::string begin(kHdf5Begin.size(), '\0');
  if (!file.read(0, begin.data(), begin.size()) || begin != kHdf5Begin) fail("is no body of pyroclast");
  const ClosingTable closing = ClosingTable::read(file, kBodyEnd, fail);
  table_ = Json::parse(closing.text, nullptr, false);
  if (!table_.is_object() || table_.value("format", 0) != kBodyFormat)
    fail(fmt::format("has format {}, and this program reads format {}",
                     table_.is_object() ? table_.value("format", 0) : 0, kBodyFormat));
  hash_ = fmt::format("{:016x}", closing.hash);
  if (hash_of_rest(table_.at("arrays"), closing.begin, file) != table_.at("rest").get<std::uint64_t>())
    fail("is damaged: what HDF5 keeps of its arrays differs from the bytes that were written");
}

void BodyFile::require(const BodyInputs& inputs) const {
  const std::string other = first_difference(table_.at("inputs").get<BodyInputs>(), inputs);
  if (!other.empty())
    throw Error(fmt::format("{}: is the body of another deck: {}; make it anew, or run without it",
                            path_.string(), other));
}

template <class T>
std::vector<T> BodyFile::rows(const std::string& name, const std::vector<int>& chunks) const {
  const Json& array = table_.at("arrays").at(name);
  const std::uint64_t place = array.at("place"), row = array.at("row");
  const File file = File::to_read(path_);
  std::vector<T> values;
  for (const int chunk : chunks) {
    const std::uint64_t begin = array.at("begins").at(chunk), end = array.at("begins").at(chunk + 1);
    const std::size_t before = values.size(), bytes = (end - begin) * row;
    values.resize(before + bytes / sizeof(T));
    if (!file.read(place + begin * row, values.data() + before, bytes) ||
        XXH3_64bits(values.data() + before, bytes) != array.at("hashes").at(chunk).get<std::uint64_t>())
      throw Error(
          fmt::format("{}: is damaged: chunk {} of \"{}\" differs from the bytes that were written; make it "
                      "anew, or run without it",
                      path_.string(), chunk, name));
  }
  return values;
}

template <int Dim>
std::unique_ptr<Model> BodyFile::model_of(const std::vector<int>& chunks,
                                          const std::shared_ptr<Ranks>& ranks) const {
  const auto begins = [&](const char* name) {
    return table_.at("arrays").at(name).at("begins").get<std::vector<int>>();
  };
  const std::vector<int> blocks = begins("blocks/material"), gridpoints = begins("gridpoints/position"),
                         zones = begins("zones/gridpoints");
  const auto rank_of_chunk = ranks_of_chunks(zones, ranks ? ranks->count() : 1);
  auto model = std::make_unique<ModelOf<Dim>>();
  PartOfBody of;
  of.ranks = ranks;
  of.zones_of_whole = zones.back();
  model->chunk_blocks = {0};
  std::vector<int> shift(gridpoints.size());  // by chunk: number here less that in the whole
  std::vector<bool> is_here(gridpoints.size());
  for (const int c : chunks) {
    is_here[c] = true;
    shift[c] = static_cast<int>(of.gridpoint.size()) - gridpoints[c];
    of.chunk.push_back(c);
    of.rank_of_chunk.push_back(rank_of_chunk[c]);
    for (int b = blocks[c]; b < blocks[c + 1]; ++b) of.block.push_back(b);
    for (int g = gridpoints[c]; g < gridpoints[c + 1]; ++g) of.gridpoint.push_back(g);
    for (int z = zones[c]; z < zones[c + 1]; ++z) of.zone.push_back(z);
    model->chunk_blocks.push_back(static_cast<int>(of.block.size()));
  }
  const auto here = [&](int gridpoint) {
    const auto chunk = std::ranges::upper_bound(gridpoints, gridpoint) - gridpoints.begin() - 1;
    return is_here[chunk] ? gridpoint + shift[chunk] : -1;
  };
  model->block_material = rows<int>("blocks/material", chunks);
  for (const int count : rows<int>("blocks/gridpoints", chunks))
    model->block_gridpoints.push_back(model->block_gridpoints.back() + count);
  for (const int count : rows<int>("blocks/zones", chunks))
    model->block_zones.push_back(model->block_zones.back() + count);
  model->position.reserve(of.gridpoint.size());
  model->zones.reserve(of.zone.size());
  for (const int c : chunks) {
    const auto position = rows<double>("gridpoints/position", {c});
    for (auto p = position.begin(); p != position.end(); p += Dim)
      std::copy_n(p, Dim, model->position.emplace_back().c.begin());
    const auto corners = rows<int>("zones/gridpoints", {c});
    for (auto corner = corners.begin(); corner != corners.end(); corner += Dim + 1)
      std::transform(corner, corner + Dim + 1, model->zones.emplace_back().begin(), here);
  }

  const auto numbers = rows<int>("faces/numbers", chunks), ends = rows<int>("contacts/gridpoints", chunks);
  const auto frames = rows<double>("faces/frame", chunks), areas = rows<double>("contacts/area", chunks);
  struct Read {
    int number, row, first;  // in the whole; in these rows; its first contact in these rows
  };
  std::vector<Read> faces;
  for (int row = 0, first = 0; row < std::ssize(numbers) / 4; first += numbers[4 * row + 2], ++row)
    if (here(ends[2 * first]) >= 0 && here(ends[2 * first + 1]) >= 0)
      faces.push_back({numbers[4 * row], row, first});
  std::ranges::sort(faces, {}, &Read::number);
  std::size_t contacts = 0;
  for (const Read& face : faces) contacts += numbers[4 * face.row + 2];
  model->contacts.reserve(contacts);
  for (const Read& face : faces) {
    const int* const number = &numbers[4 * face.row];
    const double* frame = &frames[(1 + Dim * Dim) * face.row];
    Contact<Dim> contact;
    contact.face = model->face_count();
    contact.interface = number[3];
    contact.block_size = *frame++;
    for (double& x : contact.normal.c) x = *frame++;
    for (auto& tangent : contact.tangents)
      for (double& x : tangent.c) x = *frame++;
    for (int i = 0; i < number[2]; ++i) {
      contact.a = here(ends[2 * (face.first + i)]);
      contact.b = here(ends[2 * (face.first + i) + 1]);
      contact.area = areas[face.first + i];
      of.contact.push_back(number[1] + i);
      model->contacts.push_back(contact);
    }
    model->face_contacts.push_back(static_cast<int>(model->contacts.size()));
  }
  fill_sets(table_.at("sets"), rows<int>("sets/gridpoints", chunks), here, model->sets);
  const auto contact_here = [&](int contact) { return place_in_ascending(of.contact, contact); };
  fill_sets(table_.at("contact_sets"), rows<int>("sets/contacts", chunks), contact_here, model->contact_sets);
  if (chunks.size() + 1 < blocks.size() || ranks)
    model->part = std::make_shared<const PartOfBody>(std::move(of));
  return model;
}

std::unique_ptr<Model> BodyFile::model(const std::vector<int>& chunks,
                                       const std::shared_ptr<Ranks>& ranks) const {
  auto model = table_.at("dimension") == 2 ? model_of<2>(chunks, ranks) : model_of<3>(chunks, ranks);
  table_.at("thickness").get_to(model->thickness);
  table_.at("materials").get_to(model->material_names);
  table_.at("interfaces").get_to(model->interface_names);
  table_.at("bearing_materials").get_to(model->bearing_materials);
  table_.at("bearing_interfaces").get_to(model->bearing_interfaces);
  return model;
}

SpecimenBody BodyFile::read(const std::shared_ptr<Ranks>& ranks, ForeignBlocks foreign) const {
  SpecimenBody body;
  const auto all = up_to(table_.at("neighbours").size());
  if (!ranks || ranks->count() == 1) {
    body.model = model(all, nullptr);
  } else {
    const auto zones = table_.at("arrays").at("zones/gridpoints").at("begins").get<std::vector<int>>();
    const auto rank_of_chunk = ranks_of_chunks(zones, ranks->count());
    std::set<int> needed;
    for (const int c : all)
      if (rank_of_chunk[c] == ranks->me()) {
        needed.insert(c);
        for (const int other : table_.at("neighbours").at(c)) needed.insert(other);
      }
    if (foreign == ForeignBlocks::all) needed.insert(all.begin(), all.end());
    body.model = model({needed.begin(), needed.end()}, ranks);
  }
  const Json& numbers = table_.at("numbers");
  body.numbers = {numbers.at(0), numbers.at(1), numbers.at(2), numbers.at(3), numbers.at(4)};
  if (table_.contains("press")) {
    const Json& press = table_.at("press");
    body.between_platens = {press.at(0), press.at(1), press.at(2), press.at(3), press.at(4)};
  }
  SpecimenTold told;
  if (!ranks || ranks->is_first()) {
    const Json json = Json::parse(rows<char>("specimen/told", {0}));
    json.at("text").get_to(told.text);
    json.at("warnings").get_to(told.warnings);
    json.at("facts").get_to(told.facts);
    json.at("files").get_to(told.files);
  }
  told.stone = rows<int>("specimen/grain", {0});
  body.told = std::make_shared<const SpecimenTold>(std::move(told));
  return body;
}

bool is_there(const BodyOfRun& body) {
  try {
    return BodyFile(body.folder).hash() == body.hash;
  } catch (const Error&) {
    return false;
  }
}

}  // namespace pyroclast
