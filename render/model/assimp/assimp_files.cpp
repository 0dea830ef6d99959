#include "render/model/assimp/assimp_files.h"

#include <algorithm>
#include <cctype>
#include <cstring>
#include <stdexcept>
#include <string_view>

#include "render/model/assimp/readable.h"

namespace limpid {
namespace {

// Bytes in memory, its own or somebody else's.
class Stream : public Assimp::IOStream {
 public:
  explicit Stream(std::span<const unsigned char> bytes) : bytes_(bytes) {}
  explicit Stream(std::vector<unsigned char> own) : own_(std::move(own)), bytes_(own_) {}

  std::size_t Read(void* to, std::size_t size, std::size_t count) override {
    if (size == 0) return 0;
    const std::size_t whole = std::min(count, (bytes_.size() - at_) / size);
    if (whole > 0) std::memcpy(to, bytes_.data() + at_, whole * size);
    at_ += whole * size;
    return whole;
  }
  std::size_t Write(const void*, std::size_t, std::size_t) override { return 0; }
  aiReturn Seek(std::size_t offset, aiOrigin origin) override {
    const std::size_t from = origin == aiOrigin_SET   ? 0
                             : origin == aiOrigin_CUR ? at_
                                                      : bytes_.size();
    if (offset > bytes_.size() - from) return aiReturn_FAILURE;
    at_ = from + offset;
    return aiReturn_SUCCESS;
  }
  std::size_t Tell() const override { return at_; }
  std::size_t FileSize() const override { return bytes_.size(); }
  void Flush() override {}

 private:
  std::vector<unsigned char> own_;
  std::span<const unsigned char> bytes_;
  std::size_t at_ = 0;
};

std::string kind_of(const std::string& file) {
  const std::size_t dot = file.rfind('.');
  std::string kind = dot == std::string::npos ? "" : file.substr(dot + 1);
  std::ranges::transform(kind, kind.begin(),
                         [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return kind;
}

// Models made elsewhere name files as their own system does.
std::string portable(std::string file) {
  std::replace(file.begin(), file.end(), '\\', '/');
  while (file.starts_with("./")) file.erase(0, 2);
  for (std::size_t at = file.find("%20"); at != file.npos; at = file.find("%20", at + 1))
    file.replace(at, 3, " ");
  return file;
}

}  // namespace

Assimp::IOStream* AssimpFiles::Open(const char* file, const char* mode) {
  if (std::strchr(mode, 'w') != nullptr) return nullptr;
  if (file == main_) return new Stream(bytes_);
  if (std::string_view(file).starts_with(kStem)) return nullptr;
  auto found = read(file);
  if (auto better = readable(found, kind_of(file))) found = std::move(*better);
  return found.empty() ? nullptr : new Stream(std::move(found));
}

std::vector<unsigned char> AssimpFiles::read(const std::string& file) {
  std::string why = " is missing";
  try {
    if (auto found = companions_.none() ? std::nullopt : companions_.read(portable(file))) {
      any_read_ = true;
      found_(found->size());
      return std::move(*found);
    }
  } catch (const std::runtime_error&) {
    why = " lies outside of the model's folder, or is too large";
  }
  warnings_.push_back("\"" + one_line(file) + "\"" + why + ", it is left out");
  return {};
}

}  // namespace limpid
