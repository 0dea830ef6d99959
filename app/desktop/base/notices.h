// How a part of the window asks for what can be done in it.
#pragma once

#include <chrono>
#include <deque>
#include <functional>
#include <string>
#include <string_view>

namespace limpid {

// Has a command run, by its id in the table of app/desktop/shell/commands.cpp.
using Act = std::function<void(std::string_view id)>;

// What the window tells its user, for a while.
struct Notice {
  std::string text;
  bool bad = false;
  std::chrono::steady_clock::time_point until = {};
};

class Notices {
 public:
  // What is said again stands there once.
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
