#include "app/story/story_hand.h"

#include <fmt/format.h>

#include "app/base/assets.h"
#include "core/dynamics/arm.h"
#include "core/dynamics/inverse_kinematics.h"
#include "devices/files/file_error.h"
#include "devices/files/hand/hand_through.h"

namespace limpid {
namespace {

constexpr double kFastest = 3;  // of a hand; faster it is a slip of the pen [m/s]
constexpr Range kSeconds{0, 3600};
constexpr Range kHandMetres{-10, 10};
const char* const kAllowed =
    "a file, or points [[seconds after the step's beginning, x, y, z], ...] in metres";

// t, x, y, z
std::array<double, 4> point_in(const TomlTable& step, const toml::node& node) {
  const toml::array* list = node.as_array();
  if (list == nullptr || list->size() != 4) step.refuse("hand", kAllowed);
  std::array<double, 4> point{};
  for (std::size_t i = 0; i < point.size(); ++i) {
    const Range& range = i == 0 ? kSeconds : kHandMetres;
    const auto x = list->get(i)->value<double>();
    if (!list->get(i)->is_number() || !(*x >= range.minimum && *x <= range.maximum)) {
      step.refuse("hand", fmt::format("{}; times from 0 to {} s, points from {} to {} m", kAllowed,
                                      kSeconds.maximum, kHandMetres.minimum, kHandMetres.maximum));
    }
    point[i] = *x;
  }
  return point;
}

}  // namespace

void StoryHand::read(const TomlTable& step, double begins, double ends) {
  const toml::node* node = step.find("hand");
  if (node == nullptr) {
    if (time_.empty()) step.refuse_missing("hand");
  } else if (node->is_string()) {
    read_file(step, *node->value<std::string>(), begins, ends);
  } else {
    read_points(step, begins, ends);
  }
}

void StoryHand::read_points(const TomlTable& step, double begins, double ends) {
  const toml::array* list = step.find("hand")->as_array();
  if (list == nullptr || list->empty()) step.refuse("hand", kAllowed);
  double before = -1;
  for (const toml::node& each : *list) {
    const auto [t, x, y, z] = point_in(step, each);
    const std::uint32_t line = each.source().begin.line;
    if (!(t > before && begins + t < ends)) {
      throw FileError(
          fmt::format("{}:{}: step.hand: {} s after {} s; allowed: increasing, and before the step "
                      "ends at {} s",
                      where_, line, t, std::max(before, 0.0), ends - begins));
    }
    if (before < 0 && t > 0) {
      const Vec3 here = position_.empty() ? Vec3(x, y, z) : position_.back();
      add(begins, here, line);  // until then it stays
    }
    add(begins + t, {x, y, z}, line);
    before = t;
  }
}

void StoryHand::read_file(const TomlTable& step, const std::string& file, double begins,
                          double ends) {
  const HandPath path = read_hand(beside_or_own(folder_, "hands", file));
  const std::uint32_t line = step.find("hand")->source().begin.line;
  for (std::size_t i = 0; i < path.time.size() && begins + path.time[i] < ends; ++i) {
    add(begins + path.time[i], path.position[i], line);
  }
}

void StoryHand::add(double time, const Vec3& point, std::uint32_t line) {
  const auto refuse = [&](const std::string& why) {
    throw FileError(
        fmt::format("{}:{}: step.hand: the point ({:.4f}, {:.4f}, {:.4f}) m at {:.3f} s {}", where_,
                    line, point.x(), point.y(), point.z(), time, why));
  };
  if (near_.size() == 0) near_ = rest_pose(arm_);
  auto x = inverse_kinematics(arm_, point, near_);
  if (!x) x = inverse_kinematics(arm_, point, rest_pose(arm_));
  if (!x) refuse(fmt::format("is out of reach of the arm {} within its joint limits", arm_.name));
  near_ = *x;
  if (!time_.empty()) {
    const double passed = time - time_.back(), way = (point - position_.back()).norm();
    if (way > kFastest * passed) {
      refuse(fmt::format("is {:.3f} m from the one {:.3f} s before; allowed: up to {} m/s", way,
                         passed, kFastest));
    }
  }
  time_.push_back(time);
  position_.push_back(point);
}

HandPath StoryHand::path() const { return hand_through(time_, position_, where_); }

}  // namespace limpid
