// Files that several programs change: one after the other, and each only its own part.
#pragma once

#include <filesystem>
#include <functional>
#include <string>

namespace limpid {

// Hands `change` the text of the file as it is now, empty where there is none, and puts what it
// returns in the file's place. Nobody else who comes this way reads or writes it meanwhile: they
// lock FILE.lock, which stays. The folder is made if need be. Errors: FileError where it cannot be
// read or written, or where another program holds the lock for more than two seconds; the file is
// then as it was, as it is when `change` throws.
void update_file_under_lock(const std::filesystem::path& file,
                            const std::function<std::string(const std::string& text)>& change);

// Before something else takes the place of a file that cannot be read: its bytes stay beside it, as
// FILE.unread, or with the first number that makes it a new one. Errors: FileError.
void keep_unread(const std::filesystem::path& file);

}  // namespace limpid
