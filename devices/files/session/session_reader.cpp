#include "devices/files/session/session_reader.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstring>
#include <limits>
#include <optional>

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

void read_changes(hid_t root, Session& session, const fs::path& file, hdf5::Claims& claims) {
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
    if (is_leftover(file) && rows[i] >= session.size()) break;
    if (rows[i] > session.size() || (i > 0 && rows[i] < rows[i - 1])) {
      refuse(file, fmt::format("/events/row: entry {}: row {}; needed: increasing, at most {}", i,
                               rows[i], session.size()));
    }
    session.changes.push_back({rows[i], settings[i]});
  }
}

// Reads session files, trusting nothing in them.

namespace {

namespace fs = std::filesystem;

constexpr std::size_t kBlockRows = 4096;  // rows of a column read at once

// What foreign programs need not write, and what it then is.
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
    case Column::magnet:
    case Column::hand_magnet:
    case Column::hand_pull:
    case Column::pull_point:
    case Column::pull_target:
    case Column::energy_pulled:
    case Column::energy_ledger: return 0.0;
    // What the human and objects were given, and that nothing touched, is not known.
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
  // A broken leftover would keep HDF5 rereading it for ever.
  if (flags & H5F_ACC_SWMR_READ) H5Pset_metadata_read_attempts(access.get(), 5);
  return hdf5::File(H5Fopen(file.c_str(), flags, access.get()));
}

hdf5::File open(const fs::path& file) {
  hdf5::check_before_opening(file);
  if (is_leftover(file)) {
    hdf5::File opened = open_as(file, H5F_ACC_RDONLY | H5F_ACC_SWMR_READ);
    if (!opened) refuse(file, "no row was recorded before it was killed, or the file is damaged");
    return opened;
  }
  hdf5::File opened = open_as(file, H5F_ACC_RDONLY);
  if (opened) return opened;
  const std::string reason = hdf5::last_error();
  if (open_as(file, H5F_ACC_RDONLY | H5F_ACC_SWMR_READ)) {
    refuse(file, "was never closed; rename it to end in .part and use `limpid recover`");
  }
  refuse(file, "cannot open: " + reason);
}

// Sessions whose arm nobody knows do not say.
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
    refuse(file, fmt::format("attribute {}: {} joints; needed: {}, as dof says", kJointTypes,
                             slides.size(), dof));
  }
  return slides;
}

// Of all objects that move, as many as there are poses of.
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
      refuse(file, fmt::format("{}: {} names; needed: {}, one of each body", path, names.size(),
                               extent[1]));
    }
  }
  while (names.size() < extent[1]) names.push_back(fmt::format("object {}", names.size() + 1));
  return names;
}

SessionInfo read_info(hid_t root, const fs::path& file, hdf5::Claims& claims) {
  const std::string format = hdf5::read_text(root, "format", file);
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

hdf5::Group twin_group(hid_t root, const fs::path& file) {
  if (!hdf5::has(root, kTwinGroup, file)) return {};
  return hdf5::open_group(root, kTwinGroup, file);
}

// Copies a column into the rows. Returns how many rows were there and whole; fewer than asked for
// only of a leftover.
std::size_t read_column(const Source& source, Session& session, Column column,
                        const fs::path& file) {
  const std::size_t rows = session.size();
  const auto width = static_cast<std::size_t>(source.width);
  std::vector<double> block(kBlockRows * width);
  for (std::size_t from = 0; from < rows; from += kBlockRows) {
    const std::size_t count = std::min(kBlockRows, rows - from);
    if (!read_block(source, from, count, block.data())) {
      if (is_leftover(file)) return from;
      refuse(file, fmt::format("{}: rows {} to {} cannot be read: {}", source.path, from,
                               from + count - 1, hdf5::last_error()));
    }
    for (std::size_t k = 0; k < count; ++k) {
      if (std::bit_cast<std::uint64_t>(block[k * width]) == kNeverWritten) return from + k;
      const auto row = std::span(session.rows)
                           .subspan((from + k) * static_cast<std::size_t>(session.layout.stride()),
                                    static_cast<std::size_t>(session.layout.stride()));
      std::copy_n(block.begin() + static_cast<std::ptrdiff_t>(k * width), width,
                  session.layout.in(row, column).begin());
    }
  }
  return rows;
}

std::size_t agreed_rows(const std::vector<Source>& sources, const RowLayout& layout,
                        const fs::path& file, hdf5::Claims& claims) {
  hsize_t rows = sources.front().rows;
  for (const Source& source : sources) {
    claims.stored(source.dataset);
    if (source.rows != rows && !is_leftover(file)) {
      refuse(file, fmt::format("{} has {} rows, {} has {}; needed: the same", source.path,
                               source.rows, sources.front().path, sources.front().rows));
    }
    rows = std::min(rows, source.rows);
  }
  claims.take(rows, static_cast<std::uint64_t>(layout.stride()) * sizeof(double), "rows");
  return static_cast<std::size_t>(rows);
}

void read_rows(hid_t root, Session& session, const fs::path& file, hdf5::Claims& claims) {
  std::vector<Source> sources;
  std::vector<Column> columns;
  for (const ColumnInfo& column : kColumnInfo) {
    if (!session.layout.has(column.column)) continue;
    if (!hdf5::has(root, column.path, file)) {
      if (default_of(column.column)) continue;
      refuse(file, fmt::format("{}: missing", column.path));
    }
    sources.push_back(open_column(root, column, session.layout, file));
    columns.push_back(column.column);
  }
  const auto stride = static_cast<std::size_t>(session.layout.stride());
  std::size_t whole = agreed_rows(sources, session.layout, file, claims);
  session.rows.resize(whole * stride);
  for (const ColumnInfo& column : kColumnInfo) {
    const auto value = default_of(column.column);
    if (!value) continue;
    for (std::size_t k = 0; k < whole; ++k) {
      const auto row = std::span(session.rows).subspan(k * stride, stride);
      std::ranges::fill(session.layout.in(row, column.column), *value);
    }
  }
  for (std::size_t i = 0; i < sources.size(); ++i) {
    whole = std::min(whole, read_column(sources[i], session, columns[i], file));
  }
  session.rows.resize(whole * stride);
}

Source open_rounding(hid_t group, hsize_t width, const fs::path& file) {
  Source source = open_source(group, kRoundingPath, width, file);
  const hdf5::Datatype type(H5Dget_type(source.dataset.get()));
  if (H5Tget_class(type.get()) != H5T_INTEGER || H5Tget_size(type.get()) != 1) {
    refuse(file, fmt::format("{}: of another type; needed: int8", kRoundingPath));
  }
  return source;
}

// A row's numbers from the file's units to its own. False where these cannot have come from any.
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

// The same of all rows. Returns how many from the first are whole; fewer than all only of a
// leftover.
std::size_t take_units_off(hid_t group, Session& session, const fs::path& file) {
  const SessionUnits units(session.layout, session.info.slides);
  const auto& scaled = units.scaled();
  std::optional<Source> source;
  if (!scaled.empty() && hdf5::has(group, kRoundingPath, file)) {
    source = open_rounding(group, scaled.size(), file);
  }
  const auto stride = static_cast<std::size_t>(session.layout.stride());
  std::vector<std::int8_t> block(source ? kBlockRows * scaled.size() : 0);
  for (std::size_t k = 0; k < session.size(); ++k) {
    const auto row = std::span(session.rows).subspan(k * stride, stride);
    unfile_points(session.layout.in(row, Column::contact_point),
                  session.at(k, Column::contact_force));
    const std::size_t within = k % kBlockRows;
    const std::size_t count = std::min(kBlockRows, session.size() - k);
    const char* why = nullptr;
    if (source && within == 0 &&
        (source->rows < k + count || !read_block(*source, k, count, block.data()))) {
      why = "missing, or cannot be read";
    } else if (!take_units_off(scaled, source ? block.data() + within * scaled.size() : nullptr,
                               session.layout, row)) {
      why =
          "not of these numbers: damaged, or they were changed by another program (which then "
          "has to delete /check)";
    }
    if (why == nullptr) continue;
    if (is_leftover(file)) return k;
    refuse(file, fmt::format("{}: row {}: {}", kRoundingPath, k, why));
  }
  return session.size();
}

void shorten(Session& session, std::size_t rows) {
  session.rows.resize(rows * static_cast<std::size_t>(session.layout.stride()));
  std::erase_if(session.changes, [rows](const SettingChange& c) { return c.row > rows; });
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

// One run: at the file's root, or in the twin's group. A leftover's rows that are not whole stay
// away.
void read_run(hid_t group, Session& session, const fs::path& file, hdf5::Claims& claims) {
  read_rows(group, session, file, claims);
  read_world(group, session, file, claims);
  const CheckedRows checked = checked_rows(group, session, file);
  if (is_leftover(file)) {
    session.rows.resize(checked.rows * static_cast<std::size_t>(session.layout.stride()));
  }
  read_changes(group, session, file, claims);
  check_rows(session, file);
  if (!is_leftover(file) && !checked.why.empty()) refuse(file, checked.why);
  shorten(session, take_units_off(group, session, file));
}

void read_twin(hid_t group, Session& session, const fs::path& file, hdf5::Claims& claims) {
  session.info.twin = hdf5::read_text(group, "config", file);
  Session twin;
  twin.info = session.info;
  twin.info.config = *session.info.twin;
  twin.info.twin.reset();
  twin.layout = session.layout;
  read_run(group, twin, file, claims);
  if (twin.size() != session.size() && !is_leftover(file)) {
    refuse(file, fmt::format("/twin has {} rows, the other run {}; needed: the same", twin.size(),
                             session.size()));
  }
  const std::size_t rows = std::min(twin.size(), session.size());
  shorten(session, rows);
  shorten(twin, rows);
  session.twin = std::make_shared<const Session>(std::move(twin));
}

}  // namespace

void check_rows(const Session& session, const fs::path& file) {
  double before = -std::numeric_limits<double>::infinity();
  for (std::size_t k = 0; k < session.size(); ++k) {
    const double time = session.at(k, Column::time)[0];
    const double kind = session.at(k, Column::kind)[0];
    const double wanted = session.at(k, Column::force_wanted)[0];
    if (!std::isfinite(time) || time <= before) {
      refuse(file, fmt::format("/time: row {}: {}; needed: finite and increasing", k, time));
    }
    const auto at_most = [&](double value, double most, const char* path) {
      if (value >= 0 && value <= most) return;
      refuse(file, fmt::format("{}: row {}: {}; allowed: 0 to {}", path, k, value, most));
    };
    at_most(kind, kLaws - 1, "/coupling/kind");
    at_most(wanted, 1, "/device/force_wanted");
    before = time;
  }
}

Session read_session_here(const fs::path& file) {
  const hdf5::Quiet quiet;
  const hdf5::File opened = open(file);
  Session session;
  hdf5::Claims claims(file);
  session.info = read_info(opened.get(), file, claims);
  session.layout = session.info.layout();
  try {
    read_run(opened.get(), session, file, claims);
    session.marks = read_marks(opened.get(), session.size(), file, claims);
    if (const hdf5::Group twin = twin_group(opened.get(), file)) {
      read_twin(twin.get(), session, file, claims);
    }
  } catch (const std::bad_alloc&) {
    refuse(file, "larger than this computer's memory");
  }
  return session;
}

// Tables of sweeps: numbers in columns, all of one length.

namespace {

namespace fs = std::filesystem;

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
  if (count < 0) refuse(file, fmt::format("damaged: {}: no list of numbers", path));
  claims.stored(dataset);
  claims.take(static_cast<std::uint64_t>(count), sizeof(double), path);
  std::vector<double> values(static_cast<std::size_t>(count));
  const bool read = values.empty() || H5Dread(dataset.get(), H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL,
                                              H5P_DEFAULT, values.data()) >= 0;
  hdf5::check(read, file, ("damaged: " + path).c_str());
  return values;
}

}  // namespace

wire::Table read_table_here(const fs::path& file) {
  const hdf5::Quiet quiet;
  hdf5::check_regular_file(file);
  // Recordings may be large, and are told from tables without looking through all of them.
  {
    const hdf5::File looked_at(H5Fopen(file.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT));
    if (!looked_at || H5Lexists(looked_at.get(), kMeasures, H5P_DEFAULT) <= 0) {
      refuse(file, "damaged, or no table of a sweep");
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
