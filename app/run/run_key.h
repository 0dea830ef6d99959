// Keys of programs, files and runs: equal only for what gives the same rows.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>

#include "app/run/simulate.h"

namespace limpid {

// FNV-1a, 64 bits: against accidents, not against malice.
class Digest {
 public:
  void add(const void* bytes, std::size_t count) {
    const auto* byte = static_cast<const unsigned char*>(bytes);
    for (std::size_t i = 0; i < count; ++i) value_ = (value_ ^ byte[i]) * 0x100000001b3;
  }
  void add(double x) { add(&x, sizeof x); }
  void add(std::uint64_t n) { add(&n, sizeof n); }
  // Adds lists with their lengths, so that no two of them run into the same bytes.
  void add(const std::string& text) {
    add(std::uint64_t{text.size()});
    add(text.data(), text.size());
  }
  template <class Numbers>
  void add_all(const Numbers& numbers) {
    add(static_cast<std::uint64_t>(numbers.size()));
    for (const double x : numbers) add(x);
  }

  std::uint64_t value() const { return value_; }

 private:
  std::uint64_t value_ = 0xcbf29ce484222325;
};

// Returns the digest of the file's bytes; nothing if it cannot be read.
std::optional<std::uint64_t> file_digest(const std::filesystem::path& file);

// Returns the key of the running program: another build has another one.
std::uint64_t program_digest();

// Returns the key of a program and all that decides a run: arm, scene and models, hand, rows, seed,
// and for each lane the parameters, their changes and the start.
std::uint64_t trial_key(const RunPlan& plan, std::uint64_t program);

}  // namespace limpid
