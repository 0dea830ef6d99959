// Dialog of named texts: use, save, rename and remove them.
#pragma once

#include <string>

#include "app/desktop/base/window_layout.h"

namespace limpid {

class NamedDialog {
 public:
  struct Options {
    const char* title;
    const char* what;  // "layout"
    const char* help;  // sentence on its contents
  };
  explicit NamedDialog(Options options) : options_(options) {}

  enum class Request { none, use, keep };
  struct Asked {
    Request request = Request::none;
    std::string name;
  };
  // Draws the dialog while `open`. Renames and removes by itself. The caller uses a text, or keeps
  // the present one, and reports failures by complain().
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
  bool sure_ = false;  // the user has confirmed that the chosen one goes
};

}  // namespace limpid
