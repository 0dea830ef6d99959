// What assimp 5.2 refuses, or crashes on, although it is right.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

namespace limpid {

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
