#include "devices/files/session/session_file.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <stdexcept>

#include "devices/files/file_size_signal.h"
#include "devices/files/session/dimension_scales.h"
#include "devices/files/session/session_attributes.h"
#include "devices/files/session/session_models.h"
#include "devices/files/session/session_names.h"

namespace limpid {
namespace {

using hdf5::check;

constexpr hsize_t kPage = 4096;  // bytes

// Nothing small is placed across the end of a page.
hdf5::Properties placed_within_pages() {
  hdf5::Properties creation(H5Pcreate(H5P_FILE_CREATE));
  H5Pset_file_space_strategy(creation.get(), H5F_FSPACE_STRATEGY_PAGE, false, 1);
  H5Pset_file_space_page_size(creation.get(), kPage);
  return creation;
}

}  // namespace

SessionFile::SessionFile(std::filesystem::path path, const SessionInfo& about)
    : path_(std::move(path)), layout_(about.dof) {
  SessionInfo info = about;
  if (info.arm) info.slides = slides_of(*info.arm);
  lanes_.emplace_back(path_, info);
  if (info.twin) lanes_.emplace_back(path_, info);
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
  lanes_[kMainLane].create(file_.get());
  if (info.twin) {
    const hdf5::Group twin(
        H5Gcreate2(file_.get(), kTwinGroup, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT));
    check(static_cast<bool>(twin), path_, "cannot write");
    hdf5::write_text(twin.get(), "config", *info.twin, path_);
    lanes_[kTwinLane].create(twin.get());
  }
  hdf5::Scales scales;
  if (info.arm) scales = hdf5::create_scales(file_.get(), *info.arm, path_);
  for (const SessionLane& lane : lanes_) lane.attach(scales);
  starting_ = true;
  check(H5Fstart_swmr_write(file_.get()) >= 0, path_, "cannot write");
  starting_ = false;
  check(H5Fflush(file_.get(), H5F_SCOPE_GLOBAL) >= 0, path_, "cannot write");
}

void SessionFile::append(std::span<const double> rows, std::size_t lane) {
  const auto stride = static_cast<std::size_t>(layout_.stride());
  if (rows.size() % stride != 0) {
    throw std::invalid_argument("a session takes whole rows only");
  }
  if (!file_) throw FileError(fmt::format("{}: not open for writing any more", path_.string()));
  while (!rows.empty()) {
    if (lanes_.at(lane).take(rows)) guarded([&] { lanes_[lane].flush(); });
  }
}

void SessionFile::append(const SettingChange& change, std::size_t lane) {
  if (change.setting.size() > kSettingLength) {
    throw FileError(fmt::format("{}: setting of {} characters, at most {} are kept", path_.string(),
                                change.setting.size(), kSettingLength));
  }
  if (!file_) throw FileError(fmt::format("{}: not open for writing any more", path_.string()));
  lanes_.at(lane).append(change);
}

void SessionFile::close() {
  if (!file_) return;
  guarded([&] {
    for (SessionLane& lane : lanes_) lane.flush();
    // Closing hides errors of the last writes; flushing tells them.
    check(H5Fflush(file_.get(), H5F_SCOPE_GLOBAL) >= 0, path_, "cannot write");
    for (SessionLane& lane : lanes_) lane.close();
    check(file_.close(), path_, "cannot write");
  });
}

// HDF5 cannot forget what it has not written yet: closing writes, and fails for ever on a full
// disk. So it gets the null device in place of the file and may write there what it likes.
void SessionFile::abandon() {
  if (!file_) return;
  const hdf5::Quiet quiet;
  if (starting_) {
    // HDF5 1.14 crashes when it closes a file whose start failed. As it stays open, no other file
    // gets its place on the disk, which HDF5 would take for the same one.
    for (SessionLane& lane : lanes_) lane.abandon();
    return file_.leave_open();
  }
  void* descriptor = nullptr;
  const int null_device = ::open("/dev/null", O_RDWR | O_CLOEXEC);
  if (H5Fget_vfd_handle(file_.get(), H5P_DEFAULT, &descriptor) >= 0 && null_device >= 0) {
    ::dup2(null_device, *static_cast<int*>(descriptor));
  }
  if (null_device >= 0) ::close(null_device);
  for (SessionLane& lane : lanes_) lane.abandon();
  file_.close();
}

}  // namespace limpid
