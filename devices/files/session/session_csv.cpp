#include "devices/files/session/session_csv.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <iterator>
#include <optional>
#include <string>
#include <vector>

#include "core/base/descriptor.h"
#include "devices/files/atomic_file.h"
#include "devices/files/session/derived_columns.h"
#include "devices/files/session/session_source.h"
#include "devices/files/session/session_units.h"

namespace limpid {
namespace {

std::string plain(const char* path) {
  std::string name = path + 1;
  std::ranges::replace(name, '/', '_');
  return name;
}

std::string with_unit(const std::string& name, std::string unit) {
  if (unit == "-") return name;
  for (char& c : unit) c = c == ' ' || c == '/' ? '_' : c;
  return name + "_" + unit;
}

// A body's name with '_' for characters that mean something in such a file.
std::string plain_body(std::string name) {
  for (char& c : name) {
    const bool kept = std::isalnum(static_cast<unsigned char>(c)) != 0 || (c & 0x80) != 0;
    if (!kept) c = '_';
  }
  return name;
}

// The name of a body's column: "/objects/pose" of a die becomes "objects_die_x_m" to
// "objects_die_qz", its velocity "objects_die_vx_m_s" to "objects_die_wz_rad_s".
std::string body_column_name(bool velocity, int part, const std::string& body,
                             const std::string& unit) {
  constexpr std::array kPose{"x", "y", "z", "qw", "qx", "qy", "qz"};
  constexpr std::array kVelocity{"vx", "vy", "vz", "wx", "wy", "wz"};
  const auto i = static_cast<std::size_t>(part);
  return with_unit(fmt::format("objects_{}_{}", body, velocity ? kVelocity[i] : kPose[i]), unit);
}

// The name of a column: "/device/position" of joint 2 in rad becomes "device_position_2_rad".
std::string column_name(const ColumnInfo& info, int width, int i, const std::string& unit) {
  std::string name = plain(info.path);
  if (info.width == ColumnWidth::contacts) name += fmt::format("_{}", i / 3 + 1);
  if (info.width == ColumnWidth::contacts || of_axes(info.width)) {
    name += fmt::format("_{:c}", 'x' + i % 3);
  } else if (info.width == ColumnWidth::four) {
    name += fmt::format("_{}", std::string_view("wxyz").substr(static_cast<std::size_t>(i), 1));
  } else if (width > 1) {
    name += fmt::format("_{}", i + 1);
  }
  return with_unit(name, unit);
}

// Rows of a run in the units of the session's file.
class Table {
 public:
  Table(const Session& run, const ArmDescription* arm)
      : run_(run),
        units_(run.layout, slides(run, arm)),
        row_(static_cast<std::size_t>(run.layout.stride())) {
    for (const std::string& body : run.info.bodies) {
      std::string name = plain_body(body);
      if (std::ranges::find(bodies_, name) != bodies_.end()) {
        name += fmt::format("_{}", bodies_.size() + 1);
      }
      bodies_.push_back(std::move(name));
    }
    if (arm != nullptr) derived_.emplace(*arm);
  }

  void name(const std::string& before, std::vector<std::string>& names) const {
    for (const ColumnInfo& info : kColumnInfo) {
      const int width = run_.layout.width(info.column);
      const std::vector<std::string> units = units_.units(info);
      for (int i = 0; i < width; ++i) {
        const std::string& unit = units[static_cast<std::size_t>(i) % units.size()];
        names.push_back(before + name_of(info, width, i, unit));
      }
    }
    if (!derived_) return;
    for (const DerivedInfo& info : kDerivedInfo) {
      for (const char* axis : {"_x", "_y", "_z"}) {
        names.push_back(before + with_unit(plain(info.path) + axis, info.unit));
      }
    }
  }

  void add(std::size_t k, std::vector<double>& numbers) {
    const auto from = run_.row(k);
    std::ranges::copy(from, row_.begin());
    for (const SessionUnits::Scaled& scaled : units_.scaled()) {
      double& x =
          run_.layout.in(std::span(row_), scaled.column)[static_cast<std::size_t>(scaled.part)];
      x = SessionUnits::filed(scaled, x).value;
    }
    file_points(run_.layout.in(std::span(row_), Column::contact_point),
                run_.at(k, Column::contact_force));
    numbers.insert(numbers.end(), row_.begin(), row_.end());
    if (!derived_) return;
    for (const Vec3& v : derived_->of(DerivedColumns::from(run_.layout, from))) {
      numbers.insert(numbers.end(), v.begin(), v.end());
    }
  }

 private:
  std::string name_of(const ColumnInfo& info, int width, int i, const std::string& unit) const {
    const int each = static_cast<int>(of_each_body(info));
    if (each == 0) return column_name(info, width, i, unit);
    const std::string& body = bodies_[static_cast<std::size_t>(i / each)];
    return body_column_name(info.width == ColumnWidth::velocities, i % each, body, unit);
  }
  static std::vector<bool> slides(const Session& run, const ArmDescription* arm) {
    return arm != nullptr ? slides_of(*arm) : run.info.slides;
  }

  const Session& run_;
  SessionUnits units_;
  std::optional<DerivedColumns> derived_;
  std::vector<double> row_;
  std::vector<std::string> bodies_;  // names for columns, each its own
};

constexpr std::size_t kAtOnce = 1 << 16;  // bytes

// Writes lines to a descriptor, many at a time.
class Lines {
 public:
  Lines(const std::filesystem::path& out, int to) : out_(out), to_(to) {}

  template <class Values>
  void add(const Values& values) {
    fmt::format_to(std::back_inserter(text_), "{}\n", fmt::join(values, ","));
    if (text_.size() >= kAtOnce) flush();
  }
  void flush() {
    const auto* bytes = reinterpret_cast<const unsigned char*>(text_.data());
    if (!write_all(to_, {bytes, text_.size()})) {
      throw FileError(fmt::format("{}: not written: {}", out_.string(), std::strerror(errno)));
    }
    text_.clear();
  }

 private:
  std::filesystem::path out_;
  int to_;
  fmt::memory_buffer text_;
};

void write_table(const Session& session, Lines&& lines) {
  const auto arm = recorded_arm(session.info);
  std::vector<Table> runs;
  for (std::size_t i = 0; i < session.lanes(); ++i) runs.emplace_back(session.lane(i), arm.get());
  std::vector<std::string> names;
  for (std::size_t i = 0; i < runs.size(); ++i) {
    runs[i].name(i == kMainLane ? "" : lane_name(i) + "_", names);
  }
  lines.add(names);
  std::vector<double> numbers;
  for (std::size_t k = 0; k < session.size(); ++k) {
    numbers.clear();
    for (Table& run : runs) run.add(k, numbers);
    lines.add(numbers);
  }
  lines.flush();
}

}  // namespace

void write_csv(const Session& session, const std::filesystem::path& out, bool force) {
  const NoFileSizeSignal no_signal;
  if (out == kStandardOutput) return write_table(session, {"standard output", STDOUT_FILENO});
  std::error_code none;
  if (std::filesystem::is_other(out, none)) {
    const Descriptor into(::open(out.c_str(), O_WRONLY | O_CLOEXEC));
    return write_table(session, {out, *into});
  }
  if (!force && std::filesystem::exists(out, none)) {
    throw FileError(fmt::format("{}: exists already; --force replaces it", out.string()));
  }
  check_folder(out);
  Draft draft(past_links(out));
  write_table(session, {out, draft.descriptor()});
  draft.keep();
}

}  // namespace limpid
