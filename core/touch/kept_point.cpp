#include "core/touch/kept_point.h"

namespace limpid {
namespace {

void put(std::vector<double>& into, const btVector3& v) {
  for (int i = 0; i < 3; ++i) into.push_back(v[i]);
}
void put(std::vector<double>& into, const Vec3& v) {
  for (const double x : v) into.push_back(x);
}

btVector3 vector(std::span<const double> from) { return {from[0], from[1], from[2]}; }

}  // namespace

void KeptPoint::write(const btManifoldPoint& point, bool turned, const BodyContact& contact,
                      std::vector<double>& into) {
  put(into, point.m_localPointA);
  put(into, point.m_localPointB);
  put(into, point.m_normalWorldOnB);
  put(into, point.m_positionWorldOnA);
  put(into, point.m_positionWorldOnB);
  into.push_back(point.m_distance1);
  into.push_back(point.m_lifeTime);
  into.push_back(turned ? 1 : 0);
  into.push_back(contact.rest);
  into.push_back(contact.force);
  put(into, contact.friction);
  put(into, contact.anchor);
  into.push_back(contact.slipping ? 1 : 0);
  into.push_back(contact.lost);
  into.push_back(contact.pressed);
  into.push_back(contact.impact.number());
}

KeptPoint::KeptPoint(std::span<const double> from)
    : point(vector(from), vector(from.subspan(3)), vector(from.subspan(6)), from[15]),
      turned(from[17] != 0) {
  point.m_positionWorldOnA = vector(from.subspan(9));
  point.m_positionWorldOnB = vector(from.subspan(12));
  point.m_lifeTime = static_cast<int>(from[16]);
}

void KeptPoint::read(std::span<const double> from, BodyContact& contact) {
  contact.rest = from[18];
  contact.force = from[19];
  contact.friction = Vec3(from[20], from[21], from[22]);
  contact.anchor = Vec3(from[23], from[24], from[25]);
  contact.slipping = from[26] != 0;
  contact.lost = from[27];
  contact.pressed = from[28];
  contact.impact.read(from[29]);
}

}  // namespace limpid
