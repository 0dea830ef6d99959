// Fuzzes scenes: any text gives a scene whose numbers a loop can touch, or an error of one line. A
// scene that is written is read again as the same.
#include <cmath>
#include <cstdlib>

#include "devices/files/scene/scene_file.h"
#include "devices/files/scene/scene_writer.h"
#include "devices/files/text_file.h"
#include "devices/files/urdf_file.h"

namespace {

void demand(bool holds) {
  if (!holds) std::abort();
}

void check(const limpid::Material& material) {
  demand(material.stiffness > 0 && std::isfinite(material.stiffness));
  demand(material.damping >= 0 && std::isfinite(material.damping));
  demand(material.friction_kinetic >= 0 && std::isfinite(material.friction_kinetic));
  demand(material.friction_static >= 0 && std::isfinite(material.friction_static));
}

void check(const limpid::Plane& plane, int) { demand(std::abs(plane.normal.norm() - 1) < 1e-9); }

void check(const limpid::Sphere& sphere, int) {
  demand(sphere.radius > 0 && std::isfinite(sphere.radius));
}

void check(const limpid::Box& box, int) { demand(box.size.allFinite() && box.size.minCoeff() > 0); }

void check(const limpid::Cylinder& c, int) { demand(c.radius > 0 && c.length > 0); }

void check(const limpid::Capsule& c, int) { demand(c.radius > 0 && c.length > 0); }

void check(const limpid::Mesh& mesh, int) { demand(std::isfinite(mesh.size()) && mesh.size() > 0); }

void check(const limpid::JointStop& stop, int joints) {
  demand(stop.joint >= 0 && stop.joint < joints && std::isfinite(stop.angle));
  demand(std::abs(stop.direction) == 1);
}

void check(const limpid::Object& object) {
  const limpid::Body& body = *object.body;
  demand(body.mass >= 1e-6 && body.mass <= 100 && body.restitution >= 0 && body.restitution <= 1);
  for (const limpid::BodyPart& part : object.parts) {
    demand(part.pose.matrix().allFinite());
    std::visit([](const auto& shape) { check(shape, 0); }, part.shape);
  }
  if (!body.joint) return;
  demand(std::abs(body.joint->axis.norm() - 1) < 1e-9 && body.joint->low < body.joint->high);
}

void check(const limpid::Scene& scene, int joints) {
  demand(scene.tip_radius >= 0 && std::isfinite(scene.tip_radius));
  for (const limpid::Object& object : scene.objects) {
    demand(object.pose.matrix().allFinite());
    check(object.material);
    if (object.body) check(object);
    std::visit([&](const auto& shape) { check(shape, joints); }, object.shape);
  }
  for (const limpid::Probe& probe : scene.probes) {
    demand(probe.link >= 0 && probe.link < joints && probe.radius >= 0);
    demand(probe.from.allFinite() && probe.to.allFinite() && std::isfinite(probe.radius));
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const unsigned char* data, std::size_t size) {
  static const limpid::ArmDescription arm =
      limpid::read_urdf(LIMPID_ASSETS_DIR "/devices/omni.urdf");
  static const limpid::SceneFiles files{{"a.glb", {}}, {"b.stl", {}}};
  const std::string text(reinterpret_cast<const char*>(data), size);
  try {
    const limpid::SceneDocument scene = limpid::parse_scene(text, "fuzz.toml", "", arm, files);
    check(scene.scene, arm.dof());
    const std::string written = limpid::scene_text(scene, arm);
    const limpid::SceneDocument again = limpid::parse_scene(written, "fuzz.toml", "", arm, files);
    check(again.scene, arm.dof());
    demand(again.title == scene.title && again.scene.objects.size() == scene.scene.objects.size());
    demand(again.scene.probes.size() == scene.scene.probes.size());
    demand(again.scene.springs == scene.scene.springs);
    for (std::size_t i = 0; i < scene.scene.objects.size(); ++i) {
      demand(again.scene.objects[i].body == scene.scene.objects[i].body);
      demand(again.scene.objects[i].shape == scene.scene.objects[i].shape);
    }
  } catch (const limpid::FileError& error) {
    demand(std::string(error.what()).find('\n') == std::string::npos);
  }
  return 0;
}
