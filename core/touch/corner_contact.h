// Contact of a ball of the arm with a corner: surfaces that hold it together.
#pragma once

#include "core/touch/room_contact.h"

namespace limpid {

// The room beside surfaces of one body, which are planes within a tick.
class SolidCorner : public Room {
 public:
  using Room::Room;

  void clear() {
    world_.clear();
    near_ = false;
  }
  // Adds a plane; see FreeSpace.
  void add(const Vec3& normal, double offset) { near_ = world_.add(normal, offset); }
  // Finds the nearest free place. False if the planes leave none.
  bool settle(const Vec3& center, FreeSpace::Active& active, Vec3& weights) {
    return world_.project(center, anchor_, active, weights);
  }
};

template <int N>
using CornerContact = RoomContact<N, SolidCorner>;

}  // namespace limpid
