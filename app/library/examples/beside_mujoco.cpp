// MuJoCo's arm with Limpid's coupling: MuJoCo moves the arm in a hand, Limpid ties it to a wall
// that MuJoCo does not know.
#include <limpid/limpid.h>
#include <mujoco/mujoco.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <fstream>

namespace {

constexpr const char* kArm = R"(<mujoco><option timestep="0.001" gravity="0 0 0"/><worldbody>
  <body name="upper"><joint name="shoulder" axis="0 0 1" damping="0.01"/>
    <geom type="capsule" fromto="0 0 0 0.15 0 0" size="0.01" mass="0.08"/>
    <body name="fore" pos="0.15 0 0"><joint name="elbow" axis="0 0 1" damping="0.01"/>
      <geom type="capsule" fromto="0 0 0 0.15 0 0" size="0.01" mass="0.06"/>
      <site name="tip" pos="0.15 0 0"/></body></body></worldbody></mujoco>)";

// The chain of hinges of a MuJoCo model, for Limpid.
limpid::ArmModel arm_of(const mjModel* m) {
  limpid::ArmModel arm;
  for (int j = 0; j < m->njnt; ++j) {
    const int body = m->jnt_bodyid[j];
    limpid::ArmJoint joint;
    joint.name = m->names + m->name_jntadr[j];
    joint.effort = 2;
    joint.damping = m->dof_damping[j];
    joint.mass = m->body_mass[body];
    std::copy_n(m->body_pos + 3 * body, 3, joint.position.begin());
    std::copy_n(m->jnt_axis + 3 * j, 3, joint.axis.begin());
    std::copy_n(m->body_ipos + 3 * body, 3, joint.center.begin());
    mjtNum R[9];
    mju_quat2Mat(R, m->body_iquat + 4 * body);
    const mjtNum* of = m->body_inertia + 3 * body;  // principal moments, turned into its frame
    const auto I = [&](int k, int l) {
      return R[3 * k] * of[0] * R[3 * l] + R[3 * k + 1] * of[1] * R[3 * l + 1] +
             R[3 * k + 2] * of[2] * R[3 * l + 2];
    };
    joint.inertia = {I(0, 0), I(0, 1), I(0, 2), I(1, 1), I(1, 2), I(2, 2)};
    arm.joints.push_back(joint);
  }
  arm.tip = {m->site_pos[0], m->site_pos[1], m->site_pos[2]};
  return arm;
}

}  // namespace

int main() {
  const std::string file = std::filesystem::temp_directory_path() / "limpid_arm.xml";
  std::ofstream(file) << kArm;
  mjModel* m = mj_loadXML(file.c_str(), nullptr, nullptr, 0);
  if (m == nullptr) return 1;
  mjData* d = mj_makeData(m);
  d->qpos[1] = 1.2;  // bent
  mj_forward(m, d);
  const double y = d->site_xpos[1], wall = y + 0.01, goal = y + 0.03;

  limpid::LoopOptions options;
  options.arm_text = limpid::urdf_text(arm_of(m));
  options.scene_text = limpid::SceneBuilder().plane("wall", {0, wall, 0}, {0, -1, 0}, {800}).text();
  options.settings = {"coupling.kind=predictive"};
  options.motors = limpid::Motors::simulated;
  limpid::DeviceLoop loop(options, {d->qpos, 2});
  for (int k = 0; k < 3000; ++k) {
    const auto motors = loop.tick({.position = {d->qpos, 2}});
    mjtNum J[6];
    mj_jacSite(m, d, J, nullptr, 0);
    const double hand = 200 * (goal - d->site_xpos[1]);  // [N], along y
    for (int j = 0; j < 2; ++j) {
      d->qfrc_applied[j] = motors[static_cast<std::size_t>(j)] + J[2 + j] * hand;
    }
    mj_step(m, d);
  }
  const double deep = d->site_xpos[1] - wall, wanted = 200 * 0.02 / 1000;  // two springs in a row
  std::printf("the tip is %.2f mm in the wall, by theory %.2f mm\n", 1e3 * deep, 1e3 * wanted);
  return std::fabs(deep - wanted) < 2e-4 ? 0 : 1;
}
