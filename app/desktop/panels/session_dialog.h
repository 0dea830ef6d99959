// Asks for a recording to open.
#pragma once

#include <filesystem>
#include <string>

namespace limpid {

class SessionDialog {
 public:
  // While `open`. Returns the file once it is chosen, and clears `open`.
  std::filesystem::path draw(bool& open);

 private:
  bool was_shown_ = false;
  std::string typed_, complaint_;
};

}  // namespace limpid
