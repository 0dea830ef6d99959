// Hand-over of objects to the running loop: built outside, taken in, given back to be destroyed.
#pragma once

#include <atomic>
#include <memory>

namespace limpid {

// The owner (the window) offers, the loop takes; the newest offer wins. The loop never allocates,
// waits or destroys: an object it no longer needs stays in a slot until the owner collects it, and
// until then the loop takes no other.
//
// Each slot changes hands by an exchange that acquires what the other side released, so whoever has
// the pointer sees the whole object.
template <class T>
class HandOver {
 public:
  HandOver() = default;
  HandOver(const HandOver&) = delete;
  HandOver& operator=(const HandOver&) = delete;
  ~HandOver() { clear(); }

  // offer() and collect(): for the owner.
  void offer(std::unique_ptr<T> thing) {
    collect();
    delete wanted_.exchange(thing.release(), std::memory_order_acq_rel);
  }
  void collect() { delete done_.exchange(nullptr, std::memory_order_acquire); }
  // Destroys both slots' objects; only while the loop does not run.
  void clear() {
    collect();
    delete wanted_.exchange(nullptr, std::memory_order_acquire);
  }

  // Takes the newest object, for the loop. Null: nothing new.
  T* take() noexcept {
    if (done_.load(std::memory_order_acquire) != nullptr) return nullptr;
    return wanted_.exchange(nullptr, std::memory_order_acq_rel);
  }
  // Gives the object that is no longer needed, or null; for the loop, at most once after each
  // take().
  void give_back(T* thing) noexcept { done_.store(thing, std::memory_order_release); }

 private:
  std::atomic<T*> wanted_{nullptr};
  std::atomic<T*> done_{nullptr};
};

}  // namespace limpid
