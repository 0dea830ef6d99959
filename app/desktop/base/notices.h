// Notices that the window shows for a while, and the type of function that runs a command.
#pragma once

#include <chrono>
#include <cstddef>
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
  std::chrono::system_clock::time_point said = {};
};

class Notices {
 public:
  // Shows a text; the same text, if it is shown already, moves to the end.
  void say(std::string text, bool bad = false);
  // Shows a text unless it is shown already.
  void say_once(const std::string& text, bool bad);
  const std::deque<Notice>& all() const { return notices_; }
  // Returns all that was said since the start, the last kKept of it, oldest first.
  const std::deque<Notice>& past() const { return past_; }
  // Removes notices whose time is over; to be called once a frame.
  void forget_old();
  void clear() { notices_.clear(); }

  static constexpr std::size_t kKept = 200;

 private:
  std::deque<Notice> notices_, past_;
};

}  // namespace limpid
