// Fuzzes the answers of limpid-session, as if a file had taken it over: any bytes give consistent
// rows and texts readable in a replay, or an error of one line. The first byte chooses a session or
// a table.
#include <sys/mman.h>
#include <unistd.h>

#include <cstdlib>

#include "devices/files/config_file.h"
#include "devices/files/scene/scene_file.h"
#include "devices/files/session/hand_file.h"
#include "devices/files/session/session_program.h"
#include "devices/files/session/session_reader.h"
#include "devices/files/text_file.h"
#include "devices/files/urdf_file.h"

namespace {

void demand(bool holds) {
  if (!holds) std::abort();
}

// Runs `work`; an error must be one line.
template <class Work>
void attempt(Work work) {
  try {
    work();
  } catch (const limpid::FileError& error) {
    demand(std::string(error.what()).find('\n') == std::string::npos);
  } catch (const limpid::wire::Broken&) {
  }
}

void check(const limpid::Session& session) {
  demand(session.rows.size() == session.size() * static_cast<std::size_t>(session.layout.stride()));
  for (const limpid::SettingChange& change : session.changes) demand(change.row <= session.size());
  for (std::size_t i = 0; i < session.lanes(); ++i) {
    demand(session.lane(i).size() == session.size());
  }
  limpid::check_rows(session, "fuzz.h5");
}

void read_texts(const limpid::Session& session) {
  limpid::Parameters parameters;
  attempt([&] { limpid::apply_config_text(parameters, session.info.config, "fuzz.h5"); });
  const limpid::ArmDescription arm = limpid::parse_urdf(session.info.device_urdf, "fuzz.h5", "");
  limpid::parse_scene(session.info.scene, "fuzz.h5", "", arm, session.info.models);
}

void take_in(limpid::wire::Reader from) {
  if (from.number<limpid::wire::Answer>() != limpid::wire::Answer::contents) {
    throw limpid::FileError(from.text());
  }
  const limpid::Session session = limpid::wire::take_session(from);
  check(session);
  attempt([&] { limpid::hand_of(session, "fuzz.h5"); });
  read_texts(session);
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const unsigned char* data, std::size_t size) {
  constexpr std::uint64_t kMost = 1 << 24;
  static const int file = memfd_create("answer", 0);
  if (size == 0 || file < 0) return 0;
  if (ftruncate(file, 0) != 0 || pwrite(file, data + 1, size - 1, 0) < 0) return 0;
  lseek(file, 0, SEEK_SET);
  limpid::wire::Reader from(file, kMost);
  if (data[0] % 2) {
    attempt([&] { limpid::wire::take_table(from); });
  } else {
    attempt([&] { take_in(from); });
  }
  return 0;
}
