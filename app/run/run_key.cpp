#include "app/run/run_key.h"

#include <array>
#include <fstream>

#include "app/run/replay.h"
#include "core/base/child.h"
#include "devices/files/config_file.h"

namespace limpid {
namespace {

void add_hand(Digest& digest, const HandPath& hand) {
  digest.add(hand.source);
  digest.add(hand.tick);
  digest.add_all(hand.time);
  for (const auto* points : {&hand.position, &hand.velocity}) {
    digest.add(std::uint64_t{points->size()});
    for (const Vec3& p : *points) {
      for (const double x : p) digest.add(x);
    }
  }
  digest.add_all(hand.grip);
  digest.add(std::uint64_t{hand.magnet.size()});
  for (const bool picks_up : hand.magnet) digest.add(std::uint64_t{picks_up});
  digest.add(std::uint64_t{hand.pull.size()});
  for (const BodyPull& pull : hand.pull) {
    digest.add(static_cast<std::uint64_t>(pull.body) + 1);
    for (const Vec3& at : {pull.point, pull.target}) {
      for (const double x : at) digest.add(x);
    }
  }
}

void add_start(Digest& digest, const std::optional<RigStart>& start) {
  digest.add(std::uint64_t{start.has_value()});
  if (!start) return;
  for (const auto* v : {&start->x1, &start->v1, &start->x2, &start->v2, &start->f1_hat}) {
    digest.add_all(*v);
  }
  for (const double x : start->target) digest.add(x);
  digest.add(std::uint64_t{start->armed});
  digest.add(start->reserve);
  digest.add_all(start->world);
  digest.add_all(start->warmth);
}

void add_changes(Digest& digest, const std::vector<SettingChange>& changes) {
  digest.add(std::uint64_t{changes.size()});
  for (const SettingChange& change : changes) {
    digest.add(change.row);
    digest.add(change.setting);
  }
}

void add_lane(Digest& digest, const Lane& lane) {
  digest.add(config_text(lane.parameters));
  add_changes(digest, lane.changes);
  add_start(digest, lane.start);
}

}  // namespace

std::optional<std::uint64_t> file_digest(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  if (!in) return std::nullopt;
  // A faster digest than Digest, as recordings are long: eight bytes at a time, four times side by
  // side. The last bytes are padded with 0.
  constexpr std::size_t kSide = 4;
  std::array<std::uint64_t, 1 << 13> block;
  std::array<std::uint64_t, kSide> digests{1, 2, 3, 4};
  const auto mixed = [](std::uint64_t digest, std::uint64_t next) {
    digest = (digest ^ next) * 0x9e37'79b9'7f4a'7c15;
    return digest ^ digest >> 32;
  };
  std::uint64_t size = 0;
  do {
    block.fill(0);
    in.read(reinterpret_cast<char*>(block.data()), sizeof block);
    const auto count = static_cast<std::size_t>(in.gcount());
    for (std::size_t i = 0; 8 * i < count; i += kSide) {
      for (std::size_t k = 0; k < kSide; ++k) digests[k] = mixed(digests[k], block[i + k]);
    }
    size += count;
  } while (in);
  if (in.bad()) return std::nullopt;
  for (const std::uint64_t digest : digests) size = mixed(size, digest);
  return size;
}

std::uint64_t program_digest() {
  static const std::uint64_t digest = file_digest(own_binary()).value_or(0);
  return digest;
}

std::uint64_t trial_key(const RunPlan& plan, std::uint64_t program) {
  const SessionInfo info = session_info(plan);
  Digest digest;
  digest.add(program);
  digest.add(info.app_version);
  digest.add(info.tick);
  digest.add(info.device_urdf);
  digest.add(info.scene);
  for (const auto& [name, bytes] : info.models) {
    digest.add(name);
    digest.add(std::uint64_t{bytes ? bytes->size() : 0});
    if (bytes) digest.add(bytes->data(), bytes->size());
  }
  add_hand(digest, plan.hand);
  digest.add_all(plan.hand_torque);
  digest.add(std::uint64_t{plan.force.size()});
  for (const bool armed : plan.force) digest.add(std::uint64_t{armed});
  digest.add(plan.rows);
  digest.add(plan.seed);
  digest.add(std::uint64_t{plan.lanes()});
  for (std::size_t i = 0; i < plan.lanes(); ++i) add_lane(digest, plan.lane(i));
  return digest.value();
}

}  // namespace limpid
