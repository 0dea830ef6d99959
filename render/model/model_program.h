// limpid-model: the program that turns other models into glTF, and what it may use up.
#pragma once

#include <algorithm>
#include <cstddef>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "core/base/model_kinds.h"
#include "render/model/model.h"

namespace limpid {

struct ReaderLimits {
  std::size_t memory;  // [bytes] of addresses
  unsigned seconds;    // of processor time
};

// Returns the limits for the `bytes` of the model and of all the files that it refers to, as far as
// they are known. Text takes most: a face of an OBJ of 8 bytes is some 400 bytes in the library
// that reads it.
inline ReaderLimits reader_limits(std::size_t bytes) {
  constexpr std::size_t kMost = std::size_t{8} << 30;
  const std::size_t memory = (std::size_t{512} << 20) + 100 * std::min(bytes, kMost);
  return {std::min(memory, kMost), 3 + static_cast<unsigned>(bytes >> 20)};
}

inline std::string too_much_memory(const ReaderLimits& limits) {
  return "needs more than " + std::to_string(limits.memory >> 20) +
         " MiB of memory to be read; this is the limit for a model of its size";
}

inline std::string too_long(const ReaderLimits& limits) {
  return "takes more than " + std::to_string(limits.seconds) +
         " s to be read; this is the limit for a model of its size";
}

// A model of another kind, made glTF by a program of its own: what a broken file does to the
// library that reads it stays there.
struct ConvertedModel {
  std::vector<unsigned char> glb;
  std::vector<std::string> warnings;
  bool outside = false;  // other files of the folder are in it
};

// Makes a model glTF. Throws std::runtime_error naming the file; LoadCancelled. `part` gets up to
// 0.6.
ConvertedModel convert_model(std::span<const unsigned char> bytes, const ModelKind& kind,
                             const std::string& name, const std::filesystem::path& folder,
                             const LoadProgress& progress);

// Returns why the program ended by the status of waitpid(); empty if all is well.
std::string why_ended(int status, const ReaderLimits& limits);

}  // namespace limpid
