#include "devices/files/session/session_csv.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

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

// What a body is called, without what means something in such a file.
std::string plain_body(std::string name) {
  for (char& c : name) {
    const bool kept = std::isalnum(static_cast<unsigned char>(c)) != 0 || (c & 0x80) != 0;
    if (!kept) c = '_';
  }
  return name;
}

// "/objects/pose" of a die becomes "objects_die_x_m" to "objects_die_qz", its velocity
// "objects_die_vx_m_s" to "objects_die_wz_rad_s".
std::string body_column_name(bool velocity, int part, const std::string& body,
                             const std::string& unit) {
  constexpr std::array kPose{"x", "y", "z", "qw", "qx", "qy", "qz"};
  constexpr std::array kVelocity{"vx", "vy", "vz", "wx", "wy", "wz"};
  const auto i = static_cast<std::size_t>(part);
  return with_unit(fmt::format("objects_{}_{}", body, velocity ? kVelocity[i] : kPose[i]), unit);
}

// "/device/position" of joint 2 in rad becomes "device_position_2_rad".
std::string column_name(const ColumnInfo& info, int width, int i, const std::string& unit) {
  std::string name = plain(info.path);
  if (info.width == ColumnWidth::contacts) name += fmt::format("_{}", i / 3 + 1);
  if (info.width == ColumnWidth::contacts || of_axes(info.width)) {
    name += fmt::format("_{:c}", 'x' + i % 3);
  } else if (width > 1) {
    name += fmt::format("_{}", i + 1);
  }
  return with_unit(name, unit);
}

// A run's rows as the session's file has them.
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
  std::vector<std::string> bodies_;  // as names of columns, each its own
};

}  // namespace

void write_csv(const Session& session, const std::filesystem::path& out, bool force) {
  std::error_code none;
  if (!force && std::filesystem::exists(out, none)) {
    throw FileError(fmt::format("{}: exists already; --force replaces it", out.string()));
  }
  const auto arm = recorded_arm(session.info);
  std::vector<Table> runs;
  runs.emplace_back(session, arm.get());
  if (session.twin) runs.emplace_back(*session.twin, arm.get());
  std::vector<std::string> names;
  for (std::size_t i = 0; i < runs.size(); ++i) runs[i].name(i == 0 ? "" : "twin_", names);
  // What is replaced stays until all is written.
  const bool device =
      std::filesystem::exists(out, none) && !std::filesystem::is_regular_file(out, none);
  const std::filesystem::path written = device ? out : part_of(out);
  errno = 0;
  std::ofstream file(written, std::ios::binary);
  fmt::memory_buffer line;
  const auto write_line = [&](const auto& values) {
    line.clear();
    fmt::format_to(std::back_inserter(line), "{}\n", fmt::join(values, ","));
    file.write(line.data(), static_cast<std::streamsize>(line.size()));
  };
  write_line(names);
  std::vector<double> numbers;
  for (std::size_t k = 0; k < session.size() && file; ++k) {
    numbers.clear();
    for (Table& run : runs) run.add(k, numbers);
    write_line(numbers);
  }
  file.close();
  if (!file) {
    const std::string why = std::strerror(errno != 0 ? errno : EIO);
    if (!device) std::filesystem::remove(written, none);
    throw std::runtime_error(fmt::format("{}: not written: {}", out.string(), why));
  }
  if (!device) publish(written, out, force);
}

}  // namespace limpid
