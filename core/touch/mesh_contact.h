// Contact of a ball of the arm with a mesh.
#pragma once

#include "core/touch/mesh_touch.h"
#include "core/touch/room_contact.h"

namespace limpid {

template <int N>
struct MeshContact : RoomContact<N, MeshTouch> {
  MeshContact(const Object& mesh, double radius, Eigen::Index dof)
      : RoomContact<N, MeshTouch>(MeshTouch(mesh, radius), mesh.material, dof) {}

  int probe = -1;               // index of a probe that is a ball; -1: part of a capsule
  Vec3 on_link = Vec3::Zero();  // the ball's centre, in the link's frame [m]
  Vec3 ahead = Vec3::Zero();    // the centre in the middle of the tick, as it moves [m]
  bool holds = false;           // the centre was behind the surface before the last follow()
  bool covered = false;         // by something else: the surface does not push
};

}  // namespace limpid
