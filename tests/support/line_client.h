// A client of a control socket: it writes lines, and reads those that have come.
#pragma once

#include <gtest/gtest.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include <array>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <utility>

namespace limpid::test {

class LineClient {
 public:
  explicit LineClient(const std::filesystem::path& path) : file_(socket(AF_UNIX, SOCK_STREAM, 0)) {
    sockaddr_un address{};
    address.sun_family = AF_UNIX;
    path.string().copy(address.sun_path, sizeof(address.sun_path) - 1);
    EXPECT_EQ(connect(file_, reinterpret_cast<sockaddr*>(&address), sizeof(address)), 0);
  }
  ~LineClient() { leave(); }
  LineClient(const LineClient&) = delete;
  LineClient& operator=(const LineClient&) = delete;

  void leave() {
    if (file_ >= 0) close(std::exchange(file_, -1));
  }
  void say(const std::string& line) const {
    const std::string text = line + "\n";
    ASSERT_EQ(send(file_, text.data(), text.size(), 0), static_cast<ssize_t>(text.size()));
  }
  // Takes the next line, if one has come.
  std::optional<nlohmann::json> take() {
    std::size_t end = received_.find('\n');
    if (end == std::string::npos) {
      std::array<char, 4096> bytes{};
      while (end == std::string::npos) {
        const ssize_t size = recv(file_, bytes.data(), bytes.size(), MSG_DONTWAIT);
        if (size <= 0) break;
        received_.append(bytes.data(), static_cast<std::size_t>(size));
        end = received_.find('\n');
      }
    }
    if (end == std::string::npos) return std::nullopt;
    const nlohmann::json line = nlohmann::json::parse(received_.substr(0, end));
    received_.erase(0, end + 1);
    return line;
  }

 private:
  int file_;
  std::string received_;
};

// Return the answer of a line that grants a request, and the reason of one that refuses it.
inline nlohmann::json granted(const nlohmann::json& line) {
  EXPECT_TRUE(line.contains("ok")) << line;
  return line.value("ok", nlohmann::json());
}
inline std::string reason(const nlohmann::json& line) {
  EXPECT_TRUE(line.contains("error")) << line;
  return line.value("error", "");
}

}  // namespace limpid::test
