// Dialog that asks for a file: a path to type, and its folder to click through.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace limpid {

// Returns a path with "~" expanded as a shell does.
std::filesystem::path expanded(const std::string& text);

class PathDialog {
 public:
  struct Options {
    const char* title;
    const char* action;                   // label of the button
    std::vector<std::string> extensions;  // of the files listed
    bool new_file = false;                // for a file to write; asks before it replaces one
  };
  explicit PathDialog(Options options) : options_(std::move(options)) {}

  // Folder that is one click away.
  struct Place {
    std::string name;
    std::filesystem::path folder;
  };
  // Draws the dialog while `open`. Returns the file once it is chosen, and clears `open`. `first`
  // is the path at opening, `places` are beside the list.
  std::filesystem::path draw(bool& open, const std::filesystem::path& first,
                             const std::vector<Place>& places = {});
  // Takes a file from another dialog, which has asked about replacing. Returns it, or nothing if it
  // is not acceptable; then this dialog opens with it and says why.
  std::filesystem::path take(const std::filesystem::path& file);
  const Options& options() const { return options_; }
  // Returns home, documents, `own` folders, and those of the `recent` files: existing ones, each
  // once.
  static std::vector<Place> places(const std::vector<Place>& own,
                                   const std::vector<std::string>& recent);

 private:
  void draw_places(const std::vector<Place>& places);
  bool draw_folder();  // returns whether a file was double-clicked
  void draw_new_folder();
  void list_folder();
  void go_to(const std::filesystem::path& folder);
  // Returns the file if it is acceptable now.
  std::filesystem::path choose();

  Options options_;
  bool was_open_ = false;
  bool goes_on_ = false;  // opens with the file that was not acceptable
  std::string text_, listed_, complaint_;
  std::filesystem::path replaced_;  // an existing file that the user was asked about
  bool names_folder_ = false;       // the name of a new folder is being typed
  std::string folder_name_;
  std::vector<std::filesystem::path> folders_, files_;
};

}  // namespace limpid
