#include "devices/files/session/session_csv.h"

#include <fmt/format.h>
#include <fmt/os.h>

#include <iterator>
#include <system_error>

namespace limpid {
namespace {

// "/device/position" of joint 2 in rad becomes "device_position_2_rad".
std::string column_name(const ColumnInfo& info, int width, int i) {
  std::string name = info.path + 1;
  for (char& c : name) c = c == '/' ? '_' : c;
  if (info.width == ColumnWidth::contacts) name += fmt::format("_{}", i / 3 + 1);
  if (info.width == ColumnWidth::contacts || info.width == ColumnWidth::three) {
    name += fmt::format("_{:c}", 'x' + i % 3);
  } else if (width > 1) {
    name += fmt::format("_{}", i + 1);
  }
  std::string unit = info.unit;
  if (unit == "-") return name;
  for (char& c : unit) c = c == ' ' || c == '/' ? '_' : c;
  return name + "_" + unit;
}

}  // namespace

void write_csv(const Session& session, const std::filesystem::path& out, bool force) {
  std::error_code none;
  if (!force && std::filesystem::exists(out, none)) {
    throw FileError(fmt::format("{}: exists already; --force replaces it", out.string()));
  }
  try {
    auto file = fmt::output_file(out.string());
    std::string line;
    for (const char* run : {"", "twin_"}) {
      if (*run != '\0' && !session.twin) continue;
      for (const ColumnInfo& info : kColumnInfo) {
        const int width = session.layout.width(info.column);
        for (int i = 0; i < width; ++i) {
          line += (line.empty() ? "" : ",") + (run + column_name(info, width, i));
        }
      }
    }
    file.print("{}\n", line);
    for (std::size_t k = 0; k < session.size(); ++k) {
      line.clear();
      fmt::format_to(std::back_inserter(line), "{}", fmt::join(session.row(k), ","));
      if (session.twin) {
        fmt::format_to(std::back_inserter(line), ",{}", fmt::join(session.twin->row(k), ","));
      }
      file.print("{}\n", line);
    }
    file.close();
  } catch (const std::system_error& e) {
    throw FileError(fmt::format("{}: {}", out.string(), e.what()));
  }
}

}  // namespace limpid
