// A question that a program puts to whoever sits at the window, with a choice of answers.
#pragma once

#include <chrono>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace limpid {

class PersonQuestion {
 public:
  static constexpr const char* kTitle = "A question";
  static constexpr std::size_t kMostChoices = 9;  // one a digit key
  struct Answer {
    std::size_t choice = 0;
    double seconds = 0;  // since the question was first drawn
  };

  // At least one choice; ends a question that was there before.
  void ask(std::string text, std::vector<std::string> choices);
  void withdraw() { text_.clear(); }
  bool asking() const { return !text_.empty(); }
  std::size_t choices() const { return choices_.size(); }
  const std::string& choice(std::size_t i) const { return choices_[i]; }
  // Once, when it is there.
  std::optional<Answer> take() { return std::exchange(answer_, std::nullopt); }

  // While `open`: keys 1 to 9 and the mouse answer it, Enter where there is one answer only. An
  // answer clears `open`.
  void draw(bool& open);

 private:
  using Clock = std::chrono::steady_clock;

  std::optional<std::size_t> chosen() const;

  std::string text_;  // empty: none is asked
  std::vector<std::string> choices_;
  std::optional<Clock::time_point> shown_;
  std::optional<Answer> answer_;
};

}  // namespace limpid
