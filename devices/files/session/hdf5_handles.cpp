#include "devices/files/session/hdf5_handles.h"

#include <fmt/format.h>

#include <cstdlib>
#include <cstring>

#include "devices/files/file_error.h"

namespace limpid::hdf5 {
namespace {

constexpr std::size_t kLongestText = std::size_t{64} << 20;  // [bytes]

struct Reasons {
  std::string system;
  std::string innermost;
};

// HDF5 hides errno in its text: "file write failed: ..., errno = 28, error message = ...".
herr_t collect(unsigned, const H5E_error2_t* error, void* data) {
  auto& reasons = *static_cast<Reasons*>(data);
  const std::string text = error->desc ? error->desc : "";
  if (reasons.innermost.empty()) reasons.innermost = text;
  const auto at = text.find("errno = ");
  if (reasons.system.empty() && at != std::string::npos) {
    const int code = std::atoi(text.c_str() + at + std::strlen("errno = "));
    if (code != 0) reasons.system = std::strerror(code);
  }
  return 0;
}

[[noreturn]] void refuse(const std::filesystem::path& file, const char* name, const char* found,
                         const char* allowed) {
  throw FileError(
      fmt::format("{}: attribute {}: {}; needed: {}", file.string(), name, found, allowed));
}

// Opens a scalar attribute of one class of type.
Attribute open_scalar(hid_t object, const char* name, H5T_class_t wanted, const char* allowed,
                      const std::filesystem::path& file) {
  if (H5Aexists(object, name) <= 0) refuse(file, name, "missing", allowed);
  Attribute attribute(H5Aopen(object, name, H5P_DEFAULT));
  const Datatype type(H5Aget_type(attribute.get()));
  const Dataspace space(H5Aget_space(attribute.get()));
  if (!attribute || !type || !space) refuse(file, name, "unreadable", allowed);
  if (H5Sget_simple_extent_npoints(space.get()) != 1) {
    refuse(file, name, "not a single value", allowed);
  }
  if (H5Tget_class(type.get()) != wanted) refuse(file, name, "of another type", allowed);
  return attribute;
}

Datatype text_type() {
  Datatype type(H5Tcopy(H5T_C_S1));
  H5Tset_size(type.get(), H5T_VARIABLE);
  H5Tset_cset(type.get(), H5T_CSET_UTF8);
  return type;
}

}  // namespace

std::string last_error() {
  Reasons reasons;
  H5Ewalk2(H5E_DEFAULT, H5E_WALK_UPWARD, &collect, &reasons);
  if (!reasons.system.empty()) return reasons.system;
  return reasons.innermost.empty() ? "HDF5 gives no reason" : reasons.innermost;
}

void check(bool ok, const std::filesystem::path& file, const char* what) {
  if (!ok) throw FileError(fmt::format("{}: {}: {}", file.string(), what, last_error()));
}

void write_texts(hid_t object, const char* name, const std::vector<std::string>& texts,
                 const std::filesystem::path& file) {
  const Datatype type = text_type();
  std::vector<const char*> pointers;
  for (const std::string& text : texts) pointers.push_back(text.c_str());
  const hsize_t count = pointers.size();
  const Dataspace space(H5Screate_simple(1, &count, nullptr));
  const Attribute attribute(
      H5Acreate2(object, name, type.get(), space.get(), H5P_DEFAULT, H5P_DEFAULT));
  check(attribute && H5Awrite(attribute.get(), type.get(), pointers.data()) >= 0, file,
        "cannot write");
}

void write_text(hid_t object, const char* name, const std::string& text,
                const std::filesystem::path& file) {
  const Datatype type = text_type();
  const char* pointer = text.c_str();
  write_scalar(object, name, type.get(), type.get(), &pointer, file);
}

void write_scalar(hid_t object, const char* name, hid_t stored_as, hid_t held_as, const void* value,
                  const std::filesystem::path& file) {
  const Dataspace space(H5Screate(H5S_SCALAR));
  const Attribute attribute(
      H5Acreate2(object, name, stored_as, space.get(), H5P_DEFAULT, H5P_DEFAULT));
  check(attribute && H5Awrite(attribute.get(), held_as, value) >= 0, file, "cannot write");
}

std::string read_text(hid_t object, const char* name, const std::filesystem::path& file) {
  const Attribute attribute = open_scalar(object, name, H5T_STRING, "text", file);
  const Datatype type(H5Aget_type(attribute.get()));
  if (H5Tis_variable_str(type.get()) > 0) {
    char* text = nullptr;
    if (H5Aread(attribute.get(), type.get(), &text) < 0) {
      refuse(file, name, "unreadable", "text");
    }
    const std::string copy = text ? text : "";
    H5free_memory(text);
    return copy;
  }
  if (H5Tget_size(type.get()) > kLongestText) refuse(file, name, "too long", "at most 64 MiB");
  std::string text(H5Tget_size(type.get()), '\0');
  if (H5Aread(attribute.get(), type.get(), text.data()) < 0) {
    refuse(file, name, "unreadable", "text");
  }
  text.resize(std::strlen(text.c_str()));
  return text;
}

std::vector<std::string> read_texts(hid_t object, const char* name, std::size_t most,
                                    const std::filesystem::path& file) {
  constexpr const char* kNeeded = "a list of texts";
  const Attribute attribute(H5Aopen(object, name, H5P_DEFAULT));
  const Datatype type(attribute ? H5Aget_type(attribute.get()) : H5I_INVALID_HID);
  const Dataspace space(attribute ? H5Aget_space(attribute.get()) : H5I_INVALID_HID);
  if (!type || !space) refuse(file, name, "unreadable", kNeeded);
  if (H5Tget_class(type.get()) != H5T_STRING) refuse(file, name, "of another type", kNeeded);
  const hssize_t count = H5Sget_simple_extent_npoints(space.get());
  if (count < 0 || static_cast<std::size_t>(count) > most) {
    refuse(file, name, "too many", kNeeded);
  }
  const auto texts = static_cast<std::size_t>(count);
  std::vector<std::string> all;
  if (H5Tis_variable_str(type.get()) > 0) {
    std::vector<char*> pointers(texts, nullptr);
    if (H5Aread(attribute.get(), type.get(), pointers.data()) < 0) {
      refuse(file, name, "unreadable", kNeeded);
    }
    for (char* text : pointers) {
      all.emplace_back(text ? text : "");
      H5free_memory(text);
    }
    return all;
  }
  const std::size_t length = H5Tget_size(type.get());
  std::string bytes(texts * length, '\0');
  if (H5Aread(attribute.get(), type.get(), bytes.data()) < 0) {
    refuse(file, name, "unreadable", kNeeded);
  }
  for (std::size_t at = 0; at < bytes.size(); at += length) {
    all.emplace_back(bytes.substr(at, length).c_str());
  }
  return all;
}

double read_number(hid_t object, const char* name, const std::filesystem::path& file) {
  const Attribute attribute = open_scalar(object, name, H5T_FLOAT, "a number", file);
  double value = 0;
  if (H5Aread(attribute.get(), H5T_NATIVE_DOUBLE, &value) < 0) {
    refuse(file, name, "unreadable", "a number");
  }
  return value;
}

unsigned long long read_count(hid_t object, const char* name, const std::filesystem::path& file) {
  const Attribute attribute = open_scalar(object, name, H5T_INTEGER, "a whole number", file);
  unsigned long long value = 0;
  if (H5Aread(attribute.get(), H5T_NATIVE_ULLONG, &value) < 0) {
    refuse(file, name, "unreadable", "a whole number");
  }
  return value;
}

}  // namespace limpid::hdf5
