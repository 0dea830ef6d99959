// A question that a program puts to whoever sits at the window, with a choice of answers.
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
  static constexpr std::size_t kMostChoices = 9;  // one a digit key
  struct How {
    bool beside = false;  // below the picture, which can be used meanwhile
    double seconds = 0;   // it goes by itself after so long without an answer; 0: it stays [s]
  };
  struct Answer {
    std::optional<std::size_t> choice;  // none: the time was over
    double seconds = 0;                 // since the question was first drawn
  };

  // Ends a question that was there before. Without choices there is nothing to answer: its time has
  // to end it.
  void ask(std::string text, std::vector<std::string> choices, How how);
  void withdraw();
  bool asking() const { return asks_; }
  bool beside() const { return how_.beside; }
  std::size_t number() const { return number_; }  // of questions so far
  std::size_t choices() const { return choices_.size(); }
  const std::string& choice(std::size_t i) const { return choices_[i]; }
  // Of ImGui's window.
  const char* title() const;
  // Once, when it is there.
  std::optional<Answer> take() { return std::exchange(answer_, std::nullopt); }

  // While `open`, in `view`: keys 1 to 9 and the mouse answer it, Enter where there is one answer
  // only. An answer clears `open`; one that stands beside the picture stays a moment longer, so
  // that it does not flicker where another one follows, and keys that are meant for it go nowhere
  // else.
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
  std::optional<std::size_t> taken_;  // the choice of the answer, while it is shown
  std::optional<Answer> answer_;
};

}  // namespace limpid
