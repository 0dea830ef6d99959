// HDF5 files that anybody may have made, read with distrust; owners of HDF5's identifiers.
//
// A file of this format can name other files (external storage, virtual datasets, links), whose
// bytes would be read as its own. It can name code to load (filters), and claim far more than it
// stores. Such files, and what is in them, are opened through this header, which refuses all that.
#pragma once

#include <hdf5.h>

#include <cstdint>
#include <filesystem>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "core/base/large_memory.h"

namespace limpid::hdf5 {

// Owns one identifier; `Close` is its H5?close.
template <herr_t (*Close)(hid_t)>
class Handle {
 public:
  Handle() = default;
  explicit Handle(hid_t id) : id_(id) {}
  Handle(Handle&& other) noexcept : id_(std::exchange(other.id_, H5I_INVALID_HID)) {}
  Handle& operator=(Handle&& other) noexcept {
    std::swap(id_, other.id_);
    return *this;
  }
  ~Handle() { close(); }

  // Returns whether closing worked; an identifier is closed at most once.
  bool close() { return id_ < 0 || Close(std::exchange(id_, H5I_INVALID_HID)) >= 0; }
  void leave_open() { id_ = H5I_INVALID_HID; }
  hid_t get() const { return id_; }
  explicit operator bool() const { return id_ >= 0; }

 private:
  hid_t id_ = H5I_INVALID_HID;
};

using File = Handle<H5Fclose>;
using Group = Handle<H5Gclose>;
using Dataset = Handle<H5Dclose>;
using Dataspace = Handle<H5Sclose>;
using Datatype = Handle<H5Tclose>;
using Attribute = Handle<H5Aclose>;
using Properties = Handle<H5Pclose>;

// Keeps HDF5 from printing on this thread while it lives. Every public entry to HDF5 code holds
// one, first. It also keeps HDF5 from cleaning up at the program's end, which never finishes after
// a failed write; files are closed long before.
class Quiet {
 public:
  Quiet() {
    H5dont_atexit();
    H5PLset_loading_state(0);  // files can name filters: code to load
    H5Eget_auto2(H5E_DEFAULT, &print_, &data_);
    H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);
  }
  ~Quiet() { H5Eset_auto2(H5E_DEFAULT, print_, data_); }
  Quiet(const Quiet&) = delete;
  Quiet& operator=(const Quiet&) = delete;

 private:
  H5E_auto2_t print_ = nullptr;
  void* data_ = nullptr;
};

// The reason why the last HDF5 call on this thread failed: the system's ("No space left on device")
// if there is one, else that of HDF5's innermost function.
std::string last_error();

// The same of opening a file, or that it is shorter than it says.
std::string why_not_opened(const std::filesystem::path& file);

// Throws FileError "FILE: WHAT: reason" unless `ok`.
void check(bool ok, const std::filesystem::path& file, const char* what);

// Writes a scalar UTF-8 attribute of any length, which h5py reads as str.
void write_text(hid_t object, const char* name, const std::string& text,
                const std::filesystem::path& file);
// Writes a list of such texts.
void write_texts(hid_t object, const char* name, const std::vector<std::string>& texts,
                 const std::filesystem::path& file);
void write_scalar(hid_t object, const char* name, hid_t stored_as, hid_t held_as, const void* value,
                  const std::filesystem::path& file);

// Read attributes. Errors: FileError if there is no such attribute or it is of another kind.
std::string read_text(hid_t object, const char* name, const std::filesystem::path& file);
// Reads at most `most` texts.
std::vector<std::string> read_texts(hid_t object, const char* name, std::size_t most,
                                    const std::filesystem::path& file);
double read_number(hid_t object, const char* name, const std::filesystem::path& file);
unsigned long long read_count(hid_t object, const char* name, const std::filesystem::path& file);

// Walks a file's "global heaps", which hold text of variable length: HDF5 has no checksums for
// them, and a damaged one makes it loop for ever. Errors: FileError for a heap whose objects do not
// fill it exactly.
void check_heaps(const std::filesystem::path& file);

// Checks a file before it is opened. Errors: FileError if it is missing, or no regular file (a pipe
// would make the program wait).
void check_regular_file(const std::filesystem::path& file);

// Checks a whole HDF5 file before it is opened. Errors: as check_regular_file(); FileError for
// other formats and damaged texts (see check_heaps()).
void check_before_opening(const std::filesystem::path& file);

// Opens a file that has passed check_before_opening(). Errors: FileError.
File open_to_read(const std::filesystem::path& file);

// Returns whether there is something at `path`, seen from `root`. Errors: FileError if the path has
// other than hard links.
bool has(hid_t root, const std::string& path, const std::filesystem::path& file);

// Open a dataset or a group. Errors: FileError for what does not exist, is of another kind, is not
// reached by hard links, or is stored outside of this file; for filters that do not belong to HDF5.
Dataset open_dataset(hid_t root, const std::string& path, const std::filesystem::path& file);
Group open_group(hid_t root, const std::string& path, const std::filesystem::path& file);

// Memory claimed by all that is read of one file, limited by what the file stores.
class Claims {
 public:
  explicit Claims(std::filesystem::path file, std::uint64_t most = physical_memory());

  void stored(const Dataset& dataset);  // will be read; counts once, however many links it has
  // Announces values that are read in turn. Errors: FileError if all of them together are more than
  // the datasets can unpack to.
  void pass(std::uint64_t count, std::uint64_t size, const std::string& what);
  // Announces values that are all in memory at once. Errors: as pass(), and for more than `most`.
  void take(std::uint64_t count, std::uint64_t size, const std::string& what);

 private:
  std::filesystem::path file_;
  std::uint64_t file_size_, most_;
  std::uint64_t stored_ = 0, passed_ = 0, taken_ = 0;  // [bytes]
  std::set<std::pair<unsigned long, unsigned long>> counted_;
};

}  // namespace limpid::hdf5
