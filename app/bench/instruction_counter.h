// Counts the instructions of the calling thread, where processor and system let one.
#pragma once

#include <cstdint>
#include <optional>

namespace limpid::bench {

class InstructionCounter {
 public:
  InstructionCounter();
  InstructionCounter(const InstructionCounter&) = delete;
  InstructionCounter& operator=(const InstructionCounter&) = delete;
  ~InstructionCounter();

  bool counts() const { return file_ >= 0; }
  // Of `work`, without what the system does for it.
  template <class Work>
  void count(Work&& work) {
    start();
    work();
    stop();
  }
  // All so far; nothing where they cannot be counted.
  std::optional<std::uint64_t> total() const;

 private:
  void start() const;
  void stop() const;

  int file_;
};

}  // namespace limpid::bench
