// The one error of everything that reads or writes files.
#pragma once

#include <stdexcept>

namespace limpid {

// A file that cannot be read or written; what() names it and says why.
struct FileError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

}  // namespace limpid
