#include "devices/files/session/session_reader.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstring>
#include <limits>
#include <memory>
#include <numeric>
#include <optional>
#include <utility>

#include "core/tick/parameters.h"
#include "devices/files/session/hdf5_reading.h"
#include "devices/files/session/session.h"
#include "devices/files/session/session_file.h"
#include "devices/files/session/session_marks.h"
#include "devices/files/session/session_source.h"
#include "devices/files/session/session_units.h"
#include "devices/files/session/session_writer.h"

namespace limpid {

namespace fs = std::filesystem;

namespace {

constexpr std::size_t kBlockRows = 4096;    // rows read at once, or more if a sum is over more
constexpr std::size_t kMostUnit = 1 << 20;  // rows that sums of two runs are over

// The value of a column that foreign programs need not write, if it is missing.
std::optional<double> default_of(Column column) {
  switch (column) {
    case Column::hand_grip:
    case Column::force_wanted:
    case Column::governor:
    case Column::damping_governor:
    case Column::torque_governor: return 1.0;
    case Column::solved:
    case Column::unsettled:
    case Column::force_state:
    case Column::contact_potential:
    case Column::contact_gain:
    case Column::compensation_torque:
    case Column::energy_compensation:
    case Column::objects_sweeps:
    case Column::objects_left_out:
    case Column::objects_stood_still:
    case Column::objects_turned_less:
    case Column::magnet:
    case Column::hand_magnet:
    case Column::hand_pull:
    case Column::pull_point:
    case Column::pull_target:
    case Column::energy_pulled:
    case Column::motor_warmth:
    case Column::excitation:
    case Column::energy_ledger: return 0.0;
    // Unknown: what the human and objects were given, and whether something touched.
    case Column::tool_orientation:
    case Column::energy_port:
    case Column::energy_to_objects:
    case Column::energy_objects:
    case Column::objects_gain:
    case Column::objects_awake:
    case Column::contact_point:
    case Column::contact_force: return std::numeric_limits<double>::quiet_NaN();
    default: return std::nullopt;
  }
}

hdf5::File open_as(const fs::path& file, unsigned flags) {
  const hdf5::Properties access(H5Pcreate(H5P_FILE_ACCESS));
  // A limit, as HDF5 would reread a broken leftover for ever.
  if (flags & H5F_ACC_SWMR_READ) H5Pset_metadata_read_attempts(access.get(), 5);
  return hdf5::File(H5Fopen(file.c_str(), flags, access.get()));
}

hdf5::File open(const fs::path& file) {
  hdf5::check_before_opening(file);
  if (is_leftover(file)) {
    hdf5::File opened = open_as(file, H5F_ACC_RDONLY | H5F_ACC_SWMR_READ);
    if (!opened) refuse(file, "the recording ended before the first row, or the file is damaged");
    return opened;
  }
  hdf5::File opened = open_as(file, H5F_ACC_RDONLY);
  if (opened) return opened;
  const std::string reason = hdf5::why_not_opened(file);
  if (open_as(file, H5F_ACC_RDONLY | H5F_ACC_SWMR_READ)) {
    refuse(file,
           "was never closed; add .part to the end of the file's name and use `limpid recover`");
  }
  refuse(file, "cannot open: " + reason);
}

// Flags of the joints that slide; empty in sessions whose arm is not known.
std::vector<bool> read_slides(hid_t root, int dof, const fs::path& file) {
  if (H5Aexists(root, kJointTypes) <= 0) return {};
  std::vector<bool> slides;
  for (const std::string& type : hdf5::read_texts(root, kJointTypes, kMaxDof, file)) {
    if (type != kSlidingType && type != kTurningType) {
      refuse(file, fmt::format("attribute {}: \"{:.40}\"; allowed: {} and {}", kJointTypes, type,
                               kTurningType, kSlidingType));
    }
    slides.push_back(type == kSlidingType);
  }
  if (slides.size() != static_cast<std::size_t>(dof)) {
    refuse(file, fmt::format("attribute {}: {} joints; needed: {}, the number in the attribute dof",
                             kJointTypes, slides.size(), dof));
  }
  return slides;
}

// Names of all objects that move, as many as they have poses.
std::vector<std::string> read_bodies(hid_t root, const fs::path& file) {
  const char* path = kColumnInfo[column_index(Column::body_pose)].path;
  if (!hdf5::has(root, path, file)) return {};
  const hdf5::Dataset poses = hdf5::open_dataset(root, path, file);
  const hdf5::Dataspace space(H5Dget_space(poses.get()));
  const int rank = H5Sget_simple_extent_ndims(space.get());
  std::array<hsize_t, 3> extent{};
  if (rank == 3) H5Sget_simple_extent_dims(space.get(), extent.data(), nullptr);
  if (rank != 3 || extent[1] > kMostBodies || extent[2] != kPoseNumbers) {
    refuse(file, fmt::format("{}: {} dimensions, {} x {} wide; needed: N x bodies x {}, of at most "
                             "{} bodies",
                             path, rank, extent[1], extent[2], kPoseNumbers, kMostBodies));
  }
  std::vector<std::string> names;
  if (H5Aexists(poses.get(), kBodyNames) > 0) {
    names = hdf5::read_texts(poses.get(), kBodyNames, kMostBodies, file);
    if (names.size() != extent[1]) {
      refuse(file, fmt::format("{}: {} names of bodies; needed: {}, one name for each body", path,
                               names.size(), extent[1]));
    }
  }
  while (names.size() < extent[1]) names.push_back(fmt::format("object {}", names.size() + 1));
  return names;
}

SessionInfo read_info(hid_t root, const fs::path& file, hdf5::Claims& claims) {
  const std::string format = hdf5::read_text(root, "format", file);
  if (format == kSweepFormat) {
    refuse(file, fmt::format("a sweep's table, not a recording; `limpid play {}` opens it in the "
                             "window",
                             file.string()));
  }
  if (format != kSessionFormat) {
    refuse(file, fmt::format("format \"{:.40}\"; needed: \"{}\"", format, kSessionFormat));
  }
  const auto version = hdf5::read_count(root, "version", file);
  if (version < 1 || version > kSessionVersion) {
    refuse(file, fmt::format("version {}; this program reads 1 to {}", version, kSessionVersion));
  }
  SessionInfo info;
  info.tick = hdf5::read_number(root, "tick", file);
  info.dof = static_cast<int>(std::min(hdf5::read_count(root, "dof", file), 1000000ULL));
  check_session_info(info, file);
  info.seed = hdf5::read_count(root, "seed", file);
  info.created = hdf5::read_text(root, "created", file);
  info.app_version = hdf5::read_text(root, "app_version", file);
  info.source = hdf5::read_text(root, "source", file);
  info.config = hdf5::read_text(root, "config", file);
  info.device_urdf = hdf5::read_text(root, "device_urdf", file);
  info.scene = hdf5::read_text(root, "scene", file);
  // Sessions of the first edition have none.
  if (H5Aexists(root, "safety_limits") > 0) {
    info.safety = hdf5::read_text(root, "safety_limits", file);
  }
  if (H5Aexists(root, "build") > 0) info.build = hdf5::read_text(root, "build", file);
  if (H5Aexists(root, kStory) > 0) info.story = hdf5::read_text(root, kStory, file);
  if (version > 1) info.slides = read_slides(root, info.dof, file);
  info.models = read_models(root, file, claims);
  info.bodies = read_bodies(root, file);
  return info;
}

// Opens the groups of further lanes, in turn.
std::vector<hdf5::Group> groups_beside(hid_t root, const fs::path& file) {
  std::vector<hdf5::Group> groups;
  for (std::size_t i = 1; hdf5::has(root, lane_name(i), file); ++i) {
    if (i == kMostLanes) {
      refuse(file, fmt::format("/{}: more runs than {}, the largest number allowed", lane_name(i),
                               kMostLanes));
    }
    groups.push_back(hdf5::open_group(root, lane_name(i), file));
  }
  for (std::size_t i = groups.size() + 2; i <= kMostLanes; ++i) {
    if (!hdf5::has(root, lane_name(i), file)) continue;
    refuse(file,
           fmt::format("/{}: exists, but /{} does not exist", lane_name(i), lane_name(i - 1)));
  }
  return groups;
}

Source open_rounding(hid_t group, hsize_t width, const fs::path& file) {
  Source source = open_source(group, kRoundingPath, width, file);
  const hdf5::Datatype type(H5Dget_type(source.dataset.get()));
  if (H5Tget_class(type.get()) != H5T_INTEGER || H5Tget_size(type.get()) != 1) {
    refuse(file, fmt::format("{}: of another type; needed: int8", kRoundingPath));
  }
  return source;
}

// Converts a row's numbers from the file's units. False if no numbers can have given them.
bool take_units_off(const std::vector<SessionUnits::Scaled>& scaled, const std::int8_t* rounding,
                    const RowLayout& layout, std::span<double> row) {
  for (std::size_t i = 0; i < scaled.size(); ++i) {
    double& x = layout.in(row, scaled[i].column)[static_cast<std::size_t>(scaled[i].part)];
    if (rounding == nullptr) {
      x = SessionUnits::unfiled(scaled[i], x);
      continue;
    }
    const auto whole = SessionUnits::unfiled(scaled[i], {x, rounding[i]});
    if (!whole) return false;
    x = *whole;
  }
  return true;
}

void read_world(hid_t group, Session& session, const fs::path& file, hdf5::Claims& claims) {
  if (session.layout.bodies() == 0 || !hdf5::has(group, kWorldPath, file)) return;
  const Source source = open_source(group, kWorldPath, 1, file);
  const hdf5::Datatype type(H5Dget_type(source.dataset.get()));
  if (H5Tget_class(type.get()) != H5T_FLOAT || H5Tget_size(type.get()) != 8) {
    refuse(file, fmt::format("{}: of another type; needed: float64", kWorldPath));
  }
  if (source.rows > kMostWorld) {
    refuse(file, fmt::format("{}: {} numbers; allowed: {}", kWorldPath, source.rows, kMostWorld));
  }
  claims.stored(source.dataset);
  claims.take(source.rows, sizeof(double), source.path);
  session.world.resize(source.rows);
  if (session.world.empty() || read_block(source, 0, source.rows, session.world.data())) return;
  if (!is_leftover(file)) refuse(file, fmt::format("{}: cannot be read", kWorldPath));
  session.world.clear();
}

// Reads the changed settings of a session of so many rows.
void read_changes(hid_t root, std::size_t size, Session& session, const fs::path& file,
                  hdf5::Claims& claims) {
  if (!hdf5::has(root, kEventRowPath, file) || !hdf5::has(root, kEventSettingPath, file)) return;
  const Source row_source = open_source(root, kEventRowPath, 1, file);
  const Source setting_source = open_source(root, kEventSettingPath, 1, file);
  for (const Source* source : {&row_source, &setting_source}) claims.stored(source->dataset);
  claims.take(row_source.rows, sizeof(std::uint64_t), row_source.path);
  claims.take(setting_source.rows, sizeof(std::string) + 2 * kSettingLength, setting_source.path);
  const auto rows = read_row_numbers(row_source, file);
  const auto settings = read_texts(setting_source, kSettingLength, file);
  if (rows.size() != settings.size() && !is_leftover(file)) {
    refuse(file, "/events/row and /events/setting differ in length; needed: the same");
  }
  for (std::size_t i = 0; i < std::min(rows.size(), settings.size()); ++i) {
    if (is_leftover(file) && rows[i] >= size) break;
    if (rows[i] > size || (i > 0 && rows[i] < rows[i - 1])) {
      refuse(file, fmt::format("/events/row: entry {}: row {}; needed: increasing rows, at most {}",
                               i, rows[i], size));
    }
    session.changes.push_back({rows[i], settings[i]});
  }
}

// Reader of a lane, at the file's root or in a group.
class RunReader {
 public:
  RunReader(hid_t group, const SessionInfo& info, const fs::path& file, hdf5::Claims& claims)
      : file_(file),
        layout_(info.layout()),
        units_(layout_, info.slides),
        sums_(CheckSums::open(group, file)),
        check_(layout_, file) {
    for (const ColumnInfo& column : kColumnInfo) {
      if (layout_.has(column.column)) open(group, column);
    }
    rows_ = agreed_rows(claims);
    if (!units_.scaled().empty() && hdf5::has(group, kRoundingPath, file)) {
      rounding_ = open_rounding(group, units_.scaled().size(), file);
    }
  }

  const RowLayout& layout() const { return layout_; }
  std::size_t rows() const { return rows_; }  // as the file claims
  std::size_t block() const { return sums_ ? sums_->block() : 1; }
  // Reads `count` more rows, a multiple of block() but for the last ones. Gives fewer only in a
  // leftover, those that are whole. Errors: FileError.
  void read(std::size_t count, std::vector<double>& rows) {
    const auto stride = static_cast<std::size_t>(layout_.stride());
    rows.resize(count * stride);
    for (const auto& [column, value] : missing_) {
      for (std::size_t k = 0; k < count; ++k) {
        std::ranges::fill(layout_.in(std::span(rows).subspan(k * stride, stride), column), value);
      }
    }
    std::size_t whole = count;
    for (std::size_t i = 0; i < sources_.size(); ++i) {
      whole = std::min(whole, read_column(sources_[i], columns_[i], whole, rows));
    }
    rows.resize(whole * stride);
    const auto checked = sums_ ? sums_->check(layout_, rows, from_) : CheckSums::Checked{whole, ""};
    if (is_leftover(file_)) rows.resize(checked.rows * stride);
    check_.take(rows);
    if (!is_leftover(file_) && !checked.why.empty()) refuse(file_, checked.why);
    rows.resize(take_units_off(rows) * stride);
    from_ += count;
  }

 private:
  void open(hid_t group, const ColumnInfo& column) {
    if (hdf5::has(group, column.path, file_)) {
      sources_.push_back(open_column(group, column, layout_, file_));
      columns_.push_back(column.column);
    } else if (const auto value = default_of(column.column)) {
      missing_.emplace_back(column.column, *value);
    } else {
      refuse(file_, fmt::format("{}: missing", column.path));
    }
  }

  std::size_t agreed_rows(hdf5::Claims& claims) const {
    hsize_t rows = sources_.front().rows;
    for (const Source& source : sources_) {
      claims.stored(source.dataset);
      if (source.rows != rows && !is_leftover(file_)) {
        refuse(file_, fmt::format("{} has {} rows, {} has {}; needed: the same", source.path,
                                  source.rows, sources_.front().path, sources_.front().rows));
      }
      rows = std::min(rows, source.rows);
    }
    claims.pass(rows, static_cast<std::uint64_t>(layout_.stride()) * sizeof(double), "rows");
    return static_cast<std::size_t>(rows);
  }

  // Copies a column into `count` rows. Returns how many were there and whole.
  std::size_t read_column(const Source& source, Column column, std::size_t count,
                          std::vector<double>& rows) {
    const auto width = static_cast<std::size_t>(source.width);
    const auto stride = static_cast<std::size_t>(layout_.stride());
    numbers_.resize(count * width);
    if (count > 0 && !read_block(source, from_, count, numbers_.data())) {
      // Some rows may be there: takes as many as can be read in turn.
      if (is_leftover(file_)) return count > 1 ? read_column(source, column, count / 2, rows) : 0;
      refuse(file_, fmt::format("{}: rows {} to {} cannot be read: {}", source.path, from_,
                                from_ + count - 1, hdf5::last_error()));
    }
    for (std::size_t k = 0; k < count; ++k) {
      if (std::bit_cast<std::uint64_t>(numbers_[k * width]) == kNeverWritten) return k;
      std::copy_n(numbers_.begin() + static_cast<std::ptrdiff_t>(k * width), width,
                  layout_.in(std::span(rows).subspan(k * stride, stride), column).begin());
    }
    return count;
  }

  // Converts rows from the file's units. Returns how many from the first are whole.
  std::size_t take_units_off(std::span<double> rows) {
    const auto stride = static_cast<std::size_t>(layout_.stride());
    const std::size_t count = rows.size() / stride;
    const auto& scaled = units_.scaled();
    roundings_.resize(rounding_ ? count * scaled.size() : 0);
    const bool there = !rounding_ || count == 0 ||
                       (rounding_->rows >= from_ + count &&
                        read_block(*rounding_, from_, count, roundings_.data()));
    for (std::size_t k = 0; k < count; ++k) {
      const auto row = rows.subspan(k * stride, stride);
      unfile_points(layout_.in(row, Column::contact_point),
                    layout_.in(std::span<const double>(row), Column::contact_force));
      const char* why = nullptr;
      if (!there) {
        why = "missing, or cannot be read";
      } else if (!limpid::take_units_off(
                     scaled, rounding_ ? roundings_.data() + k * scaled.size() : nullptr, layout_,
                     row)) {
        why =
            "does not fit these numbers: the file is damaged, or another program changed the file "
            "(a program that changes values on purpose must delete /check)";
      }
      if (why == nullptr) continue;
      if (is_leftover(file_)) return k;
      refuse(file_, fmt::format("{}: row {}: {}", kRoundingPath, from_ + k, why));
    }
    return count;
  }

  fs::path file_;
  RowLayout layout_;
  SessionUnits units_;
  std::optional<CheckSums> sums_;
  RowCheck check_;
  std::vector<Source> sources_;
  std::vector<Column> columns_;                     // of each source
  std::vector<std::pair<Column, double>> missing_;  // with their values
  std::optional<Source> rounding_;
  std::size_t rows_ = 0, from_ = 0;  // next row: from_
  std::vector<double> numbers_;
  std::vector<std::int8_t> roundings_;
};

// Reads the same rows of all lanes in turn. Returns how many there are.
std::size_t read_rows(std::span<RunReader> lanes, const fs::path& file, const TakeRows& take) {
  std::size_t rows = lanes[0].rows(), unit = 1;
  for (const RunReader& lane : lanes) {
    rows = std::min(rows, lane.rows());
    unit = std::lcm(unit, lane.block());
    if (unit > kMostUnit) {
      refuse(file, fmt::format("sums over {} rows; allowed: {}", unit, kMostUnit));
    }
  }
  const std::size_t block = unit * std::max<std::size_t>(1, kBlockRows / unit);
  std::vector<std::vector<double>> blocks(lanes.size());
  std::size_t read = 0;
  while (read < rows) {
    const std::size_t count = std::min(block, rows - read);
    for (std::size_t i = 0; i < lanes.size(); ++i) lanes[i].read(count, blocks[i]);
    // A leftover may lack some rows of a lane.
    const std::size_t there =
        std::ranges::min_element(blocks, {}, &std::vector<double>::size)->size();
    std::vector<std::span<const double>> pieces;
    for (const std::vector<double>& each : blocks) pieces.push_back(std::span(each).first(there));
    if (there > 0) take(pieces);
    const std::size_t whole = there / static_cast<std::size_t>(lanes[0].layout().stride());
    read += whole;
    if (whole < count) break;
  }
  return read;
}

constexpr const char* kDone = "done";
constexpr const char* kMeasures = "measure";

std::vector<std::string> attributes_of(hid_t root) {
  std::vector<std::string> names;
  const auto add = [](hid_t, const char* name, const H5A_info_t*, void* into) -> herr_t {
    static_cast<std::vector<std::string>*>(into)->emplace_back(name);
    return 0;
  };
  H5Aiterate2(root, H5_INDEX_NAME, H5_ITER_NATIVE, nullptr, add, &names);
  return names;
}

std::vector<std::string> links_of(hid_t group) {
  std::vector<std::string> names;
  const auto add = [](hid_t, const char* name, const H5L_info_t*, void* into) -> herr_t {
    static_cast<std::vector<std::string>*>(into)->emplace_back(name);
    return 0;
  };
  H5Literate(group, H5_INDEX_NAME, H5_ITER_NATIVE, nullptr, add, &names);
  return names;
}

std::vector<double> column(hid_t root, const std::string& path, const fs::path& file,
                           hdf5::Claims& claims) {
  const hdf5::Dataset dataset = hdf5::open_dataset(root, path, file);
  const hdf5::Dataspace space(H5Dget_space(dataset.get()));
  const hssize_t count = H5Sget_simple_extent_npoints(space.get());
  if (count < 0) refuse(file, fmt::format("damaged: {}: not a list of numbers", path));
  claims.stored(dataset);
  claims.take(static_cast<std::uint64_t>(count), sizeof(double), path);
  std::vector<double> values(static_cast<std::size_t>(count));
  const bool read = values.empty() || H5Dread(dataset.get(), H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL,
                                              H5P_DEFAULT, values.data()) >= 0;
  hdf5::check(read, file, ("damaged: " + path).c_str());
  return values;
}

}  // namespace

void RowCheck::take(std::span<const double> rows) {
  const auto stride = static_cast<std::size_t>(layout_.stride());
  for (std::size_t at = 0; at < rows.size(); at += stride, ++row_) {
    const auto row = rows.subspan(at, stride);
    const double time = layout_.in(row, Column::time)[0];
    if (!std::isfinite(time) || time <= before_) {
      refuse(file_, fmt::format("/time: row {}: {}; needed: finite and increasing", row_, time));
    }
    const auto at_most = [&](Column column, double most, const char* path) {
      const double value = layout_.in(row, column)[0];
      if (value >= 0 && value <= most) return;
      refuse(file_, fmt::format("{}: row {}: {}; allowed: 0 to {}", path, row_, value, most));
    };
    at_most(Column::kind, kLaws - 1, "/coupling/kind");
    at_most(Column::force_wanted, 1, "/device/force_wanted");
    before_ = time;
  }
}

void check_rows(const Session& session, const fs::path& file) {
  RowCheck(session.layout, file).take(session.rows);
}

Session read_session_here(const fs::path& file,
                          const std::function<void(const Session&, std::uint64_t)>& begins,
                          const TakeRows& take) {
  const hdf5::Quiet quiet;
  const hdf5::File opened = open(file);
  Session session;
  hdf5::Claims claims(file);
  session.info = read_info(opened.get(), file, claims);
  session.layout = session.info.layout();
  std::vector<hdf5::Group> groups = groups_beside(opened.get(), file);
  std::vector<RunReader> readers;
  readers.emplace_back(opened.get(), session.info, file, claims);
  for (std::size_t i = 0; i < groups.size(); ++i) {
    const RunReader& lane = readers.emplace_back(groups[i].get(), session.info, file, claims);
    add_lane(session, hdf5::read_text(groups[i].get(), "config", file));
    if (lane.rows() != readers[0].rows() && !is_leftover(file)) {
      refuse(file, fmt::format("/{} has {} rows, the first run {}; needed: the same",
                               lane_name(i + 1), lane.rows(), readers[0].rows()));
    }
  }
  const std::size_t claimed = readers[0].rows();
  for (std::size_t i = 0; i < session.lanes(); ++i) {
    const hid_t of = i == kMainLane ? opened.get() : groups[i - 1].get();
    read_world(of, session.lane(i), file, claims);
    read_changes(of, claimed, session.lane(i), file, claims);
  }
  begins(session, claimed);
  const std::size_t rows = read_rows(readers, file, take);
  session.marks = read_marks(opened.get(), rows, file, claims);
  drop_lost(session, rows, claimed);
  return session;
}

Session read_session_here(const fs::path& file) {
  std::array<LargeVector<double>, kMostLanes> rows;
  Session session = read_session_here(
      file, [](const Session&, std::uint64_t) {},
      [&](LaneRows some) {
        for (std::size_t i = 0; i < some.size(); ++i) {
          rows[i].insert(rows[i].end(), some[i].begin(), some[i].end());
        }
      });
  for (std::size_t i = 0; i < session.lanes(); ++i) session.lane(i).rows = std::move(rows[i]);
  return session;
}

wire::Table read_table_here(const fs::path& file) {
  const hdf5::Quiet quiet;
  hdf5::check_regular_file(file);
  // Recordings may be large: they are told from tables without a look through all of them.
  {
    const hdf5::File looked_at(H5Fopen(file.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT));
    if (!looked_at || H5Lexists(looked_at.get(), kMeasures, H5P_DEFAULT) <= 0) {
      refuse(file, "damaged, or not the table of a sweep");
    }
  }
  const hdf5::File opened = hdf5::open_to_read(file);
  const hid_t root = opened.get();
  wire::Table table;
  for (const std::string& name : attributes_of(root)) {
    const hdf5::Attribute attribute(H5Aopen(root, name.c_str(), H5P_DEFAULT));
    const hdf5::Datatype type(H5Aget_type(attribute.get()));
    const H5T_class_t kind = H5Tget_class(type.get());
    if (kind == H5T_STRING) table.texts[name] = hdf5::read_text(root, name.c_str(), file);
    if (kind == H5T_INTEGER) table.counts[name] = hdf5::read_count(root, name.c_str(), file);
  }
  hdf5::Claims claims(file);
  const auto take = [&](const std::string& path) {
    table.columns[path] = column(root, path, file, claims);
  };
  if (hdf5::has(root, kDone, file)) take(fmt::format("/{}", kDone));
  const hdf5::Group measures = hdf5::open_group(root, kMeasures, file);
  for (const std::string& name : links_of(measures.get())) {
    take(fmt::format("/{}/{}", kMeasures, name));
  }
  return table;
}

}  // namespace limpid
