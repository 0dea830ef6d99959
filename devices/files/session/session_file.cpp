#include "devices/files/session/session_file.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <stdexcept>

#include "devices/files/session/file_size_signal.h"
#include "devices/files/session/growing_dataset.h"
#include "devices/files/session/session_attributes.h"
#include "devices/files/session/session_check.h"
#include "devices/files/session/session_models.h"

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
constexpr hsize_t kPage = 4096;  // bytes

// Nothing small is placed across the end of a page.
hdf5::Properties placed_within_pages() {
  hdf5::Properties creation(H5Pcreate(H5P_FILE_CREATE));
  H5Pset_file_space_strategy(creation.get(), H5F_FSPACE_STRATEGY_PAGE, false, 1);
  H5Pset_file_space_page_size(creation.get(), kPage);
  return creation;
}

hdf5::Datatype setting_type() {
  hdf5::Datatype type(H5Tcopy(H5T_C_S1));
  H5Tset_size(type.get(), kSettingLength);
  H5Tset_strpad(type.get(), H5T_STR_NULLPAD);
  H5Tset_cset(type.get(), H5T_CSET_UTF8);
  return type;
}

// Whether a column is mostly zeros: blocks of nothing else are not written then, and a chunk of
// nothing else takes no room in the file. HDF5 reads them as zeros.
bool sparse(const ColumnInfo& column) { return column.width == ColumnWidth::contacts; }

}  // namespace

SessionFile::SessionFile(std::filesystem::path path, const SessionInfo& info)
    : path_(std::move(path)),
      layout_(info.dof),
      block_rows_(static_cast<std::uint64_t>(
          std::clamp(std::round(kFlushSeconds / info.tick), 1.0, kMostBlockRows))) {
  pending_.reserve(block_rows_ * static_cast<std::size_t>(layout_.stride()));
  guarded([&] { create(info); });
}

SessionFile::~SessionFile() { abandon(); }

// Runs `work` with HDF5 and the kernel silent; gives the file up if it throws.
template <class Work>
void SessionFile::guarded(Work work) {
  const hdf5::Quiet quiet;
  const NoFileSizeSignal no_signal;
  try {
    work();
  } catch (...) {
    abandon();
    throw;
  }
}

void SessionFile::create(const SessionInfo& info) {
  const hdf5::Properties creation = placed_within_pages();
  const hdf5::Properties access(H5Pcreate(H5P_FILE_ACCESS));
  H5Pset_libver_bounds(access.get(), H5F_LIBVER_LATEST, H5F_LIBVER_LATEST);
  // Without a cache for them (the file's: starting to write makes HDF5 forget a dataset's own) and
  // without filling, rows are written where they belong and nowhere else.
  check(H5Pset_cache(access.get(), 0, 0, 0, 0) >= 0, path_, "cannot create");
  file_ = hdf5::File(H5Fcreate(path_.c_str(), H5F_ACC_TRUNC, creation.get(), access.get()));
  check(static_cast<bool>(file_), path_, "cannot create");
  write_attributes(file_.get(), info, path_);
  write_models(file_.get(), info.models, path_);
  for (const ColumnInfo& column : kColumnInfo) create_column(column);
  create_events();
  create_check();
  check(H5Fstart_swmr_write(file_.get()) >= 0, path_, "cannot write");
  check(H5Fflush(file_.get(), H5F_SCOPE_GLOBAL) >= 0, path_, "cannot write");
}

void SessionFile::create_column(const ColumnInfo& column) {
  hdf5::Dataset& dataset = columns_[column_index(column.column)];
  dataset = create_growing(file_.get(), column.path, column.byte ? H5T_STD_U8LE : H5T_IEEE_F64LE,
                           column.width == ColumnWidth::one ? 1 : 2,  // N x 1 for a single joint
                           static_cast<hsize_t>(layout_.width(column.column)),
                           kBlocksPerChunk * block_rows_, sparse(column));
  check(static_cast<bool>(dataset), path_, "cannot write");
  hdf5::write_text(dataset.get(), "unit", column.unit, path_);
  hdf5::write_text(dataset.get(), "what", column.what, path_);
}

void SessionFile::create_events() {
  const hdf5::Datatype text = setting_type();
  event_row_ = create_growing(file_.get(), kEventRowPath, H5T_STD_U64LE, 1, 1, kEventChunk);
  event_setting_ = create_growing(file_.get(), kEventSettingPath, text.get(), 1, 1, kEventChunk);
  check(event_row_ && event_setting_, path_, "cannot write");
  hdf5::write_text(event_row_.get(), "unit", "-", path_);
  hdf5::write_text(event_row_.get(), "what", "row from which the setting holds", path_);
  hdf5::write_text(event_setting_.get(), "unit", "-", path_);
  hdf5::write_text(event_setting_.get(), "what", "parameter that changed: key = value", path_);
}

void SessionFile::create_check() {
  const auto rows = static_cast<std::int64_t>(block_rows_);
  sums_ = create_growing(file_.get(), kCheckPath, H5T_STD_U64LE, 2, kColumns, kSumChunk);
  check(static_cast<bool>(sums_), path_, "cannot write");
  hdf5::write_scalar(sums_.get(), kCheckRows, H5T_STD_I64LE, H5T_NATIVE_INT64, &rows, path_);
  hdf5::write_text(sums_.get(), kCheckColumns, check_columns(), path_);
  hdf5::write_text(sums_.get(), "unit", "-", path_);
  hdf5::write_text(sums_.get(), "what", "checksum of each column over so many rows", path_);
}

std::uint64_t SessionFile::pending_rows() const {
  return pending_.size() / static_cast<std::size_t>(layout_.stride());
}

void SessionFile::append(std::span<const double> rows) {
  const auto stride = static_cast<std::size_t>(layout_.stride());
  if (rows.size() % stride != 0) {
    throw std::invalid_argument("a session takes whole rows only");
  }
  if (!file_) throw FileError(fmt::format("{}: not open for writing any more", path_.string()));
  while (!rows.empty()) {
    const std::size_t room = block_rows_ * stride - pending_.size();
    const auto part = rows.first(std::min(room, rows.size()));
    pending_.insert(pending_.end(), part.begin(), part.end());
    rows = rows.subspan(part.size());
    if (pending_rows() == block_rows_) guarded([&] { flush(); });
  }
}

void SessionFile::append(const SettingChange& change) {
  if (change.setting.size() > kSettingLength) {
    throw FileError(fmt::format("{}: setting of {} characters, at most {} are kept", path_.string(),
                                change.setting.size(), kSettingLength));
  }
  if (!file_) throw FileError(fmt::format("{}: not open for writing any more", path_.string()));
  changes_.push_back(change);
}

// Changes go first and the sums last: what they stand for is complete.
void SessionFile::flush() {
  write_changes();
  const std::uint64_t count = pending_rows();
  if (count == 0) return;
  for (auto column = kColumnInfo.rbegin(); column != kColumnInfo.rend(); ++column) {
    write_column(*column, count);
  }
  write_check();
  flushed_rows_ += count;
  pending_.clear();
}

void SessionFile::write_check() {
  std::array<std::uint64_t, kColumns> sums;
  for (const ColumnInfo& column : kColumnInfo) {
    sums[column_index(column.column)] = column_sum(layout_, pending_, column.column);
  }
  append_to(sums_, flushed_sums_, 1, kColumns, H5T_NATIVE_UINT64, sums.data(), path_);
  ++flushed_sums_;
}

void SessionFile::write_column(const ColumnInfo& column, std::uint64_t count) {
  const auto stride = static_cast<std::size_t>(layout_.stride());
  const std::span<const double> rows(pending_);
  numbers_.clear();
  for (std::size_t at = 0; at < rows.size(); at += stride) {
    const auto values = layout_.in(rows.subspan(at, stride), column.column);
    numbers_.insert(numbers_.end(), values.begin(), values.end());
  }
  if (column.byte) {
    bytes_.resize(numbers_.size());
    std::transform(numbers_.begin(), numbers_.end(), bytes_.begin(),
                   [](double x) { return static_cast<std::uint8_t>(x); });
  }
  const void* data = column.byte ? static_cast<const void*>(bytes_.data()) : numbers_.data();
  const auto zero = [](double x) { return std::bit_cast<std::uint64_t>(x) == 0; };
  if (sparse(column) && std::ranges::all_of(numbers_, zero)) data = nullptr;
  append_to(columns_[column_index(column.column)], flushed_rows_, count,
            static_cast<hsize_t>(layout_.width(column.column)),
            column.byte ? H5T_NATIVE_UINT8 : H5T_NATIVE_DOUBLE, data, path_);
}

void SessionFile::write_changes() {
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

void SessionFile::close() {
  if (!file_) return;
  guarded([&] {
    flush();
    // Closing hides errors of the last writes; flushing tells them.
    check(H5Fflush(file_.get(), H5F_SCOPE_GLOBAL) >= 0, path_, "cannot write");
    for (hdf5::Dataset& column : columns_) check(column.close(), path_, "cannot write");
    check(event_row_.close() && event_setting_.close() && sums_.close() && file_.close(), path_,
          "cannot write");
  });
}

// HDF5 cannot forget what it has not written yet: closing writes, and fails for ever on a full
// disk. So it gets the null device in place of the file and may write there what it likes.
void SessionFile::abandon() {
  if (!file_) return;
  const hdf5::Quiet quiet;
  void* descriptor = nullptr;
  const int null_device = ::open("/dev/null", O_RDWR | O_CLOEXEC);
  if (H5Fget_vfd_handle(file_.get(), H5P_DEFAULT, &descriptor) >= 0 && null_device >= 0) {
    ::dup2(null_device, *static_cast<int*>(descriptor));
  }
  if (null_device >= 0) ::close(null_device);
  for (hdf5::Dataset& column : columns_) column.close();
  event_row_.close();
  event_setting_.close();
  sums_.close();
  file_.close();
}

}  // namespace limpid
