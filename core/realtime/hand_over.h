// Things that are built beside the running loop, taken in by it, and given back to be destroyed.
#pragma once

#include <atomic>
#include <memory>

namespace limpid {

// One owner (the window) offers, the loop takes; the newest offer wins. The loop never allocates,
// waits or destroys: what it is done with stays in a slot until the owner comes by, and until then
// it takes nothing new.
//
// Each slot changes hands by an exchange that acquires what the other side released, so that
// whoever has the pointer sees the whole object.
template <class T>
class HandOver {
 public:
  HandOver() = default;
  HandOver(const HandOver&) = delete;
  HandOver& operator=(const HandOver&) = delete;
  ~HandOver() { clear(); }

  // The owner's.
  void offer(std::unique_ptr<T> thing) {
    collect();
    delete wanted_.exchange(thing.release(), std::memory_order_acq_rel);
  }
  void collect() { delete done_.exchange(nullptr, std::memory_order_acquire); }
  // While the loop does not run.
  void clear() {
    collect();
    delete wanted_.exchange(nullptr, std::memory_order_acquire);
  }

  // The loop's. Null: nothing new.
  T* take() noexcept {
    if (done_.load(std::memory_order_acquire) != nullptr) return nullptr;
    return wanted_.exchange(nullptr, std::memory_order_acq_rel);
  }
  // After each take(), at most once: null, or what is no longer needed.
  void give_back(T* thing) noexcept { done_.store(thing, std::memory_order_release); }

 private:
  std::atomic<T*> wanted_{nullptr};
  std::atomic<T*> done_{nullptr};
};

}  // namespace limpid
