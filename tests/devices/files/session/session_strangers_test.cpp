// Session files that name other files, or ask for more than they hold: a stranger's session must
// not carry away files beside it.
#include <fcntl.h>
#include <fmt/format.h>
#include <hdf5.h>
#include <sys/stat.h>

#include <array>
#include <cstdlib>
#include <fstream>

#include "devices/files/session/hdf5_reading.h"
#include "devices/files/session/session.h"
#include "tests/devices/files/session/sample_session.h"
#include "tests/devices/files/test_files.h"

namespace limpid {
namespace {

namespace fs = std::filesystem;
using test::refusal;
using testing::AllOf;
using testing::HasSubstr;

class StrangersSession : public testing::Test {
 protected:
  StrangersSession() {
    test::write_sample(dir_ / "a.h5", 50);
    test::write_file(dir_ / "key", std::string(4096, 'k'));
  }

  template <class Work>
  void change(Work work) {
    const hid_t file = H5Fopen(a_.c_str(), H5F_ACC_RDWR, H5P_DEFAULT);
    work(file);
    H5Fclose(file);
  }

  // Puts a dataset in place of the sample's model.
  void put_model(hid_t file, hsize_t size, hid_t creation, hid_t type = H5T_STD_U8LE) {
    H5Ldelete(file, "/models/0", H5P_DEFAULT);
    add_model(file, 0, size, creation, type);
  }

  void add_model(hid_t file, int number, hsize_t size, hid_t creation, hid_t type = H5T_STD_U8LE) {
    const hid_t space = H5Screate_simple(1, &size, nullptr);
    const std::string path = fmt::format("/models/{}", number);
    const hid_t data =
        H5Dcreate2(file, path.c_str(), type, space, H5P_DEFAULT, creation, H5P_DEFAULT);
    ASSERT_GE(data, 0);
    name_it(data, path);
    H5Dclose(data);
    H5Sclose(space);
  }

  void name_it(hid_t data, const std::string& name) {
    const hid_t text = H5Tcopy(H5T_C_S1);
    H5Tset_size(text, H5T_VARIABLE);
    const hid_t scalar = H5Screate(H5S_SCALAR);
    const hid_t attribute = H5Acreate2(data, "name", text, scalar, H5P_DEFAULT, H5P_DEFAULT);
    const char* pointer = name.c_str();
    H5Awrite(attribute, text, &pointer);
    H5Aclose(attribute);
    H5Sclose(scalar);
    H5Tclose(text);
  }

  // The error of reading the session, if any; models must never contain the key.
  std::string said() {
    return refusal([this] {
      const Session session = read_session(a_);
      for (const auto& [name, bytes] : session.info.models) {
        EXPECT_EQ(std::string(bytes->begin(), bytes->end()).find("kkk"), std::string::npos);
      }
    });
  }

  const test::TempDir dir_;
  const fs::path a_ = dir_ / "a.h5";
};

TEST_F(StrangersSession, DoesNotBringBytesOfAnotherFileThroughExternalStorage) {
  change([&](hid_t file) {
    const hid_t creation = H5Pcreate(H5P_DATASET_CREATE);
    ASSERT_GE(H5Pset_external(creation, (dir_ / "key").c_str(), 0, 4096), 0);
    put_model(file, 4096, creation);
    H5Pclose(creation);
  });
  EXPECT_THAT(said(), AllOf(HasSubstr("a.h5: /models/0"), HasSubstr("stored in other files")));
}

TEST_F(StrangersSession, DoesNotBringAColumnOfAnotherFileThroughExternalStorage) {
  change([&](hid_t file) {
    H5Ldelete(file, "/coupling/eta", H5P_DEFAULT);
    const hid_t creation = H5Pcreate(H5P_DATASET_CREATE);
    ASSERT_GE(H5Pset_external(creation, (dir_ / "key").c_str(), 0, 400), 0);
    const hsize_t size = 50;
    const hid_t space = H5Screate_simple(1, &size, nullptr);
    H5Dclose(H5Dcreate2(file, "/coupling/eta", H5T_IEEE_F64LE, space, H5P_DEFAULT, creation,
                        H5P_DEFAULT));
    H5Sclose(space);
    H5Pclose(creation);
  });
  EXPECT_THAT(said(), AllOf(HasSubstr("/coupling/eta"), HasSubstr("stored in other files")));
}

TEST_F(StrangersSession, DoesNotBringAVirtualDataset) {
  fs::copy(a_, dir_ / "other.h5");
  change([&](hid_t file) {
    const hsize_t size = 6;
    const hid_t space = H5Screate_simple(1, &size, nullptr);
    const hid_t creation = H5Pcreate(H5P_DATASET_CREATE);
    ASSERT_GE(H5Pset_virtual(creation, space, (dir_ / "other.h5").c_str(), "/models/0", space), 0);
    put_model(file, size, creation);
    H5Pclose(creation);
    H5Sclose(space);
  });
  EXPECT_THAT(said(), AllOf(HasSubstr("/models/0"), HasSubstr("other datasets")));
}

// Runs follow each other: a run that were left out in silence would be lost when the file is saved
// anew.
TEST_F(StrangersSession, HasNoRunWithoutTheOneBefore) {
  change([](hid_t file) {
    H5Gclose(H5Gcreate2(file, "/lane3", H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT));
  });
  EXPECT_THAT(said(), HasSubstr("a.h5: /lane3: exists, but /twin does not exist"));
}

// HDF5 opens the other file when it checks whether the link's target exists: a pipe would make it
// wait for ever.
TEST_F(StrangersSession, FollowsNoLinkToAnotherFile) {
  ASSERT_EQ(mkfifo((dir_ / "pipe").c_str(), 0600), 0);
  for (const char* path : {"/models", "/coupling/eta", "/twin", "/events", "/check"}) {
    for (const char* target : {"other.h5", "pipe"}) {
      fs::remove(a_);
      test::write_sample(a_, 50);
      fs::copy(a_, dir_ / "other.h5", fs::copy_options::overwrite_existing);
      change([&](hid_t file) {
        H5Ldelete(file, path, H5P_DEFAULT);
        ASSERT_GE(
            H5Lcreate_external((dir_ / target).c_str(), path, file, path, H5P_DEFAULT, H5P_DEFAULT),
            0);
      });
      EXPECT_THAT(said(), AllOf(HasSubstr(path), HasSubstr("a link to another file"))) << path;
    }
  }
}

TEST_F(StrangersSession, FollowsNoSoftLink) {
  change([&](hid_t file) {
    H5Ldelete(file, "/coupling/eta", H5P_DEFAULT);
    ASSERT_GE(H5Lcreate_soft("/time", file, "/coupling/eta", H5P_DEFAULT, H5P_DEFAULT), 0);
  });
  EXPECT_THAT(said(), AllOf(HasSubstr("/coupling/eta"), HasSubstr("a soft link")));
}

// HDF5 would look for a library of the stranger's filter, load it and call it.
TEST_F(StrangersSession, LoadsNoFilterThatItNames) {
  change([&](hid_t file) {
    const hid_t creation = H5Pcreate(H5P_DATASET_CREATE);
    const hsize_t chunk = 6;
    H5Pset_chunk(creation, 1, &chunk);
    ASSERT_GE(H5Pset_filter(creation, 300, H5Z_FLAG_OPTIONAL, 0, nullptr), 0);
    put_model(file, chunk, creation);
    H5Pclose(creation);
  });
  EXPECT_THAT(said(), AllOf(HasSubstr("/models/0"), HasSubstr("filter 300")));
  unsigned loading = 1;
  {
    const hdf5::Quiet quiet;
    ASSERT_GE(H5PLget_loading_state(&loading), 0);
  }
  EXPECT_EQ(loading, 0u);
}

TEST_F(StrangersSession, IsAFileAndNoPipe) {
  ASSERT_EQ(mkfifo((dir_ / "pipe.h5").c_str(), 0600), 0);
  EXPECT_THAT(refusal([&] { read_session(dir_ / "pipe.h5"); }), HasSubstr("not a file"));
  EXPECT_THAT(refusal([&] { write_marks(dir_ / "pipe.h5", {}, {}); }), HasSubstr("not a file"));
}

// Each dataset alone could be gzip's packing of the file; all of them together could not.
TEST_F(StrangersSession, MayNotClaimTheSameBytesManyTimes) {
  change([&](hid_t file) {
    const hid_t creation = H5Pcreate(H5P_DATASET_CREATE);
    const hsize_t chunk = 1 << 20;
    H5Pset_chunk(creation, 1, &chunk);
    H5Pset_deflate(creation, 9);
    put_model(file, 64 << 20, creation);
    const hid_t data = H5Dopen2(file, "/models/0", H5P_DEFAULT);
    const std::vector<unsigned char> zeros(64 << 20);
    ASSERT_GE(H5Dwrite(data, H5T_NATIVE_UINT8, H5S_ALL, H5S_ALL, H5P_DEFAULT, zeros.data()), 0);
    H5Dclose(data);
    for (int i = 1; i < 64; ++i) {
      H5Lcreate_hard(file, "/models/0", file, fmt::format("/models/{}", i).c_str(), H5P_DEFAULT,
                     H5P_DEFAULT);
    }
    H5Pclose(creation);
  });
  EXPECT_THAT(said(), AllOf(HasSubstr("/models/"), HasSubstr("more than a file of its size")));
}

// An unwritten dataset takes no room in the file and reads as zeros.
TEST_F(StrangersSession, MayNotClaimAModelThatWasNeverWritten) {
  change([&](hid_t file) { put_model(file, hsize_t{1} << 30, H5P_DEFAULT); });
  EXPECT_THAT(said(), AllOf(HasSubstr("/models/0"), HasSubstr("more than a file of its size")));
}

TEST_F(StrangersSession, MayNotBePackedInChunksThatFillTheMemory) {
  change([&](hid_t file) {
    const hid_t creation = H5Pcreate(H5P_DATASET_CREATE);
    const hsize_t chunk = hsize_t{3} << 30, size = 10, most = H5S_UNLIMITED;
    H5Pset_chunk(creation, 1, &chunk);
    H5Pset_deflate(creation, 9);
    H5Ldelete(file, "/models/0", H5P_DEFAULT);
    const hid_t space = H5Screate_simple(1, &size, &most);
    const hid_t data =
        H5Dcreate2(file, "/models/0", H5T_STD_U8LE, space, H5P_DEFAULT, creation, H5P_DEFAULT);
    ASSERT_GE(data, 0);
    name_it(data, "a.glb");
    H5Dclose(data);
    H5Sclose(space);
    H5Pclose(creation);
  });
  EXPECT_THAT(said(), AllOf(HasSubstr("/models/0"), HasSubstr("3072 MiB")));
}

TEST_F(StrangersSession, MayNotBeLargerThanTheMemory) {
  const hdf5::Quiet quiet;
  const hdf5::File file = hdf5::open_to_read(a_);
  hdf5::Claims claims(a_, 1000);
  claims.stored(hdf5::open_dataset(file.get(), "/models/0", a_));
  claims.take(1000, 1, "first");
  EXPECT_THAT(refusal([&] { claims.take(1, 1, "second"); }),
              AllOf(HasSubstr("second"), HasSubstr("larger than this computer's memory")));
}

TEST_F(StrangersSession, HasModelsOfBytesThatAreWhatTheyWere) {
  change([&](hid_t file) { put_model(file, 6, H5P_DEFAULT, H5T_STD_U16LE); });
  EXPECT_THAT(said(), HasSubstr("/models/0: cannot be read as bytes"));
  change([&](hid_t file) {
    const hid_t creation = H5Pcreate(H5P_DATASET_CREATE);
    const hsize_t chunk = 6, first = 0;
    H5Pset_chunk(creation, 1, &chunk);
    H5Pset_fletcher32(creation);
    put_model(file, chunk, creation);
    const hid_t data = H5Dopen2(file, "/models/0", H5P_DEFAULT);
    const std::string scrambled = "glTF and no sum";
    EXPECT_GE(H5Dwrite_chunk(data, H5P_DEFAULT, 0, &first, 10, scrambled.data()), 0);
    H5Dclose(data);
    H5Pclose(creation);
  });
  EXPECT_THAT(said(), HasSubstr("/models/0: cannot be read as bytes"));
}

// Well packed data is read: gzip makes a thousand zeros one byte.
TEST_F(StrangersSession, MayBePackedByGzip) {
  change([&](hid_t file) {
    const hid_t creation = H5Pcreate(H5P_DATASET_CREATE);
    const hsize_t chunk = 1 << 20;
    H5Pset_chunk(creation, 1, &chunk);
    H5Pset_shuffle(creation);
    H5Pset_deflate(creation, 9);
    H5Pset_fletcher32(creation);
    put_model(file, 32 << 20, creation);
    const hid_t data = H5Dopen2(file, "/models/0", H5P_DEFAULT);
    const std::vector<unsigned char> zeros(32 << 20);
    H5Dwrite(data, H5T_NATIVE_UINT8, H5S_ALL, H5S_ALL, H5P_DEFAULT, zeros.data());
    H5Dclose(data);
    H5Pclose(creation);
  });
  EXPECT_EQ(said(), "");
  EXPECT_EQ(read_session(a_).info.models.begin()->second->size(), std::size_t{32} << 20);
}

}  // namespace
}  // namespace limpid
