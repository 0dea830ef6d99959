// HDF5 files that anybody may have made. A file of this format can name other files (external
// storage, virtual datasets, links), whose bytes would then be read as its own, and can name code
// to load (filters); it can also claim far more than it stores. Whatever reads such files opens
// them, and what is in them, through this header, which refuses all of that.
#pragma once

#include <cstdint>
#include <filesystem>
#include <set>
#include <string>

#include "devices/files/session/hdf5_handles.h"

namespace limpid::hdf5 {

// Errors: FileError for what is missing, or no regular file (a pipe would make the program wait).
void check_regular_file(const std::filesystem::path& file);

// Of a whole HDF5 file, before it is opened. Errors: as check_regular_file(); FileError for other
// formats and damaged texts (see check_heaps()).
void check_before_opening(const std::filesystem::path& file);

// A file that has been checked that way. Errors: FileError.
File open_to_read(const std::filesystem::path& file);

// Whether there is something at `path`, seen from `root`. Errors: FileError where the way to it is
// not made of hard links only.
bool has(hid_t root, const std::string& path, const std::filesystem::path& file);

// Errors: FileError for what is not there, no dataset (group), not reached by hard links, or stored
// elsewhere than in this file, or packed by a filter that does not belong to HDF5.
Dataset open_dataset(hid_t root, const std::string& path, const std::filesystem::path& file);
Group open_group(hid_t root, const std::string& path, const std::filesystem::path& file);

std::uint64_t physical_memory();  // [bytes]

// What all that is read of one file takes in memory, held against what the file stores.
class Claims {
 public:
  explicit Claims(std::filesystem::path file, std::uint64_t most = physical_memory());

  void stored(const Dataset& dataset);  // will be read; counts once, however many links it has
  // Before memory is taken for it. Errors: FileError where all that was asked for is more than the
  // datasets can unpack to, or than `most`.
  void take(std::uint64_t count, std::uint64_t size, const std::string& what);

 private:
  std::filesystem::path file_;
  std::uint64_t file_size_, most_;
  std::uint64_t stored_ = 0, taken_ = 0;  // [bytes]
  std::set<std::pair<unsigned long, unsigned long>> counted_;
};

}  // namespace limpid::hdf5
