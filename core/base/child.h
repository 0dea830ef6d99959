// Programs that read what strangers made, apart from the one that is at a device.
#pragma once

#include <sys/types.h>

#include <filesystem>
#include <span>
#include <string>
#include <vector>

namespace limpid {

// Where a program of this name lies: beside the one that runs.
std::filesystem::path beside_this_program(const char* name);

// A descriptor of this process, and the number that it has in the other.
struct Given {
  int here, there;
};

// A program at work. It ends at the latest with this object.
class Child {
 public:
  // `words`: the program's path, then what it is told. Besides stdin, stdout and stderr it has
  // the descriptors of `given`.
  Child(std::vector<std::string> words, std::span<const Given> given);
  ~Child();
  Child(const Child&) = delete;
  Child& operator=(const Child&) = delete;

  bool started() const { return id_ > 0; }
  // Until it has ended: its status, as waitpid() has it; 0 if all was well.
  int wait();
  // At once. The status of one that was ending by itself is its own.
  int end();

 private:
  pid_t id_ = -1;
};

// Why a program failed, as its status says; empty if it did not.
std::string why_failed(int status, const std::string& program);

}  // namespace limpid
