// What the window tells its user, for a while.
#pragma once

#include <chrono>
#include <deque>
#include <string>

namespace limpid {

struct Notice {
  std::string text;
  bool bad = false;
  std::chrono::steady_clock::time_point until = {};
};

class Notices {
 public:
  void say(std::string text, bool bad = false);
  // Not what is being said already.
  void say_once(const std::string& text, bool bad);
  const std::deque<Notice>& all() const { return notices_; }
  // Once a frame.
  void forget_old();
  void clear() { notices_.clear(); }

 private:
  std::deque<Notice> notices_;
};

}  // namespace limpid
