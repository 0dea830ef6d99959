// The files that assimp may read: the model from memory, and those beside it; both checked before.
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
  // Keeps references to all arguments; they must outlive this. Tells `found` the size of each file
  // read beside the model [bytes].
  AssimpFiles(std::span<const unsigned char> bytes, const std::string& kind, Companions& companions,
              std::function<void(std::size_t)> found)
      : bytes_(bytes), main_(kStem + kind), companions_(companions), found_(std::move(found)) {}

  const std::string& main() const { return main_; }  // name of the model for assimp

  bool Exists(const char* file) const override { return file == main_; }
  char getOsSeparator() const override { return '/'; }
  Assimp::IOStream* Open(const char* file, const char* mode) override;
  void Close(Assimp::IOStream* stream) override { delete stream; }

  // Reads pictures and material files by the names that models have for them. Empty: missing or not
  // to be read, which also adds a warning.
  std::vector<unsigned char> read(const std::string& file);
  const std::vector<std::string>& warnings() const { return warnings_; }
  bool any_read() const { return any_read_; }  // any file beside the model

 private:
  // Assimp also looks for materials by the model's name, where the model names none.
  static constexpr const char* kStem = "the model itself.";

  std::span<const unsigned char> bytes_;
  std::string main_;
  Companions& companions_;
  std::function<void(std::size_t)> found_;
  std::vector<std::string> warnings_;
  bool any_read_ = false;
};

// Checks the counts of a file before assimp spends time and memory on it. Throws std::runtime_error
// where a PLY or Collada file says that it has more of something than fits into it, or a PLY is cut
// off in its header.
void guard_counts(std::span<const unsigned char> bytes, const std::string& kind);

// Rewrites a right file ("stl", "obj", "mtl", "ply", "dae") that assimp 5.2 refuses, misreads or
// crashes on; returns nothing where assimp reads the file itself.
//
//   dae   UTF-16 and Latin-1 become UTF-8; nothing stands before the declaration
//   mtl   without `aniso` and `anisor`, whose names are taken for their numbers
//   obj   `0.5` for `.5`, which is not counted as a number
//   ply   a byte before binary data that begin with the end of a line, else skipped with the
//         header's; unknown elements have the name of one that is skipped
//   stl   text: without solids that are empty
std::optional<std::vector<unsigned char>> readable(std::span<const unsigned char> bytes,
                                                   const std::string& kind);

}  // namespace limpid
