#include "devices/files/session/session_lane.h"

#include <algorithm>
#include <bit>
#include <cmath>

#include "devices/files/session/growing_dataset.h"
#include "devices/files/session/session_check.h"
#include "devices/files/session/session_names.h"

namespace limpid {
namespace {

using hdf5::append_to;
using hdf5::check;
using hdf5::create_growing;

constexpr double kFlushSeconds = 0.5;  // rows reach the disk this often
constexpr double kMostBlockRows = 16384;
constexpr std::uint64_t kBlocksPerChunk = 16;
constexpr hsize_t kEventChunk = 64;
constexpr hsize_t kSumChunk = 64;

hdf5::Datatype setting_type() {
  hdf5::Datatype type(H5Tcopy(H5T_C_S1));
  H5Tset_size(type.get(), kSettingLength);
  H5Tset_strpad(type.get(), H5T_STR_NULLPAD);
  H5Tset_cset(type.get(), H5T_CSET_UTF8);
  return type;
}

// Whether a column is mostly zeros: blocks of nothing else are not written then, and a chunk of
// nothing else takes no room in the file. HDF5 reads them as zeros.
bool sparse(const ColumnInfo& column) {
  return column.width == ColumnWidth::contacts || column.column == Column::compensation_torque ||
         column.column == Column::energy_compensation;
}

}  // namespace

SessionLane::SessionLane(std::filesystem::path path, const SessionInfo& info)
    : path_(std::move(path)),
      layout_(info.dof),
      block_rows_(static_cast<std::uint64_t>(
          std::clamp(std::round(kFlushSeconds / info.tick), 1.0, kMostBlockRows))) {
  pending_.reserve(block_rows_ * static_cast<std::size_t>(layout_.stride()));
}

void SessionLane::create(hid_t group) {
  create_device(group);
  for (const ColumnInfo& column : kColumnInfo) create_column(group, column);
  create_events(group);
  create_check(group);
}

// The names of its columns stand together at the beginning of the file, where others look for what
// it is (assets/desktop/limpid.xml); of more than eight HDF5 would put them behind.
void SessionLane::create_device(hid_t group) {
  const hdf5::Properties compact(H5Pcreate(H5P_GROUP_CREATE));
  H5Pset_link_phase_change(compact.get(), 32, 16);
  const hdf5::Group device(H5Gcreate2(group, "device", H5P_DEFAULT, compact.get(), H5P_DEFAULT));
  check(static_cast<bool>(device), path_, "cannot write");
}

void SessionLane::create_column(hid_t group, const ColumnInfo& column) {
  hdf5::Dataset& dataset = columns_[column_index(column.column)];
  dataset =
      create_growing(group, within_group(column.path), column.byte ? H5T_STD_U8LE : H5T_IEEE_F64LE,
                     column.width == ColumnWidth::one ? 1 : 2,  // N x 1 for a single joint
                     static_cast<hsize_t>(layout_.width(column.column)),
                     kBlocksPerChunk * block_rows_, sparse(column));
  check(static_cast<bool>(dataset), path_, "cannot write");
  hdf5::write_text(dataset.get(), "unit", column.unit, path_);
  hdf5::write_text(dataset.get(), "what", column.what, path_);
}

void SessionLane::create_events(hid_t group) {
  const hdf5::Datatype text = setting_type();
  event_row_ = create_growing(group, within_group(kEventRowPath), H5T_STD_U64LE, 1, 1, kEventChunk);
  event_setting_ =
      create_growing(group, within_group(kEventSettingPath), text.get(), 1, 1, kEventChunk);
  check(event_row_ && event_setting_, path_, "cannot write");
  hdf5::write_text(event_row_.get(), "unit", "-", path_);
  hdf5::write_text(event_row_.get(), "what", "row from which the setting holds", path_);
  hdf5::write_text(event_setting_.get(), "unit", "-", path_);
  hdf5::write_text(event_setting_.get(), "what", "parameter that changed: key = value", path_);
}

void SessionLane::create_check(hid_t group) {
  const auto rows = static_cast<std::int64_t>(block_rows_);
  sums_ = create_growing(group, within_group(kCheckPath), H5T_STD_U64LE, 2, kColumns, kSumChunk);
  check(static_cast<bool>(sums_), path_, "cannot write");
  hdf5::write_scalar(sums_.get(), kCheckRows, H5T_STD_I64LE, H5T_NATIVE_INT64, &rows, path_);
  hdf5::write_text(sums_.get(), kCheckColumns, check_columns(), path_);
  hdf5::write_text(sums_.get(), "unit", "-", path_);
  hdf5::write_text(sums_.get(), "what", "checksum of each column over so many rows", path_);
}

std::uint64_t SessionLane::pending_rows() const {
  return pending_.size() / static_cast<std::size_t>(layout_.stride());
}

bool SessionLane::take(std::span<const double>& rows) {
  const std::size_t room =
      block_rows_ * static_cast<std::size_t>(layout_.stride()) - pending_.size();
  const auto part = rows.first(std::min(room, rows.size()));
  pending_.insert(pending_.end(), part.begin(), part.end());
  rows = rows.subspan(part.size());
  return pending_rows() == block_rows_;
}

// Changes go first and the sums last: what they stand for is complete.
void SessionLane::flush() {
  write_changes();
  const std::uint64_t count = pending_rows();
  if (count == 0) return;
  sort_columns(count);
  for (auto column = kColumnInfo.rbegin(); column != kColumnInfo.rend(); ++column) {
    write_column(*column, count);
  }
  write_check();
  flushed_rows_ += count;
  pending_.clear();
}

void SessionLane::write_check() {
  const auto sums = column_sums(layout_, pending_);
  append_to(sums_, flushed_sums_, 1, kColumns, H5T_NATIVE_UINT64, sums.data(), path_);
  ++flushed_sums_;
}

// Rows as columns, one behind the other.
void SessionLane::sort_columns(std::uint64_t count) {
  const auto stride = static_cast<std::size_t>(layout_.stride());
  by_column_.resize(pending_.size());
  for (std::size_t k = 0; k < count; ++k) {
    const double* row = pending_.data() + k * stride;
    for (const ColumnInfo& column : kColumnInfo) {
      const auto at = static_cast<std::size_t>(layout_.offset(column.column));
      const auto width = static_cast<std::size_t>(layout_.width(column.column));
      double* to = by_column_.data() + at * count + k * width;
      for (std::size_t i = 0; i < width; ++i) to[i] = row[at + i];
    }
  }
}

void SessionLane::write_column(const ColumnInfo& column, std::uint64_t count) {
  const auto at = static_cast<std::size_t>(layout_.offset(column.column));
  const auto width = static_cast<std::size_t>(layout_.width(column.column));
  const std::span<const double> numbers(by_column_.data() + at * count, width * count);
  if (column.byte) {
    bytes_.resize(numbers.size());
    std::transform(numbers.begin(), numbers.end(), bytes_.begin(),
                   [](double x) { return static_cast<std::uint8_t>(x); });
  }
  const void* data = column.byte ? static_cast<const void*>(bytes_.data()) : numbers.data();
  const auto zero = [](double x) { return std::bit_cast<std::uint64_t>(x) == 0; };
  if (sparse(column) && std::ranges::all_of(numbers, zero)) data = nullptr;
  append_to(columns_[column_index(column.column)], flushed_rows_, count, width,
            column.byte ? H5T_NATIVE_UINT8 : H5T_NATIVE_DOUBLE, data, path_);
}

void SessionLane::write_changes() {
  if (changes_.empty()) return;
  std::vector<std::uint64_t> rows;
  std::string settings;
  for (const SettingChange& change : changes_) {
    rows.push_back(change.row);
    settings += change.setting;
    settings.resize(rows.size() * kSettingLength, '\0');
  }
  const hdf5::Datatype text = setting_type();
  append_to(event_setting_, flushed_changes_, rows.size(), 1, text.get(), settings.data(), path_);
  append_to(event_row_, flushed_changes_, rows.size(), 1, H5T_NATIVE_UINT64, rows.data(), path_);
  flushed_changes_ += rows.size();
  changes_.clear();
}

void SessionLane::close() {
  for (hdf5::Dataset& column : columns_) check(column.close(), path_, "cannot write");
  check(event_row_.close() && event_setting_.close() && sums_.close(), path_, "cannot write");
}

void SessionLane::abandon() {
  for (hdf5::Dataset& column : columns_) column.close();
  event_row_.close();
  event_setting_.close();
  sums_.close();
}

}  // namespace limpid
