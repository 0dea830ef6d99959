#include "app/device/taken_arm.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "app/base/folders.h"
#include "devices/files/urdf_file.h"

namespace limpid {
namespace {

constexpr const char* kSayWhich =
    "choose the device's arm, in the device panel or by `limpid devices ID --arm FILE.urdf`";

bool has_own(const DeviceKind* kind) { return kind != nullptr && *kind->arm != '\0'; }

ArmDescription shipped(const char* file) { return read_urdf(data_dir() / "assets/devices" / file); }

std::string joints(int n) { return fmt::format("{} joint{}", n, n == 1 ? "" : "s"); }

ArmDescription built_in(const DeviceTraits& traits) {
  constexpr std::array kBuiltIn{"paddle.urdf", "joystick.urdf", "omni.urdf"};
  if (std::ranges::find(traits.slides, true) != traits.slides.end()) {
    throw UnknownArmError(
        fmt::format("{} has joints that slide; no built-in arm has such joints", traits.name));
  }
  if (traits.dof >= 1 && static_cast<std::size_t>(traits.dof) <= kBuiltIn.size()) {
    return shipped(kBuiltIn[static_cast<std::size_t>(traits.dof) - 1]);
  }
  throw UnknownArmError(fmt::format("{} has {}; no built-in arm has so many joints", traits.name,
                                    joints(traits.dof)));
}

// Reads a known arm's file. An error adds `what_to_do`, as no other arm may take its place unasked.
ArmDescription read_known(const std::string& file, const std::string& tip, const char* what_to_do) {
  try {
    return read_urdf(file, tip);
  } catch (const FileError& error) {
    throw FileError(fmt::format("{}; {}", error.what(), what_to_do));
  }
}

// Whether the joints are the same at the same places, whatever their links weigh.
bool same_joints(const ArmDescription& one, const ArmDescription& other) {
  const auto same = [](const Joint& a, const Joint& b) {
    constexpr double kAlike = 1e-6;
    return a.kind == b.kind && (a.axis - b.axis).norm() < kAlike &&
           (a.origin.matrix() - b.origin.matrix()).norm() < kAlike;
  };
  return std::ranges::equal(one.joints, other.joints, same);
}

void add(std::string& all, const std::string& sentence) {
  all += (all.empty() ? "" : " ") + sentence;
}

TakenArm taken(ArmDescription arm, const DeviceTraits& traits, const std::string& because,
               const std::string& besides) {
  std::string why = fmt::format("{} is used as the arm {}: {}.", traits.name, arm.name, because);
  if (!besides.empty()) why = besides + " " + why;
  return {narrowed(std::move(arm), traits), std::move(why), true};
}

std::string not_as_many(const std::string& how, const ArmDescription& arm,
                        const DeviceTraits& traits) {
  return fmt::format("{} {} the arm {} of {}. The device has {} now.", traits.name, how, arm.name,
                     joints(arm.dof()), joints(traits.dof));
}

}  // namespace

ArmDescription narrowed(ArmDescription arm, const DeviceTraits& traits) {
  if (arm.dof() != traits.dof) {
    throw FileError(fmt::format("the arm {} has {}, but the device {} has {}", arm.name,
                                joints(arm.dof()), traits.name, joints(traits.dof)));
  }
  for (std::size_t i = 0; i < arm.joints.size(); ++i) {
    Joint& joint = arm.joints[i];
    const bool slides = joint.kind == Joint::Kind::prismatic;
    if (i < traits.slides.size() && traits.slides[i] != slides) {
      throw FileError(fmt::format("joint {} {} in the arm {}, but {} in the device {}", joint.name,
                                  slides ? "slides" : "turns", arm.name,
                                  slides ? "turns" : "slides", traits.name));
    }
    if (i < traits.effort.size()) joint.effort = std::min(joint.effort, traits.effort[i]);
    if (i >= traits.lower.size() || i >= traits.upper.size()) continue;
    const double lower = std::max(joint.lower, traits.lower[i]);
    const double upper = std::min(joint.upper, traits.upper[i]);
    if (!(lower < upper)) {
      const double unit = slides ? kSlideUnit : 1;
      throw FileError(
          fmt::format("joint {} goes from {:.4g} to {:.4g} {} in the arm {}, but from {:.4g} to "
                      "{:.4g} in the device {}; needed: ranges that overlap",
                      joint.name, unit * joint.lower, unit * joint.upper, slides ? "m" : "rad",
                      arm.name, unit * traits.lower[i], unit * traits.upper[i], traits.name));
    }
    joint.lower = lower;
    joint.upper = upper;
  }
  return arm;
}

TakenArm taken_arm(const DeviceNotes& notes, const DeviceKind* kind, const DeviceTraits& traits,
                   const ArmDescription* named) {
  std::string besides;
  if (!notes.arm.empty()) {
    ArmDescription arm = read_known(notes.arm, "",
                                    "the device was identified as this arm; `limpid identify "
                                    "--forget` removes the identified arm");
    if (!arm.delay && notes.delay >= 0) arm.delay = notes.delay;
    if (arm.dof() != traits.dof) {
      add(besides, not_as_many("was identified as", arm, traits) +
                       " `limpid identify --forget` removes the identified arm.");
    } else if (has_own(kind) && !same_joints(arm, shipped(kind->arm))) {
      add(besides,
          fmt::format("The identified arm {} of {} has different joints than the device's own arm.",
                      arm.name, traits.name));
    } else {
      return taken(std::move(arm), traits, "the device was identified as this arm", besides);
    }
  }
  if (has_own(kind)) {
    return taken(shipped(kind->arm), traits, "the device reports this arm itself", besides);
  }
  if (named != nullptr && named->dof() == traits.dof) {
    return taken(*named, traits, "--device names this arm", besides);
  }
  if (named != nullptr) add(besides, not_as_many("is not", *named, traits));
  if (!notes.taken_for.empty()) {
    const std::string now = what_it_is(traits.name, traits.dof);
    const bool another = !notes.taken_as.empty() && notes.taken_as != now;
    if (another) {
      add(besides, fmt::format("The arm stored under this id was chosen for another device: {}.",
                               notes.taken_as));
    } else if (notes.taken_for == kBuiltInArm) {
      return taken(built_in(traits), traits, "this arm was chosen for the device", besides);
    } else {
      ArmDescription arm = read_known(notes.taken_for, notes.taken_for_tip, kSayWhich);
      if (arm.dof() == traits.dof) {
        return taken(std::move(arm), traits, "this arm was chosen for the device", besides);
      }
      add(besides, not_as_many("was chosen to be", arm, traits));
    }
  }
  TakenArm last;
  try {
    last = taken(built_in(traits), traits,
                 fmt::format("a built-in arm is used until you {}", kSayWhich), besides);
  } catch (const FileError& error) {
    std::string why = besides;
    add(why, fmt::format("{}; {}", error.what(), kSayWhich));
    throw UnknownArmError(why);
  }
  last.known = false;
  double most = 0;
  for (Joint& joint : last.arm.joints) {
    joint.effort = std::min(joint.effort, kShortestLever * notes.limits.tip_force);
    most = std::max(most, joint.effort);
  }
  last.why += fmt::format(" Its motors give at most {:.3g} N m until then.", most);
  return last;
}

bool may_be_told_its_arm(const DeviceNotes& notes, const DeviceKind& kind) {
  return notes.arm.empty() && !has_own(&kind) && !kind.leads_hand;
}

std::string arm_words(const DeviceNotes& notes, const DeviceKind& kind) {
  if (kind.leads_hand) return {};
  if (!notes.arm.empty()) return "arm: the identified arm, " + notes.arm;
  if (has_own(&kind)) return fmt::format("arm: the device's own arm, {}", kind.arm);
  if (notes.taken_for == kBuiltInArm) return "arm: a built-in arm, as chosen";
  if (!notes.taken_for.empty()) return fmt::format("arm: {}, as chosen", notes.taken_for);
  return "arm: a built-in arm, with little force, until you choose the device's arm: limpid "
         "devices ID --arm FILE.urdf";
}

}  // namespace limpid
