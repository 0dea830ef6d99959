// limpid-model: reads a model of another kind than glTF and writes it as glTF. What a broken or
// hostile file does to the library that reads it ends this program, not the one at a device.
//
//   limpid-model KIND FOLDER NUMBER <model >model.glb
//
// KIND is a suffix as "stl"; FOLDER may have files that the model refers to, if it is not empty;
// nothing else is within its reach (see sandbox.h). To the file of descriptor NUMBER, which is 3,
// go lines: "part 0.5", "warning ...", "outside" if other files were read, "bytes 123" of the model
// and those together; "error ..." or, if there was too little of that, "memory", and it leaves
// with 1.
#include <fcntl.h>
#include <sys/mman.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <stdexcept>

#include "core/base/descriptor.h"
#include "core/base/model_kinds.h"
#include "core/base/sandbox.h"
#include "render/model/assimp/assimp_files.h"
#include "render/model/assimp/assimp_model.h"
#include "render/model/assimp/glb_writer.h"
#include "render/model/model_program.h"

namespace {

// More than a model of so many bytes needs: some broken files are read for ever. The limits that
// can be raised again grow with the files that it turns out to refer to.
void limit_self(std::size_t bytes) {
  const limpid::ReaderLimits now = limpid::reader_limits(bytes);
  const limpid::ReaderLimits most = limpid::reader_limits(limpid::kLargestModelFiles);
  const rlimit none{0, 0}, seconds{now.seconds, most.seconds}, memory{now.memory, most.memory};
  setrlimit(RLIMIT_CORE, &none);
  setrlimit(RLIMIT_CPU, &seconds);
  if (!limpid::kSanitized) setrlimit(RLIMIT_AS, &memory);
}

std::span<const unsigned char> standard_input() {
  struct stat about {};
  if (fstat(STDIN_FILENO, &about) != 0 || about.st_size <= 0) throw std::runtime_error("is empty");
  const auto size = static_cast<std::size_t>(about.st_size);
  void* const bytes = mmap(nullptr, size, PROT_READ, MAP_PRIVATE, STDIN_FILENO, 0);
  if (bytes == MAP_FAILED) throw std::runtime_error("cannot be read");
  return {static_cast<const unsigned char*>(bytes), size};
}

}  // namespace

int main(int count, char** words) {
  if (count != 4) {
    std::fputs("limpid-model belongs to limpid, which calls it.\n", stderr);
    return 2;
  }
  std::FILE* const lines = fdopen(std::atoi(words[3]), "w");
  if (lines == nullptr) return 2;
  setlinebuf(lines);
  try {
    const std::string name = "model", kind = words[1];
    const limpid::ModelKind* const known = limpid::model_kind(name + "." + kind);
    if (known == nullptr) throw std::runtime_error("is of an unknown kind: " + kind);
    const auto bytes = standard_input();
    std::size_t size = bytes.size();
    limit_self(size);
    limpid::enter_sandbox(words[2]);
    limpid::Companions companions(name, words[2],
                                  std::min(bytes.size(), limpid::kLargestModelFiles));
    const auto better = limpid::readable(bytes, kind);
    const std::span<const unsigned char> model = better ? *better : bytes;
    limpid::guard_counts(model, kind);
    const auto grow = [&](std::size_t more) {
      limit_self(size += more);
      std::fprintf(lines, "bytes %zu\n", size);
    };
    auto* const files = new limpid::AssimpFiles(model, kind, companions, grow);
    const auto read = limpid::read_with_assimp(
        files, *known, [&](double part) { std::fprintf(lines, "part %.3f\n", part); });
    for (const std::string& warning : read.model.warnings)
      std::fprintf(lines, "warning %s\n", warning.c_str());
    if (read.outside) std::fputs("outside\n", lines);
    if (!limpid::write_all(STDOUT_FILENO, limpid::glb_of(read.model, read.pictures))) {
      throw std::runtime_error("is too large for this computer's memory");
    }
    return std::fclose(lines) == 0 ? 0 : 1;
  } catch (const std::bad_alloc&) {
    std::fputs("memory\n", lines);
  } catch (const std::exception& e) {
    std::fprintf(lines, "error %s\n", e.what());
  }
  std::fflush(lines);
  return 1;
}
