// A program that records until it is killed.
#pragma once

#include <fcntl.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <stdexcept>
#include <thread>

#include "devices/files/session/session.h"
#include "tests/devices/files/session/sample_session.h"

namespace limpid::test {

// Writes for ever in a child process and reports through a pipe how many rows are handed over.
class EndlessRecording {
 public:
  explicit EndlessRecording(const std::filesystem::path& out) {
    int ends[2];
    if (pipe2(ends, O_CLOEXEC) != 0) throw std::runtime_error("pipe");
    told_ = ends[0];
    child_ = fork();
    if (child_ == 0) write_for_ever(out, ends[1]);
    close(ends[1]);
  }
  ~EndlessRecording() { close(told_); }
  EndlessRecording(const EndlessRecording&) = delete;
  EndlessRecording& operator=(const EndlessRecording&) = delete;

  // Kills the process after so many rows and a time; returns the rows handed over until then.
  std::uint64_t kill_after(std::uint64_t rows, std::chrono::microseconds more) {
    std::uint64_t handed = 0;
    while (handed < rows && read(told_, &handed, sizeof handed) == sizeof handed) {
    }
    std::this_thread::sleep_for(more);
    kill(child_, SIGKILL);
    waitpid(child_, nullptr, 0);
    while (read(told_, &handed, sizeof handed) == sizeof handed) {
    }
    return handed;
  }

 private:
  [[noreturn]] static void write_for_ever(const std::filesystem::path& out, int tell) {
    try {
      SessionWriter writer(out, sample_info(), false);
      const RowLayout layout(3);
      for (;;) {
        const std::uint64_t before = writer.rows_written();
        if (before % 1000 == 0) writer.append(SettingChange{before, "coupling.eta = 1"});
        writer.append(sample_rows(layout, before, 50));
        const std::uint64_t now = writer.rows_written();
        if (write(tell, &now, sizeof now) < 0) break;
      }
    } catch (const std::exception&) {
    }
    _exit(1);
  }

  int told_ = -1;
  pid_t child_ = -1;
};

}  // namespace limpid::test
