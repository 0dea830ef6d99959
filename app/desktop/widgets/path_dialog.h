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

  // A folder that is one click away.
  struct Place {
    std::string name;
    std::filesystem::path folder;
  };
  // While `open`. Returns the file once it is chosen, and clears `open`; `first` is what stands
  // there when it opens, `places` are beside the list.
  std::filesystem::path draw(bool& open, const std::filesystem::path& first,
                             const std::vector<Place>& places = {});
  // Of a file that was chosen elsewhere, where one that is replaced was asked about: it, or nothing
  // where it cannot be taken as it is. The dialog then opens with it, and says why.
  std::filesystem::path take(const std::filesystem::path& file);
  const Options& options() const { return options_; }
  // Home, documents, `own` folders, and those of the `recent` files: those that are there, each
  // once.
  static std::vector<Place> places(const std::vector<Place>& own,
                                   const std::vector<std::string>& recent);

 private:
  void draw_places(const std::vector<Place>& places);
  bool draw_folder();  // whether a file was clicked twice
  void draw_new_folder();
  void list_folder();
  void go_to(const std::filesystem::path& folder);
  // The file if it can be taken now.
  std::filesystem::path choose();

  Options options_;
  bool was_open_ = false;
  bool goes_on_ = false;  // opens with what was not taken
  std::string text_, listed_, complaint_;
  std::filesystem::path replaced_;  // the file that would be, once asked
  bool names_folder_ = false;       // a new one is being named
  std::string folder_name_;
  std::vector<std::filesystem::path> folders_, files_;
};

}  // namespace limpid
