// Sections of the panel at the right, in one table.
#pragma once

#include <functional>
#include <utility>
#include <vector>

#include "app/desktop/base/notices.h"

namespace limpid {

class Desktop;

using DrawSection = std::function<void(const Act&)>;

struct SectionKind {
  const char* title;
  bool (*open)(const Desktop&);    // at the start of the window
  DrawSection (*make)(Desktop&);   // with the section's own state; once
  bool (*simple)(const Desktop&);  // whether it stands in the simple window, too
};

class Sections {
 public:
  explicit Sections(Desktop& desktop);

  void draw(const Act& act);  // into the open panel

 private:
  Desktop& desktop_;
  bool device_first_ = false;
  std::vector<std::pair<const SectionKind*, DrawSection>> drawn_;
};

}  // namespace limpid
