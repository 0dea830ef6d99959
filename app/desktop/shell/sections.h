// The sections of the panel at the right: one table.
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
  bool (*open)(const Desktop&);   // when the window begins
  DrawSection (*make)(Desktop&);  // with what it remembers; once
};

class Sections {
 public:
  explicit Sections(Desktop& desktop);

  void draw(const Act& act);  // inside of the panel

 private:
  Desktop& desktop_;
  std::vector<std::pair<const SectionKind*, DrawSection>> drawn_;
};

}  // namespace limpid
