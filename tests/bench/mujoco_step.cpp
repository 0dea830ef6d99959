#include "tests/bench/mujoco_step.h"

#include <fmt/format.h>
#include <mujoco/mujoco.h>

#include <memory>
#include <stdexcept>

namespace limpid::bench {
namespace {

struct Free {
  void operator()(mjModel* m) const { mj_deleteModel(m); }
  void operator()(mjData* d) const { mj_deleteData(d); }
};

std::string text(const Vec3& v) {
  return fmt::format("{:.17g} {:.17g} {:.17g}", v.x(), v.y(), v.z());
}

std::string text(const Pose& pose) {
  const Eigen::Quaterniond q(pose.linear());
  return fmt::format("pos=\"{}\" quat=\"{:.17g} {:.17g} {:.17g} {:.17g}\"",
                     text(pose.translation()), q.w(), q.x(), q.y(), q.z());
}

// The arm and the plane in MuJoCo's format; only tip and plane can touch, without friction.
std::string mjcf(const ArmDescription& arm, const Object& plane) {
  std::string xml = fmt::format(
      "<mujoco><compiler angle=\"radian\" boundmass=\"1e-9\"/>"
      "<option timestep=\"0.001\" gravity=\"0 0 0\"/><worldbody>"
      "<geom type=\"plane\" size=\"1 1 1\" pos=\"{}\" condim=\"1\" contype=\"1\" "
      "conaffinity=\"2\"/>",
      text(plane.pose.translation()));
  for (std::size_t i = 0; i < arm.joints.size(); ++i) {
    const Joint& joint = arm.joints[i];
    const Link& link = arm.links[i];
    const Mat3& I = link.inertia;
    xml += fmt::format(
        "<body {}><inertial pos=\"{}\" mass=\"{:.17g}\" "
        "fullinertia=\"{:.17g} {:.17g} {:.17g} {:.17g} {:.17g} {:.17g}\"/>"
        "<joint type=\"hinge\" axis=\"{}\" damping=\"{:.17g}\"/>",
        text(joint.origin), text(link.com), link.mass, I(0, 0), I(1, 1), I(2, 2), I(0, 1), I(0, 2),
        I(1, 2), text(joint.axis), joint.damping);
  }
  xml += fmt::format(
      "<geom type=\"sphere\" size=\"0.001\" mass=\"0\" pos=\"{}\" condim=\"1\" contype=\"2\" "
      "conaffinity=\"1\"/>",
      text(arm.tip.translation()));
  for (std::size_t i = 0; i < arm.joints.size(); ++i) xml += "</body>";
  return xml + "</worldbody></mujoco>";
}

std::unique_ptr<mjModel, Free> load(const std::string& xml) {
  const auto files = std::make_unique<mjVFS>();
  mj_defaultVFS(files.get());
  mj_makeEmptyFileVFS(files.get(), "arm.xml", static_cast<int>(xml.size()));
  std::copy(xml.begin(), xml.end(), static_cast<char*>(files->filedata[0]));
  std::array<char, 500> error{};
  std::unique_ptr<mjModel, Free> model(
      mj_loadXML("arm.xml", files.get(), error.data(), static_cast<int>(error.size())));
  mj_deleteVFS(files.get());
  if (!model) throw std::runtime_error(fmt::format("MuJoCo: {}", error.data()));
  return model;
}

}  // namespace

std::optional<Samples> mujoco_steps(const ArmDescription& arm, const Scene& scene,
                                    const Eigen::VectorXd& x, int steps) {
  const auto model = load(mjcf(arm, scene.objects.front()));
  const std::unique_ptr<mjData, Free> data(mj_makeData(model.get()));
  std::copy_n(x.data(), x.size(), data->qpos);
  data->xfrc_applied[6 * (model->nbody - 1) + 2] = -1;  // [N]
  for (int k = 0; k < steps / 10; ++k) mj_step(model.get(), data.get());
  Samples times(static_cast<std::size_t>(steps));
  int touching = 0;
  for (int k = 0; k < steps; ++k) {
    times.time([&] { mj_step(model.get(), data.get()); });
    touching += data->ncon > 0;
  }
  if (touching < steps) {
    fmt::print("  (MuJoCo's arm touched in {:.0f} % of its steps)\n", 100.0 * touching / steps);
  }
  return times;
}

}  // namespace limpid::bench
