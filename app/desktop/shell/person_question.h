// Question of a program to the person at the window, with a choice of answers.
#pragma once

#include <chrono>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "app/plot/plot_frame.h"

namespace limpid {

class PersonQuestion {
 public:
  static constexpr std::size_t kMostChoices = 9;  // one for each digit key
  struct How {
    bool beside = false;  // below the picture, which can be used meanwhile
    double seconds = 0;   // time until it ends without an answer; 0: it stays [s]
  };
  struct Answer {
    std::optional<std::size_t> choice;  // none: the time was over
    double seconds = 0;                 // since the question was first drawn
  };

  // Asks a question in place of the present one. Without choices only its time can end it.
  void ask(std::string text, std::vector<std::string> choices, How how);
  void withdraw();
  bool asking() const { return asks_; }
  bool beside() const { return how_.beside; }
  std::size_t number() const { return number_; }  // number of questions so far
  std::size_t choices() const { return choices_.size(); }
  const std::string& choice(std::size_t i) const { return choices_[i]; }
  // Returns the title of ImGui's window.
  const char* title() const;
  // Returns the answer, once.
  std::optional<Answer> take() { return std::exchange(answer_, std::nullopt); }

  // Draws the question in `view` while `open`. Keys 1 to 9 and the mouse answer it, and Enter a
  // single choice. An answer clears `open`. A question beside the picture stays a moment longer: it
  // does not flicker if another follows, and keys for it go nowhere else.
  void draw(bool& open, ScreenRect view);

 private:
  using Clock = std::chrono::steady_clock;

  bool begin(bool& open, ScreenRect view) const;
  std::optional<std::size_t> chosen() const;
  std::optional<std::size_t> draw_choices(float room) const;
  void draw_time() const;
  void end_with(std::optional<std::size_t> choice);
  double seconds_since(Clock::time_point time) const;

  bool asks_ = false;
  std::size_t number_ = 0;
  std::string text_;
  std::vector<std::string> choices_;
  How how_;
  std::optional<Clock::time_point> shown_, answered_;
  std::optional<std::size_t> taken_;  // choice of the answer, while it is shown
  std::optional<Answer> answer_;
};

}  // namespace limpid
