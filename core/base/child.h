// Child processes, which read strangers' files apart from the process that drives a device.
#pragma once

#include <sys/types.h>

#include <chrono>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

namespace limpid {

// Path of the file that this code is in: the running program, or a library that it has loaded.
std::filesystem::path own_binary();
// Path of Limpid's program `name`: beside that file, else in libexec/limpid above it.
std::filesystem::path own_program(const char* name);

// A descriptor of this process, and its number in the child.
struct Given {
  int here, there;
};

// A running program. It ends at the latest with this object.
class Child {
 public:
  // `words`: the program's path, then its arguments. Besides stdin, stdout and stderr the child has
  // the descriptors of `given`.
  Child(std::vector<std::string> words, std::span<const Given> given);
  ~Child();
  Child(const Child&) = delete;
  Child& operator=(const Child&) = delete;

  bool started() const { return id_ > 0; }
  // Waits for the program's end and returns its status as waitpid() has it; 0: all was well.
  int wait();
  // Waits for the program's end, then kills it; returns its status.
  int end_within(std::chrono::milliseconds longest);
  // Kills the program, and does not wait for its end.
  void kill() noexcept;
  // Kills the program and returns its status; one that was ending by itself keeps its own.
  int end();

 private:
  pid_t id_ = -1;
};

// Says why a program failed, by its status; empty if it did not.
std::string why_failed(int status, const std::string& program);

}  // namespace limpid
