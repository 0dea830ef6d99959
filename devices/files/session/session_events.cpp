#include "devices/files/session/session_events.h"

#include <fmt/format.h>

#include <algorithm>

#include "devices/files/session/session_names.h"
#include "devices/files/session/session_source.h"

namespace limpid {
namespace {

namespace fs = std::filesystem;

std::vector<std::uint64_t> read_event_rows(const Source& source, const fs::path& file) {
  const hdf5::Datatype type(H5Dget_type(source.dataset.get()));
  std::vector<std::uint64_t> rows(source.rows);
  if (H5Tget_class(type.get()) != H5T_INTEGER ||
      (!rows.empty() && H5Dread(source.dataset.get(), H5T_NATIVE_UINT64, H5S_ALL, H5S_ALL,
                                H5P_DEFAULT, rows.data()) < 0)) {
    refuse(file, fmt::format("{}: cannot be read as row numbers", source.path));
  }
  return rows;
}

std::vector<std::string> read_event_settings(const Source& source, const fs::path& file) {
  const hdf5::Datatype type(H5Dget_type(source.dataset.get()));
  const std::size_t length = H5Tget_size(type.get());
  if (H5Tget_class(type.get()) != H5T_STRING || H5Tis_variable_str(type.get()) > 0 ||
      length > kSettingLength) {
    refuse(file, fmt::format("{}: not text of at most {} bytes", source.path, kSettingLength));
  }
  std::string all(source.rows * length, '\0');
  if (!all.empty() &&
      H5Dread(source.dataset.get(), type.get(), H5S_ALL, H5S_ALL, H5P_DEFAULT, all.data()) < 0) {
    refuse(file, fmt::format("{}: cannot be read", source.path));
  }
  std::vector<std::string> settings;
  for (std::size_t at = 0; at < all.size(); at += length) {
    const std::string setting = all.substr(at, length);
    settings.emplace_back(setting.c_str(), std::min(setting.find('\0'), length));
  }
  return settings;
}

}  // namespace

void read_changes(hid_t root, Session& session, const fs::path& file, hdf5::Claims& claims) {
  if (!hdf5::has(root, kEventRowPath, file) || !hdf5::has(root, kEventSettingPath, file)) return;
  const Source row_source = open_source(root, kEventRowPath, 1, file);
  const Source setting_source = open_source(root, kEventSettingPath, 1, file);
  for (const Source* source : {&row_source, &setting_source}) claims.stored(source->dataset);
  claims.take(row_source.rows, sizeof(std::uint64_t), row_source.path);
  claims.take(setting_source.rows, sizeof(std::string) + 2 * kSettingLength, setting_source.path);
  const auto rows = read_event_rows(row_source, file);
  const auto settings = read_event_settings(setting_source, file);
  if (rows.size() != settings.size() && !is_leftover(file)) {
    refuse(file, "/events/row and /events/setting differ in length; needed: the same");
  }
  for (std::size_t i = 0; i < std::min(rows.size(), settings.size()); ++i) {
    if (is_leftover(file) && rows[i] >= session.size()) break;
    if (rows[i] > session.size() || (i > 0 && rows[i] < rows[i - 1])) {
      refuse(file, fmt::format("/events/row: entry {}: row {}; needed: increasing, at most {}", i,
                               rows[i], session.size()));
    }
    session.changes.push_back({rows[i], settings[i]});
  }
}

}  // namespace limpid
