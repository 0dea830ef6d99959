#include "devices/files/session/session_story.h"

#include <fmt/format.h>

#include "devices/files/atomic_file.h"
#include "devices/files/session/hdf5_reading.h"
#include "devices/files/session/session_reader.h"
#include "devices/files/text_file.h"

namespace limpid {

namespace fs = std::filesystem;

namespace {

constexpr const char* kStory = "story";

}  // namespace

namespace {

void write_story(const fs::path& file, const std::string& story) {
  const hdf5::Quiet quiet;
  hdf5::File opened(H5Fopen(file.c_str(), H5F_ACC_RDWR, H5P_DEFAULT));
  hdf5::check(static_cast<bool>(opened), file, "cannot be opened for its story");
  hdf5::write_text(opened.get(), kStory, story, file);
  hdf5::check(H5Fflush(opened.get(), H5F_SCOPE_GLOBAL) >= 0 && opened.close(), file,
              "cannot write its story");
}

}  // namespace

// A copy gets it and takes the session's place once it is whole: the session is there at any
// moment.
void attach_story(const fs::path& session, const std::string& story) {
  fs::path copy = session;
  copy += ".story";
  try {
    std::error_code error;
    if (!fs::copy_file(session, copy, fs::copy_options::overwrite_existing, error)) {
      throw FileError(
          fmt::format("{}: cannot be copied for its story: {}", session.string(), error.message()));
    }
    write_story(copy, story);
    publish(copy, session, true);
  } catch (const FileError&) {
    std::error_code ignored;
    fs::remove(copy, ignored);
    throw;
  }
}

std::string attached_story_here(const fs::path& session) {
  const hdf5::Quiet quiet;
  hdf5::check_regular_file(session);
  const hdf5::File file(H5Fopen(session.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT));
  if (!file || H5Aexists(file.get(), kStory) <= 0) return {};
  return hdf5::read_text(file.get(), kStory, session);
}

}  // namespace limpid
