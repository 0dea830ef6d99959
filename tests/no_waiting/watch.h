// Watch over malloc and its family, and over the mutexes, in the whole program. It counts what a
// thread does while its flag is up.
#pragma once

namespace limpid {

struct Watched {
  bool on = false;
  int allocations = 0, locks = 0;
};
extern thread_local Watched watched;

class Watch {
 public:
  Watch() { watched = {.on = true}; }
  ~Watch() { watched.on = false; }
};

}  // namespace limpid
