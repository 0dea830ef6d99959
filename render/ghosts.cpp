#include "render/ghosts.h"

#include <algorithm>

#include "render/gl/glm_door.h"

namespace limpid {
namespace {

// How far each link of the ghost is from the proxy's, as the strength of its outline: at the same
// place there is none, or it would surround the proxy.
std::vector<float> outlines_of(const ArmPose& ghost, const ArmPose& proxy,
                               double meters_per_pixel) {
  std::vector<float> strengths(ghost.links.size(), 1.0f);
  if (ghost.links.size() != proxy.links.size()) return strengths;
  for (std::size_t i = 0; i < strengths.size(); ++i) {
    const bool last = i + 1 == strengths.size();
    const auto end = [&](const ArmPose& arm) {
      return last ? arm.tip : Vec3(arm.links[i + 1].translation());
    };
    const Vec3 off = ghost.links[i].translation() - proxy.links[i].translation();
    const double apart = std::max(off.norm(), (end(ghost) - end(proxy)).norm());
    strengths[i] = static_cast<float>(std::clamp((apart / meters_per_pixel - 1) / 3, 0.0, 1.0));
  }
  return strengths;
}

}  // namespace

Links links_of(const ArmPose& arm) {
  Links out;
  for (const Pose& pose : arm.links) {
    if (!pose.matrix().allFinite()) return {};
    out.push_back(to_glm(pose));
  }
  return out;
}

std::vector<Ghost> ghosts_of(const ViewState& state, double meters_per_pixel) {
  std::vector<Ghost> ghosts;
  if (state.rerun) {
    Links links = links_of(*state.rerun);
    std::vector<float> clear(links.size(), 1.0f);
    ghosts.push_back({std::move(links), palette::kRerun, std::move(clear)});
  }
  const auto add = [&](const ArmPose& arm, const ArmPose& over, const palette::Rgb& color) {
    ghosts.push_back({links_of(arm), color, outlines_of(arm, over, meters_per_pixel)});
  };
  if (state.twin) {
    add(state.twin->proxy, state.proxy, palette::of_twin(palette::kProxy, state.theme));
    if (state.show_ghost) {
      add(state.twin->device, state.device, palette::of_twin(palette::kDevice, state.theme));
    }
  }
  if (state.show_ghost) add(state.device, state.proxy, palette::kDevice);
  return ghosts;
}

}  // namespace limpid
