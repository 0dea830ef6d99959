#include "devices/vendor/library.h"

#include <dlfcn.h>
#include <fmt/format.h>
#include <link.h>

#include <filesystem>

#include "devices/vendor/back_end.h"

namespace limpid {
namespace {

// The library that cannot be found, in the loader's "NAME: cannot open shared object file: ...";
// empty if the error is another one.
std::string not_found(const std::string& error) {
  const auto end = error.find(": cannot open shared object file");
  return end == std::string::npos ? std::string() : error.substr(0, end);
}

// Words on how to install a library that makers' libraries need. One command is in quotes: the
// window copies it. tests/system/test_vendor.py holds devices/README.md to these words.
const char* how_to_install(const std::string& library) {
  if (library.starts_with("libncurses.so.5") || library.starts_with("libtinfo.so.5")) {
    return "Debian 12 has it in libncurses5. Debian 13 does not have it; install the packages of "
           "Debian 12 there: 'wget "
           "https://deb.debian.org/debian/pool/main/n/ncurses/libtinfo5_6.4-4_amd64.deb "
           "https://deb.debian.org/debian/pool/main/n/ncurses/libncurses5_6.4-4_amd64.deb && sudo "
           "apt install ./libtinfo5_6.4-4_amd64.deb ./libncurses5_6.4-4_amd64.deb'";
  }
  if (library.starts_with("libusb-1.0")) return "'sudo apt install libusb-1.0-0'";
  return "it comes with the maker's software";
}

}  // namespace

void Library::load(std::span<const std::string> names, const std::string& where) {
  std::string other;
  for (const std::string& name : names) {
    handle_ = ::dlopen(name.c_str(), RTLD_NOW | RTLD_GLOBAL);
    if (handle_ != nullptr) {
      link_map* map = nullptr;
      path_ = ::dlinfo(handle_, RTLD_DI_LINKMAP, &map) == 0 && map != nullptr ? map->l_name : name;
      std::error_code none;
      const auto file = std::filesystem::canonical(path_, none);
      if (!none) path_ = file.string();
      return;
    }
    const char* const said = ::dlerror();
    const std::string error = said != nullptr ? said : "cannot be loaded";
    const std::string missing = not_found(error);
    if (missing == name) continue;
    if (other.empty()) {
      other = missing.empty() ? fmt::format("{} cannot be loaded: {}", name, error)
                              : fmt::format("{} needs {}, which is not installed: {}", name,
                                            missing, how_to_install(missing));
    }
  }
  if (!other.empty()) throw VendorError(other);
  throw VendorAbsent(fmt::format("{} is not installed; {}", names.front(), where));
}

void* Library::address_if_any(const char* name) const { return ::dlsym(handle_, name); }

void* Library::address(const char* name) const {
  void* const found = address_if_any(name);
  if (found == nullptr) throw VendorError(fmt::format("{} has no function {}", path_, name));
  return found;
}

}  // namespace limpid
