// What assimp gets to read: the model from memory, and what lies beside it.
#pragma once

#include <assimp/IOStream.hpp>
#include <assimp/IOSystem.hpp>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "render/model/companions.h"

namespace limpid {

class AssimpFiles : public Assimp::IOSystem {
 public:
  // All of these outlive this.
  // `found` is told how many bytes each of them has.
  AssimpFiles(std::span<const unsigned char> bytes, const std::string& kind, Companions& companions,
              std::function<void(std::size_t)> found)
      : bytes_(bytes), main_(kStem + kind), companions_(companions), found_(std::move(found)) {}

  const std::string& main() const { return main_; }  // the model's name here

  bool Exists(const char* file) const override { return file == main_; }
  char getOsSeparator() const override { return '/'; }
  Assimp::IOStream* Open(const char* file, const char* mode) override;
  void Close(Assimp::IOStream* stream) override { delete stream; }

  // Pictures and material files by the names that models have for them; empty: not there, or not
  // to be read, for which there is a warning then.
  std::vector<unsigned char> read(const std::string& file);
  const std::vector<std::string>& warnings() const { return warnings_; }
  bool any_read() const { return any_read_; }  // beside the model

 private:
  // Assimp looks for materials by the model's name, too, where it has not been told of any.
  static constexpr const char* kStem = "the model itself.";

  std::span<const unsigned char> bytes_;
  std::string main_;
  Companions& companions_;
  std::function<void(std::size_t)> found_;
  std::vector<std::string> warnings_;
  bool any_read_ = false;
};

// A look through a file before assimp spends time and memory on it.

// Throws std::runtime_error where a PLY or Collada file says that it has more of something than
// fits into it, or a PLY is cut off in its header.
void guard_counts(std::span<const unsigned char> bytes, const std::string& kind);

// What assimp 5.2 refuses, or crashes on, although it is right.

// A file of this kind ("stl", "obj", "mtl", "ply", "dae") written so that assimp reads it as what
// it is; nothing where it reads the file itself.
//
//   dae   UTF-16 and Latin-1 become UTF-8; nothing stands before the declaration
//   mtl   without `aniso` and `anisor`, whose names are taken for their numbers
//   obj   `0.5` for `.5`, which is not counted as a number
//   ply   binary data do not begin with the end of a line, which would be skipped with the
//   header's;
//         elements that it does not know have the name of one that it skips
//   stl   text: without solids that are empty
std::optional<std::vector<unsigned char>> readable(std::span<const unsigned char> bytes,
                                                   const std::string& kind);

}  // namespace limpid
