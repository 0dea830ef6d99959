#include "app/desktop/shell/marking.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace limpid {

// Counts the marks of what is recorded or played, else all in the plots.
std::size_t Marking::count() const {
  if (playback_.on()) return playback_.shown()->marks().size();
  const auto& marks = live_.stage().history.marks();
  auto first = marks.begin();
  if (live_.loop().recording()) {
    first = std::ranges::find(marks.rbegin(), marks.rend(), kRecordingMark, &PlotMark::key).base();
  }
  return static_cast<std::size_t>(std::count_if(
      first, marks.end(), [](const PlotMark& mark) { return mark.key == kNoteMark; }));
}

void Marking::begin() {
  which_.reset();
  text_ = fmt::format("mark {}", count() + 1);
  if (const PlayedSession* session = playback_.shown()) {
    const Player& player = session->player();
    const auto mouse = session->stage().group.hovered();
    const double at = mouse.value_or(player.time()) / player.session().info.tick;
    tick_ = std::min(static_cast<std::uint64_t>(std::max(0.0, std::round(at))),
                     static_cast<std::uint64_t>(player.session().size() - 1));
    if (!mouse) tick_ = player.index();
  } else {
    moment_ = live_.now();
    const History& history = live_.stage().history;
    if (const auto mouse = live_.stage().group.hovered(); mouse && !history.empty()) {
      const SampleIndex at = history.nearest(*mouse);
      const SampleIndex back = history.end() - 1 - at;
      moment_.time = history.time(at);
      // Rows of the plots and of the recording are the same ticks, as long as it goes on.
      if (moment_.row && back > *moment_.row) moment_.row.reset();
      if (moment_.row) *moment_.row -= back;
    }
  }
  dialog_.open("mark");
}

void Marking::edit(std::size_t which) {
  if (!playback_.on() || which >= playback_.shown()->marks().size()) return;
  which_ = which;
  const Mark& mark = playback_.shown()->marks()[which];
  tick_ = mark.tick;
  text_ = mark.text;
  dialog_.open("mark");
}

std::string Marking::when() const {
  if (playback_.on()) {
    const double tick = playback_.shown()->player().session().info.tick;
    return fmt::format("at {:.3f} s; kept in {}", static_cast<double>(tick_) * tick,
                       playback_.shown()->file().filename().string());
  }
  const double time = moment_.time - live_.stage().history.offset();
  return fmt::format("at {:.3f} s; {}", time,
                     moment_.row ? "kept in the recording" : "only in the plots (no recording)");
}

void Marking::accept(const std::string& text) {
  PlayedSession* session = playback_.shown();
  if (session == nullptr) return live_.note(moment_, text);
  Marks marks = session->marks();
  if (which_ && *which_ < marks.size()) {
    marks[*which_].text = text;
  } else {
    marks.push_back({tick_, text});
  }
  change(std::move(marks));
}

void Marking::remove() {
  if (!playback_.on() || !which_) return;
  Marks marks = playback_.shown()->marks();
  if (*which_ >= marks.size()) return;
  marks.erase(marks.begin() + static_cast<std::ptrdiff_t>(*which_));
  change(std::move(marks));
}

void Marking::go(int direction) {
  PlayedSession* session = playback_.shown();
  if (session == nullptr) return;
  const std::uint64_t now = session->player().index();
  const Mark* found = nullptr;
  for (const Mark& mark : session->marks()) {
    if (direction > 0 && mark.tick > now && found == nullptr) found = &mark;
    if (direction < 0 && mark.tick < now) found = &mark;
  }
  if (found == nullptr) {
    return notices_.say_once(direction > 0 ? "There is no mark after this moment."
                                           : "There is no mark before this moment.",
                             false);
  }
  session->player().seek(session->time_of(*found));
}

bool Marking::last() const {
  return playback_.on() && playback_.shown()->file() == file_ && then_ == settings_.parameters();
}

void Marking::change(Marks marks) {
  PlayedSession& session = *playback_.shown();
  if (std::exchange(file_, session.file()) != session.file()) done_.clear(), known_.clear();
  undone_.clear();
  const Marks& before = session.marks();
  known_.insert(known_.end(), before.begin(), before.end());
  done_.push_back(session.marks());
  session.show(std::move(marks));
  save(session.marks());  // show() has put them into the order of their ticks
}

void Marking::step(std::vector<Marks>& from, std::vector<Marks>& to) {
  PlayedSession* session = playback_.shown();
  if (!last() || from.empty()) return;
  to.push_back(session->marks());
  known_.insert(known_.end(), to.back().begin(), to.back().end());
  session->show(from.back());
  save(std::exchange(from.back(), {}));
  from.pop_back();
}

// Writes the marks beside the window, after earlier changes. If that fails, they stay in the plots,
// and a notice says so.
void Marking::save(Marks marks) {
  then_ = settings_.parameters();
  live_.save_beside([file = playback_.shown()->file(), marks = std::move(marks), known = known_] {
    try {
      write_marks(file, marks, known);
      return PlotNotice{fmt::format("The marks are kept in {}.", file.filename().string())};
    } catch (const std::exception& e) {
      return PlotNotice{fmt::format("{}. The marks are in the plots only.", e.what()), true};
    }
  });
}

}  // namespace limpid
