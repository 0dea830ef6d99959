// Models of other kinds than glTF are made glTF by a program of their own, limpid-model: what a
// broken file does to the library that reads it stays there.
#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "render/model/load_progress.h"
#include "render/model/reader_limits.h"

namespace limpid {

struct ConvertedModel {
  std::vector<unsigned char> glb;
  std::vector<std::string> warnings;
  bool outside = false;  // files of the folder are in it
};

// `kind`: the suffix, as "stl". Throws std::runtime_error naming the file; LoadCancelled. `part`
// gets up to 0.6.
ConvertedModel convert_model(std::span<const unsigned char> bytes, const std::string& kind,
                             const std::string& name, const std::filesystem::path& folder,
                             const LoadProgress& progress);

// Why the program ended as the status of waitpid() says; empty if all is well.
std::string why_ended(int status, const ReaderLimits& limits);

}  // namespace limpid
