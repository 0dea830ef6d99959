#include "devices/files/session/session_program.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <csignal>

#include "core/process/child.h"
#include "core/process/descriptor.h"
#include "devices/files/session/hdf5_reading.h"
#include "devices/files/session/session.h"
#include "devices/files/session/session_reader.h"
#include "devices/files/session/session_source.h"
#include "devices/files/session/session_story.h"

namespace limpid {
namespace {

namespace fs = std::filesystem;

constexpr int kPipeBytes = 1 << 20;

// Empty for one that was ended because nobody wanted to hear more.
std::string why_ended(int status) {
  if (WIFSIGNALED(status) && WTERMSIG(status) == SIGKILL) return {};
  if (WIFSIGNALED(status) && WTERMSIG(status) == SIGXCPU) {
    return "takes far longer to be read than a file of its size needs";
  }
  return why_failed(status, kSessionProgram);
}

// What the program says of `file`, as `take` understands it.
template <class Take>
auto ask(const char* what, const fs::path& file, Take take) {
  std::array<int, 2> ends{-1, -1};
  if (::pipe2(ends.data(), O_CLOEXEC) != 0) {
    refuse(file, "cannot be read, there are too many open files");
  }
  const Descriptor answers(ends[0]);
  Descriptor other_end(ends[1]);
  ::fcntl(*answers, F_SETPIPE_SZ, kPipeBytes);
  const std::string at = beside_this_program(kSessionProgram).string();
  const std::array given{Given{*other_end, STDOUT_FILENO}};
  Child child({at, what, file.string()}, given);
  if (!child.started()) {
    refuse(file,
           fmt::format("cannot be read: the program {}, which reads it, cannot be started", at));
  }
  other_end.close();
  try {
    wire::Reader from(*answers, hdf5::physical_memory());
    if (from.number<wire::Answer>() != wire::Answer::contents) throw FileError(from.text());
    return take(from);
  } catch (const wire::Broken& broken) {
    const std::string why = why_ended(child.end());
    refuse(file,
           why.empty() ? fmt::format("what reads it answers wrongly: {}", broken.what()) : why);
  } catch (const std::bad_alloc&) {
    refuse(file, "larger than this computer's memory");
  }
}

}  // namespace

Session read_session(const fs::path& file) {
  return ask("session", file, [&](wire::Reader& from) {
    Session session = wire::take_session(from);
    check_rows(session, file);
    if (session.twin) check_rows(*session.twin, file);
    return session;
  });
}

std::string attached_story(const fs::path& session) {
  return ask("story", session, [](wire::Reader& from) { return from.text(); });
}

wire::Table read_table(const fs::path& file) {
  return ask("table", file, [](wire::Reader& from) { return wire::take_table(from); });
}

}  // namespace limpid
