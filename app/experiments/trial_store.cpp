#include "app/experiments/trial_store.h"

#include <fmt/format.h>

#include <fstream>
#include <sstream>

#include "app/run/run_key.h"
#include "devices/files/atomic_file.h"

namespace limpid {
namespace {

namespace fs = std::filesystem;

fs::path stamp_of(const fs::path& session) { return fs::path(session).replace_extension(".key"); }

std::string stamp_text(std::uint64_t key, std::uint64_t bytes) {
  return fmt::format("trial {:016x}\nsession {:016x}\n", key, bytes);
}

}  // namespace

void stamp(const fs::path& session, std::uint64_t key) {
  const auto bytes = file_digest(session);
  if (!bytes) throw FileError(session.string() + ": cannot be read");
  const std::string text = stamp_text(key, *bytes);
  write_atomically(stamp_of(session),
                   {reinterpret_cast<const unsigned char*>(text.data()), text.size()});
}

std::optional<Session> stamped_session(const fs::path& file, std::uint64_t key) {
  std::ifstream in(stamp_of(file));
  std::ostringstream said;
  said << in.rdbuf();
  const auto bytes = file_digest(file);
  if (!bytes || said.str() != stamp_text(key, *bytes)) return std::nullopt;
  try {
    return read_session(file);
  } catch (const FileError&) {
    return std::nullopt;
  }
}

}  // namespace limpid
