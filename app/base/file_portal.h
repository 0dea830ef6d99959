// The desktop's own file dialog, asked over the session's bus
// (org.freedesktop.portal.FileChooser).
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace limpid {

class FilePortal {
 public:
  struct Question {
    std::string title, action;
    std::vector<std::string> extensions;  // of the files that are listed, such as ".toml"
    bool new_file = false;        // it need not be there; the desktop asks before it replaces one
    std::filesystem::path first;  // a folder with / at its end, or the new file
    std::string parent;           // window of the dialog, as portals name it; may be empty
  };
  enum class State : std::uint8_t {
    asked,
    shown,
    chosen,
    given_up,
    absent  // nobody answers within a second, or in the end; a dialog that comes later is closed
  };

  explicit FilePortal(Question question);
  // Closes the dialog. No function here waits for the bus.
  ~FilePortal();
  FilePortal(const FilePortal&) = delete;
  FilePortal& operator=(const FilePortal&) = delete;

  struct Talk;  // state of the question on both sides

  State state() const;
  std::filesystem::path file() const;  // once it is chosen

 private:
  std::shared_ptr<Talk> talk_;
};

// Returns the version of the portal that answers within a second. May take seconds.
std::optional<unsigned> file_portal_version();

}  // namespace limpid
