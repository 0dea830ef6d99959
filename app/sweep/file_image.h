// HDF5 files made in memory and put in their place whole.
#pragma once

#include <filesystem>
#include <span>
#include <string>

#include "devices/files/session/hdf5_handles.h"

namespace limpid {

class FileImage {
 public:
  // Errors of all: FileError naming `file`, whose place it will take.
  explicit FileImage(std::filesystem::path file);

  hid_t root() const { return file_.get(); }
  // Rows x width, or a list where the width is 1; without times, so that equal contents are equal
  // bytes. Protected by a checksum.
  hdf5::Dataset add(const std::string& path, hid_t stored_as, hid_t held_as, hsize_t rows,
                    hsize_t width, const void* data);
  void number(hid_t object, const char* name, std::uint64_t value);
  void text(hid_t object, const char* name, const std::string& value);
  void write();

 private:
  hdf5::Quiet quiet_;
  std::filesystem::path path_;
  hdf5::File file_;
};

}  // namespace limpid
