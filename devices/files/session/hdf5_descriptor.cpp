#include "devices/files/session/hdf5_descriptor.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <limits>

#if __has_include(<H5FDdevelop.h>)
#include <H5FDdevelop.h>
#endif

namespace limpid::hdf5 {

namespace {

// A file of this driver; HDF5's own part has to come first.
struct OpenFile {
  H5FD_t common{};
  int descriptor = -1;
  haddr_t announced = 0;  // bytes that HDF5 has reserved
};

OpenFile& own(H5FD_t* file) { return *reinterpret_cast<OpenFile*>(file); }
const OpenFile& own(const H5FD_t* file) { return *reinterpret_cast<const OpenFile*>(file); }

// Reports an error as HDF5's own driver does, for last_error().
herr_t failed(const char* what) {
  H5Epush2(H5E_DEFAULT, "hdf5_descriptor.cpp", what, 0, H5E_ERR_CLS, H5E_IO, H5E_CANTOPERATE,
           "%s failed, errno = %d", what, errno);
  return -1;
}

H5FD_t* open(const char*, unsigned flags, hid_t access, haddr_t) {
  const auto* const given = static_cast<const int*>(H5Pget_driver_info(access));
  const int descriptor = given ? ::fcntl(*given, F_DUPFD_CLOEXEC, 0) : -1;
  if (descriptor < 0) return nullptr;
  if ((flags & H5F_ACC_TRUNC) != 0 && ::ftruncate(descriptor, 0) != 0) {
    failed("truncate");
    ::close(descriptor);
    return nullptr;
  }
  auto* file = new OpenFile;
  file->descriptor = descriptor;
  return &file->common;
}

herr_t close(H5FD_t* file) {
  const int result = ::close(own(file).descriptor);
  delete &own(file);
  return result;
}

// Abilities of HDF5's own driver for files.
herr_t query(const H5FD_t*, unsigned long* can) {
  *can = H5FD_FEAT_AGGREGATE_METADATA | H5FD_FEAT_ACCUMULATE_METADATA | H5FD_FEAT_DATA_SIEVE |
         H5FD_FEAT_AGGREGATE_SMALLDATA | H5FD_FEAT_SUPPORTS_SWMR_IO |
         H5FD_FEAT_DEFAULT_VFD_COMPATIBLE;
  return 0;
}

herr_t handle(H5FD_t* file, hid_t, void** descriptor) {
  *descriptor = &own(file).descriptor;
  return 0;
}

haddr_t announced(const H5FD_t* file, H5FD_mem_t) { return own(file).announced; }

herr_t announce(H5FD_t* file, H5FD_mem_t, haddr_t bytes) {
  own(file).announced = bytes;
  return 0;
}

haddr_t size(const H5FD_t* file, H5FD_mem_t) {
  struct stat about {};
  return ::fstat(own(file).descriptor, &about) == 0 ? static_cast<haddr_t>(about.st_size) : 0;
}

// Reads; behind the end of the file there are zeros.
herr_t read(H5FD_t* file, H5FD_mem_t, hid_t, haddr_t at, size_t left, void* into) {
  auto* to = static_cast<unsigned char*>(into);
  while (left > 0) {
    const ssize_t got = ::pread(own(file).descriptor, to, left, static_cast<off_t>(at));
    if (got < 0 && errno == EINTR) continue;
    if (got < 0) return failed("read");
    if (got == 0) {
      std::memset(to, 0, left);
      return 0;
    }
    const auto bytes = static_cast<std::size_t>(got);
    to += bytes, at += bytes, left -= bytes;
  }
  return 0;
}

herr_t write(H5FD_t* file, H5FD_mem_t, hid_t, haddr_t at, size_t left, const void* bytes) {
  const auto* from = static_cast<const unsigned char*>(bytes);
  while (left > 0) {
    const ssize_t put = ::pwrite(own(file).descriptor, from, left, static_cast<off_t>(at));
    if (put < 0 && errno == EINTR) continue;
    if (put <= 0) return failed("write");
    const auto done = static_cast<std::size_t>(put);
    from += done, at += done, left -= done;
  }
  return 0;
}

herr_t truncate(H5FD_t* file, hid_t, hbool_t) {
  const OpenFile& self = own(file);
  if (size(file, H5FD_MEM_DEFAULT) == self.announced) return 0;
  if (::ftruncate(self.descriptor, static_cast<off_t>(self.announced)) == 0) return 0;
  return failed("truncate");
}

// Do nothing: HDF5 marks a file as being written only if its driver has them.
herr_t lock(H5FD_t*, hbool_t) { return 0; }
herr_t unlock(H5FD_t*) { return 0; }

H5FD_class_t driver() {
  H5FD_class_t all{};
#ifdef H5FD_CLASS_VERSION
  all.version = H5FD_CLASS_VERSION;
  all.value = static_cast<H5FD_class_value_t>(600);  // values from 512 on are free
#endif
  all.name = "limpid-descriptor";
  all.maxaddr = static_cast<haddr_t>(std::numeric_limits<off_t>::max());
  all.fc_degree = H5F_CLOSE_WEAK;
  all.fapl_size = sizeof(int);
  all.open = open;
  all.close = close;
  all.query = query;
  all.get_eoa = announced;
  all.set_eoa = announce;
  all.get_eof = size;
  all.get_handle = handle;
  all.read = read;
  all.write = write;
  all.truncate = truncate;
  all.lock = lock;
  all.unlock = unlock;
  const H5FD_mem_t lists[] = H5FD_FLMAP_DICHOTOMY;
  std::copy(std::begin(lists), std::end(lists), std::begin(all.fl_map));
  return all;
}

}  // namespace

void write_nowhere(const File& file) {
  void* descriptor = nullptr;
  const int null_device = ::open("/dev/null", O_RDWR | O_CLOEXEC);
  if (H5Fget_vfd_handle(file.get(), H5P_DEFAULT, &descriptor) >= 0 && null_device >= 0) {
    ::dup3(null_device, *static_cast<int*>(descriptor), O_CLOEXEC);
  }
  if (null_device >= 0) ::close(null_device);
}

Properties access_by(int descriptor, const std::filesystem::path& file) {
  static const H5FD_class_t kDriver = driver();
  static const hid_t registered = H5FDregister(&kDriver);
  Properties access(H5Pcreate(H5P_FILE_ACCESS));
  check(registered >= 0 && H5Pset_driver(access.get(), registered, &descriptor) >= 0, file,
        "cannot be opened");
  return access;
}

}  // namespace limpid::hdf5
