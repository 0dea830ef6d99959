// limpid-session: reads an HDF5 file of anybody and tells its contents. A broken or hostile file
// may make HDF5's library end this program, not the one at a device.
//
//   limpid-session session|table FILE >answer
//   limpid-session marks FILE <order 3<>copy >answer
//
// The program can reach only FILE (see sandbox.h), and descriptor 3, a copy of FILE, which gets the
// marks. session_program.h has order and answer.
#include <sys/resource.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cstdio>
#include <cstdlib>
#include <string_view>

#include "core/base/sandbox.h"
#include "devices/files/session/session_marks.h"
#include "devices/files/session/session_reader.h"

namespace {

// Limits processor time, as some broken files are read for ever. A mebibyte packed as tightly as
// possible takes 10 s.
void limit_self(const char* file) {
  struct stat about {};
  const rlim_t mebibytes = stat(file, &about) == 0 ? static_cast<rlim_t>(about.st_size >> 20) : 0;
  const rlimit none{0, 0}, seconds{60 + 10 * mebibytes, 60 + 10 * mebibytes};
  setrlimit(RLIMIT_CORE, &none);
  setrlimit(RLIMIT_CPU, &seconds);
}

void answer(std::string_view what, const char* file, limpid::wire::Writer& to) {
  using limpid::wire::Answer;
  if (what == "session") {
    const limpid::Session rest = limpid::read_session_here(
        file,
        [&](const limpid::Session& about, std::uint64_t rows) {
          to.number(Answer::contents);
          put_about(to, about, rows);
        },
        [&](limpid::LaneRows rows) { put_rows(to, rows); });
    put_rest(to, rest);
  } else if (what == "marks") {
    limpid::wire::Reader from(STDIN_FILENO, limpid::physical_memory());
    limpid::write_marks_here(file, limpid::kCopyToChange, limpid::wire::take_order(from));
    to.number(Answer::contents);
    to.number(std::uint8_t{0});
  } else {
    const limpid::wire::Table table = limpid::read_table_here(file);
    to.number(Answer::contents);
    put_table(to, table);
  }
}

}  // namespace

int main(int count, char** words) {
  if (count != 3) {
    std::fputs("limpid-session belongs to limpid, which calls it.\n", stderr);
    return 2;
  }
  limpid::wire::Writer to(STDOUT_FILENO);
  // Switches off HDF5's locks, which would only keep out permitted readers.
  setenv("HDF5_USE_FILE_LOCKING", "FALSE", 1);
  try {
    limit_self(words[2]);
    limpid::enter_sandbox(words[2]);
    answer(words[1], words[2], to);
    return 0;
  } catch (const limpid::wire::Broken&) {
    return 1;
  } catch (const std::exception& e) {
    to.number(limpid::wire::Answer::refusal);
    to.text(e.what());
    return 0;
  }
}
