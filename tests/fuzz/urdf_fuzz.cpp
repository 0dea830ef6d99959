// Fuzzes URDF: any text gives an arm whose numbers a loop can compute with, or an error of one
// line.
#include <cmath>
#include <cstdlib>

#include "devices/files/text_file.h"
#include "devices/files/urdf_file.h"

namespace {

void demand(bool holds) {
  if (!holds) std::abort();
}

void check(const limpid::ArmDescription& arm) {
  demand(arm.dof() >= 1 && arm.dof() <= limpid::kMaxDof);
  demand(arm.links.size() == arm.joints.size());
  demand(arm.tip.matrix().allFinite());
  for (const limpid::Joint& joint : arm.joints) {
    demand(joint.origin.matrix().allFinite() && std::abs(joint.axis.norm() - 1) < 1e-9);
    demand(joint.lower < joint.upper && joint.effort > 0 && std::isfinite(joint.effort));
    demand(joint.damping >= 0 && joint.friction >= 0);
  }
  for (const limpid::Link& link : arm.links) {
    demand(link.mass >= 0 && link.com.allFinite() && link.inertia.allFinite());
  }
  for (const limpid::Visual& visual : arm.visuals) {
    demand(visual.link >= -1 && visual.link < arm.dof());
    demand(visual.origin.matrix().allFinite() && visual.size.allFinite());
  }
  for (const std::string& line : arm.warnings) demand(line.find('\n') == std::string::npos);
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const unsigned char* data, std::size_t size) {
  const std::string text(reinterpret_cast<const char*>(data), size);
  try {
    const limpid::ArmDescription arm = limpid::parse_urdf(text, "fuzz.urdf", "");
    check(arm);
    // The recorded URDF gives the same arm again.
    const limpid::ArmDescription again = limpid::parse_urdf(arm.urdf, "fuzz.urdf", "");
    demand(again.dof() == arm.dof() && again.tip_link == arm.tip_link);
  } catch (const limpid::FileError& error) {
    demand(std::string(error.what()).find('\n') == std::string::npos);
  }
  return 0;
}
