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

constexpr double kFlushSeconds = 0.75;  // rows reach the disk at least this often
constexpr double kMostBlockRows = 16384;
constexpr std::uint64_t kMostRows = 4096;  // at once: more would not stay in the processor's cache
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

// Of ticks of so long [s].
std::uint64_t rows_of_block(double tick) {
  return std::bit_floor(
      static_cast<std::uint64_t>(std::clamp(kFlushSeconds / tick, 1.0, kMostBlockRows)));
}

}  // namespace

SessionLane::SessionLane(std::filesystem::path path, const SessionInfo& info)
    : path_(std::move(path)),
      layout_(info.dof),
      block_rows_(rows_of_block(info.tick)),
      most_rows_(std::max(block_rows_, kMostRows)),
      pending_(std::make_unique_for_overwrite<double[]>(
          most_rows_ * static_cast<std::size_t>(layout_.stride()))) {}

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

bool SessionLane::take(std::span<const double>& rows) {
  const auto stride = static_cast<std::size_t>(layout_.stride());
  const std::uint64_t most = std::clamp(flushed_rows_, block_rows_, most_rows_);
  const std::uint64_t in_blocks =
      std::min(pending_rows_ + rows.size() / stride, most) / block_rows_ * block_rows_;
  const auto part = in_blocks > 0 ? rows.first((in_blocks - pending_rows_) * stride) : rows;
  sort_in(part);
  rows = rows.subspan(part.size());
  return in_blocks > 0;
}

double* SessionLane::pending(Column column) const {
  return pending_.get() + static_cast<std::size_t>(layout_.offset(column)) * most_rows_;
}

// Rows as columns, one behind the other.
void SessionLane::sort_in(std::span<const double> rows) {
  struct Place {
    double* to;
    int width;
    bool byte;
  };
  std::array<Place, kColumns> places;  // in the order of the row
  std::ranges::transform(kColumnInfo, places.begin(), [&](const ColumnInfo& column) {
    const int width = layout_.width(column.column);
    double* first = pending(column.column);
    return Place{first + pending_rows_ * static_cast<std::size_t>(width), width, column.byte};
  });
  for (auto from = rows.begin(); from != rows.end();) {
    for (Place& place : places) {
      if (place.byte) {  // as it will be stored
        *place.to++ = static_cast<std::uint8_t>(*from++);
        continue;
      }
      for (int i = 0; i < place.width; ++i) *place.to++ = *from++;
    }
  }
  pending_rows_ += rows.size() / static_cast<std::size_t>(layout_.stride());
}

// Changes go first and the sums last: what they stand for is complete.
void SessionLane::flush() {
  write_changes();
  if (pending_rows_ == 0) return;
  for (auto column = kColumnInfo.rbegin(); column != kColumnInfo.rend(); ++column) {
    write_column(*column);
  }
  write_check();
  flushed_rows_ += pending_rows_;
  pending_rows_ = 0;
}

void SessionLane::write_check() {
  AllColumns columns;
  std::ranges::transform(kColumnInfo, columns.begin(), [&](const ColumnInfo& column) {
    const int width = layout_.width(column.column);
    return ColumnValues{pending(column.column), width, width};
  });
  std::vector<std::uint64_t> sums;
  for (std::uint64_t from = 0; from < pending_rows_; from += block_rows_) {
    const auto of_block = column_sums(columns, from, std::min(block_rows_, pending_rows_ - from));
    sums.insert(sums.end(), of_block.begin(), of_block.end());
  }
  const std::uint64_t blocks = sums.size() / kColumns;
  append_to(sums_, flushed_sums_, blocks, kColumns, H5T_NATIVE_UINT64, sums.data(), path_);
  flushed_sums_ += blocks;
}

void SessionLane::write_column(const ColumnInfo& column) {
  const auto width = static_cast<std::size_t>(layout_.width(column.column));
  const std::span<const double> numbers(pending(column.column), width * pending_rows_);
  if (column.byte) {
    bytes_.resize(numbers.size());
    std::transform(numbers.begin(), numbers.end(), bytes_.begin(),
                   [](double x) { return static_cast<std::uint8_t>(x); });
  }
  const void* data = column.byte ? static_cast<const void*>(bytes_.data()) : numbers.data();
  const auto zero = [](double x) { return std::bit_cast<std::uint64_t>(x) == 0; };
  if (sparse(column) && std::ranges::all_of(numbers, zero)) data = nullptr;
  append_to(columns_[column_index(column.column)], flushed_rows_, pending_rows_, width,
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
