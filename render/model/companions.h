// The files that a model refers to: in its folder and below, limited in size together.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace limpid {

inline constexpr std::size_t kLargestModelFiles = std::size_t{512} << 20;  // [bytes] together

// Reads a file. Throws std::runtime_error naming it if it is no file, larger than `most` or
// unreadable.
std::vector<unsigned char> read_bytes(const std::filesystem::path& path, std::size_t most);

// Makes words of a file fit for a message: no line ends, no control characters, not too long.
std::string one_line(std::string text);

// Throws std::runtime_error: the name, and why in one line.
[[noreturn]] void refuse(const std::string& name, const std::string& why);

// Decodes the characters that a URI encodes, as %20. Other percent signs stay.
std::string decoded_uri(const std::string& uri);

class Companions {
 public:
  // `name` stands for the model in messages and must outlive this; the model's own `size` counts,
  // too. An empty `folder` has no files.
  Companions(const std::string& name, std::filesystem::path folder, std::size_t size)
      : name_(name), folder_(std::move(folder)), left_(kLargestModelFiles - size) {}

  bool none() const { return folder_.empty(); }
  // Takes the file of exactly that name, else of the name that the URI encodes, as my%20file.
  // Returns nothing for a file that does not exist. Throws std::runtime_error naming the model for
  // one that lies elsewhere, cannot be read, or makes all of them too large.
  std::optional<std::vector<unsigned char>> read(const std::string& uri);

 private:
  std::filesystem::path resolve(const std::string& uri) const;

  const std::string& name_;
  std::filesystem::path folder_;
  std::size_t left_;  // bytes
};

}  // namespace limpid
