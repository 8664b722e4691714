#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "pyroclast/model/part.hpp"
#include "pyroclast/setup/setup.hpp"

namespace pyroclast {

/// Inputs of a deck that determine its body, by their keys, for messages.
using BodyInputs = std::map<std::string, std::string>;

/// Returns the inputs of a body: the tables of a deck that shape it, with hashes of the files that they name,
/// and what its interfaces and bearings are. Numbers of materials and contacts are not among them.
BodyInputs body_inputs(const Deck& deck, const Setup& setup);

/// Returns the first input by which two bodies differ, with what it was and is; empty: they are the same.
std::string first_difference(const BodyInputs& was, const BodyInputs& is);

/// Returns what is told of a specimen.
/// \param text  description for the screen
SpecimenTold told_of(const MadeSpecimen& made, const specimen::SpecimenParameters& asked, std::string text);

/// Writes `body.h5` into a folder: a body by chunk, for `BodyFile`. Behind the HDF5 file stands a table with
/// the place of each array and a hash of each chunk of it. Throws Error where it cannot be written.
void write_body(const std::filesystem::path& folder, const BodyInputs& inputs, const SpecimenBody& body);

/// Body that was made before, in `body.h5` of a folder. What differs from the bytes that were written is
/// an Error.
class BodyFile {
 public:
  /// Reads the table. Throws Error where there is no such file, or it is not whole.
  explicit BodyFile(const std::filesystem::path& folder);

  /// Returns the hash of the table, which has those of all arrays.
  const std::string& hash() const { return hash_; }
  /// Throws Error, naming what differs, where the body is not of these inputs.
  void require(const BodyInputs& inputs) const;
  /// Reads the body: all of it, or for one of several ranks its own chunks and those of the foreign blocks
  /// that it needs.
  SpecimenBody read(const std::shared_ptr<Ranks>& ranks, ForeignBlocks foreign) const;

 private:
  template <class T>
  std::vector<T> rows(const std::string& name, const std::vector<int>& chunks) const;
  template <int Dim>
  std::unique_ptr<Model> model_of(const std::vector<int>& chunks, const std::shared_ptr<Ranks>& ranks) const;
  std::unique_ptr<Model> model(const std::vector<int>& chunks, const std::shared_ptr<Ranks>& ranks) const;

  std::filesystem::path path_;
  std::string hash_;
  nlohmann::json table_;
};

/// Folder with the body of a run, and the body's hash.
struct BodyOfRun {
  std::filesystem::path folder;
  std::string hash;
};

/// Tells whether a folder still has a body.
bool is_there(const BodyOfRun& body);

}  // namespace pyroclast
