// Local sockets on which a program waits for others.
#pragma once

#include <filesystem>

namespace limpid {

// Makes a socket of `kind`, SOCK_STREAM or the like, that listens under `path`, for its user alone,
// in place of what a killed program has left there. It is under `path` once it listens: whoever
// sees it can connect. `waiting`: connections that may wait for a program to take them. Returns its
// descriptor, which does not block and is closed in programs that are started; -1 with errno if it
// cannot be made.
int listen_under(const std::filesystem::path& path, int kind, int waiting);

}  // namespace limpid
