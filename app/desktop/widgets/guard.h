// What throws in a frame becomes a notice, and the next frame comes.
#pragma once

#include <exception>
#include <utility>

namespace limpid {

// Closes whatever ImGui windows, groups and styles an exception left open.
class UiStack {
 public:
  UiStack();
  void unwind() const;

 private:
  int fonts_;
};

// Does `work`; `complain(what)` hears of an exception. Drawing may be left in the middle, if it
// began outside of other ImGui windows.
template <class Work, class Complain>
void guarded(Complain&& complain, Work&& work) {
  const UiStack before;
  try {
    std::forward<Work>(work)();
  } catch (const std::exception& e) {
    before.unwind();
    complain(e.what());
  }
}

}  // namespace limpid
