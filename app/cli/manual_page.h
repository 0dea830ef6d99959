// The manual: one page for a browser, made of what stands elsewhere already.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace limpid {

// Keys of the window under a heading, each with what it does.
struct ManualKey {
  std::string group, keys, what;
};

// Returns the page as HTML, of the READMEs of a source tree, all settings, and these keys. Links
// among the READMEs lead within the page, and pictures are in it as data. Errors: FileError, which
// names the README and the file that is missing or no picture.
std::string manual_html(const std::filesystem::path& tree, const std::vector<ManualKey>& keys);

}  // namespace limpid
