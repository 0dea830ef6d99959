// Notices that the window shows for a while, and the type of function that runs a command.
#pragma once

#include <chrono>
#include <deque>
#include <functional>
#include <string>
#include <string_view>

namespace limpid {

// Runs a command, by its id in the table of app/desktop/shell/commands.cpp.
using Act = std::function<void(std::string_view id)>;

// Message to the window's user, shown until a moment.
struct Notice {
  std::string text;
  bool bad = false;
  std::chrono::steady_clock::time_point until = {};
};

class Notices {
 public:
  // Shows a text; the same text, if it is shown already, moves to the end.
  void say(std::string text, bool bad = false);
  // Shows a text unless it is shown already.
  void say_once(const std::string& text, bool bad);
  const std::deque<Notice>& all() const { return notices_; }
  // Removes notices whose time is over; to be called once a frame.
  void forget_old();
  void clear() { notices_.clear(); }

 private:
  std::deque<Notice> notices_;
};

}  // namespace limpid
