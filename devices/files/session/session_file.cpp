#include "devices/files/session/session_file.h"

#include <fmt/format.h>

#include <array>
#include <ctime>
#include <stdexcept>
#include <string>

#include "core/dynamics/arm_description.h"
#include "devices/files/atomic_file.h"
#include "devices/files/session/hdf5_descriptor.h"
#include "devices/files/session/hdf5_reading.h"
#include "devices/files/session/session.h"
#include "devices/files/session/session_lane.h"
#include "devices/files/session/session_source.h"

namespace limpid {

namespace {

std::string now() {
  const std::time_t t = std::time(nullptr);
  std::tm utc{};
  gmtime_r(&t, &utc);
  std::array<char, 32> text{};
  std::strftime(text.data(), text.size(), "%Y-%m-%dT%H:%M:%SZ", &utc);
  return text.data();
}

constexpr const char* kConventions =
    "Row k has the state at /time[k] and the torques that act from this time to the next row. "
    "Units are SI: rad, rad/s and N m for joints that turn; m, m/s and N for joints that slide. "
    "The attribute unit of a dataset has one unit for all of its columns, or one unit for each "
    "joint. Positions, velocities and forces at the tip are x, y, z in the frame of the root link "
    "of device_urdf. The device is the arm in the hand. The proxy is its image in the simulated "
    "world; contact forces act on the proxy. Where nothing touches the proxy, /contact/force and "
    "/contact/total_force are 0 and /contact/point is not a number. Only the program uses /check: "
    "it has sums that show damage, and the rounding errors of the conversion of units. If you "
    "change a dataset, delete /check.";

constexpr const char* kBodyConventions =
    " /objects has the objects that move, in the order in which the attribute 'names' lists them. "
    "The position of an object is the position of its centre of mass. Its rotation is a quaternion "
    "w, x, y, z from its own frame to the frame of the root link.";

void write_arm(hid_t root, const SessionInfo& info, const std::filesystem::path& file) {
  std::vector<std::string> types;
  for (const bool slide : info.slides) types.emplace_back(slide ? kSlidingType : kTurningType);
  if (!types.empty()) hdf5::write_texts(root, kJointTypes, types, file);
  if (!info.arm) return;
  std::vector<std::string> names;
  for (const Joint& joint : info.arm->joints) names.push_back(joint.name);
  hdf5::write_texts(root, "joints", names, file);
  hdf5::write_text(root, "tip", info.arm->tip_link, file);
}

constexpr const char* kGroup = "/models";
constexpr std::size_t kMostModels = 64;

std::string dataset_path(std::size_t i) { return fmt::format("{}/{}", kGroup, i); }

using hdf5::check;

constexpr hsize_t kPage = 4096;  // bytes

// Keeps HDF5 from placing anything small across the end of a page.
hdf5::Properties placed_within_pages() {
  hdf5::Properties creation(H5Pcreate(H5P_FILE_CREATE));
  H5Pset_file_space_strategy(creation.get(), H5F_FSPACE_STRATEGY_PAGE, false, 1);
  H5Pset_file_space_page_size(creation.get(), kPage);
  return creation;
}

}  // namespace

void write_attributes(hid_t root, const SessionInfo& info, const std::filesystem::path& file) {
  const std::int64_t version = kSessionVersion;
  const std::int64_t dof = info.dof;
  hdf5::write_text(root, "format", kSessionFormat, file);
  hdf5::write_scalar(root, "version", H5T_STD_I64LE, H5T_NATIVE_INT64, &version, file);
  hdf5::write_scalar(root, "tick", H5T_IEEE_F64LE, H5T_NATIVE_DOUBLE, &info.tick, file);
  hdf5::write_scalar(root, "dof", H5T_STD_I64LE, H5T_NATIVE_INT64, &dof, file);
  hdf5::write_scalar(root, "seed", H5T_STD_U64LE, H5T_NATIVE_UINT64, &info.seed, file);
  hdf5::write_text(root, "created", info.created.empty() ? now() : info.created, file);
  hdf5::write_text(root, "app_version", info.app_version, file);
  hdf5::write_text(root, "build", info.build, file);
  const bool bodies = !info.bodies.empty();
  hdf5::write_text(root, "conventions",
                   std::string(kConventions) + (bodies ? kBodyConventions : ""), file);
  hdf5::write_text(root, "source", info.source, file);
  hdf5::write_text(root, "config", info.config, file);
  hdf5::write_text(root, "device_urdf", info.device_urdf, file);
  hdf5::write_text(root, "scene", info.scene, file);
  hdf5::write_text(root, "safety_limits", info.safety, file);
  if (!info.story.empty()) hdf5::write_text(root, kStory, info.story, file);
  write_arm(root, info, file);
}

void write_models(hid_t root, const SceneFiles& models, const std::filesystem::path& file) {
  const hdf5::Properties links(H5Pcreate(H5P_LINK_CREATE));
  H5Pset_create_intermediate_group(links.get(), 1);
  std::size_t i = 0;
  for (const auto& [name, bytes] : models) {
    const hsize_t size = bytes->size();
    const hdf5::Dataspace space(H5Screate_simple(1, &size, nullptr));
    const hdf5::Dataset dataset(H5Dcreate2(root, dataset_path(i++).c_str(), H5T_STD_U8LE,
                                           space.get(), links.get(), H5P_DEFAULT, H5P_DEFAULT));
    hdf5::check(dataset && H5Dwrite(dataset.get(), H5T_NATIVE_UINT8, H5S_ALL, H5S_ALL, H5P_DEFAULT,
                                    bytes->data()) >= 0,
                file, "cannot write");
    hdf5::write_text(dataset.get(), "name", name, file);
  }
}

SceneFiles read_models(hid_t root, const std::filesystem::path& file, hdf5::Claims& claims) {
  std::vector<Source> sources;
  for (std::size_t i = 0; i < kMostModels && hdf5::has(root, dataset_path(i), file); ++i) {
    const Source& source =
        sources.emplace_back(open_source(root, dataset_path(i).c_str(), 1, file));
    claims.stored(source.dataset);
    claims.take(source.rows, 1, source.path);
  }
  SceneFiles models;
  for (const Source& source : sources) {
    const std::string& path = source.path;
    const hdf5::Datatype type(H5Dget_type(source.dataset.get()));
    std::vector<unsigned char> bytes(source.rows);
    if (H5Tget_class(type.get()) != H5T_INTEGER || H5Tget_size(type.get()) != 1 ||
        (!bytes.empty() && H5Dread(source.dataset.get(), H5T_NATIVE_UINT8, H5S_ALL, H5S_ALL,
                                   H5P_DEFAULT, bytes.data()) < 0)) {
      refuse(file, path + ": cannot be read as bytes");
    }
    const std::string name = hdf5::read_text(source.dataset.get(), "name", file);
    models[name] = std::make_shared<const std::vector<unsigned char>>(std::move(bytes));
  }
  return models;
}

SessionFile::SessionFile(std::filesystem::path path, int descriptor, const SessionInfo& about,
                         Storage storage)
    : path_(std::move(path)), descriptor_(descriptor), storage_(storage), layout_(about.layout()) {
  SessionInfo info = about;
  if (info.arm) info.slides = slides_of(*info.arm);
  for (std::size_t i = 0; i < info.lanes(); ++i) lanes_.emplace_back(path_, info, storage);
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
  const hdf5::Properties access = hdf5::access_by(descriptor_, path_);
  H5Pset_libver_bounds(access.get(), H5F_LIBVER_LATEST, H5F_LIBVER_LATEST);
  // Writes rows to their places and nowhere else: without a cache (the file's, as starting to write
  // drops a dataset's own) and without filling.
  check(H5Pset_cache(access.get(), 0, 0, 0, 0) >= 0, path_, "cannot create");
  file_ = hdf5::File(H5Fcreate(path_.c_str(), H5F_ACC_TRUNC, creation.get(), access.get()));
  check(static_cast<bool>(file_), path_, "cannot create");
  write_attributes(file_.get(), info, path_);
  write_models(file_.get(), info.models, path_);
  lanes_[kMainLane].create(file_.get());
  marks_.create(file_.get(), path_);
  for (std::size_t i = 1; i < lanes_.size(); ++i) {
    const hdf5::Group group(
        H5Gcreate2(file_.get(), lane_name(i).c_str(), H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT));
    check(static_cast<bool>(group), path_, "cannot write");
    hdf5::write_text(group.get(), "config", info.beside[i - 1], path_);
    lanes_[i].create(group.get());
  }
  hdf5::Scales scales;
  if (info.arm) scales = hdf5::create_scales(file_.get(), *info.arm, info.bodies, path_);
  for (const SessionLane& lane : lanes_) lane.attach(scales);
  if (storage_ == Storage::packed) return;
  starting_ = true;
  check(H5Fstart_swmr_write(file_.get()) >= 0, path_, "cannot write");
  starting_ = false;
  check(H5Fflush(file_.get(), H5F_SCOPE_GLOBAL) >= 0, path_, "cannot write");
}

void SessionFile::append(std::span<const double> rows, std::size_t lane) {
  const auto stride = static_cast<std::size_t>(layout_.stride());
  if (rows.size() % stride != 0) {
    throw std::invalid_argument("only complete rows can be written to a session");
  }
  if (!file_) throw FileError(fmt::format("{}: is no longer open for writing", path_.string()));
  while (!rows.empty()) {
    if (!lanes_.at(lane).take(rows)) continue;
    guarded([&] {
      lanes_[lane].flush();
      if (lane == kMainLane) marks_.flush(path_);
    });
  }
}

void SessionFile::append(const SettingChange& change, std::size_t lane) {
  if (change.setting.size() > kSettingLength) {
    throw FileError(fmt::format("{}: a setting has {} characters; allowed: at most {}",
                                path_.string(), change.setting.size(), kSettingLength));
  }
  if (!file_) throw FileError(fmt::format("{}: is no longer open for writing", path_.string()));
  lanes_.at(lane).append(change);
}

void SessionFile::append(const Mark& mark) {
  check_mark(mark, path_);
  if (marks_.count() >= kMostMarks) {
    throw FileError(
        fmt::format("{}: a session can have at most {} marks", path_.string(), kMostMarks));
  }
  if (!file_) throw FileError(fmt::format("{}: is no longer open for writing", path_.string()));
  marks_.append(mark);
}

void SessionFile::append_world(std::span<const double> world, std::size_t lane) {
  if (world.size() > kMostWorld) {
    throw FileError(fmt::format("{}: {}: {} numbers; allowed: at most {}", path_.string(),
                                kWorldPath, world.size(), kMostWorld));
  }
  if (!file_) throw FileError(fmt::format("{}: is no longer open for writing", path_.string()));
  guarded([&] { lanes_.at(lane).append_world(world); });
}

// Writes the attribute after the file is closed: while others may read along, none can be made.
void SessionFile::write_warnings(const std::string& warnings) {
  const hdf5::Properties access = hdf5::access_by(descriptor_, path_);
  H5Pset_libver_bounds(access.get(), H5F_LIBVER_LATEST, H5F_LIBVER_LATEST);
  hdf5::File again(H5Fopen(path_.c_str(), H5F_ACC_RDWR, access.get()));
  // A recording that somebody has opened meanwhile gets none: its rows say the same.
  if (!again) return;
  hdf5::write_text(again.get(), "warnings", warnings, path_);
  check(again.close(), path_, "cannot write");
}

void SessionFile::close(const std::string& warnings) {
  if (!file_) return;
  guarded([&] {
    for (SessionLane& lane : lanes_) lane.flush();
    marks_.flush(path_);
    const bool packed = storage_ == Storage::packed;
    if (packed && !warnings.empty()) hdf5::write_text(file_.get(), "warnings", warnings, path_);
    // Closing hides errors of the last writes; flushing reports them.
    check(H5Fflush(file_.get(), H5F_SCOPE_GLOBAL) >= 0, path_, "cannot write");
    for (SessionLane& lane : lanes_) lane.close();
    check(marks_.close(), path_, "cannot write");
    check(file_.close(), path_, "cannot write");
    if (!packed && !warnings.empty()) write_warnings(warnings);
  });
}

void SessionFile::abandon() {
  if (!file_) return;
  const hdf5::Quiet quiet;
  hdf5::write_nowhere(file_);
  for (SessionLane& lane : lanes_) lane.abandon();
  marks_.close();
  // HDF5 1.14 crashes when it closes a file whose start failed.
  if (starting_) return file_.leave_open();
  file_.close();
}

}  // namespace limpid
