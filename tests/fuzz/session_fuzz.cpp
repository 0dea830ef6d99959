// Any bytes at all as a session file: rows that hold together and texts that are read as they are
// in a replay, or one line for people. The first byte says whether it is the leftover of a
// recording.
#include <unistd.h>

#include <cstdlib>
#include <fstream>

#include "devices/files/arm/urdf_file.h"
#include "devices/files/config/config_file.h"
#include "devices/files/file_error.h"
#include "devices/files/hand/hand_file.h"
#include "devices/files/scene/scene_file.h"
#include "devices/files/session/session.h"
#include "devices/files/session/session_story.h"

namespace {

namespace fs = std::filesystem;

void demand(bool holds) {
  if (!holds) std::abort();
}

// What `work` refuses is one line.
template <class Work>
void attempt(Work work) {
  try {
    work();
  } catch (const limpid::FileError& error) {
    demand(std::string(error.what()).find('\n') == std::string::npos);
  }
}

void check(const limpid::Session& session) {
  demand(session.rows.size() == session.size() * static_cast<std::size_t>(session.layout.stride()));
  for (const limpid::SettingChange& change : session.changes) demand(change.row <= session.size());
  if (session.twin) demand(session.twin->size() == session.size());
}

void read_texts(const limpid::Session& session) {
  limpid::Parameters parameters;
  attempt([&] { limpid::apply_config_text(parameters, session.info.config, "fuzz.h5"); });
  const limpid::ArmDescription arm = limpid::parse_urdf(session.info.device_urdf, "fuzz.h5", "");
  limpid::parse_scene(session.info.scene, "fuzz.h5", "", arm, session.info.models);
}

// In memory, under a name of this process' own.
fs::path file_of(const char* suffix) {
  return fs::path("/dev/shm") / ("session_fuzz-" + std::to_string(getpid()) + suffix);
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const unsigned char* data, std::size_t size) {
  if (size == 0) return 0;
  const fs::path file = file_of(data[0] % 2 ? ".h5.part" : ".h5");
  std::ofstream(file, std::ios::binary)
      .write(reinterpret_cast<const char*>(data + 1), static_cast<std::streamsize>(size - 1));
  attempt([&] {
    const limpid::Session session = limpid::read_session(file);
    check(session);
    attempt([&] { limpid::attached_story(file); });
    attempt([&] { limpid::hand_of(session, "fuzz.h5"); });
    read_texts(session);
  });
  fs::remove(file);
  return 0;
}
