#include "app/experiments/trial_store.h"

#include <fmt/format.h>

#include <array>
#include <cstring>
#include <fstream>
#include <sstream>

#include "app/run/replay.h"
#include "devices/files/atomic_file.h"

namespace limpid {
namespace {

namespace fs = std::filesystem;

// FNV-1a, 64 bits: against accidents, not against malice.
class Digest {
 public:
  void add(const void* bytes, std::size_t count) {
    const auto* byte = static_cast<const unsigned char*>(bytes);
    for (std::size_t i = 0; i < count; ++i) value_ = (value_ ^ byte[i]) * 0x100000001b3;
  }
  void add(double x) { add(&x, sizeof x); }
  void add(std::uint64_t n) { add(&n, sizeof n); }
  // With their lengths, so that no two lists run into the same bytes.
  void add(const std::string& text) {
    add(std::uint64_t{text.size()});
    add(text.data(), text.size());
  }
  template <class Numbers>
  void add_all(const Numbers& numbers) {
    add(static_cast<std::uint64_t>(numbers.size()));
    for (const double x : numbers) add(x);
  }

  std::uint64_t value() const { return value_; }

 private:
  std::uint64_t value_ = 0xcbf29ce484222325;
};

// Nothing where it cannot be read.
std::optional<std::uint64_t> file_digest(const fs::path& file) {
  std::ifstream in(file, std::ios::binary);
  if (!in) return std::nullopt;
  Digest digest;
  std::array<char, 1 << 16> block;
  while (in.read(block.data(), block.size()) || in.gcount() > 0) {
    digest.add(block.data(), static_cast<std::size_t>(in.gcount()));
  }
  if (in.bad()) return std::nullopt;
  return digest.value();
}

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
}

void add_start(Digest& digest, const RigStart& start) {
  for (const auto* v : {&start.x1, &start.v1, &start.x2, &start.v2, &start.f1_hat}) {
    digest.add_all(*v);
  }
  for (const double x : start.target) digest.add(x);
  digest.add(std::uint64_t{start.armed});
}

fs::path stamp_of(const fs::path& session) { return fs::path(session).replace_extension(".key"); }

std::string stamp_text(std::uint64_t key, std::uint64_t bytes) {
  return fmt::format("trial {:016x}\nsession {:016x}\n", key, bytes);
}

}  // namespace

std::uint64_t program_digest() {
  static const std::uint64_t digest = file_digest("/proc/self/exe").value_or(0);
  return digest;
}

std::uint64_t trial_key(const RunPlan& plan, std::uint64_t program) {
  const SessionInfo info = session_info(plan);
  Digest digest;
  digest.add(program);
  digest.add(info.app_version);
  digest.add(info.config);
  digest.add(info.tick);
  digest.add(info.device_urdf);
  digest.add(info.scene);
  for (const auto& [name, bytes] : info.models) {
    digest.add(name);
    digest.add(std::uint64_t{bytes ? bytes->size() : 0});
    if (bytes) digest.add(bytes->data(), bytes->size());
  }
  add_hand(digest, plan.hand);
  digest.add(std::uint64_t{plan.changes.size()});
  for (const SettingChange& change : plan.changes) {
    digest.add(change.row);
    digest.add(change.setting);
  }
  digest.add_all(plan.hand_torque);
  digest.add(std::uint64_t{plan.force.size()});
  for (const bool armed : plan.force) digest.add(std::uint64_t{armed});
  digest.add(std::uint64_t{plan.start.has_value()});
  if (plan.start) add_start(digest, *plan.start);
  digest.add(plan.rows);
  digest.add(plan.seed);
  return digest.value();
}

void stamp(const fs::path& session, std::uint64_t key) {
  const auto bytes = file_digest(session);
  if (!bytes) throw FileError(session.string() + ": cannot be read");
  const std::string text = stamp_text(key, *bytes);
  write_atomically(stamp_of(session),
                   {reinterpret_cast<const unsigned char*>(text.data()), text.size()});
}

std::optional<Session> stamped_session(const fs::path& file, std::uint64_t key) {
  std::ifstream in(stamp_of(file));
  std::ostringstream said;
  said << in.rdbuf();
  const auto bytes = file_digest(file);
  if (!bytes || said.str() != stamp_text(key, *bytes)) return std::nullopt;
  try {
    return read_session(file);
  } catch (const FileError&) {
    return std::nullopt;
  }
}

}  // namespace limpid
