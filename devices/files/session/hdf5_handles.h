// Small owners of HDF5 identifiers, and HDF5's errors as messages for people.
#pragma once

#include <hdf5.h>

#include <filesystem>
#include <string>
#include <utility>
#include <vector>

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

  // Whether closing worked; an identifier is closed once at most.
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

// While it lives, HDF5 prints nothing on this thread. Every public entry to HDF5 code holds one,
// first: HDF5 must not clean up when the program ends (files are closed long before), because
// after a failed write it never gets done with it.
class Quiet {
 public:
  Quiet() {
    H5dont_atexit();
    H5PLset_loading_state(0);  // files can name filters, which are code that HDF5 would look for
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

// Why the last HDF5 call on this thread failed: the system's reason ("No space left on device")
// if there is one, else what HDF5's innermost function said.
std::string last_error();

// Throws FileError "FILE: WHAT: reason" unless `ok`.
void check(bool ok, const std::filesystem::path& file, const char* what);

// A scalar UTF-8 attribute of any length, which h5py reads as str.
void write_text(hid_t object, const char* name, const std::string& text,
                const std::filesystem::path& file);
// A list of such texts.
void write_texts(hid_t object, const char* name, const std::vector<std::string>& texts,
                 const std::filesystem::path& file);
void write_scalar(hid_t object, const char* name, hid_t stored_as, hid_t held_as, const void* value,
                  const std::filesystem::path& file);

// Errors of the readers: FileError if there is no such attribute or it is of another kind.
std::string read_text(hid_t object, const char* name, const std::filesystem::path& file);
// At most `most` of them.
std::vector<std::string> read_texts(hid_t object, const char* name, std::size_t most,
                                    const std::filesystem::path& file);
double read_number(hid_t object, const char* name, const std::filesystem::path& file);
unsigned long long read_count(hid_t object, const char* name, const std::filesystem::path& file);

}  // namespace limpid::hdf5
