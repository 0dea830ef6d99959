// A maker's shared library, loaded while the program runs.
#pragma once

#include <span>
#include <string>

namespace limpid {

class Library {
 public:
  Library() = default;
  Library(const Library&) = delete;
  Library& operator=(const Library&) = delete;

  // Loads the first of these names or paths that there is; it stays loaded. `where`: words for
  // people that have none of them, about who has it. Throws VendorError that says what is missing,
  // also of the libraries that it needs itself.
  void load(std::span<const std::string> names, const std::string& where);

  // Path of its file, without symbolic links: their names often lack the version.
  const std::string& path() const { return path_; }

  // Gives a function of the library. Throws VendorError if it has none of this name.
  template <class Function>
  void find(const char* name, Function& function) const {
    function = reinterpret_cast<Function>(address(name));
  }
  // The same; leaves `function` as it is if there is none.
  template <class Function>
  void find_if_any(const char* name, Function& function) const {
    if (void* const found = address_if_any(name)) function = reinterpret_cast<Function>(found);
  }

 private:
  void* address(const char* name) const;
  void* address_if_any(const char* name) const;

  void* handle_ = nullptr;
  std::string path_;
};

}  // namespace limpid
