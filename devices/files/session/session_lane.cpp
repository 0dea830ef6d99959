#include "devices/files/session/session_lane.h"

#include <fmt/format.h>
#include <hdf5_hl.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "devices/files/session/session.h"
#include "devices/files/session/session_source.h"

namespace limpid {
namespace {

using hdf5::append_to;
using hdf5::check;
using hdf5::create_growing;
using hdf5::Dataset;
using hdf5::Dataspace;
using hdf5::Datatype;

constexpr unsigned kLevel = 1;  // of deflate: the fastest

Dataset create_names(hid_t root, const char* name, const std::vector<std::string>& names,
                     const std::filesystem::path& file) {
  std::size_t length = 1;
  for (const std::string& each : names) length = std::max(length, each.size());
  std::string bytes;
  for (const std::string& each : names) bytes += each + std::string(length - each.size(), '\0');
  const Datatype type(H5Tcopy(H5T_C_S1));
  H5Tset_size(type.get(), length);
  H5Tset_strpad(type.get(), H5T_STR_NULLPAD);
  H5Tset_cset(type.get(), H5T_CSET_UTF8);
  const hsize_t count = names.size();
  const Dataspace space(H5Screate_simple(1, &count, nullptr));
  Dataset dataset(
      H5Dcreate2(root, name, type.get(), space.get(), H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT));
  check(dataset &&
            H5Dwrite(dataset.get(), type.get(), H5S_ALL, H5S_ALL, H5P_DEFAULT, bytes.data()) >= 0,
        file, "cannot write");
  make_scale(dataset, name, file);
  return dataset;
}

constexpr double kFlushSeconds = 0.75;  // rows reach the disk at least this often
constexpr double kMostBlockRows = 16384;
constexpr std::uint64_t kMostRows = 4096;  // at once: more would leave the processor's cache
constexpr std::uint64_t kBlocksPerChunk = 16;
constexpr hsize_t kMostChunkBytes = 1 << 20;  // of a packed chunk
constexpr hdf5::Chunks kEventChunk{64};
constexpr hdf5::Chunks kSumChunk{64};
constexpr hdf5::Chunks kWorldChunk{1024};

constexpr hdf5::RowShape kOne;
constexpr hdf5::RowShape table(hsize_t width) { return {2, width}; }

hdf5::Datatype setting_type() {
  hdf5::Datatype type(H5Tcopy(H5T_C_S1));
  H5Tset_size(type.get(), kSettingLength);
  H5Tset_strpad(type.get(), H5T_STR_NULLPAD);
  H5Tset_cset(type.get(), H5T_CSET_UTF8);
  return type;
}

// The usual value of a column, if it has one. Blocks of nothing else are not written, and chunks of
// nothing else take no room in the file; HDF5 reads them as this value.
std::optional<double> mostly(Column column) {
  switch (column) {
    case Column::tool_orientation:
    case Column::contact_point: return std::numeric_limits<double>::quiet_NaN();
    case Column::contact_force:
    case Column::body_velocity:  // bodies sleep
    case Column::magnet:
    case Column::hand_pull:
    case Column::pull_point:
    case Column::pull_target:
    case Column::energy_pulled:
    case Column::motor_warmth:
    case Column::excitation:
    case Column::compensation_torque:
    case Column::energy_compensation: return 0.0;
    default: return std::nullopt;
  }
}

bool nothing_but(std::span<const double> numbers, double fill) {
  const auto bits = [](double x) { return std::bit_cast<std::uint64_t>(x); };
  return std::ranges::all_of(numbers, [&](double x) { return bits(x) == bits(fill); });
}

// Rows of a block; `tick` [s].
std::uint64_t rows_of_block(double tick) {
  return std::bit_floor(
      static_cast<std::uint64_t>(std::clamp(kFlushSeconds / tick, 1.0, kMostBlockRows)));
}

}  // namespace

namespace hdf5 {

Scales create_scales(hid_t root, const ArmDescription& arm, const std::vector<std::string>& bodies,
                     const std::filesystem::path& file) {
  std::vector<std::string> joints, contacts;
  for (const Joint& joint : arm.joints) joints.push_back(joint.name);
  for (int i = 1; i <= kRowContacts; ++i) {
    for (const char axis : {'x', 'y', 'z'}) contacts.push_back(fmt::format("{} of {}", axis, i));
  }
  Scales scales;
  scales.joint = create_names(root, "joint", joints, file);
  scales.axis = create_names(root, "axis", {"x", "y", "z"}, file);
  scales.quaternion = create_names(root, "quaternion", {"w", "x", "y", "z"}, file);
  scales.contact = create_names(root, "contact_axis", contacts, file);
  if (bodies.empty()) return scales;
  scales.object = create_names(root, "object", bodies, file);
  scales.pose = create_names(root, "pose", {"x", "y", "z", "qw", "qx", "qy", "qz"}, file);
  scales.motion = create_names(root, "motion", {"vx", "vy", "vz", "wx", "wy", "wz"}, file);
  return scales;
}

void make_scale(const Dataset& dataset, const char* name, const std::filesystem::path& file) {
  check(H5DSset_scale(dataset.get(), name) >= 0, file, "cannot write");
}

void attach_scale(const Dataset& dataset, const Dataset& scale, unsigned dimension,
                  const std::filesystem::path& file) {
  check(H5DSattach_scale(dataset.get(), scale.get(), dimension) >= 0, file, "cannot write");
}

Dataset create_growing(hid_t file, const char* path, hid_t type, RowShape row, Chunks how,
                       std::optional<double> fill) {
  const Properties creation(H5Pcreate(H5P_DATASET_CREATE));
  // The last chunk is packed whole, and must not hold leftovers of memory.
  const bool filled = fill || how.packed;
  H5Pset_fill_time(creation.get(), filled ? H5D_FILL_TIME_ALLOC : H5D_FILL_TIME_NEVER);
  if (fill) H5Pset_fill_value(creation.get(), H5T_NATIVE_DOUBLE, &*fill);
  const std::array<hsize_t, 3> none{0, row.width, row.each_body};
  const std::array<hsize_t, 3> unlimited{H5S_UNLIMITED, row.width, row.each_body};
  const std::array<hsize_t, 3> chunks{how.rows, row.width, row.each_body};
  const Dataspace space(H5Screate_simple(row.rank, none.data(), unlimited.data()));
  const Properties links(H5Pcreate(H5P_LINK_CREATE));
  H5Pset_create_intermediate_group(links.get(), 1);
  H5Pset_chunk(creation.get(), row.rank, chunks.data());
  if (how.packed) {
    H5Pset_shuffle(creation.get());
    H5Pset_deflate(creation.get(), kLevel);
  }
  return Dataset(
      H5Dcreate2(file, path, type, space.get(), links.get(), creation.get(), H5P_DEFAULT));
}

void append_to(const Dataset& dataset, hsize_t from, hsize_t count, RowShape row, hid_t type,
               const void* data, const std::filesystem::path& file) {
  const std::array<hsize_t, 3> extent{from + count, row.width, row.each_body};
  const std::array<hsize_t, 3> start{from, 0, 0};
  const std::array<hsize_t, 3> block{count, row.width, row.each_body};
  check(H5Dset_extent(dataset.get(), extent.data()) >= 0, file, "cannot write");
  if (data == nullptr) {
    check(H5Dflush(dataset.get()) >= 0, file, "cannot write");
    return;
  }
  const Dataspace in_file(H5Dget_space(dataset.get()));
  const Dataspace in_memory(H5Screate_simple(row.rank, block.data(), nullptr));
  check(H5Sselect_hyperslab(in_file.get(), H5S_SELECT_SET, start.data(), nullptr, block.data(),
                            nullptr) >= 0 &&
            H5Dwrite(dataset.get(), type, in_memory.get(), in_file.get(), H5P_DEFAULT, data) >= 0 &&
            H5Dflush(dataset.get()) >= 0,
        file, "cannot write");
}

}  // namespace hdf5

SessionLane::SessionLane(std::filesystem::path path, const SessionInfo& info, Storage storage)
    : path_(std::move(path)),
      storage_(storage),
      layout_(info.layout()),
      bodies_(info.bodies),
      sum_rows_(rows_of_block(info.tick)),
      block_rows_(storage == Storage::packed ? std::max(kMostRows, sum_rows_) : sum_rows_),
      most_rows_(std::max(block_rows_, kMostRows)),
      pending_(std::make_unique_for_overwrite<double[]>(
          most_rows_ * static_cast<std::size_t>(layout_.stride()))),
      units_(layout_, info.slides),
      deriver_(info.arm ? std::make_unique<DerivedColumns>(*info.arm) : nullptr) {}

void SessionLane::create(hid_t group) {
  create_device(group);
  for (const ColumnInfo& column : kColumnInfo) {
    if (layout_.has(column.column)) create_column(group, column);
  }
  if (layout_.bodies() > 0) create_world(group);
  if (deriver_) create_derived(group);
  if (!units_.scaled().empty()) create_rounding(group);
  create_events(group);
  create_check(group);
}

// Creates /device with the names of its columns together at the beginning of the file, where others
// look for its type (assets/desktop/limpid.xml). HDF5 would move more than eight elsewhere.
void SessionLane::create_device(hid_t group) {
  const hdf5::Properties compact(H5Pcreate(H5P_GROUP_CREATE));
  H5Pset_link_phase_change(compact.get(), 32, 16);
  const hdf5::Group device(H5Gcreate2(group, "device", H5P_DEFAULT, compact.get(), H5P_DEFAULT));
  check(static_cast<bool>(device), path_, "cannot write");
}

hdf5::RowShape SessionLane::shape(const ColumnInfo& column) const {
  const auto width = static_cast<hsize_t>(layout_.width(column.column));
  const hsize_t each = of_each_body(column);
  if (each > 0) return {3, width / each, each};
  const bool single = column.width == ColumnWidth::one || column.width == ColumnWidth::if_bodies;
  return single ? kOne : table(width);  // N x 1 for a single joint
}

hdf5::Chunks SessionLane::chunks(hdf5::RowShape shape) const {
  if (storage_ == Storage::safe) return {kBlocksPerChunk * block_rows_};
  const hsize_t bytes = shape.width * shape.each_body * sizeof(double);
  return {
      std::min<hsize_t>(block_rows_, std::bit_floor(std::max<hsize_t>(kMostChunkBytes / bytes, 1))),
      true};
}

void SessionLane::create_column(hid_t group, const ColumnInfo& column) {
  hdf5::Dataset& dataset = columns_[column_index(column.column)];
  dataset =
      create_growing(group, within_group(column.path), column.byte ? H5T_STD_U8LE : H5T_IEEE_F64LE,
                     shape(column), chunks(shape(column)), mostly(column.column));
  check(static_cast<bool>(dataset), path_, "cannot write");
  if (of_each_body(column) > 0) hdf5::write_texts(dataset.get(), kBodyNames, bodies_, path_);
  const std::vector<std::string> units = units_.units(column);
  if (units.size() == 1) {
    hdf5::write_text(dataset.get(), "unit", units.front(), path_);
  } else {
    hdf5::write_texts(dataset.get(), "unit", units, path_);
  }
  hdf5::write_text(dataset.get(), "what", column.what, path_);
}

void SessionLane::create_derived(hid_t group) {
  for (std::size_t i = 0; i < kDerived; ++i) {
    const DerivedInfo& info = kDerivedInfo[i];
    derived_columns_[i] =
        create_growing(group, within_group(info.path), H5T_IEEE_F64LE, table(3), chunks(table(3)),
                       i == kTotalForce ? std::optional(0.0) : std::nullopt);
    check(static_cast<bool>(derived_columns_[i]), path_, "cannot write");
    hdf5::write_text(derived_columns_[i].get(), "unit", info.unit, path_);
    hdf5::write_text(derived_columns_[i].get(), "what", info.what, path_);
  }
}

void SessionLane::create_rounding(hid_t group) {
  const hdf5::RowShape shape = table(units_.scaled().size());
  rounding_column_ =
      create_growing(group, within_group(kRoundingPath), H5T_STD_I8LE, shape, chunks(shape));
  check(static_cast<bool>(rounding_column_), path_, "cannot write");
  hdf5::write_text(rounding_column_.get(), "unit", "-", path_);
  hdf5::write_text(rounding_column_.get(), "what",
                   "rounding errors of the scaling to m and N, for joints that slide, in units of "
                   "the last place; dataset by dataset, joint by joint",
                   path_);
}

void SessionLane::attach(const hdf5::Scales& scales) const {
  const hdf5::Dataset& time = columns_[column_index(Column::time)];
  hdf5::make_scale(time, "time", path_);
  for (const ColumnInfo& column : kColumnInfo) {
    if (column.column == Column::time || !layout_.has(column.column)) continue;
    const hdf5::Dataset& dataset = columns_[column_index(column.column)];
    hdf5::attach_scale(dataset, time, 0, path_);
    if (column.width == ColumnWidth::dof && scales.joint) {
      hdf5::attach_scale(dataset, scales.joint, 1, path_);
    }
    if (of_axes(column.width) && scales.axis) {
      hdf5::attach_scale(dataset, scales.axis, 1, path_);
    }
    if (column.width == ColumnWidth::four && scales.quaternion) {
      hdf5::attach_scale(dataset, scales.quaternion, 1, path_);
    }
    if (column.width == ColumnWidth::contacts && scales.contact) {
      hdf5::attach_scale(dataset, scales.contact, 1, path_);
    }
    if (of_each_body(column) > 0 && scales.object) {
      const bool poses = column.width == ColumnWidth::poses;
      hdf5::attach_scale(dataset, scales.object, 1, path_);
      hdf5::attach_scale(dataset, poses ? scales.pose : scales.motion, 2, path_);
    }
  }
  if (!deriver_) return;
  for (const hdf5::Dataset& dataset : derived_columns_) {
    hdf5::attach_scale(dataset, time, 0, path_);
    hdf5::attach_scale(dataset, scales.axis, 1, path_);
  }
}

void SessionLane::create_events(hid_t group) {
  const hdf5::Datatype text = setting_type();
  event_row_ = create_growing(group, within_group(kEventRowPath), H5T_STD_U64LE, kOne, kEventChunk);
  event_setting_ =
      create_growing(group, within_group(kEventSettingPath), text.get(), kOne, kEventChunk);
  check(event_row_ && event_setting_, path_, "cannot write");
  hdf5::make_scale(event_row_, "row", path_);
  hdf5::attach_scale(event_setting_, event_row_, 0, path_);
  hdf5::write_text(event_row_.get(), "unit", "-", path_);
  hdf5::write_text(event_row_.get(), "what", "row from which the setting is used", path_);
  hdf5::write_text(event_setting_.get(), "unit", "-", path_);
  hdf5::write_text(event_setting_.get(), "what", "parameter that changed: key = value", path_);
}

void SessionLane::create_world(hid_t group) {
  world_ = create_growing(group, within_group(kWorldPath), H5T_IEEE_F64LE, kOne, kWorldChunk);
  check(static_cast<bool>(world_), path_, "cannot write");
  hdf5::make_scale(world_, "state", path_);
  hdf5::write_text(world_.get(), "unit", "-", path_);
  hdf5::write_text(
      world_.get(), "what",
      "state of the objects that move at the first row; a re-run begins with this state", path_);
}

void SessionLane::append_world(std::span<const double> world) {
  if (!world_ || world.empty()) return;
  append_to(world_, 0, world.size(), kOne, H5T_NATIVE_DOUBLE, world.data(), path_);
}

void SessionLane::create_check(hid_t group) {
  const auto rows = static_cast<std::int64_t>(sum_rows_);
  sums_ = create_growing(group, within_group(kCheckPath), H5T_STD_U64LE,
                         table(count_summed(layout_)), kSumChunk);
  check(static_cast<bool>(sums_), path_, "cannot write");
  hdf5::write_scalar(sums_.get(), kCheckRows, H5T_STD_I64LE, H5T_NATIVE_INT64, &rows, path_);
  hdf5::write_text(sums_.get(), kCheckColumns, check_columns(layout_), path_);
  hdf5::write_text(sums_.get(), "unit", "-", path_);
  hdf5::write_text(sums_.get(), "what", "checksum of each column for this number of rows", path_);
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

// Sorts rows into columns, one behind the other.
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
      for (int i = 0; i < place.width; ++i, ++from) {
        *place.to++ = place.byte ? static_cast<std::uint8_t>(*from) : *from;  // as stored
      }
    }
  }
  pending_rows_ += rows.size() / static_cast<std::size_t>(layout_.stride());
}

// Writes changes first and sums last: what the sums stand for is then complete.
void SessionLane::flush() {
  write_changes();
  if (pending_rows_ == 0) return;
  derive();
  convert();
  write_rounding();
  write_derived();
  for (auto column = kColumnInfo.rbegin(); column != kColumnInfo.rend(); ++column) {
    if (layout_.has(column->column)) write_column(*column);
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
  for (std::uint64_t from = 0; from < pending_rows_; from += sum_rows_) {
    const auto of_block = column_sums(columns, from, std::min(sum_rows_, pending_rows_ - from));
    for (std::size_t i = 0; i < kColumns; ++i) {
      if (summed(layout_, kColumnInfo[i])) sums.push_back(of_block[i]);
    }
  }
  const std::size_t summed_columns = count_summed(layout_);
  const std::uint64_t blocks = sums.size() / summed_columns;
  append_to(sums_, flushed_sums_, blocks, table(summed_columns), H5T_NATIVE_UINT64, sums.data(),
            path_);
  flushed_sums_ += blocks;
}

// Derives columns from the rows before these are in the file's units.
void SessionLane::derive() {
  if (!deriver_) return;
  for (auto& column : derived_) column.clear();
  for (std::uint64_t k = 0; k < pending_rows_; ++k) {
    const auto of = [&](Column c) {
      const auto width = static_cast<std::size_t>(layout_.width(c));
      return std::span<const double>(pending(c) + k * width, width);
    };
    const DerivedColumns::Values values = deriver_->of(
        {of(Column::device_position), of(Column::device_velocity), of(Column::proxy_position),
         of(Column::proxy_velocity), of(Column::contact_force)});
    for (std::size_t i = 0; i < kDerived; ++i) {
      derived_[i].insert(derived_[i].end(), values[i].begin(), values[i].end());
    }
  }
}

// Converts pending rows to the file's units.
void SessionLane::convert() {
  const auto& scaled = units_.scaled();
  rounding_.resize(pending_rows_ * scaled.size());
  for (std::size_t i = 0; i < scaled.size(); ++i) {
    const int width = layout_.width(scaled[i].column);
    double* x = pending(scaled[i].column) + scaled[i].part;
    for (std::uint64_t k = 0; k < pending_rows_; ++k, x += width) {
      const SessionUnits::Filed filed = SessionUnits::filed(scaled[i], *x);
      *x = filed.value;
      rounding_[k * scaled.size() + i] = filed.rounding;
    }
  }
  const std::size_t places =
      pending_rows_ * static_cast<std::size_t>(layout_.width(Column::contact_point));
  file_points({pending(Column::contact_point), places}, {pending(Column::contact_force), places});
}

void SessionLane::write_derived() {
  if (!deriver_) return;
  for (std::size_t i = 0; i < kDerived; ++i) {
    const bool nothing = i == kTotalForce && nothing_but(derived_[i], 0.0);
    append_to(derived_columns_[i], flushed_rows_, pending_rows_, table(3), H5T_NATIVE_DOUBLE,
              nothing ? nullptr : derived_[i].data(), path_);
  }
}

void SessionLane::write_rounding() {
  if (units_.scaled().empty()) return;
  append_to(rounding_column_, flushed_rows_, pending_rows_, table(units_.scaled().size()),
            H5T_NATIVE_INT8, rounding_.data(), path_);
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
  const std::optional<double> fill = mostly(column.column);
  if (fill && nothing_but(numbers, *fill)) data = nullptr;
  append_to(columns_[column_index(column.column)], flushed_rows_, pending_rows_, shape(column),
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
  append_to(event_setting_, flushed_changes_, rows.size(), kOne, text.get(), settings.data(),
            path_);
  append_to(event_row_, flushed_changes_, rows.size(), kOne, H5T_NATIVE_UINT64, rows.data(), path_);
  flushed_changes_ += rows.size();
  changes_.clear();
}

void SessionLane::close() {
  for (hdf5::Dataset& column : columns_) check(column.close(), path_, "cannot write");
  for (hdf5::Dataset& column : derived_columns_) check(column.close(), path_, "cannot write");
  check(rounding_column_.close() && world_.close(), path_, "cannot write");
  check(event_row_.close() && event_setting_.close() && sums_.close(), path_, "cannot write");
}

void SessionLane::abandon() {
  for (hdf5::Dataset& column : columns_) column.close();
  for (hdf5::Dataset& column : derived_columns_) column.close();
  rounding_column_.close();
  world_.close();
  event_row_.close();
  event_setting_.close();
  sums_.close();
}

}  // namespace limpid
