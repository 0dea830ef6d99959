#include "devices/files/session/derived_columns.h"

#include "devices/files/session/session.h"
#include "devices/files/text_file.h"
#include "devices/files/urdf_file.h"

namespace limpid {
namespace {

Vec<kAnyDof> joints(std::span<const double> x) {
  return Eigen::Map<const Eigen::VectorXd>(x.data(), static_cast<Eigen::Index>(x.size()));
}

}  // namespace

DerivedColumns::From DerivedColumns::from(const RowLayout& layout, std::span<const double> row) {
  const auto at = [&](Column c) { return layout.in(row, c); };
  return {at(Column::device_position), at(Column::device_velocity), at(Column::proxy_position),
          at(Column::proxy_velocity), at(Column::contact_force)};
}

DerivedColumns::Values DerivedColumns::of(const From& from) const {
  Values values;
  const auto tip = [&](std::span<const double> x, std::span<const double> v, std::size_t into) {
    Arm<kAnyDof>::Frames f;
    arm_.frames(joints(x), f);
    Jacobian<kAnyDof> J;
    values[into] = arm_.tip(f);
    arm_.point_jacobian(f, arm_.dof() - 1, values[into], J);
    values[into + 1] = J * joints(v);
  };
  tip(from.x1, from.v1, 0);
  tip(from.x2, from.v2, 2);
  Vec3& total = values[kTotalForce];
  total = Vec3::Zero();
  for (std::size_t i = 0; i < from.forces.size(); i += 3) {
    total += Vec3(from.forces[i], from.forces[i + 1], from.forces[i + 2]);
  }
  return values;
}

std::shared_ptr<const ArmDescription> recorded_arm(const SessionInfo& info) {
  if (info.arm) return info.arm;
  try {
    auto arm = std::make_shared<ArmDescription>(parse_urdf(info.device_urdf, "device_urdf", {}));
    return arm->dof() == info.dof ? arm : nullptr;
  } catch (const FileError&) {
    return nullptr;
  }
}

}  // namespace limpid
