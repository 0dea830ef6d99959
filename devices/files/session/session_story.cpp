#include "devices/files/session/session_story.h"

#include "devices/files/session/hdf5_reading.h"

namespace limpid {
namespace {

constexpr const char* kStory = "story";

}  // namespace

void attach_story(const std::filesystem::path& session, const std::string& story) {
  const hdf5::Quiet quiet;
  hdf5::File file(H5Fopen(session.c_str(), H5F_ACC_RDWR, H5P_DEFAULT));
  hdf5::check(static_cast<bool>(file), session, "cannot be opened for its story");
  hdf5::write_text(file.get(), kStory, story, session);
  hdf5::check(file.close(), session, "cannot write its story");
}

std::string attached_story(const std::filesystem::path& session) {
  const hdf5::Quiet quiet;
  hdf5::check_regular_file(session);
  const hdf5::File file(H5Fopen(session.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT));
  if (!file || H5Aexists(file.get(), kStory) <= 0) return {};
  return hdf5::read_text(file.get(), kStory, session);
}

}  // namespace limpid
