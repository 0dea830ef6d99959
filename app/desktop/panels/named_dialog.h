// What is kept by name: to be used, saved, renamed and removed.
#pragma once

#include <string>

#include "app/desktop/base/window_layout.h"

namespace limpid {

class NamedDialog {
 public:
  struct Options {
    const char* title;
    const char* what;  // "layout"
    const char* help;  // what is kept, in a sentence
  };
  explicit NamedDialog(Options options) : options_(options) {}

  enum class Request { none, use, keep };
  struct Asked {
    Request request = Request::none;
    std::string name;
  };
  // While `open`. Renames and removes; what is to be used, or to be kept of what is there now, is
  // up to the caller, who says by complain() what went wrong.
  Asked draw(bool& open, NamedTexts& texts);
  void complain(const std::string& what) { complaint_ = what; }

 private:
  Asked draw_list(const NamedTexts& texts);
  Asked draw_buttons(NamedTexts& texts);
  void draw_changes(NamedTexts& texts);
  Asked draw_name(const NamedTexts& texts, bool entered);
  void choose(const std::string& name);

  Options options_;
  bool was_open_ = false;
  std::string chosen_, name_, complaint_;
  bool sure_ = false;  // that the chosen one is to go
};

}  // namespace limpid
