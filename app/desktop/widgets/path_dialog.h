// Asks for a file: a path to type, and the folder it is in to click through.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace limpid {

// "~/gear.glb" as a shell takes it.
std::filesystem::path expanded(const std::string& text);

class PathDialog {
 public:
  struct Options {
    const char* title;
    const char* action;                   // on the button
    std::vector<std::string> extensions;  // of the files that are listed
    bool new_file = false;                // need not be there; asks before one is replaced
  };
  explicit PathDialog(Options options) : options_(std::move(options)) {}

  // While `open`. Returns the file once it is chosen, and clears `open`; `first` is what stands
  // there when it opens.
  std::filesystem::path draw(bool& open, const std::filesystem::path& first);

 private:
  void list_folder();
  void go_to(const std::filesystem::path& folder);
  // The file if it can be taken now.
  std::filesystem::path choose();

  Options options_;
  bool was_open_ = false;
  std::string text_, listed_, complaint_;
  std::filesystem::path replaced_;  // the file that would be, once asked
  std::vector<std::filesystem::path> folders_, files_;
};

}  // namespace limpid
